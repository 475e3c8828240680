//! The plan with which a start would begin the mission, computed from the events so far.

use crate::{
    event::{EventKind, RunOpened},
    order::Order,
    plan_id::{PlanId, PlanSeen},
    planner::{PlannerChoice, PlannerInfo},
    standing::Readiness,
};
use serde::{Deserialize, Serialize};

/// The plan with which a start would begin the mission, and its planner.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Ready {
    state: State,
    /// The planner that will be active first, with its parameters.
    choice: PlannerChoice,
}

/// The owned form of [`Readiness`].
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
enum State {
    #[default]
    Unseen,
    NoPlan,
    Preparing,
    Failed(String),
    Plan(PlanId),
}

impl Ready {
    pub(super) fn of(run: &RunOpened) -> Self {
        let state = if run.mission.start_names_plan && !run.mission.task.is_survey() {
            State::NoPlan
        } else {
            State::Unseen
        };
        Self { state, choice: run.mission.planner.clone() }
    }

    pub(super) fn readiness(&self) -> Readiness<'_> {
        match &self.state {
            State::Unseen => Readiness::Unseen,
            State::NoPlan => Readiness::NoPlan,
            State::Preparing => Readiness::Preparing,
            State::Failed(why) => Readiness::Failed(why),
            State::Plan(plan) => Readiness::Plan(*plan),
        }
    }

    /// Processes an event of a mission that is waiting for its start; `planner` is the planner that was opened last.
    pub(super) fn apply(&mut self, event: &EventKind, planner: Option<&PlannerInfo>) {
        match event {
            EventKind::PlannerChosen { choice, .. } | EventKind::ParametersChanged { choice, .. } => {
                self.choice = choice.clone();
            }
            _ => {}
        }
        if self.state == State::Unseen {
            return;
        }
        match event {
            EventKind::Ordered { order: Order::Plan } => self.state = State::Preparing,
            EventKind::Ordered { order: Order::ChoosePlanner(_) | Order::SetParameter { .. } } => {
                self.state = State::NoPlan;
            }
            EventKind::ZoneDrawn { .. } => {
                let is_made_again = matches!(self.state, State::Plan(_) | State::Preparing);
                self.state = if is_made_again { State::Preparing } else { State::NoPlan };
            }
            EventKind::Planned { path, legs, cuts, complete, .. } => {
                let seen = PlanSeen { path, legs, cuts, complete: *complete };
                let plan = planner.map(|info| PlanId::of(&self.choice, info, seen));
                self.state = plan.map_or(State::NoPlan, State::Plan);
            }
            EventKind::Certified { planner, refused: true, certificate } => {
                let why = certificate.reasons.join("; ");
                self.state = State::Failed(format!("plan of {planner} is not safe for the tether: {why}"));
            }
            EventKind::PlannerFailed { fault, .. } => {
                self.state = State::Failed(fault.message.clone());
            }
            _ => {}
        }
    }
}
