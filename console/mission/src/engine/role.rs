//! A planner that is being prepared while another one is active, and the purpose of the preparation.

use super::{course::Due, known::Known, requests::AskedPlan, worker::Worker};
use crate::{
    ask::PlanAsk,
    config::BetterPlan,
    event::{Effort, OfferStage},
    task::Joint,
};
use planner_api::{Plan, Reason};
use world::Shape;

/// A planner that is being prepared while another one is active.
#[derive(Clone)]
pub(super) struct Preparing {
    pub worker: Worker,
    pub role: Role,
}

/// The purpose of the preparation.
#[derive(Clone)]
pub(super) enum Role {
    /// The planner takes over as soon as it has an acceptable plan.
    Candidate(Candidate),
    /// The planner makes a plan for the rest of the task, to replace the repaired plan in use.
    Better(Better),
}

impl Preparing {
    /// Whether the robot stands still until the planner has planned.
    pub(super) fn robot_waits(&self) -> bool {
        matches!(&self.role, Role::Candidate(candidate) if candidate.robot_waits)
    }
}

/// A planner that takes over as soon as it has an acceptable plan.
#[derive(Clone)]
pub(super) struct Candidate {
    /// The plan that the candidate still has to make.
    pub due: Due,
    /// The plan that the candidate is asked to keep to. This is the candidate's own plan, not the plan in use.
    pub keep: Option<Plan>,
    /// Obstacles found since the candidate's plan was requested.
    pub found_since: Vec<Shape>,
    /// Whether the robot stands still until the candidate has planned, because it had moved too far during the
    /// candidate's first attempt.
    pub robot_waits: bool,
}

impl Candidate {
    /// Prepares a planner that has not been opened yet, given the reason for the change and the plan to keep to.
    pub(super) fn prepare(worker: Worker, reason: Reason, keep: Option<Plan>) -> Preparing {
        let due = Due::from_here(reason);
        let candidate = Self { due, keep, found_since: Vec::new(), robot_waits: false };
        Preparing { worker, role: Role::Candidate(candidate) }
    }

    pub(super) fn plan_ask(&mut self, known: &Known) -> (AskedPlan, PlanAsk) {
        self.found_since.clear();
        known.plan_ask(&self.due, known.trail.len(), self.keep.clone())
    }
}

/// State of the better plan, which begins at a place on the current plan.
#[derive(Clone)]
pub(super) enum Better {
    /// The planner is being opened.
    Opening,
    /// The plan, which is to begin at this place, is being made.
    Planning(Joint),
    /// The plan has turned out to be better and is offered.
    Offered(Box<Offer>),
}

/// A better plan that is offered.
#[derive(Clone)]
pub(super) struct Offer {
    pub joint: Joint,
    pub plan: Plan,
    pub flown: Effort,
    pub better: Effort,
    /// Whether the operator has ordered the plan to be taken.
    pub is_ordered: bool,
}

impl Better {
    /// The stage of the offer; `None` before the first offer. With [`BetterPlan::Take`], every offer counts as
    /// accepted.
    pub(super) fn stage(&self, setting: BetterPlan) -> Option<OfferStage> {
        let Self::Offered(offer) = self else { return None };
        let is_accepted = offer.is_ordered || setting == BetterPlan::Take;
        Some(if is_accepted { OfferStage::Accepted } else { OfferStage::Offered })
    }

    /// The place where the better plan begins; `None` until the planner has been asked for the plan.
    pub(super) fn joint(&self) -> Option<Joint> {
        match self {
            Self::Opening => None,
            Self::Planning(joint) => Some(*joint),
            Self::Offered(offer) => Some(offer.joint),
        }
    }
}
