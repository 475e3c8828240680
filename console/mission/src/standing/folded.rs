//! The standing of a mission, computed from its events.

mod ready;

use super::{InShadow, PositionTrust, Readiness, Standing};
use crate::{
    config::BetterPlan,
    event::{EventKind, OfferStage, PlanMade},
    order::Order,
    phase::{Gait, Hold, Phase},
    plan_id::PlanId,
    planner::PlannerInfo,
};
use ready::Ready;
use serde::{Deserialize, Serialize};
use vehicle::port::Stood;
use world::Point;

/// The standing of a mission as it follows from its events, for code that sees only the events.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[allow(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub struct FoldedStanding {
    /// The phase of the mission.
    pub phase: Phase,
    /// The gait of the last order that released the robot.
    gait: Option<Gait>,
    /// The limit on the position error while the position counts as lost, metres.
    lost: Option<f64>,
    /// Whether the ranges contradict each other.
    is_alarmed: bool,
    /// The active planner, as last opened.
    planner: Option<Box<PlannerInfo>>,
    /// The planner in shadow; `None` without one.
    #[serde(default)]
    shadow: Option<InShadow>,
    /// The better plan that is offered or accepted; `None` without one.
    #[serde(default)]
    offer: Option<OfferStage>,
    /// Whether the scenario takes better plans without an order.
    #[serde(default)]
    takes_offers: bool,
    /// The plan with which a start would begin the mission, and its planner.
    #[serde(default)]
    ready: Ready,
    /// Why the vehicle must not be driven, as a clause.
    #[serde(default)]
    trouble: Option<String>,
    /// Why a vehicle that waits for its start does not stand still, as a clause.
    #[serde(default)]
    unsteady: Option<String>,
    /// Whether the robot is a real vehicle.
    #[serde(default)]
    is_live: bool,
    /// Whether the task is a survey.
    #[serde(default)]
    is_survey: bool,
    /// The beginning of the last plan before the start, and where a real vehicle is.
    #[serde(default)]
    first: Option<Point>,
    #[serde(default)]
    here: Option<Point>,
}

impl FoldedStanding {
    /// Processes one event; the events must be passed in the order of the journal.
    pub fn apply(&mut self, event: &EventKind) {
        match event {
            EventKind::RunOpened(run) => {
                let takes_offers = run.mission.better_plan == BetterPlan::Take;
                let (is_live, is_survey) = (run.mission.live, run.mission.task.is_survey());
                *self = Self { ready: Ready::of(run), takes_offers, is_live, is_survey, ..Self::default() };
            }
            EventKind::Link(link) => self.trouble = link.trouble(),
            EventKind::Stood { confirmed, after_s, moved } => {
                let stood = Stood { confirmed: *confirmed, after_s: *after_s, moved: *moved };
                self.unsteady = stood.trouble().map(str::to_owned);
            }
            EventKind::Estimated { pose } => self.here = self.is_live.then_some(pose.position),
            EventKind::Planned { path, .. } => self.first = path.first().copied(),
            EventKind::Ordered { order } if order.is_start() => self.phase = Phase::Running(Gait::Steady),
            EventKind::Ordered { order } => {
                if matches!(order, Order::Shadow(_)) {
                    self.shadow = Some(InShadow::default());
                }
                if *order == Order::TakePlan {
                    self.offer = Some(OfferStage::Accepted);
                }
                self.gait = match order {
                    Order::Step => Some(Gait::OneTick),
                    Order::StepTo(to) => Some(Gait::To(*to)),
                    Order::DriveBack => Some(Gait::Back),
                    _ => None,
                };
            }
            EventKind::Resumed => {
                self.phase = Phase::Running(self.gait.take().unwrap_or(Gait::Steady));
            }
            EventKind::Held { by, resumes } => {
                self.phase = Phase::Held(Hold { by: by.clone(), resumes: *resumes });
            }
            EventKind::Ended { outcome, .. } => self.phase = Phase::Ended(*outcome),
            EventKind::PositionLost { limit_m, .. } => self.lost = Some(*limit_m),
            EventKind::PositionRegained { .. } => self.lost = None,
            EventKind::RangesInconsistent { .. } => self.is_alarmed = true,
            EventKind::RangesConsistent => self.is_alarmed = false,
            EventKind::PlannerChosen { info, .. } => self.planner = Some(info.clone()),
            EventKind::BetterPlanned(PlanMade { objection, .. }) => {
                let stage = if self.takes_offers { OfferStage::Accepted } else { OfferStage::Offered };
                self.offer = objection.is_none().then_some(stage);
            }
            EventKind::BetterPlanTaken(_) | EventKind::BetterPlanDropped(_) => self.offer = None,
            EventKind::Promoted { .. } | EventKind::ShadowEnded { .. } => self.shadow = None,
            _ => {}
        }
        if let Some(shadow) = &mut self.shadow {
            shadow.tally.apply(event);
            shadow.has_planned |=
                matches!(event, EventKind::Shadowed { of } if matches!(**of, EventKind::Planned { .. }));
        }
        if self.phase == Phase::Waiting {
            self.ready.apply(event, self.planner.as_deref());
        }
    }

    /// The plan with which a start would begin the mission, if it is ready.
    pub fn ready_plan(&self) -> Option<PlanId> {
        match self.ready.readiness() {
            Readiness::Plan(plan) => Some(plan),
            _ => None,
        }
    }

    /// Everything that decides whether an order is accepted now.
    pub fn standing(&self) -> Standing<'_> {
        let position = match self.lost {
            Some(limit_m) => PositionTrust::Lost { limit_m },
            None if self.is_alarmed => PositionTrust::Alarmed,
            None => PositionTrust::Good,
        };
        let is_waiting = self.phase == Phase::Waiting;
        Standing {
            phase: &self.phase,
            position,
            planner: self.planner.as_deref(),
            shadow: self.shadow,
            offer: self.offer,
            readiness: self.ready.readiness(),
            trouble: self.trouble.as_deref().or(self.unsteady.as_deref().filter(|_| is_waiting)),
            is_live: self.is_live,
            is_survey: self.is_survey,
            from_plan_m: self
                .here
                .zip(self.first)
                .filter(|_| is_waiting)
                .map(|(here, at)| (here - at).norm()),
        }
    }
}
