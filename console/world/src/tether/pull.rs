//! The pull that moves a taut cable along itself, against the friction of the floor and of what the cable bears on.

use super::cable::Cable;
use crate::beside_limit;
use geometry::Point;
use serde::{Deserialize, Serialize};

/// Standard gravity, metres per second squared.
const GRAVITY_M_PER_S2: f64 = 9.806_65;
/// Largest pull that is computed, newtons; a cable that needs more is given this value, so that figures stay finite.
const MOST_N: f64 = 1e6;

/// The weight and friction of a cable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drag {
    /// Friction of the floor, newtons per metre of cable.
    pub floor_n_per_m: f64,
    /// Coefficient of friction on everything that the cable bears on.
    pub friction: f64,
}

/// A reel at the anchor, and the cable on it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Reel {
    /// Mass of the cable in its medium, kilograms per metre: what lies on the floor, less the buoyancy.
    pub mass_kg_per_m: f64,
    /// Coefficient of friction of the cable on the floor.
    pub floor_friction: f64,
    /// Pull with which the reel takes the cable up, newtons.
    pub pull_n: f64,
    /// Drag of the reel itself while it pays the cable out, newtons. The reel keeps its own pull as well: see
    /// [`Reel::paying_out_n`].
    pub pay_out_n: f64,
    /// Largest pull of the robot on its cable, newtons; `None` if it is not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub robot_pull_n: Option<f64>,
    /// Share of the reel's pull up to which a path is certified without a warning.
    pub pull_ratio_max: f64,
}

impl Reel {
    /// Returns the friction of the cable, with its coefficient on everything except the floor.
    pub fn drag(&self, friction: f64) -> Drag {
        Drag { floor_n_per_m: self.floor_friction * self.mass_kg_per_m * GRAVITY_M_PER_S2, friction }
    }

    /// Returns the pull up to which a path is certified without a warning, newtons.
    pub fn preferred_n(&self) -> f64 {
        self.pull_ratio_max * self.pull_n
    }

    /// Returns the pull that draws the cable off the reel, newtons: a reel that takes slack up keeps pulling while the robot
    /// drives away.
    pub fn paying_out_n(&self) -> f64 {
        self.pull_n.max(self.pay_out_n)
    }

    /// Returns the limits of a path, with the coefficient of friction of the cable on everything except the floor.
    pub fn limits(&self, friction: f64) -> PullLimits {
        PullLimits {
            drag: self.drag(friction),
            reel_n: self.pull_n,
            preferred_n: self.preferred_n(),
            pay_out_n: self.paying_out_n(),
            robot_n: self.robot_pull_n,
        }
    }
}

/// The limits of the pull that a path may need.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PullLimits {
    /// The weight and friction of the cable.
    pub drag: Drag,
    /// Pull of the reel, newtons; a path that needs more is refused.
    pub reel_n: f64,
    /// Pull above which a path is certified with a warning, newtons.
    pub preferred_n: f64,
    /// Pull that is needed at the reel to pay the cable out, newtons.
    pub pay_out_n: f64,
    /// Largest pull of the robot on its cable, newtons; `None` if it is not known.
    pub robot_n: Option<f64>,
}

/// The pull that a path needs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pull {
    /// Largest pull at the reel that taking up the cable needs, newtons; 1 MN stands for more.
    pub needed_n: f64,
    /// Where the robot is then, tank frame.
    pub at: Point,
    /// Pull of the reel, newtons.
    pub reel_n: f64,
    /// Largest pull of the robot that paying out the cable needs, newtons; 1 MN stands for more.
    pub robot_needed_n: f64,
    /// Where the robot is then, tank frame.
    pub robot_at: Point,
}

impl Pull {
    /// Returns the pull needed as a share of the pull of the reel.
    pub fn ratio(&self) -> f64 {
        self.needed_n / self.reel_n
    }

    /// Returns the figures as text: `3.9 of 6.0 N at -2.5, 5.1 m`.
    ///
    /// ```
    /// use world::{Point, tether::Pull};
    /// let at = Point::new(-2.5, 5.1);
    /// let pull = Pull { needed_n: 3.94, at, reel_n: 6.0, robot_needed_n: 4.4, robot_at: at };
    /// assert_eq!(pull.text(), "3.9 of 6.0 N at -2.5, 5.1 m");
    /// ```
    pub fn text(&self) -> String {
        let [needed, reel] = beside_limit(self.needed_n, self.reel_n, 1);
        format!("{needed} of {reel} N at {:.1}, {:.1} m", self.at.x, self.at.y)
    }
}

/// A part of the cable: a bend, or the free span before it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    /// Length of the straight span that precedes the bend on the side of the anchor, metres.
    pub span_m: f64,
    /// Radius of the bend, metres.
    pub radius_m: f64,
    /// Angle by which the cable turns, radians.
    pub wrap_rad: f64,
}

impl Drag {
    /// Returns the pull behind a straight span that is pulled with a given force, newtons.
    fn along(self, pull_n: f64, span_m: f64) -> f64 {
        (pull_n + self.floor_n_per_m * span_m).min(MOST_N)
    }

    /// Returns the pull behind a bend, newtons. Along the arc, the cable rubs on the floor and on the bend:
    /// dT/dθ = μ T + w r, with w the friction of the floor and μ that of the bend.
    fn around(self, pull_n: f64, radius_m: f64, wrap_rad: f64) -> f64 {
        let floor_n = self.floor_n_per_m * radius_m;
        let gain = (self.friction * wrap_rad).exp_m1();
        let by_floor_n =
            if self.friction * wrap_rad > 1e-9 { floor_n / self.friction * gain } else { floor_n * wrap_rad };
        // The gain may be infinite and the pull zero.
        let by_pull_n = if pull_n > 0.0 { pull_n * (1.0 + gain) } else { 0.0 };
        (by_pull_n + by_floor_n).min(MOST_N)
    }
}

impl Cable {
    /// Returns the pull at the anchor that is needed to take the cable up from a robot that does not pull, newtons; 1 MN
    /// stands for more.
    ///
    /// From the robot to the anchor, the pull grows along every metre of cable by the friction of the floor, and round
    /// every bend by the capstan equation. Along a straight move of the robot, the pull falls and then rises: its slope
    /// has the sign of cos α ± μ sin α, with α the angle between the move and the free span. So a path needs the largest
    /// pull at one of the points that define it.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::{Cable, Drag}};
    /// # let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let wall = Boundary::Circle { radius_m: 10.0 };
    /// let mut cable = Cable::new(Point::origin(), &wall, &[column]).unwrap();
    /// cable.drag_to(Point::new(0.0, 8.0));
    /// let drag = Drag { floor_n_per_m: 0.3, friction: 0.3 };
    /// assert!((cable.pull_at_anchor_n(drag) - 0.3 * 8.0).abs() < 1e-9);
    /// ```
    #[must_use]
    pub fn pull_at_anchor_n(&self, drag: Drag) -> f64 {
        let last_n = drag.along(0.0, self.free_span_m());
        self.stretches().rev().fold(last_n, |pull_n, Stretch { span_m, radius_m, wrap_rad }| {
            drag.along(drag.around(pull_n, radius_m, wrap_rad), span_m)
        })
    }

    /// Returns the pull of the robot that is needed to draw cable off a reel at the anchor that pays out under a given
    /// pull, newtons; 1 MN stands for more.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::{Cable, Drag}};
    /// # let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let wall = Boundary::Circle { radius_m: 10.0 };
    /// let mut cable = Cable::new(Point::origin(), &wall, &[column]).unwrap();
    /// cable.drag_to(Point::new(0.0, 8.0));
    /// let drag = Drag { floor_n_per_m: 0.3, friction: 0.3 };
    /// assert!((cable.pull_at_robot_n(drag, 0.5) - (0.5 + 0.3 * 8.0)).abs() < 1e-9);
    /// ```
    #[must_use]
    pub fn pull_at_robot_n(&self, drag: Drag, pay_out_n: f64) -> f64 {
        let behind_n = self.stretches().fold(pay_out_n, |pull_n, Stretch { span_m, radius_m, wrap_rad }| {
            drag.around(drag.along(pull_n, span_m), radius_m, wrap_rad)
        });
        drag.along(behind_n, self.free_span_m())
    }
}

/// The pull that a path needs, evaluated at each of its points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pulling {
    drag: Drag,
    pay_out_n: f64,
    most: Pull,
}

impl Pulling {
    pub(super) fn new(limits: &PullLimits, anchor: Point) -> Self {
        let PullLimits { drag, reel_n, pay_out_n, .. } = *limits;
        let most = Pull { needed_n: 0.0, at: anchor, reel_n, robot_needed_n: 0.0, robot_at: anchor };
        Self { drag, pay_out_n, most }
    }

    /// Evaluates the cable with the robot at a point of the path.
    pub(super) fn look_at(&mut self, cable: &Cable, robot: Point) {
        let needed_n = cable.pull_at_anchor_n(self.drag);
        if needed_n > self.most.needed_n {
            (self.most.needed_n, self.most.at) = (needed_n, robot);
        }
        let robot_n = cable.pull_at_robot_n(self.drag, self.pay_out_n);
        if robot_n > self.most.robot_needed_n {
            (self.most.robot_needed_n, self.most.robot_at) = (robot_n, robot);
        }
    }

    pub(super) fn most(self) -> Pull {
        self.most
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tests")]
mod tests;
