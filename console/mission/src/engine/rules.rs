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
use fallback::FallbackRule;
pub(super) use late_planner::LatePlannerRule;
use lost_position::LostPositionRule;
use stuck::StuckRule;
use tether::TetherRule;
use time_limit::TimeLimitRule;

use crate::{
    config::MissionConfig,
    event::{HoldReason, Outcome, TetherAlarm},
    standing::{Hold, Phase, PositionTrust, Resumes},
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
    /// Whether the bumper touched something.
    pub touched: bool,
    /// The limit that the tether has reached in this tick.
    pub reached: Option<&'a TetherAlarm>,
    /// Whether the mission puts ways home along the tether before plans.
    pub can_replan: bool,
    /// Whether the hull fits back along the tether.
    pub can_go_home: bool,
    pub planner: PlannerSeen<'a>,
}

/// What the rules see of the active planner.
pub(super) struct PlannerSeen<'a> {
    pub id: &'a str,
    /// Whether the robot stands because a plan is being made.
    pub is_waited_for: bool,
    /// Whether an answer is owed.
    pub owes: bool,
    /// For how long an answer that a moving robot needs has been owed, seconds.
    pub owed_s: Option<f64>,
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
    /// The task is done.
    Done,
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
    pub(super) fn new(config: &MissionConfig) -> Self {
        Self {
            time_limit: TimeLimitRule::default(),
            lost_position: LostPositionRule::default(),
            stuck: StuckRule::new(config.stuck_s),
            tether: TetherRule::default(),
            fallback: FallbackRule::default(),
        }
    }

    /// One tick of a mission under way; the first rule that has something to say wins.
    pub(super) fn update(&mut self, seen: &Seen<'_>, phase: &Phase) -> Option<Verdict> {
        let time_is_up = self.time_limit.update(seen, matches!(phase, Phase::Held(_)));
        if seen.touched {
            return Some(Verdict::End(Outcome::Collision, "the bumper touched something".into()));
        }
        match phase {
            _ if time_is_up.is_some() => time_is_up,
            Phase::Running(_) => self.update_running(seen),
            Phase::Held(hold) => self.update_held(seen, hold),
            Phase::Waiting | Phase::Ended(_) => None,
        }
    }

    fn update_running(&mut self, seen: &Seen<'_>) -> Option<Verdict> {
        let Self { lost_position, tether, stuck, .. } = self;
        lost_position
            .update(seen)
            .or_else(|| seen.task.is_done(seen.here).then_some(Verdict::Done))
            .or_else(|| seen.reached.map(|alarm| tether.update(seen, alarm)))
            .or_else(|| LatePlannerRule::update(&seen.planner))
            .or_else(|| if seen.planner.is_waited_for { None } else { stuck.update(seen) })
    }

    /// What lets a robot move again that is held until something has cleared.
    fn update_held(&mut self, seen: &Seen<'_>, hold: &Hold) -> Option<Verdict> {
        if hold.resumes != Resumes::WhenCleared {
            return None;
        }
        match hold.by {
            HoldReason::PositionLost | HoldReason::RangesInconsistent => LostPositionRule::update_held(seen),
            HoldReason::Tether { .. } => self.tether.update_held(seen),
            HoldReason::PlannerSilent { .. } => (!seen.planner.owes).then_some(Verdict::Resume),
            _ => None,
        }
    }

    /// The robot is to move again: what was counted before says nothing about what follows.
    pub(super) fn restart(&mut self) {
        self.lost_position = LostPositionRule::default();
        self.stuck.restart();
    }
}
