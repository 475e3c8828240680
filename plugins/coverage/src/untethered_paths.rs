//! Paths for a robot without a tether: the shortest path, on either side of any obstacle.

use crate::inflation::SLACK_M;
use crate::workspace::Workspace;
use geometry::convex::Part;
use planner_api::{Ctx, Result};
use world::{Point, Shape, shortest::GrownFloor};

/// The floor of a robot that may go anywhere.
pub(crate) struct UntetheredPaths {
    floor: GrownFloor,
    /// The same floor with slightly less clearance, for ends of paths that are slightly too close to something.
    tight: GrownFloor,
}

impl UntetheredPaths {
    /// Creates the paths through a workspace.
    pub(crate) fn new(workspace: &Workspace, ctx: &Ctx<'_>) -> Result<Self> {
        ctx.check()?;
        let shapes: Vec<Shape> = workspace.parts.iter().map(Part::to_shape).collect();
        let floor = |keep_m: f64| {
            GrownFloor::new(&workspace.wall, keep_m, shapes.iter().map(|shape| (shape, keep_m)))
        };
        let keep_m = workspace.keep_m;
        Ok(Self { floor: floor(keep_m + SLACK_M / 4.0), tight: floor(keep_m - SLACK_M / 4.0) })
    }

    /// The shortest path; a straight line if an end is too close to something.
    pub(crate) fn path(&self, from: Point, to: Point) -> Vec<Point> {
        let path = |floor: &GrownFloor| {
            if floor.is_free(from, to) {
                return Some(vec![from, to]);
            }
            floor.shortest(from, to, &mut || true).ok().map(|way| way.points())
        };
        path(&self.floor).or_else(|| path(&self.tight)).unwrap_or_else(|| vec![from, to])
    }
}
