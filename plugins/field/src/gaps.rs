//! Which way round: what blocks the way, the gaps beside it that are too narrow, and the side of the smaller detour.
//!
//! Wang et al. 2023 turn counter-clockwise about single points, which pushes back at half of them and cancels between
//! two. Here obstacles that leave no passage between them, or to the wall, are gone round as one.

use crate::{body::Body, laws::Sense};
use geometry::convex::{Part, crossing};
use std::collections::BTreeSet;
use world::{Point, Vector, geometry::wrap_angle_rad, polyline::nearest_on_segment};

/// The way is looked at this far ahead, metres.
const AHEAD_M: f64 = 2.5;
/// Obstacles further from the hull than this are not looked at, metres.
const HORIZON_M: f64 = 4.0;
/// Never more obstacles than this, the nearest ones, are looked at.
const MOST_BODIES: usize = 48;
/// A side is kept for this long after the way has become free, seconds.
const KEPT_S: f64 = 2.0;
/// A way blocked by less than this share of the guard distance counts as free: the guard slides past.
const BLOCKING_SHARE: f64 = 0.7;

/// What the steering looks at in one tick.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    /// Mission time, seconds.
    pub t_s: f64,
    /// Where the robot believes to be.
    pub at: Point,
    /// Where it looks, radians.
    pub heading_rad: f64,
    /// Where it is bound.
    pub target: Point,
    /// Coming this near to the target is enough, metres: preset points pass obstacles closely.
    pub near_enough_m: f64,
    /// What it senses.
    pub bodies: &'a [Body],
    /// The wall.
    pub wall: &'a world::Boundary,
    /// Radius of the hull, metres.
    pub hull_m: f64,
    /// Distance the guard keeps between hull and anything solid, metres.
    pub keep_m: f64,
}

/// What to go round, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Detour {
    /// The obstacles to go round as one.
    pub members: BTreeSet<u32>,
    /// Lines that close the narrow gaps between them.
    pub closed: Vec<(Point, Point)>,
    /// Which way round.
    pub sense: Sense,
}

/// Chooses the side once for every group of obstacles that blocks the way.
#[derive(Debug, Clone, Default)]
pub struct GapSteering {
    kept: Option<Kept>,
}

#[derive(Debug, Clone)]
struct Kept {
    members: BTreeSet<u32>,
    sense: Sense,
    seen_s: f64,
    /// Whether a wall was taken into account; after that the side is not changed again on its account, for what is
    /// left and right of the way changes as the robot goes round.
    knows_wall: bool,
}

impl GapSteering {
    /// What blocks the way to the target now, if anything, and which way round to go.
    pub fn update(&mut self, view: &View<'_>) -> Option<Detour> {
        self.kept = self.kept.take().filter(|kept| view.t_s - kept.seen_s < KEPT_S);
        let group = Group::blocking(view)?;
        let sense = self.sense(&group, view);
        let same = self.kept.as_ref().is_some_and(|kept| kept.knows_wall && kept.concerns(&group));
        let knows_wall = same || group.left_closed || group.right_closed;
        self.kept = Some(Kept { members: group.members.clone(), sense, seen_s: view.t_s, knows_wall });
        Some(Detour { members: group.members, closed: group.closed, sense })
    }

    /// Tries the other side: this one led nowhere.
    pub fn flip(&mut self) {
        if let Some(kept) = &mut self.kept {
            kept.sense = kept.sense.reversed();
        }
    }

    fn sense(&self, group: &Group, view: &View<'_>) -> Sense {
        let kept = self.kept.as_ref().filter(|kept| kept.concerns(group));
        let Some(kept) = kept else { return group.shorter_side(view) };
        let leads_nowhere = group.is_closed(kept.sense) && !group.is_closed(kept.sense.reversed());
        if leads_nowhere && !kept.knows_wall { kept.sense.reversed() } else { kept.sense }
    }
}

impl Kept {
    fn concerns(&self, group: &Group) -> bool {
        !self.members.is_disjoint(&group.members)
    }
}

/// Obstacles that leave no passage between them.
#[derive(Debug, Clone, Default)]
struct Group {
    members: BTreeSet<u32>,
    closed: Vec<(Point, Point)>,
    corners: Vec<(Point, f64)>,
    left_closed: bool,
    right_closed: bool,
}

/// A passage too narrow, between two bodies or, without a second one, between a body and the wall.
struct Narrow {
    first: usize,
    second: Option<usize>,
    line: (Point, Point),
}

impl Group {
    fn blocking(view: &View<'_>) -> Option<Self> {
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
        let mut group = Self::default();
        for passage in narrow.iter().filter(|n| members.contains(&n.first)) {
            group.closed.push(passage.line);
            if passage.second.is_none() {
                group.close_side(view, passage.line.1);
            }
        }
        for body in members.iter().map(|index| bodies[*index]) {
            group.members.insert(body.id);
            group.corners.extend(body.parts.iter().flat_map(Part::corners));
        }
        Some(group)
    }

    /// The group touches the wall there, so that side leads nowhere.
    fn close_side(&mut self, view: &View<'_>, wall: Point) {
        if (view.target - view.at).perp(&(wall - view.at)) > 0.0 {
            self.left_closed = true;
        } else {
            self.right_closed = true;
        }
    }

    /// Whether going round this way ends at the wall.
    fn is_closed(&self, sense: Sense) -> bool {
        if sense == Sense::Clockwise { self.left_closed } else { self.right_closed }
    }

    /// The side on which less has to be turned away from the target, the present heading weighing a little.
    fn shorter_side(&self, view: &View<'_>) -> Sense {
        let bearing_rad = bearing(view.target - view.at);
        let room_m = view.hull_m + view.keep_m;
        let (mut left_rad, mut right_rad) = (0.0_f64, 0.0_f64);
        for (corner, radius_m) in &self.corners {
            let to_corner = corner - view.at;
            let half_rad = ((radius_m + room_m) / to_corner.norm().max(1e-9)).min(1.0).asin();
            let off_rad = wrap_angle_rad(bearing(to_corner) - bearing_rad);
            left_rad = left_rad.max(off_rad + half_rad);
            right_rad = right_rad.max(half_rad - off_rad);
        }
        let heading_rad = wrap_angle_rad(view.heading_rad - bearing_rad).clamp(-1.0, 1.0);
        let penalty = |closed: bool| if closed { 10.0 } else { 0.0 };
        let left = left_rad - 0.3 * heading_rad + penalty(self.is_closed(Sense::Clockwise));
        let right = right_rad + 0.3 * heading_rad + penalty(self.is_closed(Sense::CounterClockwise));
        if left <= right { Sense::Clockwise } else { Sense::CounterClockwise }
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
        .bodies
        .iter()
        .map(|body| (body.hull_distance_m(view.at, view.hull_m), body))
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

/// From the corner of a body that is nearest to the wall to the wall, if no passage is left there.
fn narrow_to_wall(wall: &world::Boundary, body: &Body, room_m: f64) -> Option<(Point, Point)> {
    let corners = body.parts.iter().flat_map(Part::corners);
    let gaps = corners.map(|(corner, radius_m)| (wall.wall_distance_m(corner) - radius_m, corner));
    let (width_m, corner) = gaps.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (width_m < room_m).then(|| (corner, nearest_on_wall(wall, corner)))
}

fn nearest_on_wall(wall: &world::Boundary, point: Point) -> Point {
    match wall {
        world::Boundary::Circle { radius_m } => {
            Point::from(point.coords.try_normalize(1e-9).unwrap_or_else(Vector::x) * *radius_m)
        }
        world::Boundary::Polygon { vertices } => vertices
            .iter()
            .zip(vertices.iter().cycle().skip(1))
            .map(|(a, b)| nearest_on_segment(*a, *b, point))
            .min_by(|a, b| (a - point).norm().total_cmp(&(b - point).norm()))
            .unwrap_or(point),
    }
}

/// The body nearest to the robot that stands in the way, or belongs to a closed gap that the way leads through.
fn blocker(view: &View<'_>, bodies: &[&Body], narrow: &[Narrow]) -> Option<usize> {
    let way = view.target - view.at;
    let end = view.at + way.cap_magnitude((way.norm() - view.near_enough_m).clamp(0.0, AHEAD_M));
    let room_m = view.hull_m + BLOCKING_SHARE * view.keep_m;
    let in_way = bodies.iter().position(|body| body.segment_distance_m(view.at, end) < room_m);
    let across =
        narrow.iter().filter(|n| crossing(view.at, end, n.line.0, n.line.1).is_some()).map(|n| n.first);
    // Bodies are sorted by distance, so the smaller index is the nearer one.
    across.chain(in_way).min()
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_api::Outline;

    fn columns(places: &[(f64, f64)]) -> Vec<Body> {
        let column = |(id, (x, y)): (usize, &(f64, f64))| {
            let outline = Outline::Disc { center: Point::new(*x, *y), radius_m: 0.2 };
            Body::new(id as u32, &outline).expect("a disc has extent")
        };
        places.iter().enumerate().map(column).collect()
    }

    const WALL: world::Boundary = world::Boundary::Circle { radius_m: 10.0 };

    fn northward(bodies: &[Body], at: Point) -> View<'_> {
        let heading_rad = std::f64::consts::FRAC_PI_2;
        let target = at + Vector::new(0.0, 2.0);
        View {
            t_s: 0.0,
            at,
            heading_rad,
            target,
            near_enough_m: 0.0,
            bodies,
            wall: &WALL,
            hull_m: 0.25,
            keep_m: 0.1,
        }
    }

    #[test]
    fn a_free_way_needs_no_detour() {
        let bodies = columns(&[(1.0, 1.0)]);
        assert_eq!(GapSteering::default().update(&northward(&bodies, Point::origin())), None);
    }

    #[test]
    fn it_passes_on_the_side_of_the_smaller_detour() {
        let bodies = columns(&[(0.1, 1.0)]);
        let detour = GapSteering::default().update(&northward(&bodies, Point::origin())).expect("blocked");
        // The column stands a little to the right, so it stays on the right hand.
        assert_eq!(detour.sense, Sense::Clockwise);
    }

    #[test]
    fn columns_without_a_passage_are_gone_round_as_one() {
        let bodies = columns(&[(-0.4, 1.0), (0.4, 1.0), (1.3, 1.0), (4.0, 1.0)]);
        let detour = GapSteering::default().update(&northward(&bodies, Point::origin())).expect("blocked");
        assert_eq!(detour.members, BTreeSet::from([0, 1, 2]));
        assert_eq!((detour.closed.len(), detour.sense), (2, Sense::Clockwise));
    }

    #[test]
    fn no_detour_leads_between_a_column_and_the_wall() {
        // The smaller detour would be on the right, where the wall is.
        let bodies = columns(&[(9.2, 1.0)]);
        let detour =
            GapSteering::default().update(&northward(&bodies, Point::new(9.3, 0.0))).expect("blocked");
        assert_eq!(detour.sense, Sense::Clockwise);
    }

    #[test]
    fn a_side_is_kept_until_it_is_flipped() {
        let bodies = columns(&[(0.1, 1.0)]);
        let mut steering = GapSteering::default();
        steering.update(&northward(&bodies, Point::origin()));
        let moved = northward(&bodies, Point::new(0.2, 0.0));
        assert_eq!(steering.update(&moved).map(|d| d.sense), Some(Sense::Clockwise));
        steering.flip();
        assert_eq!(steering.update(&moved).map(|d| d.sense), Some(Sense::CounterClockwise));
    }
}
