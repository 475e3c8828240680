//! The screen counts the same floor as scanned again as the account does, whatever happens in the mission.

use crate::fixture::{ScriptedMission, config, opened};
use account::Fold;
use mission::{Event, EventKind, HoldReason, Order};
use nalgebra::{Matrix3, Vector3};
use planner_api::PoseEstimate;
use proptest::prelude::*;
use tui::model::Run;
use world::{CoverageGrid, FloorClass, Pose};

/// A stretch of a mission: an order or a hold at its beginning, steps of 0.1 m north or south, and whether the position is sure.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    change: Change,
    steps: i32,
    is_sure: bool,
}

#[derive(Debug, Clone, Copy)]
enum Change {
    Start,
    Hold,
    Resume,
}

impl Change {
    fn event(self, mission: &ScriptedMission) -> Event {
        match self {
            Self::Start => mission.now(EventKind::Ordered { order: Order::Start }),
            Self::Hold => mission.held(HoldReason::Operator),
            Self::Resume => mission.now(EventKind::Resumed),
        }
    }
}

/// The events of a mission that waits for five ticks, begins with a start and goes on with some stretches.
fn events(stretches: &[Stretch]) -> Vec<Event> {
    let (mission, config) = (ScriptedMission::new(), config());
    let EventKind::RunOpened(run) = opened() else { unreachable!("the run opens first") };
    let mut grid = CoverageGrid::new(run.floor);
    let mut events = mission.opening();
    let (mut last, mut has_begun) = (config.start, false);
    for Stretch { change, steps, is_sure } in stretches {
        if has_begun || matches!(change, Change::Start) {
            has_begun = true;
            events.push(change.event(&mission));
        }
        for _ in 0..steps.abs() {
            let here = Pose {
                position: last.position + world::Vector::y() * 0.1 * f64::from(steps.signum()),
                ..last
            };
            let before = std::mem::replace(&mut last, here);
            let variance_m2 = if *is_sure { 4e-4 } else { 0.04 };
            let covariance = Matrix3::from_diagonal(&Vector3::new(variance_m2, variance_m2, 1e-4));
            let pose = PoseEstimate { position: here.position, heading_rad: here.heading_rad, covariance };
            events.push(mission.now(EventKind::Estimated { pose }));
            let runs = grid.not_covered_under(config.tool(), before, here);
            if has_begun && *is_sure && !runs.is_empty() {
                grid.apply(&runs);
                events.push(mission.now(EventKind::Covered { runs }));
            }
        }
    }
    events
}

fn stretch() -> impl Strategy<Value = Stretch> {
    let change = prop_oneof![Just(Change::Start), Just(Change::Hold), Just(Change::Resume)];
    (change, -25..25_i32, prop::bool::weighted(0.8)).prop_map(|(change, steps, is_sure)| Stretch {
        change,
        steps,
        is_sure,
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// Every scanned cell has a pass with an error, and has the same class on the screen as in the account.
    #[test]
    fn screen_and_account_find_the_same_floor_scanned_again(stretches in prop::collection::vec(stretch(), 1..8)) {
        let (mut run, mut fold) = (Run::default(), Fold::new());
        for event in events(&stretches) {
            run.fold(&event);
            fold.apply(&event);
        }
        let (screen, account) = (run.coverage.as_ref().unwrap(), fold.scanned().unwrap());
        for cell in 0..screen.floor().len() {
            if screen.is_scanned(cell) {
                prop_assert!(account.passes().error_mm(cell).is_some(), "cell {} has no error", cell);
            }
            let shown = screen.class_at(screen.floor().center(cell), false);
            let class = shown.map_or(FloorClass::Outside, |(class, _)| class);
            prop_assert_eq!(class, account.class(cell), "cell {}", cell);
        }
    }
}
