#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::{
    RangeNoise,
    draws::{Draws, paper_stations, ring},
};
use world::{Boundary, Point};

fn config(stations: Vec<Station>, start: Pose) -> PositionerConfig {
    PositionerConfig { noise: RangeNoise::Uniform { ratio: 0.05 }, ..PositionerConfig::new(stations, start) }
}

fn at_the_origin(stations: &[Station]) -> Positioner {
    Positioner::new(config(stations.to_vec(), Pose::new(0.0, 0.0, 0.0)))
}

#[test]
fn a_cycle_gives_ranges_a_fix_and_a_better_estimate() {
    let stations = paper_stations();
    let (mut positioner, mut draws) = (at_the_origin(&stations), Draws::new(0.05, 20, 1));
    let before = positioner.error_95_m();
    let result = positioner.cycle(&draws.cycle(&stations, Point::new(0.03, -0.02)));
    assert_eq!(result.rangings.len(), 3);
    assert_eq!(result.fix.unwrap().used.len(), 3);
    assert!(result.accepted && positioner.error_95_m() < before);
}

#[test]
fn silent_stations_are_named() {
    let stations = ring(4, 7.5);
    let (mut positioner, mut draws) = (at_the_origin(&stations), Draws::new(0.05, 20, 1));
    let mut sets = draws.cycle(&stations, Point::origin());
    sets[1].ranges_m.clear();
    sets.remove(2);
    let fix = positioner.cycle(&sets).fix.unwrap();
    assert_eq!(fix.excluded, [(StationId(2), Exclusion::Silent), (StationId(3), Exclusion::Silent)]);
    assert_eq!(fix.integrity, Integrity::Untestable);
    assert!(fix.mirror.is_some());
}

#[test]
fn one_station_alone_gives_no_fix_but_helps_the_estimate() {
    let stations = paper_stations();
    let (mut positioner, mut draws) = (at_the_origin(&stations), Draws::new(0.0, 20, 1));
    let result = positioner.cycle(&draws.cycle(&stations[..1], Point::new(0.05, 0.0)));
    assert_eq!(result.fix, Err(FixError::TooFewStations { have: 1, need: 2 }));
    assert!(result.accepted);
    assert!(positioner.estimate().pose.position.x > 0.01);
    assert!(!positioner.cycle(&[]).accepted);
}

#[test]
fn a_range_that_is_none_spoils_the_cycle_but_not_the_estimate() {
    let stations = paper_stations();
    let (mut positioner, mut draws) = (at_the_origin(&stations), Draws::new(0.05, 20, 1));
    let mut sets = draws.cycle(&stations, Point::origin());
    sets[2].ranges_m[7] = f64::NAN;
    let before = positioner.estimate();
    let result = positioner.cycle(&sets);
    assert_eq!(result.fix, Err(FixError::BadRange { station: StationId(3) }));
    assert!(!result.accepted && result.rangings.is_empty());
    assert_eq!(positioner.estimate(), before);
}

#[test]
fn a_fix_under_alarm_does_not_move_the_estimate() {
    let stations = ring(4, 7.5);
    let (mut positioner, mut draws) = (at_the_origin(&stations), Draws::new(0.05, 20, 1));
    let mut sets = draws.cycle(&stations, Point::origin());
    sets[0].ranges_m.iter_mut().for_each(|r| *r += 1.5);
    let before = positioner.estimate();
    let result = positioner.cycle(&sets);
    assert_eq!(result.fix.unwrap().integrity, Integrity::Alarm);
    assert!(!result.accepted);
    assert_eq!(positioner.estimate(), before);
}

#[test]
fn with_five_stations_the_one_that_lies_is_left_out() {
    let stations = ring(5, 7.5);
    let (mut positioner, mut draws) = (at_the_origin(&stations), Draws::new(0.05, 20, 1));
    let mut sets = draws.cycle(&stations, Point::origin());
    sets[3].ranges_m.iter_mut().for_each(|r| *r += 1.0);
    let result = positioner.cycle(&sets);
    let fix = result.fix.unwrap();
    assert!(matches!(fix.excluded[..], [(StationId(4), Exclusion::Residual { residual_m, gate_m })]
        if (residual_m - 1.0).abs() < 0.2 && gate_m < 0.5));
    assert_eq!(fix.integrity, Integrity::Ok);
    assert!(result.accepted && fix.position.coords.norm() < 0.15);
}

#[test]
fn a_robot_that_was_stopped_while_its_tracks_went_on_is_found_again() {
    let stations = paper_stations();
    let (mut positioner, mut draws) = (at_the_origin(&stations), Draws::new(0.05, 20, 9));
    let mut accepted = Vec::new();
    for _ in 0..6 {
        for _ in 0..10 {
            positioner.predict(&Odometry { forward_m: 0.03, sideways_m: 0.0, turn_rad: 0.0 });
        }
        let result = positioner.cycle(&draws.cycle(&stations, Point::new(-3.0, 0.0)));
        accepted.push((result.accepted, result.fix.unwrap().integrity));
    }
    assert_eq!(accepted[..2], [(false, Integrity::Suspect); 2]);
    assert!(accepted[2].0);
    assert!((positioner.estimate().pose.position - Point::new(-3.0, 0.0)).norm() < 0.4);
}

#[test]
fn a_robot_that_began_elsewhere_and_turned_otherwise_than_was_said_is_found() {
    let stations = ring(5, 7.5);
    for (k, heading_rad) in [0.4, -1.2, 2.0, 3.1].into_iter().enumerate() {
        let mut draws = Draws::new(0.05, 20, k as u64);
        let mut truth = Pose::new(3.0, -2.0, heading_rad);
        let mut positioner = at_the_origin(&stations);
        for tick in 1..=120 {
            truth = truth.moved(0.03, 0.0, 0.01);
            positioner.predict(&Odometry { forward_m: 0.03, sideways_m: 0.0, turn_rad: 0.01 });
            if tick % 10 == 0 {
                positioner.cycle(&draws.cycle(&stations, truth.position));
            }
        }
        let pose = positioner.estimate().pose;
        let turned_rad = (pose.heading_rad - truth.heading_rad).sin().abs();
        assert!((pose.position - truth.position).norm() < 0.15, "{heading_rad}: {pose:?}, truth {truth:?}");
        assert!(turned_rad < 0.15, "{heading_rad}: {pose:?}, truth {truth:?}");
    }
}

#[test]
fn a_spiral_with_slip_is_followed_within_the_reported_errors() {
    let stations = paper_stations();
    let mut draws = Draws::new(0.05, 20, 77);
    let mut truth = Pose::new(8.0, 0.0, std::f64::consts::FRAC_PI_2);
    let mut positioner = Positioner::new(config(stations.clone(), truth));
    let (mut radius_m, mut errors, mut inside) = (8.0, 0.0, 0);
    for tick in 1..=6000 {
        let (way, turn) = (0.03, 0.03 / radius_m);
        radius_m -= 0.001;
        truth = truth.moved(way * (0.97 + 0.01 * draws.bell()), 0.0, turn);
        let turn_rad = turn * (1.0 + 0.02 * draws.bell()) + 0.0001;
        positioner.predict(&Odometry {
            forward_m: way * (1.0 + 0.02 * draws.bell()),
            sideways_m: 0.0,
            turn_rad,
        });
        if tick % 10 == 0 {
            positioner.cycle(&draws.cycle(&stations, truth.position));
        }
        let off = (positioner.estimate().pose.position - truth.position).norm();
        errors += off;
        inside += i32::from(off < positioner.error_95_m());
    }
    assert!(errors / 6000.0 < 0.05, "{}", errors / 6000.0);
    assert!(inside > 5600, "{inside}");
}

#[test]
fn a_fix_beyond_the_wall_is_reported() {
    let stations = paper_stations();
    let (mut positioner, mut draws) = (at_the_origin(&stations), Draws::new(0.0, 20, 1));
    let fix = positioner.cycle(&draws.cycle(&stations, Point::new(0.0, -3.0))).fix.unwrap();
    assert_eq!(fix.check_inside(&Boundary::Circle { radius_m: 10.0 }), Ok(()));
    let answer = fix.check_inside(&Boundary::Circle { radius_m: 2.0 });
    assert!(matches!(answer, Err(FixError::OutsideTank { by_m }) if (by_m - 1.0).abs() < 1e-6));
}

#[test]
fn single_repetitions_close_to_a_station_do_not_mislead_the_estimate() {
    let stations = paper_stations();
    let mut draws = Draws::new(0.05, 1, 5);
    let mut truth = Pose::new(8.6, -2.0, std::f64::consts::FRAC_PI_2);
    let mut positioner = Positioner::new(config(stations.clone(), truth));
    let (mut worst, mut inside) = (0.0_f64, 0);
    for tick in 1..=2000 {
        // Up and down past the station at (7.5, 0).
        let way = if tick % 400 < 200 { 0.02 } else { -0.02 };
        truth = truth.moved(way, 0.0, 0.0);
        positioner.predict(&Odometry { forward_m: way, sideways_m: 0.0, turn_rad: 0.0 });
        if tick % 10 == 0 {
            positioner.cycle(&draws.cycle(&stations, truth.position));
        }
        let off = (positioner.estimate().pose.position - truth.position).norm();
        worst = worst.max(off);
        inside += i32::from(off < positioner.error_95_m());
    }
    assert!(worst < 0.35, "{worst}");
    assert!(inside > 1900, "{inside}");
}

#[test]
fn two_doubts_add_up_as_independent_errors() {
    let one = Doubt {
        likely_errors: [CommonError::Share(0.03), CommonError::Length(0.3)],
        likely_m: 0.3,
        ..Doubt::default()
    };
    let other = Doubt {
        ratio: 0.1,
        likely_errors: [CommonError::Share(0.04), CommonError::default()],
        likely_m: 0.4,
        sigma_m: 0.2,
        is_suspect: true,
    };
    let both = one.beside(other);
    assert_eq!(both, other.beside(one));
    assert_eq!(one.beside(Doubt::default()), one);
    assert_eq!(both.likely_errors, [CommonError::Share(0.05), CommonError::Length(0.3)]);
    assert_eq!((both.ratio, both.likely_m, both.sigma_m, both.is_suspect), (0.1, 0.5, 0.2, true));
}
