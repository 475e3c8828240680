//! Answers from a journal. An event that answers an ask contains everything needed to repeat that answer.

use super::{EventKind, PlanMade};
use crate::{
    ask::{Answer, Ask, AskId, Given, Said, What},
    planner::{Cause, During, Fault},
};
use planner_api::{Command, Leg, Plan, Status};
use std::collections::VecDeque;

/// Answers asks from a journal, each in the tick in which the original answer arrived.
#[derive(Debug, Default)]
pub struct RecordedAnswers {
    /// The open asks, and whether each is for a plan.
    open: Vec<(AskId, bool)>,
    due: VecDeque<Recorded>,
}

/// An answer from a journal.
#[derive(Debug)]
struct Recorded {
    ask: AskId,
    closing: EventKind,
    said: Said,
}

impl RecordedAnswers {
    /// Takes the recorded events of the tick that begins; answers recorded for earlier ticks are dropped if no ask
    /// matched them.
    pub fn begin_tick<'a>(&mut self, events: impl IntoIterator<Item = &'a EventKind>) {
        self.due.clear();
        let mut said = Said::default();
        for event in events {
            // A planner in shadow answers like any other planner.
            let event = if let EventKind::Shadowed { of } = event { of } else { event };
            match event {
                EventKind::Drawn { drawings } => said.drawings.clone_from(drawings),
                EventKind::Scalars { scalars } => said.scalars.clone_from(scalars),
                EventKind::PlannerLogged { level, message, .. } => said.logs.push((*level, message.clone())),
                closing => {
                    // Drawings, figures and logs precede the event that answers the ask.
                    let said = std::mem::take(&mut said);
                    if let Some(ask) = closing.closes() {
                        self.due.push_back(Recorded { ask, closing: closing.clone(), said });
                    }
                }
            }
        }
    }

    /// Registers an ask from the mission.
    pub fn submit(&mut self, ask: &Ask) {
        if ask.what == What::Close {
            self.open.retain(|(open, _)| open.worker != ask.id.worker);
        } else {
            self.open.push((ask.id, matches!(ask.what, What::Plan(_))));
        }
    }

    /// The next answer in this tick to an open ask, and whether the original mission used the answer; the journal does
    /// not contain the contents of unused answers.
    pub fn next_answer(&mut self) -> Option<(Answer, bool)> {
        // Answers are recorded when they are used, which may be after the next ask to the same worker.
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
    /// The ask that this event answers. Each ask is answered by exactly one event, in the tick in which its answer
    /// arrived.
    pub fn closes(&self) -> Option<AskId> {
        match self {
            Self::PlannerPrepared { ask, .. }
            | Self::ShadowBegan { ask, .. }
            | Self::ShadowMissed { ask, .. }
            | Self::Snapshotted { ask, .. }
            | Self::BetterPlanned(PlanMade { ask, .. })
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

    /// The planner's answer, to the extent that the mission used it; `None` for events that answer no ask.
    ///
    /// The cost of a plan is not recorded, since nothing reads it. A command is returned as it was sent or, if it was
    /// limited, as the planner requested it. A plan that no planner can have made, because the journal was edited, is
    /// returned as a fault. `is_plan` states whether the ask was for a plan.
    pub fn recorded_answer(&self, is_plan: bool) -> Option<Result<Given, Fault>> {
        Some(match self {
            Self::PlannerChosen { ask: Some(_), info, .. }
            | Self::PlannerPrepared { info, .. }
            | Self::ShadowBegan { info, .. } => Ok(Given::Opened(info.clone())),
            Self::ParametersChanged { ask: Some(_), .. } => Ok(Given::Reconfigured),
            Self::Planned { ask: Some(_), return_path, path, complete, legs, cuts, .. } => {
                without_return_path(*return_path, path, *complete, legs, cuts).map(Given::Plan)
            }
            Self::BetterPlanned(PlanMade { path, complete, legs, cuts, .. }) => {
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

/// The planner's own plan, without the first `return_path` points: the return path that the mission put before it.
///
/// # Errors
/// No planner can have made this plan.
fn without_return_path(
    return_path: usize,
    path: &[world::Point],
    complete: bool,
    legs: &[Leg],
    cuts: &[Vec<world::Point>],
) -> Result<Plan, Fault> {
    // The return path has its own leg, the first one.
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
        message: format!("the planner in the journal {what}"),
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
            Err("the planner in the journal gave a leg that begins on the return path".into())
        );
        assert!(recorded(0, &[leg(0, 5)]).unwrap_err().ends_with("to 5 in a path of 5 points"));
        assert!(recorded(usize::MAX, &[leg(0, 0), leg(1, 2)]).is_err());
        assert!(recorded(9, &[leg(0, 9), leg(9, 9)]).is_err());
    }
}
