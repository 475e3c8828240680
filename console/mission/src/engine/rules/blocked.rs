//! A planner that cannot continue along its lanes is asked for new ones from the robot's position. This happens after a
//! delay, because the robot may first have to turn, or to see the obstacle better.

use super::seen::Verdict;
use planner_api::{Reason, Status};
use world::Point;

/// Time, seconds, after which a planner that cannot continue along its lanes is asked for new ones.
const BLOCKED_S: f64 = 1.0;
/// Maximum number of new plans at one place.
const MOST_PLANS: usize = 4;
/// Distance, metres, from which a blocked robot counts as blocked at a new place.
const MOVED_ON_M: f64 = 0.3;

/// How long a planner has been reporting that it cannot continue, and where.
#[derive(Clone, Debug, Default)]
pub(in crate::engine) struct BlockedRule {
    blocked_s: f64,
    /// The place where the planner last reported that it cannot continue, and the number of plans requested there.
    at: Option<(Point, usize)>,
    /// How long the planner has been reporting that it cannot continue while the hull is in a no-go zone, seconds.
    in_zone_s: f64,
}

impl BlockedRule {
    /// Processes one command per tick; `in_lanes` states whether the planner follows lanes, `in_zone` whether the hull is
    /// in a no-go zone. No new plan leads out of a zone, because each begins in it.
    pub(crate) fn update(
        &mut self,
        status: Status,
        here: Point,
        (in_lanes, in_zone): (bool, bool),
        tick_s: f64,
    ) -> Option<Verdict> {
        let is_stuck = status == Status::Stuck;
        self.in_zone_s = if is_stuck && in_zone { self.in_zone_s + tick_s } else { 0.0 };
        self.blocked_s = if is_stuck && !in_zone { self.blocked_s + tick_s } else { 0.0 };
        if self.blocked_s < BLOCKED_S || !in_lanes {
            return None;
        }
        self.blocked_s = 0.0;
        let (at, times) = self.at.filter(|(at, _)| (here - at).norm() < MOVED_ON_M).unwrap_or((here, 0));
        self.at = Some((at, times + 1));
        // More plans that begin at the same obstacle do not help: the rule for a stuck robot takes over.
        (times < MOST_PLANS).then_some(Verdict::Replan(Reason::Blocked))
    }

    /// Whether the planner finds no way out of a no-go zone.
    pub(crate) fn is_shut_in(&self) -> bool {
        self.in_zone_s >= BLOCKED_S
    }

    /// Forgets that the planner found no way out of a zone, because the robot is held.
    pub(crate) fn stand(&mut self) {
        self.in_zone_s = 0.0;
    }
}
