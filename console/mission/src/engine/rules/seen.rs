//! What rules see of a tick, and what they say.

use crate::{
    config::MissionConfig,
    event::TetherAlarm,
    phase::{Hold, Outcome},
    standing::PositionTrust,
    task::Task,
};
use planner_api::Reason;
use world::Point;

/// A robot that is stopped again within this distance is stopped in the same place, metres.
pub(super) const SAME_PLACE_M: f64 = 1.0;

/// What the rules see of a tick.
pub(in crate::engine) struct Seen<'a> {
    pub config: &'a MissionConfig,
    /// Mission time at the top of the tick, seconds.
    pub now_s: f64,
    /// Estimated position.
    pub here: Point,
    pub position: PositionTrust,
    pub task: &'a Task,
    /// What is left of the planner's path, metres, if it gave one.
    pub plan_left_m: Option<f64>,
    /// Scanned share of the reachable floor, 0 to 1.
    pub scanned: f64,
    /// Whether the bumper touched something.
    pub touched: bool,
    /// The limit that the tether has reached in this tick.
    pub reached: Option<&'a TetherAlarm>,
    /// Whether the mission puts return paths along the tether before plans.
    pub can_replan: bool,
    /// Whether the hull fits back along the tether.
    pub can_go_home: bool,
    pub planner: PlannerSeen<'a>,
}

/// What the rules see of the active planner.
pub(in crate::engine) struct PlannerSeen<'a> {
    pub id: &'a str,
    /// Whether the robot stands because a plan is being made.
    pub is_waited_for: bool,
    /// Whether an answer is owed.
    pub owes: bool,
    /// For how long an answer that a moving robot needs has been owed, seconds.
    pub owed_s: Option<f64>,
}

impl Seen<'_> {
    pub(super) fn is_position_good(&self) -> bool {
        self.position == PositionTrust::Good
    }
}

/// What follows from a rule.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::engine) enum Verdict {
    /// The robot is held.
    Hold(Hold),
    /// The robot is held, and its way is planned again from there.
    HoldAndReplan(Hold),
    /// The robot moves on.
    Resume,
    /// The way is planned again.
    Replan(Reason),
    /// The task is done.
    Done,
    /// The mission is over.
    End(Outcome, String),
}
