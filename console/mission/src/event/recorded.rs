//! The answers that a journal holds: each event that closes an ask carries what a mission needs to repeat it.

use super::EventKind;
use crate::{
    ask::{Answer, Ask, AskId, Given, Said, What},
    planner::{Cause, During, Fault},
};
use planner_api::{Command, Leg, Plan, Status};
use std::collections::VecDeque;

/// Answers asks from a journal, each in the tick in which it was answered when the journal was written.
#[derive(Debug, Default)]
pub struct RecordedAnswers {
    /// What was asked and not answered yet, and whether it is a plan.
    open: Vec<(AskId, bool)>,
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
            // A planner in shadow answers like any other.
            let event = if let EventKind::Shadowed { of } = event { of } else { event };
            match event {
                EventKind::Drawn { drawings } => said.drawings.clone_from(drawings),
                EventKind::Scalars { scalars } => said.scalars.clone_from(scalars),
                EventKind::PlannerLogged { level, message, .. } => said.logs.push((*level, message.clone())),
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
    pub fn submit(&mut self, ask: &Ask) {
        if ask.what == What::Close {
            self.open.retain(|(open, _)| open.worker != ask.id.worker);
        } else {
            self.open.push((ask.id, matches!(ask.what, What::Plan(_))));
        }
    }

    /// The next answer of this tick to something that was asked, and whether the mission made use of it: of one that it
    /// did not the journal does not hold the content.
    pub fn next_answer(&mut self) -> Option<(Answer, bool)> {
        // A worker's answers are recorded when they are used, which may be after the next question to it.
        let is_open = |recorded: &Recorded| self.open.iter().position(|(open, _)| *open == recorded.ask);
        let (at, open) =
            self.due.iter().enumerate().find_map(|(at, recorded)| Some((at, is_open(recorded)?)))?;
        let Recorded { ask, closing, said } = self.due.remove(at)?;
        let (_, is_plan) = self.open.swap_remove(open);
        let result = closing.recorded_answer(is_plan)?;
        let is_used =
            !matches!(closing, EventKind::Discarded { plan: None, .. } | EventKind::ShadowMissed { .. });
        Some((Answer { ask, result, said }, is_used))
    }
}

impl EventKind {
    /// The ask whose answer this event reports. Each answered ask is reported by exactly one event, in the tick in which
    /// the answer arrived.
    pub fn closes(&self) -> Option<AskId> {
        match self {
            Self::PlannerPrepared { ask, .. }
            | Self::ShadowBegan { ask, .. }
            | Self::ShadowMissed { ask, .. }
            | Self::Snapshotted { ask, .. }
            | Self::BetterPlanned { ask, .. }
            | Self::Discarded { ask, .. } => Some(*ask),
            Self::Shadowed { of } => of.closes(),
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
    /// The cost of a plan is not recorded, since nobody reads it, and a command is the one that was sent. A plan that no
    /// planner can have given (the journal was edited) is a fault. A command that was limited is the one that was asked for. `is_plan`: whether a plan was asked for.
    pub fn recorded_answer(&self, is_plan: bool) -> Option<Result<Given, Fault>> {
        Some(match self {
            Self::PlannerChosen { ask: Some(_), info, .. }
            | Self::PlannerPrepared { info, .. }
            | Self::ShadowBegan { info, .. } => Ok(Given::Opened(info.clone())),
            Self::ParametersChanged { ask: Some(_), .. } => Ok(Given::Reconfigured),
            Self::Planned { ask: Some(_), return_path, path, complete, legs, cuts, .. } => {
                without_return_path(*return_path, path, *complete, legs, cuts).map(Given::Plan)
            }
            Self::BetterPlanned { path, complete, legs, cuts, .. } => {
                without_return_path(0, path, *complete, legs, cuts).map(Given::Plan)
            }
            Self::Commanded { ask: Some(_), command, asked } => Ok(Given::Command(asked.unwrap_or(*command))),
            Self::Snapshotted { bytes, .. } => Ok(Given::State { bytes: *bytes }),
            Self::Discarded { plan: Some(plan), .. } => return plan.recorded_answer(is_plan),
            Self::Discarded { .. } if is_plan => Ok(Given::Plan(Plan::default())),
            Self::Discarded { .. } | Self::ShadowMissed { .. } => {
                Ok(Given::Command(Command::still(Status::Waiting)))
            }
            Self::Shadowed { of } => return of.recorded_answer(is_plan),
            Self::PlannerFailed { ask: Some(_), fault } => Err(fault.clone()),
            _ => return None,
        })
    }
}

/// The plan as the planner gave it, before the mission put a return path of so many points in front.
///
/// # Errors
/// No planner can have given it.
fn without_return_path(
    return_path: usize,
    path: &[world::Point],
    complete: bool,
    legs: &[Leg],
    cuts: &[Vec<world::Point>],
) -> Result<Plan, Fault> {
    // The return path has a leg of its own, the first.
    let own = legs.iter().skip(usize::from(return_path > 0));
    let shifted = |leg: &Leg| {
        let (first, last) = (leg.first.checked_sub(return_path)?, leg.last.checked_sub(return_path)?);
        Some(Leg { first, last, ..*leg })
    };
    let legs: Option<Vec<Leg>> = own.map(shifted).collect();
    let legs = legs.ok_or_else(|| impossible("gave a leg that begins on the return path"))?;
    let path = path.iter().skip(return_path).copied().collect();
    let plan = Plan { path, complete, legs, cuts: cuts.to_vec(), ..Plan::default() };
    plan.check().map_err(|what| impossible(&what))?;
    Ok(plan)
}

fn impossible(what: &str) -> Fault {
    Fault {
        planner: String::new(),
        during: During::Plan,
        cause: Cause::BadOutput,
        message: format!("the planner of the journal {what}"),
        partial: Vec::new(),
        plugin_sha256: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;
    use planner_api::LegTag;

    fn leg(first: usize, last: usize) -> Leg {
        Leg { tag: LegTag::Travel, first, last }
    }

    fn recorded(return_path: usize, legs: &[Leg]) -> Result<Vec<(usize, usize)>, String> {
        let path: Vec<_> = (0..5).map(|x| Point2::new(f64::from(x), 0.0)).collect();
        let plan = without_return_path(return_path, &path, true, legs, &[]).map_err(|fault| fault.message)?;
        Ok(plan.legs.iter().map(|leg| (leg.first, leg.last)).collect())
    }

    #[test]
    fn a_plan_of_an_edited_journal_is_a_fault_and_no_panic() {
        assert_eq!(recorded(2, &[leg(0, 2), leg(2, 4)]), Ok(vec![(0, 2)]));
        assert_eq!(
            recorded(2, &[leg(0, 2), leg(1, 4)]),
            Err("the planner of the journal gave a leg that begins on the return path".into())
        );
        assert!(recorded(0, &[leg(0, 5)]).unwrap_err().ends_with("to 5 of a path of 5 points"));
        assert!(recorded(usize::MAX, &[leg(0, 0), leg(1, 2)]).is_err());
        assert!(recorded(9, &[leg(0, 9), leg(9, 9)]).is_err());
    }
}
