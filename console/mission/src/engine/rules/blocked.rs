//! A planner that cannot go on along its lanes is asked for new ones from where the robot stands; not at once again, for
//! the robot may have to turn or to be seen better first.

use super::seen::Verdict;
use planner_api::{Reason, Status};
use world::Point;

/// A planner that has been stuck in its lanes for this long is asked for new ones, seconds.
const BLOCKED_S: f64 = 1.0;
/// So many plans are asked for in one place.
const MOST_PLANS: usize = 4;
/// A robot that is blocked further away than this is blocked in another place, metres.
const MOVED_ON_M: f64 = 0.3;

/// For how long a planner has said that it cannot go on, and where.
#[derive(Clone, Debug, Default)]
pub(in crate::engine) struct BlockedRule {
    blocked_s: f64,
    /// Where it said so last, and how often there.
    at: Option<(Point, usize)>,
}

impl BlockedRule {
    /// One command of a planner, a tick after the one before; `in_lanes` says whether it follows lanes.
    pub(crate) fn update(
        &mut self,
        status: Status,
        here: Point,
        in_lanes: bool,
        tick_s: f64,
    ) -> Option<Verdict> {
        self.blocked_s = if status == Status::Stuck { self.blocked_s + tick_s } else { 0.0 };
        if self.blocked_s < BLOCKED_S || !in_lanes {
            return None;
        }
        self.blocked_s = 0.0;
        let (at, times) = self.at.filter(|(at, _)| (here - at).norm() < MOVED_ON_M).unwrap_or((here, 0));
        self.at = Some((at, times + 1));
        // Plans that all begin with the same obstacle do not help: the rule for a robot that is stuck takes over.
        (times < MOST_PLANS).then_some(Verdict::Replan(Reason::Blocked))
    }
}
