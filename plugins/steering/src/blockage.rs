//! Finds what blocks the path. Obstacles with no passage between them, or to the wall, are treated as one.

use crate::{body::Body, side::Side, tick::Tick};
use geometry::{
    Boundary, Point, Vector,
    convex::{Part, crossing},
    direction_or,
    polyline::{edges, nearest_on_segment},
    wrap_angle_rad,
};
use std::collections::BTreeSet;

/// Distance ahead within which the path is examined, metres.
const AHEAD_M: f64 = 2.5;
/// Distance from the hull beyond which obstacles are ignored, metres.
const HORIZON_M: f64 = 4.0;
/// Maximum number of obstacles considered, nearest first.
const MOST_BODIES: usize = 48;
/// Share of the guard distance within which an obstacle beside the path blocks it. At a larger distance, the guard lets
/// the robot slide past.
const BLOCKING_SHARE: f64 = 0.7;
/// Length of the last part of the path to a preset point, which need not be free, metres. Preset paths pass close to
/// obstacles, and the mission looks half a metre ahead.
const PASSING_M: f64 = 0.35;

/// The surroundings in one tick, and the clearance that the hull needs.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    /// The robot's pose, its target and the bodies it senses.
    pub tick: &'a Tick<'a>,
    /// The wall.
    pub wall: &'a Boundary,
    /// Radius of the hull, metres.
    pub hull_m: f64,
    /// Distance that the guard keeps between the hull and any solid, metres.
    pub keep_m: f64,
}

/// A group of obstacles with no passage between them, at least one of which blocks the path.
#[derive(Debug, Clone, Default)]
pub(crate) struct Blockage {
    /// Ids of the obstacles.
    pub members: BTreeSet<u32>,
    /// Lines that close the narrow gaps between the obstacles.
    pub closed: Vec<(Point, Point)>,
    corners: Vec<(Point, f64)>,
    /// The sides on which a detour would end at the wall.
    pub dead_ends: Vec<Side>,
}

/// A passage that is too narrow: between two bodies, or between one body and the wall if there is no second body.
struct Narrow {
    first: usize,
    second: Option<usize>,
    line: (Point, Point),
}

impl View<'_> {
    fn at(&self) -> Point {
        self.tick.pose.position
    }

    /// The vector from the robot to its target.
    fn way(&self) -> Vector {
        self.tick.target - self.at()
    }
}

impl Blockage {
    /// Finds what blocks the path to the target, if anything.
    pub(crate) fn of(view: &View<'_>) -> Option<Self> {
        let bodies = nearest_bodies(view);
        let narrow = narrow_passages(view, &bodies);
        let seed = blocker(view, &bodies, &narrow)?;
        let mut members = BTreeSet::from([seed]);
        let mut open = vec![seed];
        while let Some(body) = open.pop() {
            for other in narrow.iter().filter_map(|n| n.other_end(body)) {
                if members.insert(other) {
                    open.push(other);
                }
            }
        }
        let mut blockage = Self::default();
        for passage in narrow.iter().filter(|n| members.contains(&n.first)) {
            blockage.closed.push(passage.line);
            if passage.second.is_none() {
                let is_left = view.way().perp(&(passage.line.1 - view.at())) > 0.0;
                blockage.dead_ends.push(if is_left { Side::Left } else { Side::Right });
            }
        }
        for body in members.iter().map(|index| bodies[*index]) {
            blockage.members.insert(body.id);
            blockage.corners.extend(body.parts.iter().flat_map(Part::corners));
        }
        Some(blockage)
    }

    /// The side that requires the smaller turn away from the target; the current heading has a small weight.
    pub(crate) fn shorter_side(&self, view: &View<'_>) -> Side {
        let bearing_rad = bearing(view.way());
        let room_m = view.hull_m + view.keep_m;
        let (mut left_rad, mut right_rad) = (0.0_f64, 0.0_f64);
        for (corner, radius_m) in &self.corners {
            let to_corner = corner - view.at();
            let half_rad = ((radius_m + room_m) / to_corner.norm().max(1e-9)).min(1.0).asin();
            let off_rad = wrap_angle_rad(bearing(to_corner) - bearing_rad);
            left_rad = left_rad.max(off_rad + half_rad);
            right_rad = right_rad.max(half_rad - off_rad);
        }
        let heading_rad = wrap_angle_rad(view.tick.pose.heading_rad - bearing_rad).clamp(-1.0, 1.0);
        let penalty = |side: Side| if self.dead_ends.contains(&side) { 10.0 } else { 0.0 };
        let left = left_rad - 0.3 * heading_rad + penalty(Side::Left);
        let right = right_rad + 0.3 * heading_rad + penalty(Side::Right);
        if left <= right { Side::Left } else { Side::Right }
    }
}

impl Narrow {
    fn other_end(&self, body: usize) -> Option<usize> {
        match self.second {
            Some(second) if self.first == body => Some(second),
            Some(second) if second == body => Some(self.first),
            _ => None,
        }
    }
}

fn bearing(vector: Vector) -> f64 {
    vector.y.atan2(vector.x)
}

fn nearest_bodies<'a>(view: &View<'a>) -> Vec<&'a Body> {
    let mut near: Vec<(f64, &Body)> = view
        .tick
        .bodies
        .iter()
        .map(|body| (body.hull_distance_m(view.at(), view.hull_m), body))
        .filter(|(distance_m, _)| *distance_m < HORIZON_M)
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.id.cmp(&b.1.id)));
    near.truncate(MOST_BODIES);
    near.into_iter().map(|(_, body)| body).collect()
}

fn narrow_passages(view: &View<'_>, bodies: &[&Body]) -> Vec<Narrow> {
    let room_m = 2.0 * (view.hull_m + view.keep_m);
    let mut narrow = Vec::new();
    for (first, body) in bodies.iter().enumerate() {
        for (offset, other) in bodies[first + 1..].iter().enumerate() {
            if let Some(gap) = body.gap(other).filter(|gap| gap.width_m < room_m) {
                let second = Some(first + 1 + offset);
                narrow.push(Narrow { first, second, line: (gap.from, gap.to) });
            }
        }
        if let Some(line) = narrow_to_wall(view.wall, body, room_m) {
            narrow.push(Narrow { first, second: None, line });
        }
    }
    narrow
}

/// If the gap between a body and the wall is too narrow, returns the line across the gap, from the body's corner
/// nearest to the wall.
fn narrow_to_wall(wall: &Boundary, body: &Body, room_m: f64) -> Option<(Point, Point)> {
    let corners = body.parts.iter().flat_map(Part::corners);
    let gaps = corners.map(|(corner, radius_m)| (wall.wall_distance_m(corner) - radius_m, corner));
    let (width_m, corner) = gaps.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (width_m < room_m).then(|| (corner, nearest_on_wall(wall, corner)))
}

fn nearest_on_wall(wall: &Boundary, point: Point) -> Point {
    match wall {
        Boundary::Circle { radius_m } => Point::from(direction_or(point.coords, Vector::x()) * *radius_m),
        Boundary::Polygon { vertices } => edges(vertices)
            .map(|(a, b)| nearest_on_segment(a, b, point))
            .min_by(|a, b| (a - point).norm().total_cmp(&(b - point).norm()))
            .unwrap_or(point),
    }
}

/// The body nearest to the robot that blocks the path, or that borders a closed gap on the path.
fn blocker(view: &View<'_>, bodies: &[&Body], narrow: &[Narrow]) -> Option<usize> {
    let (at, way) = (view.at(), view.way());
    let near_enough_m = if view.tick.is_last { 0.0 } else { PASSING_M };
    let end = at + way.cap_magnitude((way.norm() - near_enough_m).clamp(0.0, AHEAD_M));
    let room_m = view.hull_m + BLOCKING_SHARE * view.keep_m;
    let in_way = bodies.iter().position(|body| body.segment_distance_m(at, end) < room_m);
    let across = narrow.iter().filter(|n| crossing(at, end, n.line.0, n.line.1).is_some()).map(|n| n.first);
    // Bodies are sorted by distance, so the smaller index is the nearer one.
    across.chain(in_way).min()
}
