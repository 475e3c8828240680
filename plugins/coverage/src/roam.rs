//! Ways for a robot without a tether: the shortest, on either side of whatever stands between.

use crate::ground::{Ground, SLACK_M};
use geometry::convex::Part;
use planner_api::{Ctx, Result};
use world::{Point, Shape, shortest::GrownFloor};

/// The floor of a robot that may go anywhere.
pub struct Roam {
    floor: GrownFloor,
    /// The same without spare room, for ends that have none.
    tight: GrownFloor,
}

impl Roam {
    /// The floor of a ground.
    ///
    /// # Errors
    /// When the console wants an end.
    pub fn new(ground: &Ground, ctx: &Ctx<'_>) -> Result<Self> {
        ctx.check()?;
        let shapes: Vec<Shape> = ground.parts.iter().map(shape).collect();
        let floor =
            |keep_m: f64| GrownFloor::new(&ground.wall, keep_m, shapes.iter().map(|shape| (shape, keep_m)));
        Ok(Self { floor: floor(ground.keep_m + SLACK_M / 4.0), tight: floor(ground.keep_m - SLACK_M / 4.0) })
    }

    /// The shortest way; straight where an end is too near to something for any.
    pub fn way(&self, from: Point, to: Point) -> Vec<Point> {
        let way = |floor: &GrownFloor| {
            if floor.is_free(from, to) {
                return Some(vec![from, to]);
            }
            floor.shortest(from, to, &mut || true).ok().map(|way| way.points())
        };
        way(&self.floor).or_else(|| way(&self.tight)).unwrap_or_else(|| vec![from, to])
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
