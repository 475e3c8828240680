#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::{
    Aggregation,
    draws::{Draws, exact, ring},
};
use proptest::prelude::*;

const LATE: Consensus = Consensus { wrong: WrongRanges::Late };

proptest! {
    #[test]
    fn two_late_stations_of_eight_are_found(
        x in -7.0..7.0_f64, y in -7.0..7.0_f64, first in 0..8_usize, apart in 1..8_usize,
        late in (0.5..8.0_f64, 0.5..8.0_f64),
    ) {
        let (stations, truth) = (ring(8, 7.5), Point::new(x, y));
        prop_assume!(stations.iter().all(|s| (s.position - truth).norm() > 0.3));
        let mut ranges = exact(&stations, truth);
        let second = (first + apart) % 8;
        ranges[first].range_m += late.0;
        ranges[second].range_m += late.1;
        let fix = LATE.solve(&ranges, &stations, None).unwrap();
        prop_assert!((fix.position - truth).norm() < 1e-6, "{}", fix.position);
        prop_assert_eq!(fix.used.len(), 6);
        let is_late = |e: &Exclusion| matches!(e, Exclusion::Residual { residual_m, .. } if *residual_m > 0.4);
        prop_assert!(fix.excluded.iter().all(|(_, e)| is_late(e)));
        prop_assert_eq!(fix.integrity, Integrity::Ok);
    }
}

/// Mean error if each station is hidden in one cycle of five. A hidden station's range is too long by an exponentially
/// distributed length with a mean of one metre.
fn hidden(n: u32, runs: u32) -> f64 {
    let (stations, mut draws) = (ring(n, 7.5), Draws::new(0.05, 20, 14));
    let mut error_m = 0.0;
    for _ in 0..runs {
        let truth = draws.on_disc();
        let mut ranges = draws.rangings(&stations, truth, Aggregation::Mean);
        for range in &mut ranges {
            if draws.even() < -0.6 {
                range.range_m -= f64::midpoint(1.0, draws.even()).max(1e-9).ln();
            }
        }
        error_m += (LATE.solve(&ranges, &stations, None).unwrap().position - truth).norm();
    }
    error_m / f64::from(runs)
}

#[test]
fn one_station_in_five_may_be_hidden() {
    let (eight, six) = (hidden(8, 4_000), hidden(6, 4_000));
    assert!(eight < 0.055, "{eight}");
    assert!(six < 0.085, "{six}");
}

#[test]
fn a_short_range_is_doubted_only_where_ranges_may_be_short() {
    let stations = ring(7, 7.5);
    let mut ranges = exact(&stations, Point::new(2.0, 1.0));
    ranges[3].range_m -= 1.0;
    let fix = Consensus { wrong: WrongRanges::Any }.solve(&ranges, &stations, None).unwrap();
    assert_eq!(fix.excluded.len(), 1);
    assert!((fix.position - Point::new(2.0, 1.0)).norm() < 1e-6);
    let fix = LATE.solve(&ranges, &stations, None).unwrap();
    assert_ne!(fix.integrity, Integrity::Ok, "three stations that agree do not outvote four");
}

#[test]
fn four_stations_that_cannot_say_which_one_lies_are_suspect() {
    let stations = ring(4, 7.5);
    let mut ranges = exact(&stations, Point::new(1.0, 1.0));
    ranges[0].range_m += 1.0;
    let fix = LATE.solve(&ranges, &stations, None).unwrap();
    assert_ne!(fix.integrity, Integrity::Ok);
}

#[test]
fn many_stations_do_not_mean_many_subsets() {
    assert_eq!(subsets(8).count(), 56);
    assert!(subsets(40).count() <= 2 * MOST_SUBSETS);
    assert_eq!(subsets(2).count(), 0);
}

#[test]
fn beside_a_station_the_other_side_of_its_circle_is_looked_at() {
    // One station is within arm's reach and another is wrong: the first consistent answer is on the wrong side.
    let (stations, mut draws) = (ring(6, 7.5), Draws::new(0.05, 20, 10_001));
    for run in 0..2_000 {
        let truth = stations[0].position + world::Vector::new(draws.even(), draws.even()) * 0.3;
        let mut ranges = draws.rangings(&stations, truth, Aggregation::Mean);
        ranges[1 + run % 5].range_m += 1.0;
        let fix = LATE.solve(&ranges, &stations, None).unwrap();
        let error_m = (fix.position - truth).norm();
        assert!(fix.integrity != Integrity::Ok || error_m < 0.3, "{truth} {fix:?}");
    }
}
