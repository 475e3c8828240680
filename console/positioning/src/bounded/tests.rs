#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::{
    Aggregation, Nls, RangeNoise,
    draws::{Draws, paper_stations, ring, stations},
};
use proptest::prelude::*;

const BOUNDED: Bounded = Bounded { ratio: 0.05 };

/// Error and longer semi-axis of the 95 % ellipse of a fix from stations on a ring, metres.
fn error_and_axis_m(seed: u64, repetitions: usize, n: u32) -> (f64, f64) {
    let (stations, mut draws) = (ring(n, 7.5), Draws::new(0.05, repetitions, seed));
    let truth = draws.on_disc();
    let fix = BOUNDED.solve(&draws.rangings(&stations, truth, Aggregation::Mean), &stations, None).unwrap();
    ((fix.position - truth).norm(), fix.ellipse_95().0)
}

proptest! {
    #[test]
    fn the_truth_always_is_in_the_set_and_the_set_never_empty(
        seed in any::<u64>(), repetitions in 1..30_usize, n in 3..9_u32,
    ) {
        let (error_m, long_m) = error_and_axis_m(seed, repetitions, n);
        // Seen from any side, a convex set is spread by a concave density. Of all such densities, that of a triangle
        // reaches furthest from its mean: sqrt(8) standard deviations, 1.16 times the longer semi-axis. Bent sets and
        // sets of two pieces may reach further, but a truth so far off is as rare as the small piece in which it must
        // lie.
        prop_assert!(error_m < 3.0 * long_m, "{error_m} {long_m}");
    }
}

#[test]
fn all_of_the_ring_about_a_station_close_by_counts() {
    let (error_m, long_m) = error_and_axis_m(12_166_711_506_782_477_027, 1, 6);
    // Reference values, computed on a fine grid over the set: 0.3085 m and 0.5797 m.
    assert!((error_m - 0.3085).abs() < 0.02 && (long_m - 0.5797).abs() < 0.02, "{error_m} {long_m}");
}

#[test]
fn a_bent_sliver_is_found_and_so_is_a_set_on_which_least_squares_do_not_settle() {
    for (seed, repetitions, n) in [(27_566_082_698, 4, 5), (38_860_116_580, 1, 7), (1_463_004_389, 27, 8)] {
        let (error_m, long_m) = error_and_axis_m(seed, repetitions, n);
        assert!(error_m < 1.2 * long_m, "{seed}: {error_m} {long_m}");
    }
}

#[test]
fn two_stations_leave_the_piece_on_the_side_of_the_prior() {
    let stations = stations(&[(-5.0, 0.0), (5.0, 0.0)]);
    let mut draws = Draws::new(0.05, 5, 3);
    for y in [3.0, -3.0, 0.1, -0.1] {
        let truth = Point::new(1.0, y);
        let ranges = draws.rangings(&stations, truth, Aggregation::Mean);
        let prior = (Point::new(0.5, 2.0 * y), Matrix2::identity());
        let fix = BOUNDED.solve(&ranges, &stations, Some(prior)).unwrap();
        let (long_m, _, _) = fix.ellipse_95();
        assert!(
            (fix.position - truth).norm() < 1.2 * long_m && long_m < 2.0,
            "{y}: {} {long_m}",
            fix.position
        );
    }
}

/// Mean errors of this solver and of least squares, metres, and the mean squared error of this solver in units of its
/// own variance.
fn mean_error_m(stations: &[Station], repetitions: usize, runs: u32) -> (f64, f64, f64) {
    let mut draws = Draws::new(0.05, repetitions, 31);
    let (mut bounded, mut nls, mut squared) = (0.0, 0.0, 0.0);
    for _ in 0..runs {
        let truth = draws.on_disc();
        let ranges = draws.rangings(stations, truth, Aggregation::Mean);
        let fix = BOUNDED.solve(&ranges, stations, None).unwrap();
        let off = fix.position - truth;
        bounded += off.norm();
        squared += off.dot(&(fix.covariance.try_inverse().unwrap() * off));
        nls += (Nls.solve(&ranges, stations, None).unwrap().position - truth).norm();
    }
    let n = f64::from(runs);
    (bounded / n, nls / n, squared / n)
}

#[test]
fn the_error_is_far_below_that_of_the_mean() {
    let (bounded, nls, squared) = mean_error_m(&paper_stations(), 20, 3_000);
    assert!(bounded < 0.027 && bounded < 0.42 * nls, "{bounded} {nls}");
    // The mean of e^T C^-1 e is the trace of C^-1 C.
    assert!((1.9..2.1).contains(&squared), "{squared}");
    let (bounded, nls, _) = mean_error_m(&ring(8, 7.5), 20, 1_500);
    assert!(bounded < 0.0075 && bounded < 0.27 * nls, "{bounded} {nls}");
}

#[test]
fn a_single_repetition_is_no_worse_than_least_squares() {
    let (bounded, nls, _) = mean_error_m(&paper_stations(), 1, 3_000);
    assert!(bounded < 1.01 * nls, "{bounded} {nls}");
}

#[test]
fn noise_beyond_the_bound_leaves_no_position() {
    let stations = paper_stations();
    let mut draws = Draws::new(0.05, 20, 7);
    let truth = draws.on_disc();
    let mut sets = draws.cycle(&stations, truth);
    sets[1].ranges_m[0] *= 1.3;
    let noise = RangeNoise::Uniform { ratio: 0.05 };
    let ranges = Aggregation::Mean.aggregate(&sets, &noise).unwrap();
    assert_eq!(BOUNDED.solve(&ranges, &stations, None), Err(FixError::EmptySet { ratio: 0.05 }));
}

#[test]
fn a_bound_that_is_no_share_leaves_nothing() {
    let stations = paper_stations();
    let ranges = Draws::new(0.05, 20, 7).rangings(&stations, Point::new(1.0, 2.0), Aggregation::Mean);
    for ratio in [-0.1, 1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(Bounded { ratio }.solve(&ranges, &stations, None), Err(FixError::EmptySet { .. })));
    }
}
