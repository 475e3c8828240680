//! The rules that hold the robot, let it move again, ask for another plan, or end the mission.
//!
//! Each rule is a type with its own state and an `update` that sees one tick and says what follows from it, if anything.
//! Nothing else changes a rule's state, and no rule changes anything but its own.

mod blocked;
mod cuts;
mod fallback;
mod late_planner;
mod lost_position;
mod stuck;
mod tether;
mod time_limit;

pub(super) use blocked::BlockedRule;
pub(super) use cuts::{CutsRule, HOME_M};
pub(super) use fallback::FallbackRule;
pub(super) use late_planner::LatePlannerRule;
pub(super) use lost_position::LostPositionRule;
pub(super) use stuck::StuckRule;
pub(super) use tether::TetherRule;
pub(super) use time_limit::TimeLimitRule;

use crate::{
    config::MissionConfig,
    event::Outcome,
    standing::{Hold, PositionTrust},
    task::Task,
};
use planner_api::Reason;
use world::Point;

/// A robot that is stopped again within this distance is stopped in the same place, metres.
const SAME_PLACE_M: f64 = 1.0;

/// What the rules see of a tick.
pub(super) struct Seen<'a> {
    pub config: &'a MissionConfig,
    /// Mission time at the top of the tick, seconds.
    pub now_s: f64,
    /// Estimated position.
    pub here: Point,
    pub position: PositionTrust,
    pub task: &'a Task,
    /// Scanned share of the reachable floor, 0 to 1.
    pub scanned: f64,
}

impl Seen<'_> {
    fn is_position_good(&self) -> bool {
        self.position == PositionTrust::Good
    }
}

/// What follows from a rule.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Verdict {
    /// The robot is held.
    Hold(Hold),
    /// The robot is held, and its way is planned again from there.
    HoldAndReplan(Hold),
    /// The robot moves on.
    Resume,
    /// The way is planned again.
    Replan(Reason),
    /// The mission is over.
    End(Outcome, String),
}

/// The rules that do not depend on which planner drives.
pub(super) struct Rules {
    pub time_limit: TimeLimitRule,
    pub lost_position: LostPositionRule,
    pub stuck: StuckRule,
    pub tether: TetherRule,
    pub fallback: FallbackRule,
}

impl Rules {
    /// The rules at the start of a mission.
    pub fn new(config: &MissionConfig) -> Self {
        Self {
            time_limit: TimeLimitRule::default(),
            lost_position: LostPositionRule::default(),
            stuck: StuckRule::new(config.stuck_s),
            tether: TetherRule::default(),
            fallback: FallbackRule::default(),
        }
    }

    /// The robot is to move again: what was counted before says nothing about what follows.
    pub fn restart(&mut self) {
        self.lost_position = LostPositionRule::default();
        self.stuck.restart();
    }
}
