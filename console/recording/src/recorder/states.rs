//! Who drives, whether the robot moves, and whether its position is known: lanes of the timeline of states.

use super::{
    paths,
    stream::{At, Stream},
    style,
};
use crate::{error::RecordingError, rr};
use mission::{EventKind, Order, Outcome, event::HoldReason};

type Done = Result<(), RecordingError>;

const WAITING: &str = "waiting";
const MOVING: &str = "moving";
const HELD: &str = "held by the operator";
const STEPPED: &str = "held after a step";
const HELD_LOST: &str = "held, position lost";
const HELD_FAULT: &str = "held, planner fault";
const HELD_STUCK: &str = "held, stuck";
const KNOWN: &str = "known";
const LOST: &str = "lost";

/// The states of a run.
pub(crate) struct States {
    mission: &'static str,
    planners: Vec<String>,
}

impl States {
    pub(crate) fn open(stream: &Stream, at: At) -> Result<Self, RecordingError> {
        let outcome = |outcome: Outcome, color| (outcome.word(), color);
        let grey = style::rgb(90, 100, 115);
        let amber = style::rgb(190, 140, 50);
        let red = style::rgb(200, 70, 65);
        let green = style::rgb(70, 150, 95);
        let mission = [
            (WAITING, grey),
            (MOVING, green),
            (HELD, amber),
            (STEPPED, amber),
            (HELD_LOST, red),
            (HELD_FAULT, red),
            (HELD_STUCK, red),
            outcome(Outcome::Complete, style::rgb(60, 120, 200)),
            outcome(Outcome::Stuck, amber),
            outcome(Outcome::Collision, red),
            outcome(Outcome::TimeLimit, amber),
            outcome(Outcome::Aborted, amber),
        ];
        stream.always(paths::STATE_MISSION, &configuration(&mission))?;
        stream.always(paths::STATE_POSITION, &configuration(&[(KNOWN, green), (LOST, red)]))?;
        stream.once(paths::STATE_MISSION, at, &rr::StateChange::single(WAITING))?;
        stream.once(paths::STATE_POSITION, at, &rr::StateChange::single(KNOWN))?;
        Ok(Self { mission: WAITING, planners: Vec::new() })
    }

    pub(crate) fn apply(&mut self, event: &EventKind, at: At, stream: &Stream) -> Done {
        match event {
            EventKind::Ordered { order: Order::Start } | EventKind::Resumed => self.enter(MOVING, at, stream),
            // A run without an operator is never told to start.
            EventKind::Commanded { .. } if self.mission == WAITING => self.enter(MOVING, at, stream),
            EventKind::Held { by } => self.enter(held(by), at, stream),
            EventKind::Ended { outcome, .. } => self.enter(outcome.word(), at, stream),
            EventKind::PositionLost { .. } => {
                stream.once(paths::STATE_POSITION, at, &rr::StateChange::single(LOST))
            }
            EventKind::PositionRegained { .. } => {
                stream.once(paths::STATE_POSITION, at, &rr::StateChange::single(KNOWN))
            }
            EventKind::PlannerChosen { choice, .. } => self.planner(&choice.id, at, stream),
            _ => Ok(()),
        }
    }

    fn enter(&mut self, state: &'static str, at: At, stream: &Stream) -> Done {
        self.mission = state;
        stream.once(paths::STATE_MISSION, at, &rr::StateChange::single(state))
    }

    fn planner(&mut self, id: &str, at: At, stream: &Stream) -> Done {
        if !self.planners.iter().any(|known| known == id) {
            self.planners.push(id.to_owned());
            let colors = style::SERIES.into_iter().cycle();
            let states: Vec<_> = self.planners.iter().map(String::as_str).zip(colors).collect();
            stream.always(paths::STATE_PLANNER, &configuration(&states))?;
        }
        stream.once(paths::STATE_PLANNER, at, &rr::StateChange::single(id))
    }
}

fn held(by: &HoldReason) -> &'static str {
    match by {
        HoldReason::Operator => HELD,
        HoldReason::Stepped => STEPPED,
        HoldReason::PositionLost => HELD_LOST,
        HoldReason::PlannerFault { .. } => HELD_FAULT,
        HoldReason::Stuck { .. } => HELD_STUCK,
    }
}

fn configuration(states: &[(&str, [u8; 4])]) -> rr::StateConfiguration {
    rr::StateConfiguration::new()
        .with_values(states.iter().map(|state| state.0))
        .with_colors(states.iter().map(|state| style::color(state.1)))
}
