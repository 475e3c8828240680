//! Which orders a mission accepts now.
//!
//! There is one table, [`Standing::allows`]. The mission consults it for every order; the screen consults it to show
//! which keys are available, and why the other keys are not. The table has no state and changes none.

mod folded;

pub use folded::FoldedStanding;

use crate::{
    event::{OfferStage, READY_AFTER, ShadowTally},
    order::Order,
    phase::{Gait, Hold, HoldReason, Outcome, Phase},
    plan_id::PlanId,
    planner::PlannerInfo,
};
use serde::{Deserialize, Serialize};
use std::fmt;

/// How reliable the position is.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub enum PositionTrust {
    /// Within the limit.
    #[default]
    Good,
    /// The position error is beyond the limit, or there are no more fixes.
    Lost {
        /// The limit on the 95 % error, metres.
        limit_m: f64,
    },
    /// The ranges contradict each other.
    Alarmed,
}

/// The plan with which a start would begin the mission.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Readiness<'a> {
    /// Plans are not shown before the start: whatever plan is made is run.
    Unseen,
    /// There is no plan, and none is being made.
    NoPlan,
    /// The planner is being opened or changed, or is making a plan.
    Preparing,
    /// The planner failed, or its plan cannot be run. Contains the reason, as a sentence.
    Failed(&'a str),
    /// This plan is ready.
    Plan(PlanId),
}

/// What decides whether the planner in shadow can take over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct InShadow {
    /// Its record.
    pub tally: ShadowTally,
    /// Whether it has made a plan.
    pub has_planned: bool,
}

/// Everything that decides whether an order is accepted. Both the mission and the screen can compute it.
#[derive(Debug, Clone, Copy)]
pub struct Standing<'a> {
    /// The phase of the mission.
    pub phase: &'a Phase,
    /// How reliable the position is.
    pub position: PositionTrust,
    /// The active planner, as last opened.
    pub planner: Option<&'a PlannerInfo>,
    /// The planner in shadow; `None` without one.
    pub shadow: Option<InShadow>,
    /// The better plan that is offered or accepted; `None` without one.
    pub offer: Option<OfferStage>,
    /// The plan with which a start would begin the mission.
    pub readiness: Readiness<'a>,
    /// The reason why a real vehicle must not be driven now, as a clause; `None` if it may be driven, and in a simulation.
    pub trouble: Option<&'a str>,
    /// Whether the robot is a real vehicle.
    pub is_live: bool,
    /// Whether the task is a survey, in which the mission itself drives.
    pub is_survey: bool,
    /// For a real vehicle that has not been started: its distance from the beginning of its plan, metres; `None`
    /// without a plan.
    pub from_plan_m: Option<f64>,
}

/// Distance from the robot to the beginning of a plan, metres, above which the plan must be made again.
pub(crate) const NEAR_PLAN_M: f64 = 0.5;

/// Why an order is refused.
#[derive(Debug, Clone, PartialEq)]
pub enum Refusal {
    /// The mission is over.
    Ended(Outcome),
    /// The mission has not been started.
    NotStarted,
    /// The mission has already been started.
    AlreadyStarted,
    /// The plan or the planner is not ready yet.
    Planning,
    /// There is no plan to start with.
    NoPlan,
    /// The planner failed, or its plan cannot be run.
    PlanFailed {
        /// The reason, as a sentence.
        why: String,
    },
    /// The plan that is ready is not the one that the start order names, or the order names no plan.
    OtherPlan {
        /// The plan that was seen.
        seen: Option<PlanId>,
        /// The plan that is ready.
        ready: PlanId,
    },
    /// The plan begins too far from the robot.
    PlanElsewhere {
        /// Distance from the robot to the beginning of the plan, metres.
        away_m: f64,
    },
    /// The mission is running.
    AlreadyMoving,
    /// A single step is possible only while the robot is held.
    StepNeedsHold,
    /// The robot can be ordered to drive back only while it is held.
    BackNeedsHold,
    /// The robot is driving back.
    DrivingBack,
    /// The planner can be changed only while the robot is held.
    SwapNeedsHold,
    /// The parameter cannot be changed while the mission runs.
    NotLive {
        /// Key of the parameter.
        key: String,
    },
    /// The position error is beyond the limit, or there are no more fixes.
    PositionLost {
        /// The limit on the 95 % error, metres.
        limit_m: f64,
    },
    /// The ranges contradict each other.
    RangesInconsistent,
    /// The vehicle cannot be driven.
    Vehicle {
        /// The reason, as a clause.
        why: String,
    },
    /// A survey uses no planner.
    NoPlannerInSurvey,
    /// A real vehicle cannot be stepped by ticks.
    StepOfVehicle,
    /// Faults can be injected only into a simulation.
    FaultOfVehicle,
    /// No plan has been refused because of the tether.
    NoPlanRefused,
    /// No better plan is offered.
    NoOffer,
    /// The better plan has already been accepted.
    OfferAccepted,
    /// No planner runs in shadow.
    NoShadow,
    /// The planner in shadow has not made a plan yet.
    ShadowHasNoPlan,
    /// The planner in shadow has not answered enough steps in a row yet.
    ShadowNotReady {
        /// Number of steps that it has answered in a row.
        in_row: u64,
    },
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ended(outcome) => write!(f, "the mission has ended ({})", outcome.word()),
            Self::NotStarted => f.write_str("the mission has not been started"),
            Self::AlreadyStarted => f.write_str("the mission has already been started"),
            Self::Planning => f.write_str("the plan is not ready yet; start when it is"),
            Self::NoPlan => f.write_str("there is no plan to start with; make one first"),
            Self::PlanFailed { why } => write!(f, "no plan can be run: {why}"),
            Self::OtherPlan { seen: None, ready } => {
                write!(f, "a start must name the plan that was seen; plan {} is ready", ready.short())
            }
            Self::OtherPlan { seen: Some(seen), ready } => write!(
                f,
                "plan {} was seen, but plan {} is ready now; check it and start again",
                seen.short(),
                ready.short()
            ),
            Self::PlanElsewhere { away_m } => write!(
                f,
                "the plan begins {away_m:.2} m from the robot (at most {NEAR_PLAN_M} m is allowed); plan again from here"
            ),
            Self::AlreadyMoving => f.write_str("the mission is already running"),
            Self::StepNeedsHold => f.write_str("a single step requires HOLD first"),
            Self::BackNeedsHold => f.write_str("driving back requires HOLD first"),
            Self::DrivingBack => f.write_str("the robot is driving back; HOLD first"),
            Self::SwapNeedsHold => f.write_str("changing the planner requires HOLD first"),
            Self::NotLive { key } => {
                write!(f, "parameter `{key}` cannot be changed while the mission is running; HOLD first")
            }
            Self::PositionLost { limit_m } => {
                write!(f, "the position is lost (95 % error limit {limit_m:.2} m); resuming requires a fix")
            }
            Self::RangesInconsistent => {
                f.write_str("the ranges contradict each other; resuming requires a consistent fix")
            }
            Self::Vehicle { why } => write!(f, "the vehicle cannot be driven: {why}"),
            Self::NoPlannerInSurvey => f.write_str("a survey drives without a planner; start it as it is"),
            Self::StepOfVehicle => f.write_str(
                "a real vehicle cannot be stepped by ticks, because its time does not stop; step to the end of the lane \
                 or to the next event",
            ),
            Self::FaultOfVehicle => f.write_str("faults can be injected only into a simulation"),
            Self::NoPlanRefused => f.write_str("no plan has been refused because of the tether"),
            Self::NoOffer => f.write_str("no better plan is offered"),
            Self::OfferAccepted => {
                f.write_str("the better plan has been accepted; the robot changes over where that plan begins")
            }
            Self::NoShadow => f.write_str("no planner runs in shadow"),
            Self::ShadowHasNoPlan => f.write_str("the planner in shadow has not made a plan yet"),
            Self::ShadowNotReady { in_row } => write!(
                f,
                "the planner in shadow has answered {in_row} steps in a row; taking over requires {READY_AFTER}"
            ),
        }
    }
}

impl Standing<'_> {
    /// Whether an order is accepted now.
    ///
    /// [`Order::Hold`] is accepted while the mission runs, and during every hold.
    ///
    /// # Errors
    /// The reason why the order is refused.
    pub fn allows(&self, order: &Order) -> Result<(), Refusal> {
        match (order, self.phase) {
            (_, Phase::Ended(outcome)) => Err(Refusal::Ended(*outcome)),
            (
                Order::Plan
                | Order::ChoosePlanner(_)
                | Order::SetParameter { .. }
                | Order::CheckPlanner
                | Order::Shadow(_),
                _,
            ) if self.is_survey => Err(Refusal::NoPlannerInSurvey),
            (Order::Step, _) if self.is_live => Err(Refusal::StepOfVehicle),
            (Order::Inject(_), _) if self.is_live => Err(Refusal::FaultOfVehicle),
            (Order::Shadow(_) | Order::SetParameter { .. }, Phase::Running(Gait::Back)) => {
                Err(Refusal::DrivingBack)
            }
            (
                Order::Abort
                | Order::Terminate
                | Order::UseStation { .. }
                | Order::DrawZone(_)
                | Order::Note(_),
                _,
            )
            | (Order::Plan | Order::NoteChecks(_), Phase::Waiting)
            | (Order::Hold | Order::Inject(_) | Order::Shadow(_), Phase::Running(_) | Phase::Held(_))
            | (Order::NoteOutlooks(_), Phase::Held(_))
            | (
                Order::CheckPlanner | Order::ChoosePlanner(_) | Order::SetParameter { .. },
                Phase::Waiting | Phase::Held(_),
            ) => Ok(()),
            (Order::Start, Phase::Waiting) => self.can_start(None),
            (Order::StartPlan(seen), Phase::Waiting) => self.can_start(Some(*seen)),
            (
                Order::Plan | Order::Start | Order::StartPlan(_) | Order::NoteChecks(_),
                Phase::Running(_) | Phase::Held(_),
            ) => Err(Refusal::AlreadyStarted),
            (
                Order::Hold
                | Order::Resume
                | Order::Step
                | Order::StepTo(_)
                | Order::DriveBack
                | Order::NoteOutlooks(_)
                | Order::Inject(_)
                | Order::Shadow(_)
                | Order::Promote
                | Order::DropShadow
                | Order::TakePlan,
                Phase::Waiting,
            ) => Err(Refusal::NotStarted),
            (Order::Resume | Order::Step | Order::StepTo(_) | Order::DriveBack, Phase::Held(_))
            | (Order::FlyUncertified, Phase::Held(Hold { by: HoldReason::PlanRefused { .. }, .. })) => {
                self.can_move()
            }
            (Order::Resume | Order::NoteOutlooks(_) | Order::CheckPlanner, Phase::Running(_)) => {
                Err(Refusal::AlreadyMoving)
            }
            (Order::Step | Order::StepTo(_), Phase::Running(_)) => Err(Refusal::StepNeedsHold),
            (Order::DriveBack, Phase::Running(Gait::Back)) => Err(Refusal::DrivingBack),
            (Order::DriveBack, Phase::Running(_)) => Err(Refusal::BackNeedsHold),
            (Order::Promote, _) => self.can_promote(),
            (Order::DropShadow, _) => self.shadow.map(|_| ()).ok_or(Refusal::NoShadow),
            (Order::TakePlan, _) => match self.offer {
                Some(OfferStage::Offered) => Ok(()),
                Some(OfferStage::Accepted) => Err(Refusal::OfferAccepted),
                None => Err(Refusal::NoOffer),
            },
            (Order::FlyUncertified, _) => Err(Refusal::NoPlanRefused),
            (Order::ChoosePlanner(_), Phase::Running(_)) => Err(Refusal::SwapNeedsHold),
            (Order::SetParameter { key, .. }, Phase::Running(_)) => {
                if self.is_live(key) {
                    Ok(())
                } else {
                    Err(Refusal::NotLive { key: key.clone() })
                }
            }
        }
    }

    /// Checks that a start order names the plan that is ready.
    fn can_start(&self, seen: Option<PlanId>) -> Result<(), Refusal> {
        self.can_drive()?;
        match self.readiness {
            Readiness::Unseen => {}
            Readiness::NoPlan => return Err(Refusal::NoPlan),
            Readiness::Preparing => return Err(Refusal::Planning),
            Readiness::Failed(why) => return Err(Refusal::PlanFailed { why: why.to_owned() }),
            Readiness::Plan(ready) if seen == Some(ready) => {}
            Readiness::Plan(ready) => return Err(Refusal::OtherPlan { seen, ready }),
        }
        match self.from_plan_m.filter(|away_m| *away_m > NEAR_PLAN_M) {
            Some(away_m) => Err(Refusal::PlanElsewhere { away_m }),
            None => Ok(()),
        }
    }

    fn can_drive(&self) -> Result<(), Refusal> {
        self.trouble.map_or(Ok(()), |why| Err(Refusal::Vehicle { why: why.to_owned() }))
    }

    fn can_move(&self) -> Result<(), Refusal> {
        self.can_drive()?;
        match self.position {
            PositionTrust::Good => Ok(()),
            PositionTrust::Lost { limit_m } => Err(Refusal::PositionLost { limit_m }),
            PositionTrust::Alarmed => Err(Refusal::RangesInconsistent),
        }
    }

    /// The plan of the promoted planner is certified from the robot's position. While the robot is held, no steps are
    /// requested, and a change of planner moves nothing. It is then enough that the planner in shadow has a plan, as
    /// for any other change of planner.
    fn can_promote(&self) -> Result<(), Refusal> {
        match self.shadow {
            None => Err(Refusal::NoShadow),
            Some(InShadow { has_planned, .. }) if matches!(self.phase, Phase::Held(_)) => {
                if has_planned {
                    self.can_move()
                } else {
                    Err(Refusal::ShadowHasNoPlan)
                }
            }
            Some(InShadow { tally, .. }) if !tally.is_ready() => {
                Err(Refusal::ShadowNotReady { in_row: tally.in_row })
            }
            Some(_) => self.can_move(),
        }
    }

    fn is_live(&self, key: &str) -> bool {
        self.planner.is_some_and(|info| info.has_live(key))
    }
}

#[cfg(test)]
mod tests;
