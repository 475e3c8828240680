//! The inputs and the verdicts of rules.

use crate::{
    config::MissionConfig,
    event::TetherAlarm,
    phase::{Hold, Outcome},
    standing::PositionTrust,
    task::Task,
    tether::Clearance,
};
use planner_api::Reason;
use world::Point;

/// Distance from the previous stop, metres, within which the robot counts as stopped at the same place again.
pub(super) const SAME_PLACE_M: f64 = 1.0;

/// The inputs of the rules in one tick.
#[expect(clippy::struct_excessive_bools, reason = "each is an observation of its own")]
pub(in crate::engine) struct Seen<'a> {
    pub config: &'a MissionConfig,
    /// Mission time at the top of the tick, seconds.
    pub now_s: f64,
    /// Estimated position.
    pub here: Point,
    pub position: PositionTrust,
    pub task: &'a Task,
    /// Remaining length of the planner's path or of the way back, metres, if there is one.
    pub plan_left_m: Option<f64>,
    /// Whether the robot has reached the end of the way back.
    pub is_back: bool,
    /// Whether the task is done, or the robot is back, and the last pulses are awaited.
    pub is_finishing: bool,
    /// The no-go zone that the hull entered in this tick, if any.
    pub breached: Option<&'a str>,
    /// A no-go zone that the hull is in, if any.
    pub in_zone: Option<&'a str>,
    /// Scanned share of the reachable floor, 0 to 1.
    pub scanned: f64,
    /// Whether the bumper was touched.
    pub touched: bool,
    /// The tether limit that was reached in this tick, if any.
    pub reached: Option<&'a TetherAlarm>,
    /// What the tether on the floor beside which the robot drives back means for it; `None` if it drives back beside none.
    pub beside: Option<Clearance>,
    /// Cable beyond the taut line, metres, that a stopped reel has left on the floor, if the robot would come near it before it
    /// could stop.
    pub left_ahead_m: Option<f64>,
    /// Whether the mission may begin a plan with a return path along the tether.
    pub can_replan: bool,
    /// Whether the hull fits through the return path along the tether.
    pub can_go_home: bool,
    pub planner: PlannerSeen<'a>,
}

/// The active planner as the rules see it.
pub(in crate::engine) struct PlannerSeen<'a> {
    pub id: &'a str,
    /// Whether the robot stands still because a plan is being made.
    pub is_waited_for: bool,
    /// Whether the planner owes an answer.
    pub owes: bool,
    /// How long the planner has owed an answer that a moving robot needs, seconds.
    pub owed_s: Option<f64>,
    /// Whether the planner finds no way out of a no-go zone.
    pub is_shut_in: bool,
}

impl Seen<'_> {
    pub(super) fn is_position_good(&self) -> bool {
        self.position == PositionTrust::Good
    }
}

/// The decision of a rule.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::engine) enum Verdict {
    /// Hold the robot.
    Hold(Hold),
    /// Hold the robot and plan again from its position.
    HoldAndReplan(Hold),
    /// Let the robot move again.
    Resume,
    /// Plan again.
    Replan(Reason),
    /// The task is done.
    Done,
    /// The robot is back, as ordered.
    Back,
    /// The mission is over.
    End(Outcome, String),
}
