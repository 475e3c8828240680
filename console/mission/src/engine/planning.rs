//! Evaluates plans: decides whether a plan may be run.

use super::{known::Known, requests::AskedPlan};
use crate::{ask::AskId, event::EventKind};
use planner_api::{Leg, LegTag, Plan};
use world::{Point, polyline};

/// Length, metres, below which a plan leads nowhere.
const NO_WAY_M: f64 = 0.01;

/// A plan as it would be run, with its events.
pub(super) struct Evaluated {
    /// The plan, including the return path that the mission put before it.
    pub plan: Plan,
    /// The event that says that the plan was made, and the plan's certificate for the tether.
    pub events: Vec<EventKind>,
    /// Why the plan is not run.
    pub objection: Option<Objection>,
}

/// The reason for not running a plan.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Objection {
    /// Whether the tether is the reason.
    pub by_tether: bool,
    /// The reason, as a sentence.
    pub message: String,
}

impl Known {
    /// Evaluates a plan against the map as known now.
    pub(super) fn evaluate(
        &self,
        ask: Option<AskId>,
        planner: &str,
        asked: &AskedPlan,
        plan: Plan,
    ) -> Evaluated {
        let plan = after(&asked.return_path, plan);
        let mut events = vec![planned(ask, planner, asked, &plan)];
        let objection = self.objection(planner, &plan, &mut events);
        Evaluated { plan, events, objection }
    }

    /// Why a plan is not run, or `None`; the plan's certificate is added to the events.
    pub(super) fn objection(
        &self,
        planner: &str,
        plan: &Plan,
        events: &mut Vec<EventKind>,
    ) -> Option<Objection> {
        let by_tether = self.certified(planner, plan, events);
        by_tether.or_else(|| self.objection_to_way(planner, plan))
    }

    /// Why a plan is not safe for the tether, or `None`; the plan's certificate is added to the events.
    fn certified(&self, planner: &str, plan: &Plan, events: &mut Vec<EventKind>) -> Option<Objection> {
        let tether = self.tether.as_ref()?;
        let certificate = tether.certify(plan, self.chart.world(), self.task_ends_at_anchor());
        let refused = !certificate.certified && !tether.flies_uncertified();
        let why = certificate.reasons.join("; ");
        events.push(EventKind::Certified { planner: planner.to_owned(), refused, certificate });
        let message = || format!("plan of {planner} is not safe for the tether: {why}");
        refused.then(|| Objection { by_tether: true, message: message() })
    }

    /// Refuses a first plan that leads nowhere although there is floor to scan: the robot would be back at the anchor
    /// immediately, and the mission would count as complete.
    fn objection_to_way(&self, planner: &str, plan: &Plan) -> Option<Objection> {
        let coverage = &self.floor.coverage;
        if polyline::length_m(&plan.path) >= NO_WAY_M || self.task.lanes_left().is_some() {
            return None;
        }
        let left_m2 = self.task.floor_left(coverage).len() as f64 * coverage.floor().cell_m2();
        let message = || {
            format!(
                "plan of {planner} scans none of the remaining {left_m2:.2} m²: no lane reaches it; try another planner, a smaller \
                 mission.overlap_m or other mission.boxes_m"
            )
        };
        (left_m2 > 0.0).then(|| Objection { by_tether: false, message: message() })
    }
}

/// The event for a plan that was made, including its return path.
pub(super) fn planned(ask: Option<AskId>, planner: &str, asked: &AskedPlan, plan: &Plan) -> EventKind {
    EventKind::Planned {
        ask,
        return_path: asked.return_path.len(),
        planner: planner.to_owned(),
        reason: asked.reason.clone(),
        length_m: polyline::length_m(&plan.path),
        path: plan.path.clone(),
        complete: plan.complete,
        legs: plan.legs.clone(),
        cuts: plan.cuts.clone(),
    }
}

/// Adds the return path at the start of a plan.
pub(super) fn after(return_path: &[Point], mut plan: Plan) -> Plan {
    let Some(last) = return_path.len().checked_sub(1) else { return plan };
    let shifted = |leg: &Leg| Leg { first: leg.first + last + 1, last: leg.last + last + 1, ..*leg };
    let retract = Leg { tag: LegTag::Retract, first: 0, last };
    plan.legs = std::iter::once(retract).chain(plan.legs.iter().map(shifted)).collect();
    plan.path.splice(0..0, return_path.iter().copied());
    plan
}
