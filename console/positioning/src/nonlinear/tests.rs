#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::{
    Aggregation, Integrity, LinearLs,
    draws::{Draws, exact, paper_stations, ring, skew_stations, stations},
};
use proptest::prelude::*;

proptest! {
    #[test]
    fn exact_ranges_give_the_exact_point(
        places in prop::collection::vec((-20.0..20.0_f64, -20.0..20.0_f64), 3..8),
        x in -15.0..15.0_f64,
        y in -15.0..15.0_f64,
    ) {
        let (stations, truth) = (stations(&places), Point::new(x, y));
        prop_assume!(stations.iter().all(|s| (s.position - truth).norm() > 0.05));
        let ranges = exact(&stations, truth);
        let anchors = anchored(&ranges, &stations).unwrap();
        let prior = Some((truth, Matrix2::identity()));
        let fix = Nls.solve(&ranges, &stations, prior).unwrap();
        let tolerance = if conditioning(&anchors) < 50.0 { 1e-7 } else { 1e-3 };
        prop_assert!((fix.position - truth).norm() < tolerance, "{}", fix.position);
        prop_assert!(fix.chi2 < 1e-6);
    }

    #[test]
    fn no_step_from_the_solution_fits_better(
        errors in prop::collection::vec(-0.3..0.3_f64, 3), bearing in 0.0..std::f64::consts::TAU,
    ) {
        let stations = skew_stations();
        let mut ranges = exact(&stations, Point::new(1.0, -2.0));
        ranges.iter_mut().zip(&errors).for_each(|(r, e)| r.range_m += e);
        let fix = Nls.solve(&ranges, &stations, None).unwrap();
        let anchors = anchored(&ranges, &stations).unwrap();
        let aside = fix.position + Vector::new(bearing.cos(), bearing.sin()) * 1e-3;
        prop_assert!(Slope::at(&anchors, aside).cost >= Slope::at(&anchors, fix.position).cost);
    }
}

/// Mean error, share of truths within the 95 % ellipse and share of fixes judged `Ok`, over the disc.
fn on_the_disc(stations: &[Station], repetitions: usize, runs: usize) -> (f64, f64, f64) {
    let mut draws = Draws::new(0.05, repetitions, 21);
    let (mut error, mut inside, mut fine) = (0.0, 0.0, 0.0);
    for _ in 0..runs {
        let truth = draws.on_disc();
        let rangings = draws.rangings(stations, truth, Aggregation::Mean);
        let fix = Nls.solve(&rangings, stations, None).unwrap();
        let off = fix.position - truth;
        error += off.norm();
        inside += f64::from(u8::from(off.dot(&(fix.covariance.try_inverse().unwrap() * off)) < 5.991));
        fine += f64::from(u8::from(fix.integrity == Integrity::Ok));
    }
    (error / runs as f64, inside / runs as f64, fine / runs as f64)
}

#[test]
fn three_stations_reach_the_bound_with_an_honest_ellipse() {
    let (error, inside, fine) = on_the_disc(&paper_stations(), 20, 10_000);
    assert!((error - 0.0647).abs() < 0.0015, "{error}");
    assert!((0.93..0.97).contains(&inside), "{inside}");
    assert!((0.98..0.997).contains(&fine), "{fine}");
}

#[test]
fn single_repetitions_reach_the_bound_too() {
    let (error, inside, _) = on_the_disc(&paper_stations(), 1, 10_000);
    assert!((error - 0.3135).abs() < 0.015, "{error}");
    assert!((0.93..0.98).contains(&inside), "{inside}");
}

#[test]
fn eight_stations_reach_their_bound() {
    let (error, inside, fine) = on_the_disc(&ring(8, 7.5), 20, 5_000);
    assert!((error - 0.028).abs() < 0.0015, "{error}");
    assert!((0.93..0.97).contains(&inside), "{inside}");
    assert!((0.98..0.997).contains(&fine), "{fine}");
}

#[test]
fn the_error_is_half_of_that_of_the_linear_method() {
    let (stations, mut draws) = (skew_stations(), Draws::new(0.05, 20, 2));
    let (mut linear, mut nonlinear) = (0.0, 0.0);
    for _ in 0..3_000 {
        let truth = draws.on_disc();
        let rangings = draws.rangings(&stations, truth, Aggregation::Mean);
        linear += (LinearLs.solve(&rangings, &stations, None).unwrap().position - truth).norm();
        nonlinear += (Nls.solve(&rangings, &stations, None).unwrap().position - truth).norm();
    }
    assert!(nonlinear < 0.6 * linear, "{nonlinear} {linear}");
}

#[test]
fn two_stations_need_a_prior() {
    let stations = paper_stations();
    let ranges = &exact(&stations, Point::new(1.0, -2.0))[..2];
    assert_eq!(Nls.solve(ranges, &stations, None), Err(FixError::TooFewStations { have: 2, need: 3 }));
    let prior = Some((Point::new(0.0, -1.0), Matrix2::identity()));
    let fix = Nls.solve(ranges, &stations, prior).unwrap();
    assert!((fix.position - Point::new(1.0, -2.0)).norm() < 1e-9);
    assert!((fix.mirror.unwrap() - Point::new(1.0, 2.0)).norm() < 1e-9);
    assert_eq!(Nls.solve(&ranges[..1], &stations, prior), Err(FixError::TooFewStations { have: 1, need: 2 }));
}

#[test]
fn stations_on_a_line_leave_the_side_to_the_prior() {
    let stations = stations(&[(-5.0, 1.0), (0.0, 1.0), (5.0, 1.0)]);
    let ranges = exact(&stations, Point::new(1.0, 3.0));
    assert!(matches!(Nls.solve(&ranges, &stations, None), Err(FixError::Collinear { .. })));
    for (near, found, other) in [(2.0, 3.0, -1.0), (0.0, -1.0, 3.0)] {
        let fix = Nls.solve(&ranges, &stations, Some((Point::new(0.0, near), Matrix2::identity()))).unwrap();
        assert!((fix.position - Point::new(1.0, found)).norm() < 1e-6, "{}", fix.position);
        assert!((fix.mirror.unwrap() - Point::new(1.0, other)).norm() < 1e-6);
    }
}

#[test]
fn nearly_collinear_stations_report_the_mirror_and_a_clear_layout_does_not() {
    let mut draws = Draws::new(0.05, 20, 4);
    let flat = stations(&[(7.5, 0.0), (-7.5, 0.0), (0.0, 0.3)]);
    let truth = Point::new(1.0, 2.0);
    let prior = Some((truth, Matrix2::identity() * 0.01));
    let fix = Nls.solve(&draws.rangings(&flat, truth, Aggregation::Mean), &flat, prior).unwrap();
    assert!((fix.position - truth).norm() < 0.3);
    assert!(fix.mirror.unwrap().y < 0.0);
    let clear = paper_stations();
    assert_eq!(
        Nls.solve(&draws.rangings(&clear, truth, Aggregation::Mean), &clear, prior).unwrap().mirror,
        None
    );
}

#[test]
fn a_station_that_lies_raises_the_alarm() {
    let stations = ring(6, 7.5);
    let mut ranges = exact(&stations, Point::new(2.0, 1.0));
    ranges[3].range_m += 1.0;
    let fix = Nls.solve(&ranges, &stations, None).unwrap();
    assert_eq!(fix.integrity, Integrity::Alarm);
    assert_eq!(fix.degrees_of_freedom, 4);
}
