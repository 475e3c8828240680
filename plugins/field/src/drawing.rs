//! Forces made visible.

use crate::law::Forces;
use planner_api::{Ctx, Layer};
use world::{Point, Vector};

/// No arrow is longer, metres: near an outline repulsion grows beyond all bounds.
const LONGEST_M: f64 = 1.5;
/// Shorter arrows are left out, metres.
const SHORTEST_M: f64 = 0.02;

/// Reports the size of every force, and draws them if anyone looks.
///
/// An arrow of one metre is a force as large as the pull of a target one metre off.
pub fn show(ctx: &Ctx<'_>, at: Point, forces: &Forces, k_att: f64) {
    ctx.scalar("F_att", forces.attraction.norm(), "N");
    ctx.scalar("F_rep", forces.repulsion.norm(), "N");
    ctx.scalar("F_rot", forces.rotation.norm(), "N");
    if !ctx.wants_drawing() {
        return;
    }
    let layers = [
        (Layer::Attraction, forces.attraction),
        (Layer::Repulsion, forces.repulsion),
        (Layer::Rotation, forces.rotation),
        (Layer::Resultant, forces.resultant()),
    ];
    for (layer, force) in layers {
        if let Some(arrow) = arrow(force, k_att) {
            ctx.arrow(layer, at, arrow);
        }
    }
}

fn arrow(force: Vector, k_att: f64) -> Option<Vector> {
    let arrow = (force / k_att.max(1e-9)).cap_magnitude(LONGEST_M);
    (arrow.norm() >= SHORTEST_M).then_some(arrow)
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
        show(&bench.ctx(), Point::origin(), &forces, 200.0);
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
        let forces = Forces { attraction: Vector::x(), ..Forces::default() };
        show(&bench.ctx(), Point::origin(), &forces, 1.0);
        assert!(bench.drawings().is_empty() && bench.scalars().len() == 3);
    }
}
