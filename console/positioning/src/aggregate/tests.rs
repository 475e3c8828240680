#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::draws::Draws;
use proptest::prelude::*;
use world::StationId;

const NORMAL: RangeNoise = RangeNoise::Gaussian { sigma_ratio: 0.03 };
const EVERY: [Aggregation; 5] = [
    Aggregation::Mean,
    Aggregation::RootMeanSquare,
    Aggregation::Midrange,
    Aggregation::TrimmedMean,
    Aggregation::Posterior,
];

fn set(ranges_m: &[f64]) -> RangeSet {
    RangeSet { station: StationId(1), ranges_m: ranges_m.to_vec() }
}

#[test]
fn twenty_repetitions_cut_the_sigma_by_their_root() {
    let ranging = Aggregation::Mean.aggregate(&[set(&[10.0; 20])], &NORMAL).unwrap()[0];
    assert!((ranging.range_m - 10.0).abs() < 1e-12);
    assert!((ranging.sigma_m - 0.3 / 20.0_f64.sqrt()).abs() < 1e-12);
    assert_eq!(ranging.repetitions, 20);
}

#[test]
fn the_root_mean_square_keeps_the_mean_of_the_squares() {
    let ranging = Aggregation::RootMeanSquare.aggregate(&[set(&[1.0, 7.0])], &NORMAL).unwrap()[0];
    assert!((ranging.range_m - 5.0).abs() < 1e-12);
}

#[test]
fn a_station_without_ranges_is_silent() {
    assert!(Aggregation::Mean.aggregate(&[set(&[])], &NORMAL).unwrap().is_empty());
}

#[test]
fn one_bad_repetition_is_an_error() {
    for bad in [0.0, -1.0, 1e-300, f64::NAN, f64::INFINITY, 1e300] {
        let answer = Aggregation::Mean.aggregate(&[set(&[5.0, bad])], &NORMAL);
        assert_eq!(answer, Err(FixError::BadRange { station: StationId(1) }), "{bad}");
    }
}

#[test]
fn exact_ranges_still_have_a_sigma() {
    let ranging =
        Aggregation::Mean.aggregate(&[set(&[5.0])], &RangeNoise::Gaussian { sigma_ratio: 0.0 }).unwrap()[0];
    assert!((ranging.sigma_m - SIGMA_FLOOR_M).abs() < 1e-15);
}

/// Root mean square error and sigma of 20 uniform or triangular errors of at most 5 % at 10 m.
fn scatter(how: Aggregation, noise: &RangeNoise) -> (f64, f64) {
    let mut draws = Draws::new(0.05, 20, 9);
    let error = |draws: &mut Draws| match noise {
        RangeNoise::Triangular { .. } => f64::midpoint(draws.even(), draws.even()),
        _ => draws.even(),
    };
    let (mut squares, mut sigmas) = (0.0, 0.0);
    for _ in 0..4_000 {
        let ranges: Vec<f64> = (0..20).map(|_| 10.0 * (1.0 + 0.05 * error(&mut draws))).collect();
        let ranging = how.aggregate(&[set(&ranges)], noise).unwrap()[0];
        squares += (ranging.range_m - 10.0).powi(2);
        sigmas += ranging.sigma_m.powi(2);
    }
    ((squares / 4_000.0_f64).sqrt(), (sigmas / 4_000.0_f64).sqrt())
}

#[test]
fn every_way_knows_its_own_scatter() {
    for noise in [RangeNoise::Uniform { ratio: 0.05 }, RangeNoise::Triangular { ratio: 0.05 }] {
        for how in EVERY {
            let (error, sigma) = scatter(how, &noise);
            assert!((sigma / error - 1.0).abs() < 0.08, "{how:?} {noise:?}: {sigma} for {error}");
        }
    }
}

#[test]
fn the_extremes_are_more_informative_than_the_mean_for_bounded_noise() {
    let uniform = RangeNoise::Uniform { ratio: 0.05 };
    let (mean, _) = scatter(Aggregation::Mean, &uniform);
    assert!(scatter(Aggregation::Midrange, &uniform).0 < 0.55 * mean);
    assert!(scatter(Aggregation::Posterior, &uniform).0 < 0.55 * mean);
    let triangular = RangeNoise::Triangular { ratio: 0.05 };
    let (mean, _) = scatter(Aggregation::Mean, &triangular);
    assert!(scatter(Aggregation::Midrange, &triangular).0 > 1.05 * mean);
    assert!(scatter(Aggregation::Posterior, &triangular).0 < 0.95 * mean);
}

#[test]
fn a_wild_ping_is_trimmed() {
    let mut ranges = vec![10.0, 10.1, 9.9, 10.2, 9.8, 10.0, 10.05, 9.95];
    let clean = Aggregation::TrimmedMean.aggregate(&[set(&ranges)], &NORMAL).unwrap()[0];
    ranges.push(14.0);
    let trimmed = Aggregation::TrimmedMean.aggregate(&[set(&ranges)], &NORMAL).unwrap()[0];
    assert!((trimmed.range_m - clean.range_m).abs() < 1e-12);
    assert!((trimmed.sigma_m - clean.sigma_m).abs() < 1e-12);
    assert!((trimmed.most_m - 14.0).abs() < 1e-12, "the extremes are those of all ranges");
}

#[test]
fn ranges_that_no_distance_explains_fall_back_to_the_trimmed_mean() {
    let far_apart = [set(&[9.0, 10.0, 11.0])];
    let noise = RangeNoise::Uniform { ratio: 0.05 };
    let posterior = Aggregation::Posterior.aggregate(&far_apart, &noise).unwrap();
    assert_eq!(posterior, Aggregation::TrimmedMean.aggregate(&far_apart, &noise).unwrap());
}

proptest! {
    #[test]
    fn every_way_stays_between_the_extremes(
        ranges in prop::collection::vec(0.01..100.0_f64, 1..30), ratio in 1e-6..0.9_f64,
    ) {
        let least = ranges.iter().copied().fold(f64::INFINITY, f64::min);
        let most = ranges.iter().copied().fold(0.0, f64::max);
        for noise in [RangeNoise::Gaussian { sigma_ratio: ratio }, RangeNoise::HeavyTailed { sigma_ratio: ratio }] {
            for how in [Aggregation::Mean, Aggregation::RootMeanSquare, Aggregation::Midrange, Aggregation::TrimmedMean] {
                let ranging = how.aggregate(&[set(&ranges)], &noise).unwrap()[0];
                prop_assert!(ranging.range_m >= least * 0.999_999 && ranging.range_m <= most * 1.000_001);
                prop_assert!(ranging.sigma_m.is_finite());
            }
        }
    }
}
