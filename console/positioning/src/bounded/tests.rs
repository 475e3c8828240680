#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::{
    Aggregation, Nls, RangeNoise,
    draws::{Draws, paper_stations, ring},
};
use proptest::prelude::*;

const BOUNDED: Bounded = Bounded { ratio: 0.05 };

proptest! {
    #[test]
    fn the_truth_always_is_in_the_set_and_the_set_never_empty(
        seed in any::<u64>(), repetitions in 1..30_usize, n in 3..9_u32,
    ) {
        let (stations, mut draws) = (ring(n, 7.5), Draws::new(0.05, repetitions, seed));
        let truth = draws.on_disc();
        let fix = BOUNDED.solve(&draws.rangings(&stations, truth, Aggregation::Mean), &stations, None).unwrap();
        let (long, _, _) = fix.ellipse_95();
        // A sliver may be cut short by the straightened rings, but never by much.
        prop_assert!((fix.position - truth).norm() < 3.0 * long + 0.01, "{} {truth} {long}", fix.position);
    }
}

fn mean_error_m(stations: &[Station], repetitions: usize, runs: u32) -> (f64, f64, f64) {
    let mut draws = Draws::new(0.05, repetitions, 31);
    let (mut bounded, mut nls, mut inside) = (0.0, 0.0, 0.0);
    for _ in 0..runs {
        let truth = draws.on_disc();
        let ranges = draws.rangings(stations, truth, Aggregation::Mean);
        let fix = BOUNDED.solve(&ranges, stations, None).unwrap();
        let off = fix.position - truth;
        bounded += off.norm();
        inside += f64::from(u8::from(off.dot(&(fix.covariance.try_inverse().unwrap() * off)) < 5.991));
        nls += (Nls.solve(&ranges, stations, None).unwrap().position - truth).norm();
    }
    let n = f64::from(runs);
    (bounded / n, nls / n, inside / n)
}

#[test]
fn the_error_is_far_below_that_of_the_mean() {
    let (bounded, nls, inside) = mean_error_m(&paper_stations(), 20, 3_000);
    assert!(bounded < 0.027 && bounded < 0.42 * nls, "{bounded} {nls}");
    assert!((0.93..0.99).contains(&inside), "{inside}");
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
