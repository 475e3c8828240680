//! A floor with discs, a start and a goal, and the result of a planner on it.

use super::flown::{Flown, Trip, fly};
use crate::study::{Block, Method, Planned, Planners, Result, Row, Runner, StudyError};
use planner_api::{Boundary, Limits, Motion, Obstacle, Site, Task};
use serde::{Deserialize, Serialize};
use trials::discs;
use world::{Boundary as WallOf, Point, Pose, Vector, polyline, shape::rectangle};

/// Distance of the wall from everything else, metres; the papers have no wall.
const WALL_OFF_M: f64 = 20.0;
/// Distance from the goal at which a drive ends, metres.
const FLOWN_TOLERANCE_M: f64 = 0.1;
/// Number of times that every plan is made; the fastest counts.
const TIMED: usize = 5;

/// A floor with discs.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GotoLayout {
    /// Id of the case.
    pub id: &'static str,
    /// The start of the robot, metres.
    pub start: Point,
    /// The goal.
    pub goal: Point,
    /// Centres and radii, metres; radius 0 is a point.
    pub discs: Vec<(Point, f64)>,
    /// Radius of the robot, metres.
    pub hull_m: f64,
    /// Distance at which the goal counts as reached, metres.
    pub tolerance_m: f64,
}

/// The figures of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Measured {
    /// The answer.
    pub planned: Planned,
    /// Whether the goal was reached without a collision.
    pub arrived: bool,
    /// Least distance between hull and discs, metres.
    pub clearance_m: f64,
    /// Length, metres.
    pub length_m: f64,
    /// Length divided by that of the shortest path.
    pub ratio: f64,
}

impl GotoLayout {
    /// Asks a planner for a plan, several times to measure its planning time.
    ///
    /// # Errors
    /// The planner is missing, refuses its parameters or fails.
    pub(super) fn measure(&self, planners: &Planners, method: &Method) -> Result<Measured> {
        let mut best = self.plan(planners, method)?;
        for _ in 1..TIMED {
            let next = self.plan(planners, method)?;
            best = if next.plan_time_ms < best.plan_time_ms { next } else { best };
        }
        self.measured(best)
    }

    fn plan(&self, planners: &Planners, method: &Method) -> Result<Planned> {
        let (corners, obstacles) = (self.corners(), discs::obstacles(&self.discs));
        let task = Task::Goto { goal: self.goal, tolerance_m: self.tolerance_m };
        planners.plan(method, self.start(), task, &self.site(&corners, &obstacles))
    }

    /// Has a planner drive on the layout for at most `most_s` seconds, at one metre per second.
    ///
    /// # Errors
    /// The planner is missing, refuses its parameters or fails.
    pub(super) fn fly(&self, planners: &Planners, method: &Method, most_s: f64) -> Result<Flown> {
        let (corners, obstacles) = (self.corners(), discs::obstacles(&self.discs));
        let (start, goal) = (self.start(), self.goal);
        let trip = Trip { start, goal, tolerance_m: FLOWN_TOLERANCE_M, most_s };
        fly(planners, method, &self.site(&corners, &obstacles), &trip)
    }

    /// Draws a plan, if drawings are requested.
    pub(super) fn draw(&self, runner: &Runner<'_>, method: &Method, measured: &Measured) {
        let Some(gallery) = runner.gallery() else { return };
        let world = discs::world(WallOf::Polygon { vertices: self.corners() }, &self.discs);
        gallery.add_path((self.id, 0, &method.id), &world, self.hull_m, None, &measured.planned.plan);
    }

    fn start(&self) -> Pose {
        Pose { position: self.start, heading_rad: 0.0 }
    }

    fn site<'a>(&self, corners: &'a [Point], obstacles: &'a [Obstacle<'a>]) -> Site<'a> {
        Site {
            revision: 0,
            boundary: Boundary::Polygon { vertices: corners },
            obstacles,
            zones: &[],
            limits: Limits {
                motion: Motion::Point,
                v_max_m_per_s: 1.0,
                w_max_rad_per_s: 1.0,
                radius_m: self.hull_m,
                sensing_range_m: 100.0,
                acceleration_m_per_s2: 100.0,
                tick_s: 0.1,
                amphibious: None,
            },
            swath_m: 1.0,
            clearance_m: 0.0,
            seed: 0,
        }
    }

    fn measured(&self, planned: Planned) -> Result<Measured> {
        let clearance_m = discs::path_distance_m(&self.discs, planned.path()) - self.hull_m;
        let length_m = polyline::length_m(planned.path());
        let off_m = (self.goal - planned.end(self.start)).norm();
        let arrived = off_m <= self.tolerance_m + 1e-6 && clearance_m >= 0.0;
        let shortest = discs::shortest_path(&self.corners(), &self.discs, self.hull_m, self.start, self.goal);
        let shortest = shortest.map_err(|no| StudyError::Refused(format!("{}: {no}", self.id)))?;
        Ok(Measured { planned, arrived, clearance_m, length_m, ratio: length_m / shortest.length_m })
    }

    fn corners(&self) -> Vec<Point> {
        let all = || self.discs.iter().map(|disc| disc.0).chain([self.start, self.goal]);
        let off = Vector::new(WALL_OFF_M, WALL_OFF_M);
        let low = all().reduce(|a, b| a.inf(&b)).unwrap_or(self.start) - off;
        let high = all().reduce(|a, b| a.sup(&b)).unwrap_or(self.start) + off;
        rectangle(low, high)
    }
}

/// A wall of discs along a line through `corners`, which are given ahead and to the left of `at`, looking along
/// `toward_rad`.
pub(super) fn wall_of_discs(
    corners: &[(f64, f64)],
    at: Point,
    toward_rad: f64,
    radius_m: f64,
    spacing_m: f64,
) -> Vec<(Point, f64)> {
    let ahead = Vector::new(toward_rad.cos(), toward_rad.sin());
    let left = Vector::new(-ahead.y, ahead.x);
    let line: Vec<Point> = corners.iter().map(|(x, y)| at + ahead * *x + left * *y).collect();
    polyline::resampled(&line, spacing_m).into_iter().map(|center| (center, radius_m)).collect()
}

impl Measured {
    /// The figures of a plan, without printed values.
    pub(super) fn rows(&self, block: &Block<'_>) -> Vec<Row> {
        let row = |metric: &str, ours: f64, unit: &str| block.row(metric, ours, unit, 1);
        let mut rows = vec![row("success_rate", f64::from(u8::from(self.arrived)), "")];
        if let Some(stop) = self.planned.path().last() {
            rows.extend([row("stop_x", stop.x, "m"), row("stop_y", stop.y, "m")]);
        }
        rows.extend([
            row("steps", self.planned.n_steps(), ""),
            row("length_m", self.length_m, "m"),
            row("min_clearance", self.clearance_m, "m"),
            row("plan_time_ms", self.planned.plan_time_ms, "ms"),
        ]);
        if self.arrived {
            rows.push(row("length_ratio_mean", self.ratio, ""));
        }
        rows
    }
}
