//! A floor with discs, a start and a goal, and what a planner makes of it.

use super::Method;
use crate::{
    planners::{Planned, Planners},
    row::Row,
    study::Problem,
};
use nalgebra::Matrix3;
use planner_api::{
    Boundary, Limits, Motion, Obstacle, Outline, PlanRequest, PoseEstimate, Reason, Site, Task, Vector2,
};
use world::{Point, Shape, Vector, polyline, shortest::GrownFloor};

/// The wall stands this far from everything: the papers have none, metres.
const WALL_OFF_M: f64 = 20.0;

/// A floor with discs.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scene {
    /// Id of the case.
    pub id: &'static str,
    /// Where the robot is put down, metres.
    pub start: Point,
    /// Where it is to go.
    pub goal: Point,
    /// Centres and radii, metres; radius 0 is a point.
    pub discs: Vec<(Point, f64)>,
    /// Radius of the robot, metres.
    pub hull_m: f64,
    /// Distance at which the goal counts as reached, metres.
    pub tolerance_m: f64,
}

/// What came out of a plan.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Walk {
    /// The answer.
    pub planned: Planned,
    /// Whether the goal was reached without a touch.
    pub arrived: bool,
    /// Least distance between hull and discs, metres.
    pub clearance_m: f64,
    /// Length, metres.
    pub length_m: f64,
    /// Length over that of the shortest way.
    pub ratio: f64,
}

impl Scene {
    /// Asks a planner for a plan on it; the better of `times` as far as the time goes.
    ///
    /// # Errors
    /// The planner is missing, refuses its parameters or broke down.
    pub(super) fn walk(&self, planners: &Planners, method: &Method, times: usize) -> Result<Walk, Problem> {
        let mut walks = (0..times.max(1)).map(|_| self.walk_once(planners, method));
        let first = walks.next().expect("it is asked at least once")?;
        walks.try_fold(first, |best, next| {
            let next = next?;
            Ok(if next.planned.plan_time_ms < best.planned.plan_time_ms { next } else { best })
        })
    }

    fn walk_once(&self, planners: &Planners, method: &Method) -> Result<Walk, Problem> {
        let (corners, obstacles) = (self.corners(), self.obstacles());
        let site = Site {
            revision: 0,
            boundary: Boundary::Polygon { vertices: &corners },
            obstacles: &obstacles,
            zones: &[],
            limits: Limits {
                motion: Motion::Point,
                v_max_m_per_s: 1.0,
                w_max_rad_per_s: 1.0,
                radius_m: self.hull_m,
                sensing_range_m: 100.0,
            },
            swath_m: 1.0,
            clearance_m: 0.0,
            seed: 0,
        };
        let start = PoseEstimate { position: self.start, heading_rad: 0.0, covariance: Matrix3::zeros() };
        let task = Task::Goto { goal: self.goal, tolerance_m: self.tolerance_m };
        let request = PlanRequest { reason: &Reason::Start, start, task, site: &site, previous: &[] };
        let planned = planners.plan(method.planner, &method.parameters, &request)?;
        self.measured(planned)
    }

    fn measured(&self, planned: Planned) -> Result<Walk, Problem> {
        let path = planned.path();
        let end = path.last().copied().unwrap_or(self.start);
        let clearances = self.discs.iter().map(|(at, radius_m)| polyline::distance_m(path, *at) - radius_m);
        let clearance_m = clearances.fold(f64::INFINITY, f64::min) - self.hull_m;
        let length_m = polyline::length_m(path);
        let arrived = (self.goal - end).norm() <= self.tolerance_m + 1e-6 && clearance_m >= 0.0;
        let ratio = length_m / self.shortest_m()?;
        Ok(Walk { planned, arrived, clearance_m, length_m, ratio })
    }

    /// Length of the shortest way, metres.
    fn shortest_m(&self) -> Result<f64, Problem> {
        let shape = |(center, radius_m): &(Point, f64)| Shape::Disc { center: *center, radius_m: *radius_m };
        let shapes: Vec<Shape> = self.discs.iter().map(shape).collect();
        let wall = world::Boundary::Polygon { vertices: self.corners().to_vec() };
        let floor = GrownFloor::new(&wall, self.hull_m, shapes.iter().map(|shape| (shape, self.hull_m)));
        let way = floor.shortest(self.start, self.goal, &mut || true);
        way.map(|way| way.length_m).map_err(|no| Problem::Nothing(format!("{}: {no}", self.id)))
    }

    fn corners(&self) -> [Point; 4] {
        let all = || self.discs.iter().map(|disc| disc.0).chain([self.start, self.goal]);
        let off = Vector::new(WALL_OFF_M, WALL_OFF_M);
        let low = all().reduce(|a, b| a.inf(&b)).unwrap_or(self.start) - off;
        let high = all().reduce(|a, b| a.sup(&b)).unwrap_or(self.start) + off;
        [low, Point::new(high.x, low.y), high, Point::new(low.x, high.y)]
    }

    fn obstacles(&self) -> Vec<Obstacle<'static>> {
        let obstacle = |(id, &(center, radius_m)): (usize, &(Point, f64))| Obstacle {
            id: id as u32,
            outline: Outline::Disc { center, radius_m },
            discovered: false,
            velocity_m_per_s: Vector2::zeros(),
        };
        self.discs.iter().enumerate().map(obstacle).collect()
    }
}

/// A wall of discs along a line through `corners`, each ahead and to the left of `at`, looking along `toward_rad`.
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

impl Walk {
    /// Where the path ends.
    pub(super) fn stop(&self) -> Option<Point> {
        self.planned.path().last().copied()
    }

    /// Number of moves.
    pub(super) fn steps(&self) -> f64 {
        self.planned.path().len().saturating_sub(1) as f64
    }

    /// Everything but what the paper prints.
    pub(super) fn rows(&self, table: &str, case: &str, method: &Method) -> Vec<Row> {
        let row = |metric: &str, ours: f64, unit: &str| {
            Row::new(table, case, method.id, metric, Some(ours), unit).note(method.note)
        };
        let mut rows = vec![row("success_rate", f64::from(u8::from(self.arrived)), "")];
        if let Some(stop) = self.stop() {
            rows.extend([row("stop_x", stop.x, "m"), row("stop_y", stop.y, "m")]);
        }
        rows.extend([
            row("steps", self.steps(), ""),
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
