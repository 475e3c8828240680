//! Lanes: the lines along which the floor is scanned, before anyone says in which order.

use crate::{
    cuts::Cut,
    ground::{Ground, direction},
    slit::Slit,
};
use std::f64::consts::TAU;
use world::{Boundary, Point, Vector, polyline};

/// Lanes are looked at this closely, metres.
const STEP_M: f64 = 0.04;
/// Chord of a lane along a round wall, metres.
const CHORD_M: f64 = 0.15;

/// Sine of the angle from which on a cut lies across straight lanes.
const ACROSS: f64 = 0.6;

/// How lanes lie on the floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pattern {
    /// At even distances from the wall.
    Contours,

    /// Straight, at this angle from east, inside some contours along the wall.
    Straight {
        /// Direction, radians.
        angle_rad: f64,
        /// Place of the first lane across the direction, metres.
        shift_m: f64,
        /// Distance between lanes, metres.
        spacing_m: f64,
        /// Contours along the wall around them.
        laps: usize,
    },
}

/// A lane, in the direction it was made in.
#[derive(Debug, Clone, PartialEq)]
pub struct Lane {
    /// Its points; at least two.
    pub points: Vec<Point>,
}

impl Lane {
    /// The pieces of the lane that are wanted.
    pub fn kept(&self, is_wanted: &dyn Fn(Point) -> bool) -> Vec<Self> {
        let fine = polyline::resampled(&self.points, 0.1);
        let wanted: Vec<bool> = fine.iter().map(|p| is_wanted(*p)).collect();
        if wanted.iter().all(|w| *w) {
            return vec![self.clone()];
        }
        let places: Vec<usize> = (0..fine.len()).collect();
        let runs = places.split(|k| !wanted[*k]).filter(|run| run.len() > 1);
        runs.map(|run| Self { points: thinned(&fine[run[0]..=run[run.len() - 1]]) }).collect()
    }
}

/// How near lanes come to what bounds them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// Distance from a cut at which lanes end, metres.
    pub cut_m: f64,
    /// How far straight lanes reach into the innermost lap, as a share of the swath.
    pub lap_share: f64,
    /// Shorter lanes are left out, metres.
    pub least_m: f64,
}

impl Pattern {
    /// How many lanes a straight cut would break.
    pub fn broken_lanes(&self, wall: &Boundary, a: Point, b: Point, swath_m: f64) -> f64 {
        match self {
            Self::Contours => {
                let n = 8;
                let depth = |k: i32| wall.wall_distance_m(a + (b - a) * (f64::from(k) / f64::from(n)));
                (0..n).map(|k| (depth(k + 1) - depth(k)).abs()).sum::<f64>() / swath_m
            }
            Self::Straight { angle_rad, spacing_m, laps, .. } => {
                let across = direction(*angle_rad).perp(&(b - a)).abs();
                let laps = if wall.wall_distance_m(b) < 0.1 { *laps as f64 } else { 0.0 };
                (across / spacing_m).max(0.0) + laps
            }
        }
    }

    /// Direction of the lanes, if they are straight.
    pub fn ahead(&self) -> Option<Vector> {
        match self {
            Self::Contours => None,
            Self::Straight { angle_rad, .. } => Some(direction(*angle_rad)),
        }
    }

    /// Where a cut that runs with the lanes shall leave its obstacle, so as to lie between two lanes.
    pub fn bend(&self, foot: Point, end: Point) -> Option<Point> {
        let Self::Straight { shift_m, spacing_m, .. } = self else { return None };
        let ahead = self.ahead()?;
        let along = (end - foot).try_normalize(1e-9)?;
        if along.perp(&ahead).abs() > 0.02 {
            return None;
        }
        let side = Vector::new(-ahead.y, ahead.x);
        let place = (foot.coords.dot(&side) - shift_m) / spacing_m;
        let gap = (place - 0.5).round() + 0.5;
        Some(foot + side * ((gap - place) * spacing_m) + along * 0.05)
    }
}

/// The lanes of a pattern, broken where there is no room and at the cuts.
pub fn lanes(ground: &Ground, slit: &Slit, cuts: &[Cut], pattern: &Pattern, reach: &Reach) -> Vec<Lane> {
    let mut lanes = Vec::new();
    let sides = corridors(ground, cuts, pattern);
    for k in 0..sides.len() {
        let fence =
            Fence { cuts, cut_m: 0.45 * ground.swath_m, sides: &sides[..k], side_m: 0.25 * ground.swath_m };
        clip(ground, slit, &fence, &sides[k], reach, &mut lanes);
    }
    let fence = Fence { cuts, cut_m: reach.cut_m, sides: &sides, side_m: 0.5 * ground.swath_m };
    for line in &lines(ground, pattern, reach) {
        clip(ground, slit, &fence, line, reach, &mut lanes);
    }
    lanes
}

/// What lanes keep away from besides walls and obstacles.
#[derive(Clone, Copy)]
struct Fence<'a> {
    cuts: &'a [Cut],
    cut_m: f64,
    sides: &'a [Vec<Point>],
    side_m: f64,
}

impl<'a> Fence<'a> {
    /// Cuts and corridors whose boxes a lane comes near.
    fn near(&self, line: &[Point]) -> Vec<Rail<'a>> {
        let (low, high) = bounds(line);
        let cuts = self.cuts.iter().map(|cut| Rail::new(&cut.line, self.cut_m));
        let sides = self.sides.iter().map(|side| Rail::new(side, self.side_m));
        cuts.chain(sides).filter(|rail| rail.may_bar(low, high)).collect()
    }
}

/// A line with the distance to keep from it, and the box of what may be too near.
struct Rail<'a> {
    line: &'a [Point],
    far_m: f64,
    low: Point,
    high: Point,
}

impl<'a> Rail<'a> {
    fn new(line: &'a [Point], far_m: f64) -> Self {
        let (low, high) = bounds(line);
        let far = Vector::new(far_m, far_m).add_scalar(1e-9);
        Self { line, far_m, low: low - far, high: high + far }
    }

    /// Whether anything within a box may be too near.
    fn may_bar(&self, low: Point, high: Point) -> bool {
        self.low.x < high.x && self.high.x > low.x && self.low.y < high.y && self.high.y > low.y
    }

    fn bars(&self, at: Point) -> bool {
        self.may_bar(at, at) && polyline::distance_m(self.line, at) < self.far_m
    }
}

fn bounds(line: &[Point]) -> (Point, Point) {
    let first = line[0];
    line.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)))
}

/// Lines along one side of every cut across the lanes, the same side everywhere, so that what was swept outward is left
/// inward. Beside a cut along the lanes there is a lane anyway.
fn corridors(ground: &Ground, cuts: &[Cut], pattern: &Pattern) -> Vec<Vec<Point>> {
    let last_side = |cut: &Cut| {
        let (a, b) = (cut.line[cut.line.len() - 2], cut.line[cut.line.len() - 1]);
        let ahead = (b - a).try_normalize(1e-9)?;
        let is_across = pattern.ahead().is_none_or(|lane| lane.perp(&ahead).abs() >= ACROSS);
        let aside = Vector::new(-ahead.y, ahead.x) * (ground.swath_m / 2.0);
        is_across.then(|| vec![a + aside, b + aside])
    };
    cuts.iter().filter_map(last_side).collect()
}

/// The unbroken lines of a pattern.
fn lines(ground: &Ground, pattern: &Pattern, reach: &Reach) -> Vec<Vec<Point>> {
    let start_m = ground.keep_m + crate::ground::SLACK_M;
    match *pattern {
        Pattern::Contours => contours(ground, start_m, usize::MAX),
        Pattern::Straight { angle_rad, shift_m, spacing_m, laps } => {
            let mut lines = contours(ground, start_m, laps);
            let edge_m =
                if laps == 0 { start_m } else { start_m + (laps as f64 - reach.lap_share) * ground.swath_m };
            lines.extend(straight(ground, angle_rad, shift_m, spacing_m, edge_m));
            lines
        }
    }
}

/// Lines at even distances from the wall, outermost first.
fn contours(ground: &Ground, start_m: f64, most: usize) -> Vec<Vec<Point>> {
    let offsets = (0..most.min(10_000)).map(|k| start_m + k as f64 * ground.swath_m);
    match &ground.wall {
        Boundary::Circle { radius_m } => {
            let radii = offsets.map(|offset| radius_m - offset).take_while(|r| *r > -0.3 * ground.swath_m);
            radii.map(|r| circle(r.max(0.08))).collect()
        }
        Boundary::Polygon { vertices } => offsets.map_while(|offset| inset(vertices, offset)).collect(),
    }
}

fn circle(radius_m: f64) -> Vec<Point> {
    let n = (TAU * radius_m / CHORD_M).ceil().max(12.0);
    (0..=n as usize).map(|k| Point::origin() + direction(TAU * k as f64 / n) * radius_m).collect()
}

/// A polygon with its edges moved inward, closed; `None` once it is used up. Good for convex walls.
fn inset(vertices: &[Point], offset_m: f64) -> Option<Vec<Point>> {
    let n = vertices.len();
    let moved = |k: usize| {
        let (a, b) = (vertices[k % n], vertices[(k + 1) % n]);
        let along = (b - a).normalize();
        let inward = Vector::new(-along.y, along.x) * offset_m;
        (a + inward, along)
    };
    let mut ring = Vec::with_capacity(n + 1);
    for k in 0..n {
        let ((a, u), (b, v)) = (moved(k + n - 1), moved(k));
        let turn = u.perp(&v);
        let corner = if turn.abs() < 1e-9 { b } else { a + u * ((b - a).perp(&v) / turn) };
        ring.push(corner);
    }
    let is_alive = (0..n).all(|k| (ring[(k + 1) % n] - ring[k]).dot(&moved(k).1) > 0.0);
    ring.push(ring[0]);
    is_alive.then_some(ring)
}

/// Straight lines across the floor no nearer to the wall than `edge_m`.
fn straight(ground: &Ground, angle_rad: f64, shift_m: f64, spacing_m: f64, edge_m: f64) -> Vec<Vec<Point>> {
    let ahead = direction(angle_rad);
    let side = Vector::new(-ahead.y, ahead.x);
    let (low, high) = ground.wall.bounds();
    let middle = halfway(low, high);
    let reach_m = (high - low).norm();
    let first = ((middle.coords.dot(&side) - reach_m / 2.0 - shift_m) / spacing_m).floor() as i64;
    let last = ((middle.coords.dot(&side) + reach_m / 2.0 - shift_m) / spacing_m).ceil() as i64;
    let mut lines = Vec::new();
    for k in first..=last {
        let foot = Point::from(side * (shift_m + k as f64 * spacing_m) + ahead * middle.coords.dot(&ahead));
        let ends = [foot - ahead * reach_m / 2.0, foot + ahead * reach_m / 2.0];
        let line = polyline::resampled(&ends, STEP_M);
        for run in line.split(|p| ground.wall.wall_distance_m(*p) < edge_m - 1e-6).filter(|run| run.len() > 1)
        {
            lines.push(vec![run[0], run[run.len() - 1]]);
        }
    }
    lines
}

fn halfway(a: Point, b: Point) -> Point {
    a + (b - a) / 2.0
}

/// Adds the pieces of a line that can be driven.
fn clip(
    ground: &Ground,
    slit: &Slit,
    fence: &Fence<'_>,
    line: &[Point],
    reach: &Reach,
    lanes: &mut Vec<Lane>,
) {
    let near = fence.near(line);
    let is_open = |at: Point| {
        !near.iter().any(|rail| rail.bars(at))
            && ground.room.spare_m(at) >= crate::ground::SLACK_M / 2.0
            && slit.contains(at)
    };
    let fine = polyline::resampled(line, STEP_M);
    let open: Vec<bool> = fine.iter().map(|p| is_open(*p)).collect();
    let is_loop = line.len() > 2 && (line[0] - line[line.len() - 1]).norm() < 1e-9;
    let n = fine.len();
    // A ring begins behind a break, so that no lane is broken where the ring was closed.
    let start = if is_loop { (0..n - 1).find(|k| !open[*k]).unwrap_or(0) } else { 0 };
    let around: Vec<usize> =
        if is_loop { (0..n).map(|k| (start + k) % (n - 1)).collect() } else { (0..n).collect() };
    for run in around.split(|k| !open[*k]).filter(|run| !run.is_empty()) {
        let mut points: Vec<Point> = run.iter().map(|k| fine[*k]).collect();
        let beyond = |k: usize, step: isize| {
            let at = around.iter().position(|other| *other == k)?.checked_add_signed(step)?;
            around.get(at).map(|other| fine[*other])
        };
        if let Some(out) = beyond(run[0], -1) {
            points.insert(0, last_open(points[0], out, &is_open));
        }
        if let Some(out) = beyond(run[run.len() - 1], 1) {
            points.push(last_open(points[points.len() - 1], out, &is_open));
        }
        let points = thinned(&points);
        if polyline::length_m(&points) >= reach.least_m {
            lanes.push(Lane { points });
        }
    }
}

/// The last open place between an open and a closed one.
fn last_open(open: Point, closed: Point, is_open: &dyn Fn(Point) -> bool) -> Point {
    let (mut from, mut to) = (0.0, 1.0);
    for _ in 0..7 {
        let middle = f64::midpoint(from, to);
        if is_open(open + (closed - open) * middle) {
            from = middle;
        } else {
            to = middle;
        }
    }
    open + (closed - open) * from
}

/// The same line with fewer points: none further than two millimetres from it.
pub fn thinned(points: &[Point]) -> Vec<Point> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut kept = vec![points[0]];
    let mut from = 0;
    while from + 1 < points.len() {
        let mut to = from + 1;
        while to + 1 < points.len() && (to + 1 - from) < 40 && is_straight(&points[from..=to + 1]) {
            to += 1;
        }
        kept.push(points[to]);
        from = to;
    }
    kept
}

fn is_straight(run: &[Point]) -> bool {
    let (a, b) = (run[0], run[run.len() - 1]);
    run.iter().all(|p| (p - polyline::nearest_on_segment(a, b, *p)).norm() < 1e-3)
}
