//! Who drives, whether the robot moves, and whether its position is known: lanes of the timeline of states.
//!
//! The viewer fits this timeline only once, to what it has read when the first lane appears. So the lanes are written
//! all together at the end, where they are fitted to the whole run. A recording whose writer was killed has none;
//! the event log shows the same, and a recording regenerated from the journal has them.

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
const HELD_ALARMED: &str = "held, ranges contradict";
const HELD_FAULT: &str = "held, planner fault";
const HELD_STUCK: &str = "held, stuck";
const HELD_TETHER: &str = "held, tether";
const HELD_REFUSED: &str = "held, plan refused";
const KNOWN: &str = "known";
const LOST: &str = "lost";

/// The states of a run.
pub(crate) struct States {
    mission: &'static str,
    planners: Vec<String>,
    changes: Vec<(&'static str, At, String)>,
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
            (HELD_ALARMED, red),
            (HELD_FAULT, red),
            (HELD_STUCK, red),
            (HELD_TETHER, red),
            (HELD_REFUSED, red),
            outcome(Outcome::Complete, style::rgb(60, 120, 200)),
            outcome(Outcome::Stuck, amber),
            outcome(Outcome::Collision, red),
            outcome(Outcome::TimeLimit, amber),
            outcome(Outcome::Entangled, red),
            outcome(Outcome::Aborted, amber),
        ];
        stream.always(paths::STATE_MISSION, &configuration(&mission))?;
        stream.always(paths::STATE_POSITION, &configuration(&[(KNOWN, green), (LOST, red)]))?;
        let mut states = Self { mission: WAITING, planners: Vec::new(), changes: Vec::new() };
        states.change(paths::STATE_MISSION, at, WAITING);
        states.change(paths::STATE_POSITION, at, KNOWN);
        Ok(states)
    }

    pub(crate) fn apply(&mut self, event: &EventKind, at: At) {
        match event {
            EventKind::Ordered { order: Order::Start } | EventKind::Resumed => self.enter(MOVING, at),
            // A run without an operator never receives a start order.
            EventKind::Commanded { .. } if self.mission == WAITING => self.enter(MOVING, at),
            EventKind::Held { by, .. } => self.enter(held(by), at),
            EventKind::Ended { outcome, .. } => self.enter(outcome.word(), at),
            EventKind::PositionLost { .. } => self.change(paths::STATE_POSITION, at, LOST),
            EventKind::PositionRegained { .. } => self.change(paths::STATE_POSITION, at, KNOWN),
            EventKind::PlannerChosen { choice, .. } => self.planner(&choice.id, at),
            _ => {}
        }
    }

    /// Writes all lanes.
    pub(crate) fn finish(&self, stream: &Stream) -> Done {
        let colors = style::SERIES.into_iter().cycle();
        let planners: Vec<_> = self.planners.iter().map(String::as_str).zip(colors).collect();
        stream.always(paths::STATE_PLANNER, &configuration(&planners))?;
        for (path, at, state) in &self.changes {
            stream.once(path, *at, &rr::StateChange::single(state.as_str()))?;
        }
        Ok(())
    }

    fn enter(&mut self, state: &'static str, at: At) {
        self.mission = state;
        self.change(paths::STATE_MISSION, at, state);
    }

    fn planner(&mut self, id: &str, at: At) {
        if !self.planners.iter().any(|known| known == id) {
            self.planners.push(id.to_owned());
        }
        self.change(paths::STATE_PLANNER, at, id);
    }

    fn change(&mut self, path: &'static str, at: At, state: &str) {
        self.changes.push((path, at, state.to_owned()));
    }
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
    }
}

fn configuration(states: &[(&str, [u8; 4])]) -> rr::StateConfiguration {
    rr::StateConfiguration::new()
        .with_values(states.iter().map(|state| state.0))
        .with_colors(states.iter().map(|state| style::color(state.1)))
}
