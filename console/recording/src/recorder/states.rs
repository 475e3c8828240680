//! The lanes of the state timeline: the active planner, the motion of the robot, and the state of its position.
//!
//! The viewer fits a state timeline only once, to the data that it has read when the first lane appears. Because the
//! timeline is linked to the time axis of all views ([`super::layout`]), it always shows the whole run.

use super::{
    paths,
    stream::{At, Stream},
    style,
};
use crate::{error::RecordingError, rr};
use mission::{EventKind, HoldReason, Outcome};

type Done = Result<(), RecordingError>;

const WAITING: &str = "waiting";
const MOVING: &str = "moving";
const HELD: &str = "held by the operator";
const STEPPED: &str = "held after a step";
const HELD_LOST: &str = "held, position lost";
const HELD_ALARMED: &str = "held, contradictory ranges";
const HELD_FAULT: &str = "held, planner fault";
const HELD_STUCK: &str = "held, stuck";
const HELD_TETHER: &str = "held, tether";
const HELD_REFUSED: &str = "held, plan refused";
const HELD_ZONE: &str = "held, hull in a no-go zone";
const RETURNING: &str = "driving back";
const HELD_VEHICLE: &str = "held, vehicle";
const KNOWN: &str = "known";
const LOST: &str = "lost";

/// The states of a run.
pub(crate) struct States {
    mission: &'static str,
    planners: Vec<String>,
}

impl States {
    pub(crate) fn open(stream: &Stream, at: At) -> Result<Self, RecordingError> {
        let outcome = |outcome: Outcome, color| (outcome.word(), outcome.word(), color);
        let grey = style::rgb(90, 100, 115);
        let amber = style::rgb(190, 140, 50);
        let red = style::rgb(200, 70, 65);
        let green = style::rgb(70, 150, 95);
        let mission = [
            (WAITING, WAITING, grey),
            (MOVING, MOVING, green),
            (HELD, "held", amber),
            (STEPPED, "step", amber),
            (HELD_LOST, "lost", red),
            (HELD_ALARMED, "ranges", red),
            (HELD_FAULT, "fault", red),
            (HELD_STUCK, "stuck", red),
            (HELD_TETHER, "tether", red),
            (HELD_REFUSED, "refused", red),
            (HELD_ZONE, "zone", red),
            (RETURNING, "back", green),
            (HELD_VEHICLE, "vehicle", red),
            outcome(Outcome::Complete, style::rgb(60, 120, 200)),
            outcome(Outcome::Stuck, amber),
            outcome(Outcome::Collision, red),
            outcome(Outcome::TimeLimit, amber),
            outcome(Outcome::Entangled, red),
            outcome(Outcome::Aborted, amber),
        ];
        stream.always(paths::STATE_MISSION, &configuration(&mission))?;
        stream.always(paths::STATE_POSITION, &configuration(&[(KNOWN, KNOWN, green), (LOST, LOST, red)]))?;
        change(stream, paths::STATE_MISSION, at, WAITING)?;
        change(stream, paths::STATE_POSITION, at, KNOWN)?;
        Ok(Self { mission: WAITING, planners: Vec::new() })
    }

    pub(crate) fn apply(&mut self, stream: &Stream, event: &EventKind, at: At) -> Done {
        match event {
            EventKind::Ordered { order } if order.is_start() => self.enter(stream, MOVING, at),
            // A drive back begins before the event that the robot may move again.
            EventKind::Resumed if self.mission == RETURNING => Ok(()),
            EventKind::Resumed => self.enter(stream, MOVING, at),
            EventKind::ReturnBegan { .. } => self.enter(stream, RETURNING, at),
            // A run without an operator never receives a start order.
            EventKind::Commanded { .. } if self.mission == WAITING => self.enter(stream, MOVING, at),
            EventKind::Held { by, .. } => self.enter(stream, held(by), at),
            EventKind::Ended { outcome, .. } => self.enter(stream, outcome.word(), at),
            EventKind::PositionLost { .. } => change(stream, paths::STATE_POSITION, at, LOST),
            EventKind::PositionRegained { .. } => change(stream, paths::STATE_POSITION, at, KNOWN),
            EventKind::PlannerChosen { choice, .. } => self.planner(stream, &choice.id, at),
            _ => Ok(()),
        }
    }

    fn enter(&mut self, stream: &Stream, state: &'static str, at: At) -> Done {
        self.mission = state;
        change(stream, paths::STATE_MISSION, at, state)
    }

    fn planner(&mut self, stream: &Stream, id: &str, at: At) -> Done {
        if !self.planners.iter().any(|known| known == id) {
            self.planners.push(id.to_owned());
            let colors = style::SERIES.into_iter().cycle();
            let planners = self.planners.iter().zip(colors);
            let planners: Vec<_> = planners.map(|(id, color)| (id.as_str(), id.as_str(), color)).collect();
            stream.always(paths::STATE_PLANNER, &configuration(&planners))?;
        }
        change(stream, paths::STATE_PLANNER, at, id)
    }
}

fn change(stream: &Stream, path: &str, at: At, state: &str) -> Done {
    stream.once(path, at, &rr::StateChange::single(state))
}

fn held(by: &HoldReason) -> &'static str {
    match by {
        HoldReason::Operator | HoldReason::PlannerReplaced => HELD,
        HoldReason::Stepped => STEPPED,
        HoldReason::PositionLost => HELD_LOST,
        HoldReason::RangesInconsistent => HELD_ALARMED,
        HoldReason::PlannerFault { .. } | HoldReason::PlannerSilent { .. } => HELD_FAULT,
        HoldReason::Stuck { .. } => HELD_STUCK,
        HoldReason::Tether { .. } => HELD_TETHER,
        HoldReason::PlanRefused { .. } => HELD_REFUSED,
        HoldReason::ZoneBreached { .. } => HELD_ZONE,
        HoldReason::Vehicle { .. } | HoldReason::Guard { .. } => HELD_VEHICLE,
    }
}

/// The styles of the states: each has a colour and a short word, because the viewer cuts words that do not fit.
fn configuration(states: &[(&str, &str, [u8; 4])]) -> rr::StateConfiguration {
    rr::StateConfiguration::new()
        .with_values(states.iter().map(|state| state.0))
        .with_labels(states.iter().map(|state| state.1))
        .with_colors(states.iter().map(|state| style::color(state.2)))
}
