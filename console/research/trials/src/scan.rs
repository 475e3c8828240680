//! The figures of a path that scans the floor of a tank: coverage, length, turns and what it does to the tether.

use crate::tanks::{CLEARANCE_M, HULL_M, SWATH_M, Tank};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use world::{
    CoverageGrid, Floor, Point, Pose, Vector,
    coverage::Tool,
    geometry::wrap_angle_rad,
    polyline,
    tether::{Case, Certificate, Limits, TetherError, certify},
};

/// Angle by which the bar turns between two marks, at most, radians.
const TURN_STEP_RAD: f64 = 0.2;

/// How a path over a floor went.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scan {
    /// Scanned share of the floor that the tool can reach.
    pub coverage_reachable: f64,
    /// Scanned share of the whole floor.
    pub coverage_whole: f64,
    /// Length, metres.
    pub length_m: f64,
    /// Length over reachable area by swath.
    pub length_over_lower_bound: f64,
    /// Changes of heading by more than 30 degrees.
    pub turns: usize,
    /// Sum of the changes of heading, in whole turns.
    pub rotation_turns: f64,
    /// What the tether says, without limits.
    pub certificate: Certificate,
}

impl Tank {
    /// The figures of a path that starts and ends at the anchor, counted in cells of `cell_m`.
    ///
    /// # Errors
    /// The tether has no anchor.
    pub fn score(&self, path: &[Point], cuts: &[Vec<Point>], cell_m: f64) -> Result<Scan, TetherError> {
        let world = self.world();
        let room_m = HULL_M + CLEARANCE_M;
        let mut grid = CoverageGrid::new(Floor::new(&world, cell_m, room_m, SWATH_M, self.anchor));
        sweep(&mut grid, path);
        let unlimited = f64::INFINITY;
        let certificate = certify(&Case {
            path,
            anchor: self.anchor,
            cable: None,
            boundary: &self.boundary,
            obstacles: &world.obstacles,
            room_m,
            limits: Limits {
                reel_length_m: unlimited,
                wrap_max_rad: unlimited,
                wrap_total_max_rad: unlimited,
            },
            returns: true,
            cuts,
        })?;
        let length_m = polyline::length_m(path);
        let area_m2 = grid.counts().reachable as f64 * cell_m * cell_m;
        let turns = turns_rad(path);
        Ok(Scan {
            coverage_reachable: grid.fraction_reachable(),
            coverage_whole: grid.fraction_whole(),
            length_m,
            length_over_lower_bound: length_m / (area_m2 / SWATH_M),
            turns: turns.iter().filter(|turn| **turn > 30_f64.to_radians()).count(),
            rotation_turns: turns.iter().sum::<f64>() / TAU,
            certificate,
        })
    }
}

/// Marks what a bar across the heading scans along a path; it also scans when the robot turns in place.
fn sweep(grid: &mut CoverageGrid, path: &[Point]) {
    let tool = Tool::Bar { swath_m: SWATH_M };
    let mut before: Option<f64> = None;
    for pair in path.windows(2).filter(|pair| (pair[1] - pair[0]).norm() > 1e-9) {
        let way = pair[1] - pair[0];
        let heading_rad = way.y.atan2(way.x);
        let at = |position: Point, heading_rad: f64| Pose { position, heading_rad };
        if let Some(from_rad) = before {
            let turn = wrap_angle_rad(heading_rad - from_rad);
            let n = (turn.abs() / TURN_STEP_RAD).ceil().max(1.0);
            for k in 0..n as usize {
                let heading = |k: f64| at(pair[0], from_rad + turn * k / n);
                grid.mark(tool, heading(k as f64), heading(k as f64 + 1.0));
            }
        }
        grid.mark(tool, at(pair[0], heading_rad), at(pair[1], heading_rad));
        before = Some(heading_rad);
    }
}

/// The changes of heading along a path, radians, not negative.
fn turns_rad(path: &[Point]) -> Vec<f64> {
    let headings: Vec<Vector> = path.windows(2).filter_map(|w| (w[1] - w[0]).try_normalize(1e-9)).collect();
    headings.windows(2).map(|w| w[0].perp(&w[1]).atan2(w[0].dot(&w[1])).abs()).collect()
}
