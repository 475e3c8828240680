//! One way of a survey, and how the robot follows it.

use super::super::known::Known;
use crate::{event::SurveyGoal, task::CornerPatience};
use geometry::{Braking, PathFollower};
use planner_api::Command;
use world::Point;

/// Distance from the end of a way within which the robot counts as there, metres.
const THERE_M: f64 = 0.1;
/// Least time for a way, seconds: a place beside the robot must be scanned more than once before it counts as reached.
const LOOK_S: f64 = 1.5;
/// Speed at corners and at the end of a way, metres per second.
const SLOW_M_PER_S: f64 = 0.05;

/// A way that a survey takes.
#[derive(Clone)]
pub(super) struct Leg {
    pub to: SurveyGoal,
    pub goal: Point,
    /// Mission time at which the way was chosen, seconds.
    begun_s: f64,
    follower: PathFollower,
    at_corner: CornerPatience,
}

impl Leg {
    pub(super) fn along((to, goal): (SurveyGoal, Point), way: &[Point], begun_s: f64) -> Self {
        Self { to, goal, begun_s, follower: PathFollower::exact(way), at_corner: CornerPatience::default() }
    }

    /// Remaining length, metres.
    pub(super) fn left_m(&self, here: Point) -> f64 {
        self.follower.left_m(here)
    }

    /// Whether the robot has reached the end, and scans have been made on the way or there.
    pub(super) fn is_done(&self, here: Point, now_s: f64) -> bool {
        self.follower.is_done(here, THERE_M) && now_s - self.begun_s >= LOOK_S
    }

    /// The rest of the way.
    pub(super) fn remaining(&self) -> &[Point] {
        self.follower.remaining()
    }
}

impl Known {
    /// Advances along the way of a survey; the command for this tick, in the form in which the robot receives it.
    pub(super) fn command_of_survey(&mut self) -> Option<Command> {
        self.keep_trail();
        let (here, passed_s) = (self.place_on_map(), self.config.tick_s * self.briskness());
        let (leg, map) = (self.survey.as_mut()?.leg.as_mut()?, self.chart.map());
        leg.follower.advance(here, |at| map.clearance_m(at) >= 0.0);
        leg.at_corner.wait(&mut leg.follower, here, passed_s);
        let onward = leg.follower.target() - here;
        let braking = Braking::of(&self.config.limits);
        let before = |way_m: f64| braking.speed_before(way_m, SLOW_M_PER_S);
        let to_corner = leg.follower.corner_m(here).map_or(f64::INFINITY, before);
        let speed =
            before(leg.follower.left_m(here) - THERE_M).min(to_corner).min(self.config.limits.v_max_m_per_s);
        let velocity = onward.try_normalize(1e-9).map_or(onward, |direction| direction * speed);
        Some(self.sending().as_sent(Command::velocity(velocity)))
    }
}
