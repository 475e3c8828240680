//! Which orders a mission accepts now.
//!
//! There is one table, [`Standing::allows`]. The mission asks it for every order; the screen asks the same table to say
//! which keys do something and why the others do not. It has no state and changes none.

mod folded;

pub use folded::FoldedStanding;

use crate::{
    event::{READY_AFTER, ShadowTally},
    order::Order,
    phase::{Hold, HoldReason, Outcome, Phase},
    planner::PlannerInfo,
};
use serde::{Deserialize, Serialize};
use std::fmt;

/// How far the position can be relied on.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub enum PositionTrust {
    /// Within the limit.
    #[default]
    Good,
    /// Its error is beyond the limit, or there are no fixes any more.
    Lost {
        /// The limit of the 95 % error, metres.
        limit_m: f64,
    },
    /// The ranges contradict each other.
    Alarmed,
}

/// Everything that decides whether an order is accepted. The mission and the screen both can compute it.
#[derive(Debug, Clone, Copy)]
pub struct Standing<'a> {
    /// What the mission is doing.
    pub phase: &'a Phase,
    /// How far the position can be relied on.
    pub position: PositionTrust,
    /// The planner that was opened last to drive.
    pub planner: Option<&'a PlannerInfo>,
    /// How the planner in shadow does; `None` without one.
    pub shadow: Option<ShadowTally>,
    /// Whether a better plan is offered and not taken yet.
    pub has_offer: bool,
}

/// Why an order is not accepted.
#[derive(Debug, Clone, PartialEq)]
pub enum Refusal {
    /// The mission is over.
    Ended(Outcome),
    /// The mission has not been started.
    NotStarted,
    /// The mission has been started before.
    AlreadyStarted,
    /// The mission is running.
    AlreadyMoving,
    /// A single step needs a robot that is held.
    StepNeedsHold,
    /// Another planner needs a robot that is held.
    SwapNeedsHold,
    /// The parameter cannot change while the mission runs.
    NotLive {
        /// Which parameter.
        key: String,
    },
    /// The position error is beyond the limit, or there are no fixes any more.
    PositionLost {
        /// The limit of the 95 % error, metres.
        limit_m: f64,
    },
    /// The ranges contradict each other.
    RangesInconsistent,
    /// No plan has been refused because of the tether.
    NoPlanRefused,
    /// No better plan is offered.
    NoOffer,
    /// No planner flies in shadow.
    NoShadow,
    /// The planner in shadow has not proven itself yet.
    ShadowNotReady {
        /// Steps that it has answered in a row.
        in_row: u64,
    },
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ended(outcome) => write!(f, "the mission has ended ({})", outcome.word()),
            Self::NotStarted => f.write_str("the mission has not been started"),
            Self::AlreadyStarted => f.write_str("the mission has already been started"),
            Self::AlreadyMoving => f.write_str("the mission is already running"),
            Self::StepNeedsHold => f.write_str("a single step requires HOLD first"),
            Self::SwapNeedsHold => f.write_str("changing the planner requires HOLD first"),
            Self::NotLive { key } => {
                write!(f, "parameter `{key}` cannot be changed while running; HOLD first")
            }
            Self::PositionLost { limit_m } => {
                write!(f, "the position is lost (95 % error limit {limit_m:.2} m); resuming requires a fix")
            }
            Self::RangesInconsistent => {
                f.write_str("the ranges contradict each other; resuming requires a consistent fix")
            }
            Self::NoPlanRefused => f.write_str("no plan has been refused because of the tether"),
            Self::NoOffer => f.write_str("no better plan is offered"),
            Self::NoShadow => f.write_str("no planner flies in shadow"),
            Self::ShadowNotReady { in_row } => write!(
                f,
                "the planner in shadow has answered {in_row} steps in a row, taking over requires {READY_AFTER}"
            ),
        }
    }
}

impl Standing<'_> {
    /// Whether an order is accepted now.
    ///
    /// [`Order::Hold`] is accepted whenever there is anything to hold: while the mission runs, and under every hold.
    ///
    /// # Errors
    /// Why it is not.
    pub fn allows(&self, order: &Order) -> Result<(), Refusal> {
        match (order, self.phase) {
            (_, Phase::Ended(outcome)) => Err(Refusal::Ended(*outcome)),
            (Order::Abort | Order::Terminate | Order::UseStation { .. } | Order::DrawZone(_), _)
            | (Order::Plan | Order::Start | Order::NoteChecks(_), Phase::Waiting)
            | (Order::Hold | Order::Inject(_) | Order::Shadow(_), Phase::Running(_) | Phase::Held(_))
            | (Order::NoteOutlooks(_), Phase::Held(_))
            | (Order::ChoosePlanner(_) | Order::SetParameter { .. }, Phase::Waiting | Phase::Held(_)) => {
                Ok(())
            }
            (Order::Plan | Order::Start | Order::NoteChecks(_), Phase::Running(_) | Phase::Held(_)) => {
                Err(Refusal::AlreadyStarted)
            }
            (
                Order::Hold
                | Order::Resume
                | Order::Step
                | Order::StepTo(_)
                | Order::NoteOutlooks(_)
                | Order::Inject(_)
                | Order::Shadow(_)
                | Order::Promote
                | Order::DropShadow
                | Order::TakePlan,
                Phase::Waiting,
            ) => Err(Refusal::NotStarted),
            (Order::Resume | Order::Step | Order::StepTo(_), Phase::Held(_)) => self.can_move(),
            (Order::Resume | Order::NoteOutlooks(_), Phase::Running(_)) => Err(Refusal::AlreadyMoving),
            (Order::Step | Order::StepTo(_), Phase::Running(_)) => Err(Refusal::StepNeedsHold),
            (Order::FlyUncertified, Phase::Held(Hold { by: HoldReason::PlanRefused { .. }, .. })) => {
                self.can_move()
            }
            (Order::Promote, _) => self.can_promote(),
            (Order::DropShadow, _) => self.shadow.map(|_| ()).ok_or(Refusal::NoShadow),
            (Order::TakePlan, _) => self.has_offer.then_some(()).ok_or(Refusal::NoOffer),
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

    fn can_move(&self) -> Result<(), Refusal> {
        match self.position {
            PositionTrust::Good => Ok(()),
            PositionTrust::Lost { limit_m } => Err(Refusal::PositionLost { limit_m }),
            PositionTrust::Alarmed => Err(Refusal::RangesInconsistent),
        }
    }

    /// The plan of the planner that takes over is certified from where the robot is.
    fn can_promote(&self) -> Result<(), Refusal> {
        match self.shadow {
            None => Err(Refusal::NoShadow),
            Some(ShadowTally { in_row, .. }) if in_row < READY_AFTER => {
                Err(Refusal::ShadowNotReady { in_row })
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
