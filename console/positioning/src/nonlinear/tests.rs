#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::{
    Aggregation, Integrity, LinearLs,
    draws::{Draws, exact, paper_stations, ring, skew_stations, stations},
};
use nalgebra::Rotation2;
use proptest::prelude::*;
use std::f64::consts::TAU;

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
        errors in prop::collection::vec(-0.3..0.3_f64, 3), bearing in 0.0..TAU,
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

#[test]
fn a_saddle_becomes_a_valley_with_the_same_axes() {
    let turn = Rotation2::new(0.7);
    let with = |a: f64, b: f64| turn.matrix() * Matrix2::new(a, 0.0, 0.0, b) * turn.matrix().transpose();
    for (a, b) in [(3.0, 2.0), (3.0, -2.0), (1.0, -2.0), (-3.0, -2.0)] {
        assert!((made_positive(with(a, b)) - with(a.abs(), b.abs())).norm() < 1e-12);
    }
}

/// The results of the solver over the floor of the tank.
struct Score {
    mean_error_m: f64,
    /// Mean error of normal noise with the smallest possible covariance, at the same truths.
    bound_m: f64,
    /// Share of truths within the 95 % ellipse.
    inside: f64,
    /// Share of fixes whose integrity is `Ok`.
    fine: f64,
}

fn on_the_disc(stations: &[Station], repetitions: usize, runs: u32) -> Score {
    let mut draws = Draws::new(0.05, repetitions, 21);
    let mut score = Score { mean_error_m: 0.0, bound_m: 0.0, inside: 0.0, fine: 0.0 };
    for _ in 0..runs {
        let truth = draws.on_disc();
        let rangings = draws.rangings(stations, truth, Aggregation::Mean);
        let fix = Nls.solve(&rangings, stations, None).unwrap();
        let off = fix.position - truth;
        let normal = Vector::new(draws.bell(), draws.bell());
        let least = information_at(&anchored(&rangings, stations).unwrap(), truth).try_inverse().unwrap();
        score.mean_error_m += off.norm();
        score.bound_m += (least.cholesky().unwrap().l() * normal).norm();
        score.inside += f64::from(u8::from(off.dot(&(fix.covariance.try_inverse().unwrap() * off)) < 5.991));
        score.fine += f64::from(u8::from(fix.integrity == Integrity::Ok));
    }
    let n = f64::from(runs);
    Score {
        mean_error_m: score.mean_error_m / n,
        bound_m: score.bound_m / n,
        inside: score.inside / n,
        fine: score.fine / n,
    }
}

#[test]
fn three_stations_reach_the_bound_with_an_honest_ellipse() {
    let score = on_the_disc(&paper_stations(), 20, 20_000);
    assert!((score.mean_error_m - 0.0655).abs() < 0.0015, "{}", score.mean_error_m);
    assert!(score.mean_error_m < 1.03 * score.bound_m, "{} {}", score.mean_error_m, score.bound_m);
    assert!((0.93..0.97).contains(&score.inside), "{}", score.inside);
    assert!((0.98..0.997).contains(&score.fine), "{}", score.fine);
}

#[test]
fn single_repetitions_reach_the_bound_too() {
    let score = on_the_disc(&paper_stations(), 1, 10_000);
    assert!((score.mean_error_m - 0.3135).abs() < 0.02, "{}", score.mean_error_m);
    assert!((0.93..0.98).contains(&score.inside), "{}", score.inside);
}

#[test]
fn eight_stations_reach_their_bound() {
    let score = on_the_disc(&ring(8, 7.5), 20, 5_000);
    assert!((score.mean_error_m - 0.028).abs() < 0.0015, "{}", score.mean_error_m);
    assert!(score.mean_error_m < 1.03 * score.bound_m, "{} {}", score.mean_error_m, score.bound_m);
    assert!((0.93..0.97).contains(&score.inside), "{}", score.inside);
    assert!((0.98..0.997).contains(&score.fine), "{}", score.fine);
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
fn two_stations_give_both_crossings_and_a_prior_chooses() {
    let stations = paper_stations();
    let ranges = &exact(&stations, Point::new(1.0, -2.0))[..2];
    let bare = Nls.solve(ranges, &stations, None).unwrap();
    assert!(((bare.mirror.unwrap() - bare.position).norm() - 4.0).abs() < 1e-9);
    assert_eq!(bare.integrity, Integrity::Untestable);
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
    let flat = stations(&[(7.5, 0.0), (-7.5, 0.0), (0.0, 0.05)]);
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

#[test]
fn close_to_a_station_the_search_still_settles() {
    let (stations, mut draws) = (paper_stations(), Draws::new(0.05, 20, 6));
    let mut error = 0.0;
    for _ in 0..3_000 {
        let truth = stations[0].position + Vector::new(draws.even(), draws.even()) * 0.4;
        let rangings = draws.rangings(&stations, truth, Aggregation::Mean);
        error += (Nls.solve(&rangings, &stations, None).unwrap().position - truth).norm() / 3_000.0;
    }
    assert!(error < 0.1, "{error}");
}
