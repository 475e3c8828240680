//! What the mission is doing, and which orders it accepts then.
//!
//! There is one table, [`Standing::allows`]. The mission asks it for every order; the screen asks the same table to say
//! which keys do something and why the others do not. It has no state and changes none.

use crate::{
    event::{EventKind, HoldReason, Outcome},
    order::Order,
    planner::PlannerInfo,
};
use serde::{Deserialize, Serialize};
use std::fmt;

/// What the mission is doing.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum Phase {
    /// Nothing has been started.
    #[default]
    Waiting,
    /// The robot moves, or will as soon as its planner is ready.
    Running(Gait),
    /// The robot stands still.
    Held(Hold),
    /// It is over.
    Ended(Outcome),
}

/// For how long a running robot moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Gait {
    /// Until something stops it.
    Steady,
    /// Until one command was sent.
    OneTick,
}

/// Why the robot stands still, and whether that may end without an order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hold {
    /// Why.
    pub by: HoldReason,
    /// Whether it ends by itself.
    pub resumes: Resumes,
}

/// Whether a hold ends by itself. Whatever it says, [`Order::Hold`] makes it end by an order only.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Resumes {
    /// Only an order lets the robot move again.
    #[default]
    Never,
    /// The robot moves again as soon as the cause is gone.
    WhenCleared,
    /// The robot moves again as soon as the fallback planner has a plan.
    ByFallback,
}

impl Resumes {
    /// Whether only an order ends the hold.
    pub fn is_never(&self) -> bool {
        *self == Self::Never
    }
}

impl Phase {
    /// Whether the robot moves, or may begin to move without an order.
    pub fn may_move(&self) -> bool {
        match self {
            Self::Running(_) => true,
            Self::Held(hold) => !hold.resumes.is_never(),
            Self::Waiting | Self::Ended(_) => false,
        }
    }
}

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
}

/// The standing of a mission as it follows from its events, for those who see nothing else of the mission.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FoldedStanding {
    /// What the mission is doing.
    pub phase: Phase,
    /// Whether the last order was for a single step.
    is_stepping: bool,
    /// The limit of the position error, metres, while the position counts as lost.
    lost: Option<f64>,
    /// Whether the ranges contradict each other.
    is_alarmed: bool,
    /// The planner that was opened last to drive.
    planner: Option<Box<PlannerInfo>>,
}

impl FoldedStanding {
    /// Takes in one event; they must come in the order of the journal.
    pub fn apply(&mut self, event: &EventKind) {
        match event {
            EventKind::RunOpened(_) => *self = Self::default(),
            EventKind::Ordered { order: Order::Start } => self.phase = Phase::Running(Gait::Steady),
            EventKind::Ordered { order } => self.is_stepping = *order == Order::Step,
            EventKind::Resumed => {
                let gait = if std::mem::take(&mut self.is_stepping) { Gait::OneTick } else { Gait::Steady };
                self.phase = Phase::Running(gait);
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
            _ => {}
        }
    }

    /// Everything that decides whether an order is accepted now.
    pub fn standing(&self) -> Standing<'_> {
        let position = match self.lost {
            Some(limit_m) => PositionTrust::Lost { limit_m },
            None if self.is_alarmed => PositionTrust::Alarmed,
            None => PositionTrust::Good,
        };
        Standing { phase: &self.phase, position, planner: self.planner.as_deref() }
    }
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
                write!(f, "parameter `{key}` cannot be changed while the mission is running; HOLD first")
            }
            Self::PositionLost { limit_m } => {
                write!(f, "the position is lost (95 % error limit {limit_m:.2} m); resuming requires a fix")
            }
            Self::RangesInconsistent => {
                f.write_str("the ranges contradict each other; cannot resume without a consistent fix")
            }
            Self::NoPlanRefused => f.write_str("no plan has been refused because of the tether"),
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
            (Order::Abort, _)
            | (Order::Start, Phase::Waiting)
            | (Order::Hold, Phase::Running(_) | Phase::Held(_))
            | (Order::ChoosePlanner(_) | Order::SetParameter { .. }, Phase::Waiting | Phase::Held(_)) => {
                Ok(())
            }
            (Order::Start, Phase::Running(_) | Phase::Held(_)) => Err(Refusal::AlreadyStarted),
            (Order::Hold | Order::Resume | Order::Step, Phase::Waiting) => Err(Refusal::NotStarted),
            (Order::Resume | Order::Step, Phase::Held(_)) => self.can_move(),
            (Order::Resume, Phase::Running(_)) => Err(Refusal::AlreadyMoving),
            (Order::Step, Phase::Running(_)) => Err(Refusal::StepNeedsHold),
            (Order::FlyUncertified, Phase::Held(Hold { by: HoldReason::PlanRefused { .. }, .. })) => {
                self.can_move()
            }
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

    fn is_live(&self, key: &str) -> bool {
        self.planner.is_some_and(|info| info.has_live(key))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PlannerChoice;
    use crate::planner::{ParamValue, Parameters};

    fn phases() -> Vec<Phase> {
        let held = HoldReason::every("m").into_iter().flat_map(|by| {
            [Resumes::Never, Resumes::WhenCleared, Resumes::ByFallback]
                .map(|resumes| Phase::Held(Hold { by: by.clone(), resumes }))
        });
        let others = [
            Phase::Waiting,
            Phase::Running(Gait::Steady),
            Phase::Running(Gait::OneTick),
            Phase::Ended(Outcome::Complete),
        ];
        others.into_iter().chain(held).collect()
    }

    fn orders() -> Vec<Order> {
        let choice = PlannerChoice { id: "apf".into(), parameters: Parameters::new() };
        vec![
            Order::Start,
            Order::Hold,
            Order::Resume,
            Order::Step,
            Order::FlyUncertified,
            Order::Abort,
            Order::ChoosePlanner(choice),
            Order::SetParameter { key: "gain".into(), value: ParamValue::Flag(true) },
        ]
    }

    fn standing(phase: &Phase, position: PositionTrust) -> Standing<'_> {
        Standing { phase, position, planner: None }
    }

    #[test]
    fn hold_and_abort_are_accepted_in_every_phase_that_has_anything_to_stop() {
        let lost = PositionTrust::Lost { limit_m: 0.3 };
        for position in [PositionTrust::Good, lost, PositionTrust::Alarmed] {
            for phase in phases() {
                let standing = standing(&phase, position);
                let under_way = matches!(phase, Phase::Running(_) | Phase::Held(_));
                assert_eq!(standing.allows(&Order::Hold).is_ok(), under_way, "{phase:?}");
                assert_eq!(standing.allows(&Order::Abort).is_ok(), !matches!(phase, Phase::Ended(_)));
                assert!(!phase.may_move() || standing.allows(&Order::Hold).is_ok(), "{phase:?}");
            }
        }
    }

    #[test]
    fn nothing_that_moves_the_robot_is_accepted_without_a_position() {
        let lost = PositionTrust::Lost { limit_m: 0.3 };
        for position in [lost, PositionTrust::Alarmed] {
            for phase in phases() {
                for order in [Order::Resume, Order::Step, Order::FlyUncertified] {
                    assert!(standing(&phase, position).allows(&order).is_err(), "{phase:?} {order:?}");
                }
            }
        }
    }

    #[test]
    fn the_whole_table() {
        let word = |text: &str| text.split(['(', ' ', '{']).next().unwrap_or_default().to_owned();
        let mut table = Vec::new();
        for phase in phases().iter().filter(|phase| !matches!(phase, Phase::Held(h) if !h.resumes.is_never()))
        {
            for order in orders() {
                let answer = match standing(phase, PositionTrust::Good).allows(&order) {
                    Ok(()) => "accepted".to_owned(),
                    Err(why) => why.to_string(),
                };
                let (order, phase) = (format!("{order:?}"), format!("{phase:?}"));
                let by = phase.split("by: ").nth(1).map(|by| format!(" {}", word(by))).unwrap_or_default();
                let (phase, by) = (word(&phase), by.trim_end_matches(','));
                table.push(format!("{phase}{by}: {}: {answer}", word(&order)));
            }
        }
        insta::assert_snapshot!(table.join("\n"));
    }
}
