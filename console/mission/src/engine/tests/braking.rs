//! A robot that brakes instead of stopping instantly: the floor that it passes over after HOLD counts, and every reader
//! of the events computes the same floor.

use super::{covering::covering, *};
use crate::{FoldedStanding, Passage};
use positioning::fix::{ellipse_95, position_covariance};
use proptest::prelude::*;
use std::collections::BTreeSet;

/// The cells that the events of a run report as scanned, and the cells that a reader computes from the poses.
#[derive(Default)]
struct Read {
    claimed: BTreeSet<usize>,
    claimed_while_held: BTreeSet<usize>,
    passed: BTreeSet<usize>,
}

impl Read {
    fn of(flight: &Flight, config: &MissionConfig) -> Self {
        let floor = flight.mission.known.floor.coverage.floor();
        let (mut read, mut standing, mut last) = (Self::default(), FoldedStanding::default(), config.start);
        for event in &flight.events {
            standing.apply(&event.kind);
            match &event.kind {
                EventKind::Estimated { pose } => {
                    let here = Pose { position: pose.position, heading_rad: pose.heading_rad };
                    let before = std::mem::replace(&mut last, here);
                    let error_m = ellipse_95(&position_covariance(&pose.covariance)).0;
                    if Passage::of(&standing.phase, error_m, config.scan_limit_m()) == Passage::Counts {
                        read.passed.extend(floor.cells_under(config.tool(), before, here));
                    }
                }
                EventKind::Covered { runs } => {
                    let cells = || runs.iter().flat_map(|run| run.range());
                    read.claimed.extend(cells());
                    if matches!(standing.phase, Phase::Held(_)) {
                        read.claimed_while_held.extend(cells());
                    }
                }
                _ => {}
            }
        }
        read
    }
}

/// Waits, starts, and is held after each of these numbers of ticks until it stands still.
fn held_after(spans: &[usize], braking_m_per_s2: f64, config: &MissionConfig) -> Flight {
    let mut flight = Flight::new(config.clone());
    flight.braking_m_per_s2 = braking_m_per_s2;
    flight.fly(5);
    flight.tick(&[Order::Start]);
    for ticks in spans {
        flight.fly(*ticks);
        flight.tick(&[Order::Hold]);
        flight.fly(45);
        flight.tick(&[Order::Resume]);
    }
    flight
}

#[test]
fn floor_that_a_held_robot_passes_while_it_brakes_counts() {
    let flight = held_after(&[60, 60], 0.2, &covering());
    assert!(!Read::of(&flight, &covering()).claimed_while_held.is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// A cell counts as scanned only if every reader of the events finds that the tool passed over it, at a place that
    /// counts.
    #[test]
    fn every_cell_that_counts_was_passed_where_it_counts(
        spans in prop::collection::vec(1_usize..80, 1..5),
        braking_m_per_s2 in 0.1..1.0_f64,
        limit_m in prop_oneof![Just(0.3), 0.005..0.05_f64],
    ) {
        let scan = ScanConfig { position_limit_m: Some(limit_m), ..ScanConfig::default() };
        let config = MissionConfig { scan, ..covering() };
        let read = Read::of(&held_after(&spans, braking_m_per_s2, &config), &config);
        let lost: Vec<_> = read.claimed.difference(&read.passed).collect();
        prop_assert!(lost.is_empty(), "{lost:?} of {} cells", read.claimed.len());
    }
}
