//! The figures of a path that scans the floor of a tank: coverage, length, turns and the effect on the tether.

use crate::tanks::{CLEARANCE_M, HULL_M, SWATH_M, Tank};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use world::{
    Boundary, CoverageGrid, FloorMaker, Point, Shape, ShellZone, SweptArea, Tool, Vector,
    geometry::unit_vector,
    polyline,
    tether::{Case, Certificate, Limits, TetherError, certify},
};

/// The tool.
const TOOL: Tool = Tool::Bar { swath_m: SWATH_M };
/// Width of the critical zone along the shell, metres (API 653: 3 inches).
const CRITICAL_ZONE_M: f64 = 0.075;
/// Speeds of the robot for computing the time of a path: 0.4 m/s and 60 degrees a second.
const SPEED_M_PER_S: f64 = 0.4;
const TURN_RAD_PER_S: f64 = std::f64::consts::PI / 3.0;
/// Distance between the points at which a lane is checked for room, metres.
const LANE_STEP_M: f64 = 0.02;

/// The figures of a path over a floor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scan {
    /// Scanned share of the floor that the tool can reach.
    pub coverage_reachable: f64,
    /// The same share, computed from the area that the bar swept instead of from cells.
    pub coverage_exact: f64,
    /// Scanned share of the whole floor.
    pub coverage_whole: f64,
    /// Scanned share of the critical zone along the shell.
    pub critical_zone: f64,
    /// The share of the critical zone that one lane along the shell would scan, if the robot drove it wherever there is
    /// room for hull and clearance.
    pub critical_zone_possible: f64,
    /// Length, metres.
    pub length_m: f64,
    /// Length divided by (reachable area divided by swath).
    pub length_over_lower_bound: f64,
    /// Changes of heading by more than 30 degrees.
    pub turns: usize,
    /// Sum of the changes of heading, in whole turns.
    pub rotation_turns: f64,
    /// Time for driving and turning in sequence at the robot's speeds, divided by the time for driving the lower bound
    /// of the length.
    pub time_over_lower_bound: f64,
    /// The figures of the tether, without limits.
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
        let floor = FloorMaker::new(&world, cell_m, room_m, SWATH_M, self.anchor);
        let mut grid = CoverageGrid::new(floor.clone().into_floor());
        let (mut area, mut zone) =
            (SweptArea::new(&self.boundary), ShellZone::new(&self.boundary, CRITICAL_ZONE_M));
        Tool::along(path, |from, to| {
            grid.mark(TOOL, from, to);
            area.pass(TOOL, from, to);
            zone.pass(TOOL, from, to);
        });
        let shapes: Vec<Shape> = world.obstacles.iter().map(|obstacle| obstacle.shape.clone()).collect();
        let scanned = |zone: &ShellZone| {
            zone.figures(|point| shapes.iter().any(|shape| shape.distance_m(point) < 0.0)).scanned
        };
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
            pull: None,
            returns: true,
            cuts,
        })?;
        let length_m = polyline::length_m(path);
        let area_m2 = grid.counts().reachable as f64 * cell_m * cell_m;
        let turns: Vec<f64> = polyline::turns_rad(path).collect();
        Ok(Scan {
            coverage_reachable: grid.fraction_reachable(),
            coverage_exact: area.share_of(&floor, &self.boundary, &shapes).unwrap_or(0.0),
            coverage_whole: grid.fraction_whole(),
            critical_zone: scanned(&zone),
            critical_zone_possible: scanned(&self.zone_in_reach(&shapes)),
            length_m,
            length_over_lower_bound: length_m / (area_m2 / SWATH_M),
            time_over_lower_bound: (length_m / SPEED_M_PER_S + turns.iter().sum::<f64>() / TURN_RAD_PER_S)
                / (area_m2 / (SWATH_M * SPEED_M_PER_S)),
            turns: turns.iter().filter(|turn| **turn > 30_f64.to_radians()).count(),
            rotation_turns: turns.iter().sum::<f64>() / TAU,
            certificate,
        })
    }
}

impl Tank {
    /// The critical zone as the bar scans it across a lane along the shell, wherever the hull has room for that.
    fn zone_in_reach(&self, shapes: &[Shape]) -> ShellZone {
        let mut zone = ShellZone::new(&self.boundary, CRITICAL_ZONE_M);
        let room_m = HULL_M + CLEARANCE_M;
        let is_free = |at: Point| {
            self.boundary.wall_distance_m(at) >= room_m - 1e-9
                && shapes.iter().all(|shape| shape.distance_m(at) >= room_m)
        };
        let lanes: Vec<Vec<Point>> = match &self.boundary {
            Boundary::Circle { radius_m } => {
                let n = (TAU * radius_m / LANE_STEP_M).ceil();
                let at = |k: usize| Point::from(unit_vector(TAU * k as f64 / n) * (radius_m - room_m));
                vec![(0..=n as usize).map(at).collect()]
            }
            Boundary::Polygon { vertices } => {
                let lane = |(a, b): (Point, Point)| {
                    let aside = (b - a).normalize() * room_m;
                    let inward = Vector::new(-aside.y, aside.x);
                    polyline::resampled(&[a + inward, b + inward], LANE_STEP_M)
                };
                polyline::edges(vertices).map(lane).collect()
            }
        };
        for lane in &lanes {
            for run in lane.split(|at| !is_free(*at)) {
                Tool::along(run, |from, to| zone.pass(TOOL, from, to));
            }
        }
        zone
    }
}
