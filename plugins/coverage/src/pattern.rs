//! Patterns of lanes, before obstacles and cuts break them.

use crate::inflation::SLACK_M;
use crate::plane::{direction, extent, left_of};
use crate::slit_domain::SlitDomain;
use crate::tuning::choice::BENT_RAD;
use crate::tuning::lanes::{INTO_LAP, SPACING};
use crate::workspace::{Workspace, reach_m};
use geometry::convex::Part;
use std::f64::consts::{PI, TAU};
use world::{Boundary, Point, Vector, polyline};

/// Sampling step along rows, metres.
const STEP_M: f64 = 0.04;
/// Chord length of a lane along a round wall, metres.
const CHORD_M: f64 = 0.15;
/// Minimum width of the slivers along the wall that are counted, metres.
const LEAST_SLIVER_M: f64 = 0.02;

/// The layout of lanes on the floor.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Pattern {
    /// Lanes that follow the wall at constant distances.
    Contours,
    /// Straight lanes, surrounded by some contours along the wall.
    Straight {
        rows: Rows,
        /// Number of contours along the wall around the straight lanes.
        laps: usize,
    },
}

impl Pattern {
    /// The number of lanes that a straight cut would break.
    pub(crate) fn broken_lanes(&self, wall: &Boundary, a: Point, b: Point, swath_m: f64) -> f64 {
        match self {
            Self::Contours => {
                let n = 8;
                let depth = |k: i32| wall.wall_distance_m(a + (b - a) * (f64::from(k) / f64::from(n)));
                (0..n).map(|k| (depth(k + 1) - depth(k)).abs()).sum::<f64>() / swath_m
            }
            Self::Straight { rows, laps } => {
                let across = rows.ahead().perp(&(b - a)).abs();
                let laps = if wall.wall_distance_m(b) < 0.1 { *laps as f64 } else { 0.0 };
                (across / rows.spacing_m).max(0.0) + laps
            }
        }
    }

    /// The direction of the lanes, if they are straight.
    pub(crate) fn ahead(&self) -> Option<Vector> {
        let Self::Straight { rows, .. } = self else { return None };
        Some(rows.ahead())
    }

    /// The point where a cut that runs with the lanes should bend after leaving its obstacle, so that it lies between
    /// two lanes.
    pub(crate) fn bend(&self, foot: Point, end: Point) -> Option<Point> {
        let Self::Straight { rows, .. } = self else { return None };
        let along = (end - foot).try_normalize(1e-9)?;
        let is_along = along.perp(&rows.ahead()).abs() <= 0.02;
        is_along.then(|| foot + rows.to_gap(foot) + along * 0.05)
    }

    /// The distance from the outermost lap along the wall at which straight lanes begin, metres.
    pub(crate) fn within_laps_m(&self, swath_m: f64) -> f64 {
        match self {
            Self::Straight { laps: laps @ 1.., .. } => (*laps as f64 - INTO_LAP) * swath_m,
            Self::Straight { .. } | Self::Contours => 0.0,
        }
    }

    /// The unbroken lines of the pattern: those along walls, and the straight ones. Between inner walls, one lap runs
    /// along all walls and around every obstacle.
    pub(crate) fn lines(&self, domain: &SlitDomain<'_>) -> (Vec<Vec<Point>>, Vec<Vec<Point>>) {
        let workspace = domain.workspace;
        let start_m = workspace.keep_m + SLACK_M;
        let Self::Straight { rows, laps } = self else {
            return (contours(workspace, start_m, usize::MAX), Vec::new());
        };
        if workspace.is_room && *laps > 0 {
            let along_walls = domain.rings().iter().map(|ring| moved_left(ring, SLACK_M / 2.0)).collect();
            return (along_walls, rows.lines(&workspace.wall, start_m));
        }
        let laps_m = self.within_laps_m(workspace.swath_m);
        (contours(workspace, start_m, *laps), rows.lines(&workspace.wall, start_m + laps_m))
    }
}

/// A closed ring with every side shifted to its left.
fn moved_left(ring: &[Point], by_m: f64) -> Vec<Point> {
    let sides: Vec<Vector> = ring.windows(2).map(|w| left_of((w[1] - w[0]).normalize())).collect();
    let mut moved: Vec<Point> = (0..sides.len())
        .map(|k| {
            let (before, after) = (sides[(k + sides.len() - 1) % sides.len()], sides[k]);
            ring[k] + (before + after) * (by_m / (1.0 + before.dot(&after)).max(0.2))
        })
        .collect();
    moved.extend(moved.first().copied());
    moved
}

/// Lines at constant distances from the wall, outermost first. In a round tank, the last is a small circle around the
/// centre.
fn contours(workspace: &Workspace, start_m: f64, most: usize) -> Vec<Vec<Point>> {
    let swath_m = workspace.swath_m;
    let offsets = (0..most.min(10_000)).map(|k| start_m + k as f64 * swath_m);
    match &workspace.wall {
        Boundary::Circle { radius_m } => {
            let radii = offsets.map(|offset| radius_m - offset).take_while(|r| *r > -0.3 * swath_m);
            radii.map(|r| circle(r.max(0.08))).collect()
        }
        Boundary::Polygon { vertices } => offsets.map_while(|offset| inset(vertices, offset)).collect(),
    }
}

fn circle(radius_m: f64) -> Vec<Point> {
    let n = (TAU * radius_m / CHORD_M).ceil().max(12.0);
    (0..=n as usize).map(|k| Point::origin() + direction(TAU * k as f64 / n) * radius_m).collect()
}

/// A polygon with its edges shifted inward, closed; `None` once it has vanished. Suitable for convex walls.
fn inset(vertices: &[Point], offset_m: f64) -> Option<Vec<Point>> {
    let n = vertices.len();
    // A point on every shifted edge, and the direction of the edge.
    let moved = polyline::edges(vertices).map(|(a, b)| {
        let along = (b - a).normalize();
        (a + left_of(along) * offset_m, along)
    });
    let moved: Vec<(Point, Vector)> = moved.collect();
    let corner = |k: usize| {
        let ((a, u), (b, v)) = (moved[(k + n - 1) % n], moved[k]);
        let turn = u.perp(&v);
        if turn.abs() < 1e-9 { b } else { a + u * ((b - a).perp(&v) / turn) }
    };
    let mut ring: Vec<Point> = (0..n).map(corner).collect();
    let is_alive = (0..n).all(|k| (ring[(k + 1) % n] - ring[k]).dot(&moved[k].1) > 0.0);
    ring.push(ring[0]);
    is_alive.then_some(ring)
}

/// Straight lanes side by side.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Rows {
    /// Direction of the lanes, radians from east.
    pub angle_rad: f64,
    /// Position of the first lane across the direction, metres.
    shift_m: f64,
    /// Distance between lanes, metres.
    pub spacing_m: f64,
}

impl Rows {
    /// Rows through the centre of a round tank, or evenly spaced rows between straight walls.
    pub(crate) fn new(workspace: &Workspace, angle_rad: f64) -> Self {
        match workspace.wall {
            Boundary::Circle { .. } => {
                Self { angle_rad, shift_m: 0.0, spacing_m: workspace.swath_m * SPACING }
            }
            Boundary::Polygon { .. } => Self::even(workspace, angle_rad),
        }
    }

    /// Evenly spaced rows from wall to wall.
    pub(crate) fn even(workspace: &Workspace, angle_rad: f64) -> Self {
        let side = direction(angle_rad + PI / 2.0);
        let (low, high) = match &workspace.wall {
            Boundary::Circle { radius_m } => (-radius_m, *radius_m),
            Boundary::Polygon { vertices } => extent(vertices.iter().map(|v| v.coords.dot(&side))),
        };
        let margin_m = workspace.keep_m + SLACK_M;
        let width_m = (high - low - 2.0 * margin_m).max(workspace.swath_m);
        // A floor slightly wider than a whole number of swaths gets no additional lane.
        let n = (width_m / workspace.swath_m - 0.02).ceil().max(1.0);
        Self { angle_rad, shift_m: low + margin_m, spacing_m: width_m / n }
    }

    /// The same rows, shifted sideways by a share of their spacing.
    pub(crate) fn aside(self, share: f64) -> Self {
        Self { shift_m: self.shift_m + share * self.spacing_m, ..self }
    }

    /// Estimates how many rows the obstacles break. A row that an obstacle only grazes bends around it and counts as a
    /// fraction of a row.
    pub(crate) fn broken(&self, workspace: &Workspace) -> f64 {
        let side = left_of(self.ahead());
        let by = |part: &Part| {
            let reach = (reach_m(part) + workspace.keep_m) / self.spacing_m;
            let place = (part.middle().coords.dot(&side) - self.shift_m) / self.spacing_m;
            let rows = (place - reach).ceil() as i64..=(place + reach).floor() as i64;
            let broken = |row: i64| ((row as f64 - place).abs() / reach).min(1.0).acos() / BENT_RAD;
            rows.map(|row| broken(row).min(1.0)).sum::<f64>()
        };
        workspace.parts.iter().map(by).sum()
    }

    /// The length of the slivers that rows inside a lap leave along a round wall, metres.
    pub(crate) fn slivers_m(&self, workspace: &Workspace) -> f64 {
        let Boundary::Circle { radius_m } = workspace.wall else { return 0.0 };
        let half_m = workspace.swath_m / 2.0;
        let inner_m = radius_m - workspace.keep_m - SLACK_M - half_m;
        let beyond = |shift_m: f64| {
            let last_m = shift_m + ((inner_m - shift_m) / self.spacing_m).floor() * self.spacing_m;
            let swept_m = last_m + half_m;
            let is_wide = swept_m + LEAST_SLIVER_M < inner_m;
            if is_wide { 2.0 * (inner_m * inner_m - swept_m * swept_m).sqrt() } else { 0.0 }
        };
        beyond(self.shift_m) + beyond(-self.shift_m)
    }

    /// The unit vector along the lanes.
    pub(crate) fn ahead(&self) -> Vector {
        direction(self.angle_rad)
    }

    /// The displacement from a position to the nearest line midway between two lanes, metres.
    pub(crate) fn to_gap(self, from: Point) -> Vector {
        let side = left_of(self.ahead());
        let place = (from.coords.dot(&side) - self.shift_m) / self.spacing_m;
        let gap = (place - 0.5).round() + 0.5;
        side * ((gap - place) * self.spacing_m)
    }

    /// The lines of the rows, except parts closer to the wall than `edge_m`.
    pub(crate) fn lines(&self, wall: &Boundary, edge_m: f64) -> Vec<Vec<Point>> {
        let (ahead, side) = (self.ahead(), left_of(self.ahead()));
        let (low, high) = wall.bounds();
        let (middle, reach_m) = (low + (high - low) / 2.0, (high - low).norm());
        let first =
            ((middle.coords.dot(&side) - reach_m / 2.0 - self.shift_m) / self.spacing_m).floor() as i64;
        let last = ((middle.coords.dot(&side) + reach_m / 2.0 - self.shift_m) / self.spacing_m).ceil() as i64;
        let mut lines = Vec::new();
        for k in first..=last {
            let across = side * (self.shift_m + k as f64 * self.spacing_m);
            let foot = Point::from(across + ahead * middle.coords.dot(&ahead));
            let ends = [foot - ahead * reach_m / 2.0, foot + ahead * reach_m / 2.0];
            let line = polyline::resampled(&ends, STEP_M);
            let inside = line.split(|p| wall.wall_distance_m(*p) < edge_m - 1e-6);
            lines.extend(inside.filter(|run| run.len() > 1).map(|run| vec![run[0], run[run.len() - 1]]));
        }
        lines
    }
}
