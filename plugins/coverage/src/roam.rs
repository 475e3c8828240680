//! Ways for a robot without a tether: the shortest, on either side of whatever stands between.

use crate::ground::{Ground, SLACK_M};
use field::part::Part;
use planner_api::{Ctx, Result};
use world::{Point, Shape, shortest::GrownFloor};

/// The floor of a robot that may go anywhere.
pub struct Roam {
    floor: GrownFloor,
}

impl Roam {
    /// The floor of a ground.
    ///
    /// # Errors
    /// When the console wants an end.
    pub fn new(ground: &Ground, ctx: &Ctx<'_>) -> Result<Self> {
        ctx.check()?;
        let shapes: Vec<Shape> = ground.parts.iter().map(shape).collect();
        let keep_m = ground.keep_m + SLACK_M / 4.0;
        let solids = shapes.iter().map(|shape| (shape, keep_m));
        Ok(Self { floor: GrownFloor::new(&ground.wall, keep_m, solids) })
    }

    /// The shortest way; straight where an end is too near to something for any.
    pub fn way(&self, from: Point, to: Point) -> Vec<Point> {
        if self.floor.is_free(from, to) {
            return vec![from, to];
        }
        let way = self.floor.shortest(from, to, &mut || true);
        way.map_or_else(|_| vec![from, to], |way| way.points())
    }
}

fn shape(part: &Part) -> Shape {
    match part {
        Part::Capsule { a, b, half_width_m } if a == b => Shape::Disc { center: *a, radius_m: *half_width_m },
        Part::Capsule { a, b, half_width_m } => {
            Shape::Polyline { points: vec![*a, *b], half_width_m: *half_width_m }
        }
        Part::Polygon { vertices } => Shape::Polygon { vertices: vertices.clone() },
    }
}
