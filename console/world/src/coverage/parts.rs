//! The parts of a tool: some of its channels may be dead, and the floor under these is not tested.

use super::tool::Tool;
use geometry::{Pose, Vector};

/// A part of a tool, or a whole tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolPart {
    tool: Tool,
    /// Distance of its middle from the middle of the tool, metres; positive to the left.
    left_m: f64,
}

impl ToolPart {
    /// Returns a whole tool.
    ///
    /// ```
    /// use world::{Pose, Tool, ToolPart};
    /// let part = ToolPart::whole(Tool::Bar { swath_m: 0.6 });
    /// assert_eq!((part.tool().swath_m(), part.at(Pose::new(1.0, 2.0, 0.3))), (0.6, Pose::new(1.0, 2.0, 0.3)));
    /// ```
    pub fn whole(tool: Tool) -> Self {
        Self { tool, left_m: 0.0 }
    }

    /// Returns the part of a tool between two distances from its middle, metres, positive to the left, the smaller one
    /// first. A disc has no channels across a heading, so its only part is the whole disc.
    ///
    /// ```
    /// use world::{Pose, Tool, ToolPart};
    /// let left = ToolPart::between(Tool::Bar { swath_m: 0.6 }, [0.1, 0.3]);
    /// assert!((left.tool().swath_m() - 0.2).abs() < 1e-12);
    /// assert!((left.at(Pose::new(0.0, 0.0, 0.0)).position.y - 0.2).abs() < 1e-12);
    /// ```
    pub fn between(tool: Tool, [right_m, left_m]: [f64; 2]) -> Self {
        match tool {
            Tool::Bar { .. } => {
                Self { tool: Tool::Bar { swath_m: left_m - right_m }, left_m: f64::midpoint(right_m, left_m) }
            }
            Tool::Disc { .. } => Self::whole(tool),
        }
    }

    /// Returns the parts of a tool that are left without some stretches, each with its ends as in [`Self::between`] and
    /// widened by `rim_m` metres on both sides. Without stretches, this is the whole tool; of a disc, nothing is left.
    ///
    /// ```
    /// use world::{Tool, ToolPart};
    /// let tool = Tool::Bar { swath_m: 0.6 };
    /// assert_eq!(ToolPart::without(tool, &[], 0.02), [ToolPart::whole(tool)]);
    /// let widths = |dead: &[[f64; 2]]| {
    ///     let parts = ToolPart::without(tool, dead, 0.02);
    ///     parts.iter().map(|part| (1000.0 * part.tool().swath_m()).round()).collect::<Vec<_>>()
    /// };
    /// assert_eq!(widths(&[[0.0, 0.1]]), [280.0, 180.0]);
    /// assert_eq!(widths(&[[-0.3, -0.2], [0.19, 0.3]]), [350.0]);
    /// ```
    pub fn without(tool: Tool, stretches: &[[f64; 2]], rim_m: f64) -> Vec<Self> {
        if stretches.is_empty() {
            return vec![Self::whole(tool)];
        }
        let Tool::Bar { swath_m } = tool else { return Vec::new() };
        let mut dead: Vec<[f64; 2]> = stretches.iter().map(|[from, to]| [from - rim_m, to + rim_m]).collect();
        dead.sort_by(|one, other| one[0].total_cmp(&other[0]));
        let (mut from_m, mut parts) = (-swath_m / 2.0, Vec::new());
        for [dead_from_m, dead_to_m] in dead.into_iter().chain([[swath_m / 2.0, f64::INFINITY]]) {
            if dead_from_m - from_m > NARROW_M {
                parts.push(Self::between(tool, [from_m, dead_from_m.min(swath_m / 2.0)]));
            }
            from_m = from_m.max(dead_to_m);
        }
        parts
    }

    /// Returns the tool that this part is.
    pub fn tool(self) -> Tool {
        self.tool
    }

    /// Returns the pose of this part if the whole tool is at a pose.
    #[must_use]
    pub fn at(self, pose: Pose) -> Pose {
        if self.left_m == 0.0 {
            return pose;
        }
        let left = Vector::new(-pose.heading_rad.sin(), pose.heading_rad.cos());
        Pose { position: pose.position + left * self.left_m, ..pose }
    }
}

/// The width up to which a part is left out, metres.
const NARROW_M: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Boundary, CoverageGrid, Floor, Point, World};
    use proptest::prelude::*;

    const TOOL: Tool = Tool::Bar { swath_m: 0.6 };

    fn grid() -> CoverageGrid {
        let boundary = Boundary::Circle { radius_m: 3.0 };
        let world = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
        CoverageGrid::new(Floor::new(&world, 0.05, 0.25, 0.6, Point::origin()))
    }

    proptest! {
        #[test]
        fn no_cell_that_a_dead_stretch_touches_counts_and_the_others_do(
            heading_rad in 0.0..std::f64::consts::TAU,
            from_m in -0.3..0.25_f64,
            width_m in 0.01..0.1_f64,
        ) {
            let grid = grid();
            let rim_m = grid.floor().rim_m();
            let dead = [from_m, from_m + width_m];
            let (from, to) = (Pose::new(0.02, 0.01, heading_rad), Pose::new(0.02, 0.01, heading_rad).moved(1.0, 0.0, 0.0));
            let under = |parts: &[ToolPart]| grid.not_covered_under_parts(parts, from, to);
            let cells = |parts: &[ToolPart]| -> Vec<usize> {
                under(parts).into_iter().flat_map(crate::CellRun::range).collect()
            };
            let (all, live) = (cells(&[ToolPart::whole(TOOL)]), cells(&ToolPart::without(TOOL, &[dead], rim_m)));
            let left = Vector::new(-heading_rad.sin(), heading_rad.cos());
            for cell in all {
                let across_m = left.dot(&(grid.floor().center(cell) - from.position));
                let beyond_m = (dead[0] - rim_m - across_m).max(across_m - dead[1] - rim_m);
                // Cells at the edge, to within rounding, are either.
                prop_assert!(beyond_m < 1e-6 || live.contains(&cell), "{} m", across_m);
                prop_assert!(beyond_m > -1e-6 || !live.contains(&cell), "{} m", across_m);
            }
        }
    }

    #[test]
    fn a_disc_without_a_channel_scans_nothing() {
        let tool = Tool::Disc { swath_m: 0.6 };
        assert_eq!(ToolPart::without(tool, &[[0.0, 0.1]], 0.0), []);
        assert_eq!(ToolPart::between(tool, [0.0, 0.1]), ToolPart::whole(tool));
    }

    #[test]
    fn parts_that_overlap_in_a_turn_name_each_cell_once() {
        let grid = grid();
        let parts = ToolPart::without(TOOL, &[[-0.02, 0.02]], 0.0);
        let (from, to) = (Pose::new(0.0, 0.0, 0.0), Pose::new(0.1, 0.0, 1.0));
        let runs = grid.not_covered_under_parts(&parts, from, to);
        assert!(runs.windows(2).all(|pair| pair[0].range().end < pair[1].range().start), "{runs:?}");
    }
}
