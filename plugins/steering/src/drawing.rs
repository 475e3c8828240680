//! Draws the forces that drive the robot.

use crate::body::Body;
use geometry::{Point, Vector};
use planner_api::{Ctx, Layer};

/// Distance beyond which the pull of a target stays constant, metres.
pub const FAR_M: f64 = 1.0;
/// Longest arrow, metres: repulsion grows without bound near an outline.
const LONGEST_M: f64 = 1.5;
/// Length below which an arrow is not drawn, metres.
const SHORTEST_M: f64 = 0.02;

/// The separate forces on a robot at one position, for drawing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Forces {
    /// Pull of the target.
    pub attraction: Vector,
    /// Push of obstacles and wall.
    pub repulsion: Vector,
    /// Rotating force.
    pub rotation: Vector,
}

impl Forces {
    /// Only the pull of a target.
    pub fn toward(at: Point, aim: Point) -> Self {
        Self { attraction: (aim - at).cap_magnitude(FAR_M), ..Self::default() }
    }

    /// The sum of all forces.
    pub fn resultant(&self) -> Vector {
        self.attraction + self.repulsion + self.rotation
    }

    /// Reports the size of every force, and draws the forces if drawings are requested.
    ///
    /// An arrow of one metre represents a force as large as the pull of a target one metre away.
    pub fn show(&self, ctx: &Ctx<'_>, at: Point, k_att: f64) {
        ctx.scalar("F_att", self.attraction.norm(), "N");
        ctx.scalar("F_rep", self.repulsion.norm(), "N");
        ctx.scalar("F_rot", self.rotation.norm(), "N");
        if !ctx.wants_drawing() {
            return;
        }
        let layers = [
            (Layer::Attraction, self.attraction),
            (Layer::Repulsion, self.repulsion),
            (Layer::Rotation, self.rotation),
            (Layer::Resultant, self.resultant()),
        ];
        for (layer, force) in layers {
            let arrow = (force / k_att.max(1e-9)).cap_magnitude(LONGEST_M);
            if arrow.norm() >= SHORTEST_M {
                ctx.arrow(layer, at, arrow);
            }
        }
    }
}

/// Reports the distance between a hull at a position and the nearest body, if there is one.
pub fn show_nearest(ctx: &Ctx<'_>, at: Point, hull_m: f64, bodies: &[Body]) {
    let distances_m = bodies.iter().map(|body| body.hull_distance_m(at, hull_m));
    if let Some(nearest_m) = distances_m.min_by(f64::total_cmp) {
        ctx.scalar("obstacle_distance", nearest_m, "m");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_api::{Drawing, testing::Bench};

    #[test]
    fn arrows_are_scaled_by_the_pull_and_capped() {
        let bench = Bench::new();
        let forces = Forces {
            attraction: Vector::new(100.0, 0.0),
            repulsion: Vector::new(-1e9, 0.0),
            ..Forces::default()
        };
        forces.show(&bench.ctx(), Point::origin(), 200.0);
        let lengths: Vec<f64> = bench
            .drawings()
            .iter()
            .map(|d| if let Drawing::Arrow { vector, .. } = d { vector.x } else { 0.0 })
            .collect();
        assert_eq!(lengths, [0.5, -1.5, -1.5]);
        assert_eq!(bench.scalar("F_att"), Some(100.0));
    }

    #[test]
    fn nothing_is_drawn_when_nobody_looks() {
        let bench = Bench::new();
        bench.look_away();
        Forces { attraction: Vector::x(), ..Forces::default() }.show(&bench.ctx(), Point::origin(), 1.0);
        assert!(bench.drawings().is_empty() && bench.scalars().len() == 3);
    }
}
