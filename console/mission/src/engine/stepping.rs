//! Steps: the robot is ordered to move until it reaches the end of a lane, or until an event occurs.

use super::{Mission, known::Known};
use crate::{
    event::{Event, EventKind, Severity},
    phase::{Gait, Hold, HoldReason, Phase, Resumes, StepTo},
};
use world::Point;

/// Length of a step if there are no lanes, metres.
const STEP_M: f64 = 1.0;

/// Where the robot was on its plan when it was released.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlaceOnPlan {
    /// Index of the stretch of the plan that the robot was on; `None` without lanes.
    leg: Option<usize>,
    /// The robot's position at that time.
    at: Point,
}

/// Whether an event is logged as WATCH or above.
fn asks_attention(kind: &EventKind) -> bool {
    let event = Event { tick: 0, t_s: 0.0, kind: kind.clone() };
    event.log_line(&[]).is_some_and(|line| line.severity >= Severity::Watch)
}

impl Known {
    pub(super) fn place_on_plan(&self) -> PlaceOnPlan {
        PlaceOnPlan { leg: self.task.leg_index(), at: self.locator.position() }
    }
}

impl Mission {
    /// Holds the robot again once the awaited end of a lane or event has come.
    pub(super) fn end_step(&mut self) {
        let (Phase::Running(Gait::To(to)), Some(from)) = (&self.known.phase, self.stepped_from) else {
            return;
        };
        let is_there = match to {
            StepTo::LaneEnd if from.leg.is_some() => self.known.task.leg_index() != from.leg,
            StepTo::LaneEnd => (self.known.position() - from.at).norm() >= STEP_M,
            StepTo::Event => self.happened.has(asks_attention),
        };
        if is_there {
            self.stepped_from = None;
            self.hold(Hold { by: HoldReason::Stepped, resumes: Resumes::Never });
        }
    }
}
