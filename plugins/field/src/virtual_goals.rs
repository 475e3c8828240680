//! The improved field of Yang et al. 2021: virtual goals on a square around the goal, and a pull that does not fade.
//!
//! In the printed formulas, signs and roots are missing. This module implements attraction towards the goal, repulsion
//! away from obstacles, a constant pull `k d_0` near the goal, and a score for virtual goals that avoids the blocked
//! direction.

use crate::{
    goal_law::{GoalLaw, TangentUse},
    laws::PushForm,
    pull::Pull,
};
use geometry::{Point, Vector};
use std::collections::VecDeque;
use steering::KnownMap;

/// Share of the attraction gain below which a force counts as zero (eq. 17 says "= 0", which discrete steps never
/// meet).
const ZERO_SHARE: f64 = 0.5;
/// Number of steps over which the robot's displacement is measured.
const STALL_STEPS: usize = 6;
/// Displacement, in steps, below which the robot counts as stalled.
const STALL_SHARE: f64 = 1.5;
/// Distance from a virtual goal, in steps, within which that virtual goal counts as reached.
const REACHED_STEPS: f64 = 2.0;
/// Maximum number of steps for which a virtual goal is kept.
pub const HOLD_STEPS: usize = 30;

/// Gains and ranges (Table 2 of the paper).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SquareLaw {
    /// Attraction gain.
    pub k_att: f64,
    /// Range of the goal, metres: within it, the pull is constant and no virtual goal is used.
    pub d_0_m: f64,
    /// Distance of the virtual goals from the goal, metres; the paper gives no value.
    pub square_m: f64,
    /// Whether virtual goals and the constant pull are used. Without them, the field is the classical one.
    pub improved: bool,
    /// Maximum number of steps for which a virtual goal is kept.
    pub hold_steps: usize,
}

/// The virtual goal in use, and the robot's recent steps.
#[derive(Debug, Clone, Default)]
pub struct VirtualGoals {
    current: Option<Point>,
    held: usize,
    recent: VecDeque<Point>,
    /// Number of virtual goals used so far.
    pub used: u32,
}

impl SquareLaw {
    /// The pull on a robot (eq. 17): towards the virtual goal if there is one, otherwise towards the goal; constant
    /// near the goal.
    pub fn attraction(&self, at: Point, goal: Point, virtual_goal: Option<Point>) -> Vector {
        let way = goal - at;
        let near = self.improved && way.norm() < self.d_0_m;
        match virtual_goal {
            _ if near => way.try_normalize(1e-12).unwrap_or_else(Vector::zeros) * (self.k_att * self.d_0_m),
            Some(corner) => (corner - at) * self.k_att,
            None => way * self.k_att,
        }
    }

    /// The push from obstacles and wall that belongs to this pull. The gain and ranges are those of [`GoalLaw`].
    pub fn push(&self, k_rep: f64, rho_m: f64, wall_gain: f64) -> GoalLaw {
        let pull = Pull::Capped { k: self.k_att, d_0_m: self.d_0_m };
        let push = PushForm::Khatib;
        GoalLaw { pull, k_rep, push, rho_m, tangent: TangentUse::Off, tangent_weight: 0.0, wall_gain }
    }

    /// The corners of the square around the goal, at 45, 135, 225 and 315 degrees.
    pub fn corners(&self, goal: Point) -> [Point; 4] {
        let half_m = self.square_m * std::f64::consts::FRAC_1_SQRT_2;
        [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]
            .map(|(x, y)| goal + Vector::new(x * half_m, y * half_m))
    }

    /// The corner farthest from the blocked direction (eq. 18 with its second vector reversed; as printed, the blocked
    /// direction itself scores best). `push` is the sum of all repulsion. If scores are equal, the first corner wins.
    pub fn best_corner(
        &self,
        at: Point,
        goal: Point,
        push: Vector,
        is_usable: impl Fn(Point) -> bool,
    ) -> Option<Point> {
        let score = |corner: &Point| push.angle(&(corner - at)).to_degrees();
        let usable = self.corners(goal).into_iter().filter(|corner| is_usable(*corner));
        usable
            .map(|corner| (180.0 - score(&corner), corner))
            .reduce(|best, next| if next.0 > best.0 + 1e-9 { next } else { best })
            .map(|(_, corner)| corner)
    }
}

impl VirtualGoals {
    /// Switches to the best free corner, if there is one. `push` is the sum of all repulsion.
    pub fn take_best(&mut self, law: &SquareLaw, at: Point, goal: Point, push: Vector, map: &KnownMap) {
        if let Some(corner) = law.best_corner(at, goal, push, |corner| map.clearance_m(corner) > 0.0) {
            self.take(corner);
        }
    }

    /// The virtual goal in use.
    pub fn current(&self) -> Option<Point> {
        self.current
    }

    /// Records the position of the next step. Returns whether the robot is in a local minimum and needs a virtual goal.
    /// `force` is the force without a virtual goal.
    pub fn needs_one(&mut self, law: &SquareLaw, at: Point, goal: Point, force: Vector, step_m: f64) -> bool {
        let stalled = self.record(at, step_m);
        if !law.improved || (goal - at).norm() < law.d_0_m {
            self.current = None;
            return false;
        }
        if let Some(corner) = self.current {
            self.held += 1;
            let is_reached = (corner - at).norm() <= REACHED_STEPS * step_m;
            if !is_reached && self.held < law.hold_steps {
                return false;
            }
            self.current = None;
        }
        force.norm() < ZERO_SHARE * law.k_att || stalled
    }

    /// Switches to a virtual goal.
    pub fn take(&mut self, corner: Point) {
        self.current = Some(corner);
        self.held = 0;
        self.used += 1;
        self.recent.clear();
    }

    /// Whether the recent steps made almost no headway.
    fn record(&mut self, at: Point, step_m: f64) -> bool {
        self.recent.push_back(at);
        if self.recent.len() <= STALL_STEPS {
            return false;
        }
        let first = self.recent.pop_front().expect("it holds more than one");
        (at - first).norm() < STALL_SHARE * step_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: SquareLaw =
        SquareLaw { k_att: 15.0, d_0_m: 3.0, square_m: 2.0, improved: true, hold_steps: HOLD_STEPS };
    const GOAL: Point = Point::new(10.0, 0.0);

    #[test]
    fn the_pull_is_continuous_at_its_range_and_does_not_fade() {
        let pull = |x: f64| LAW.attraction(Point::new(x, 0.0), GOAL, None).x;
        assert!((pull(7.0 - 1e-9) - pull(7.0 + 1e-9)).abs() < 1e-6);
        assert!((pull(9.99) - 45.0).abs() < 1e-9);
        let classic = SquareLaw { improved: false, ..LAW };
        assert!((classic.attraction(Point::new(9.0, 0.0), GOAL, None).x - 15.0).abs() < 1e-9);
    }

    #[test]
    fn before_a_wall_the_corner_most_to_the_side_wins_and_the_first_of_two() {
        let corner = LAW.best_corner(Point::origin(), GOAL, -Vector::x(), |_| true).expect("there are four");
        assert!((corner - Point::new(10.0 - 2.0_f64.sqrt(), 2.0_f64.sqrt())).norm() < 1e-9);
        let other = LAW.best_corner(Point::origin(), GOAL, -Vector::x(), |corner| corner.y < 0.0);
        assert!(other.is_some_and(|corner| corner.y < 0.0));
        assert_eq!(LAW.best_corner(Point::origin(), GOAL, -Vector::x(), |_| false), None);
    }

    #[test]
    fn a_robot_that_stands_still_needs_a_virtual_goal_for_a_while() {
        let mut goals = VirtualGoals::default();
        let force = Vector::new(100.0, 0.0);
        let needs: Vec<bool> =
            (0..8).map(|_| goals.needs_one(&LAW, Point::origin(), GOAL, force, 0.1)).collect();
        assert_eq!(needs.iter().position(|need| *need), Some(STALL_STEPS));
        goals.take(Point::new(8.0, 2.0));
        let kept = (0..100).take_while(|k| {
            let at = Point::new(f64::from(*k) * 0.05, 0.0);
            goals.needs_one(&LAW, at, GOAL, force, 0.1);
            goals.current().is_some()
        });
        assert_eq!(kept.count(), HOLD_STEPS - 1);
    }

    #[test]
    fn near_the_goal_none_is_used() {
        let mut goals = VirtualGoals::default();
        let at = Point::new(8.0, 0.0);
        assert!((0..20).all(|_| !goals.needs_one(&LAW, at, GOAL, Vector::zeros(), 0.1)));
    }
}
