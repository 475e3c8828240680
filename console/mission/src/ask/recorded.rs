//! The answers that a journal holds: each event that closes an ask carries what a mission needs to repeat it.

use super::{Answer, Ask, AskId, Given, Said, What};
use crate::{event::EventKind, planner::Fault};
use planner_api::{Command, Leg, Plan, Status};
use std::collections::VecDeque;

/// Answers asks from a journal, each in the tick in which it was answered when the journal was written.
#[derive(Debug, Default)]
pub struct RecordedAnswers {
    open: Vec<Ask>,
    due: VecDeque<Recorded>,
}

/// An answer in a journal.
#[derive(Debug)]
struct Recorded {
    ask: AskId,
    closing: EventKind,
    said: Said,
}

impl RecordedAnswers {
    /// Takes the recorded events of the tick that begins; answers of an earlier tick that nobody asked for are forgotten.
    pub fn begin_tick<'a>(&mut self, events: impl IntoIterator<Item = &'a EventKind>) {
        self.due.clear();
        let mut said = Said::default();
        for event in events {
            match event {
                EventKind::Drawn { drawings } => said.drawings.clone_from(drawings),
                EventKind::Scalars { scalars } => said.scalars.clone_from(scalars),
                EventKind::PlannerSaid { level, message, .. } => said.logs.push((*level, message.clone())),
                closing => {
                    // What a planner said stands directly before the event that closes its ask.
                    let said = std::mem::take(&mut said);
                    if let Some(ask) = closing.closes() {
                        self.due.push_back(Recorded { ask, closing: closing.clone(), said });
                    }
                }
            }
        }
    }

    /// Takes an ask of the mission.
    pub fn submit(&mut self, ask: Ask) {
        if ask.what == What::Close {
            self.open.retain(|open| open.id.worker != ask.id.worker);
        } else {
            self.open.push(ask);
        }
    }

    /// The next answer of this tick to something that was asked, with the ask, and whether the mission made use of it: of
    /// one that it did not the journal does not hold the content.
    pub fn next_answer(&mut self) -> Option<(Ask, Answer, bool)> {
        // A worker's answers are recorded when they are used, which may be after the next question to it.
        let is_open = |recorded: &Recorded| self.open.iter().position(|open| open.id == recorded.ask);
        let (at, open) =
            self.due.iter().enumerate().find_map(|(at, recorded)| Some((at, is_open(recorded)?)))?;
        let (Recorded { ask: id, closing, said }, ask) = (self.due.remove(at)?, self.open.swap_remove(open));
        let result = closing.recorded_answer(&ask.what)?;
        let is_used = !matches!(closing, EventKind::Discarded { .. });
        Some((ask, Answer { ask: id, result, said }, is_used))
    }
}

impl EventKind {
    /// The ask whose answer this event reports. Each answered ask is reported by exactly one event, in the tick in which
    /// the answer arrived.
    pub fn closes(&self) -> Option<AskId> {
        match self {
            Self::PlannerPrepared { ask, .. } | Self::Snapshotted { ask, .. } | Self::Discarded { ask } => {
                Some(*ask)
            }
            Self::PlannerChosen { ask, .. }
            | Self::ParametersChanged { ask, .. }
            | Self::Planned { ask, .. }
            | Self::Commanded { ask, .. }
            | Self::PlannerFailed { ask, .. } => *ask,
            _ => None,
        }
    }

    /// What the planner answered, as far as the mission made use of it; `None` for events that close no ask.
    ///
    /// The cost of a plan is not recorded, since nobody reads it, and a command is the one that was sent.
    pub fn recorded_answer(&self, what: &What) -> Option<Result<Given, Fault>> {
        Some(match self {
            Self::PlannerChosen { ask: Some(_), info, .. } | Self::PlannerPrepared { info, .. } => {
                Ok(Given::Opened(info.clone()))
            }
            Self::ParametersChanged { ask: Some(_), .. } => Ok(Given::Reconfigured),
            Self::Planned { ask: Some(_), way_home, path, complete, legs, cuts, .. } => {
                Ok(Given::Plan(without_way_home(*way_home, path, *complete, legs, cuts)))
            }
            Self::Commanded { ask: Some(_), command } => Ok(Given::Command(*command)),
            Self::Snapshotted { bytes, .. } => Ok(Given::State { bytes: *bytes }),
            Self::Discarded { .. } => Ok(match what {
                What::Plan(_) => Given::Plan(Plan::default()),
                _ => Given::Command(Command::still(Status::Waiting)),
            }),
            Self::PlannerFailed { ask: Some(_), fault } => Err(fault.clone()),
            _ => return None,
        })
    }
}

/// The plan as the planner gave it, before the mission put a way home of so many points in front.
fn without_way_home(
    way_home: usize,
    path: &[world::Point],
    complete: bool,
    legs: &[Leg],
    cuts: &[Vec<world::Point>],
) -> Plan {
    // The way home has a leg of its own, the first.
    let own = legs.iter().skip(usize::from(way_home > 0));
    let legs =
        own.map(|leg| Leg { first: leg.first - way_home, last: leg.last - way_home, ..*leg }).collect();
    let path = path.iter().skip(way_home).copied().collect();
    Plan { path, complete, legs, cuts: cuts.to_vec(), ..Plan::default() }
}
