//! Finds the way out of a trap formed by the tank's outline: straight towards the goal, and along whatever stands in
//! the way.
//!
//! Xu et al. 2022 consider only free-standing obstacles. The tank's outline encloses the robot and its goal: it has no
//! mouth to seal and no circle to go around. So the robot follows the outline of whatever stops it. It leaves the
//! outline where it is closer to the goal than ever before and nothing stops it there. That method reaches the goal if
//! a path exists (Class1 in Ng and Bräunl 2007, after Lumelsky and Stepanov 1987).

use crate::{
    clusters::{Clusters, gap_m},
    mouth::{LAST_VIRTUAL, is_virtual},
};
use geometry::convex::Part;
use nalgebra::Rotation2;
use std::{
    collections::BTreeSet,
    f64::consts::{PI, TAU},
};
use steering::{KnownMap, Nearby, Side, Solid};
use world::{Boundary, Point, Vector, polyline::edges};

/// Number of edges of a round wall: in a tank of 10 m they are at most 1 mm inside the circle.
const ROUND_EDGES: u32 = 256;
/// Id of the edges of the wall. Ids of obstacles count up; ids of no-go zones count down from the largest number.
const WALL: u32 = LAST_VIRTUAL;

/// The robot detects outlines within the distance to keep plus this distance, metres.
const HAND_M: f64 = 0.2;
/// Angle from its last move by which the robot turns back if it detects no outline, radians.
const HAND_RAD: f64 = 0.6 * PI;
/// Number of directions tried.
const DIRECTIONS: u32 = 96;
/// Difference between distances to the goal up to which they count as equal, metres.
const ROUNDING_M: f64 = 1e-9;
/// Distance without progress, as a multiple of the length of all outlines, after which the robot gives up in any case.
const ROUNDS: f64 = 2.0;
/// Distance without progress, metres, after which a return to the point closest to the goal means that the robot has
/// gone all the way around.
const ROUND_LEAST_M: f64 = 1.0;

/// The outlines of all real solids on the floor and of the wall.
#[derive(Debug, Clone)]
pub struct Outline {
    /// The solids and the edges of the wall.
    map: KnownMap,
    nearby: Nearby,
    /// Obstacles with no passage to the wall, directly or through their clusters.
    held: BTreeSet<u32>,
    length_m: f64,
}

impl Outline {
    /// Creates the outlines of a map whose solids are clustered with a margin. `reach_m` is the largest distance at
    /// which a robot that keeps its distance looks for outlines, metres.
    pub fn new(map: &KnownMap, clusters: &Clusters, margin_m: f64, reach_m: f64) -> Self {
        let walls = edges_of(&map.wall);
        let passage_m = 2.0 * (map.hull_m + margin_m);
        let real = || map.solids.iter().filter(|solid| !is_virtual(solid));
        let touching =
            real().filter(|solid| walls.iter().any(|wall| gap_m(solid, wall, passage_m) < passage_m));
        let ids = touching.map(|solid| solid.id).collect();
        let held = clusters.closure(map, &ids).into_iter().map(|index| map.solids[index].id).collect();
        let solids: Vec<Solid> = real().cloned().chain(walls).collect();
        let length_m = solids.iter().map(|solid| round_m(solid, map.hull_m + margin_m)).sum();
        let map = KnownMap { solids, wall: map.wall.clone(), hull_m: map.hull_m };
        Self { map, nearby: Nearby::new(reach_m + HAND_M), held, length_m }
    }

    /// The edges of the wall.
    pub fn walls(&self) -> impl Iterator<Item = &Solid> {
        self.map.solids.iter().filter(|solid| solid.id == WALL)
    }

    /// Whether an obstacle is connected to the wall.
    pub fn holds(&self, id: u32) -> bool {
        self.held.contains(&id)
    }

    /// A lower bound for the length of all outlines, metres.
    pub fn length_m(&self) -> f64 {
        self.length_m
    }

    /// The distance from a position to the nearest outline, metres.
    fn distance_m(&self, at: Point) -> f64 {
        self.map.clearance_m(at) + self.map.hull_m
    }

    /// Unit vectors away from all outlines within this distance, metres.
    fn ways_out(&mut self, at: Point, reach_m: f64) -> impl Iterator<Item = Vector> + '_ {
        let (map, nearby) = (&self.map, &mut self.nearby);
        let near = nearby.update(map, at).iter().map(move |index| map.solids[*index].distance(at));
        near.filter(move |(distance_m, _)| *distance_m < reach_m).map(|(_, away)| away)
    }

    /// Returns a test for steps of a given length from a position. A step passes if it keeps a given distance from
    /// every outline, or leads away from the outlines that are closer. Length and distance are in metres.
    fn steps(&mut self, at: Point, step_m: f64, keep_m: f64) -> impl Fn(&Vector) -> bool + use<'_> {
        let (map, nearby) = (&self.map, &mut self.nearby);
        let near = nearby.update(map, at).iter().map(|index| &map.solids[*index]);
        let reach_m = keep_m + step_m + ROUNDING_M;
        let near =
            near.map(|solid| (solid, solid.distance(at).0)).filter(|(_, before_m)| *before_m < reach_m);
        let near: Vec<(&Solid, f64)> = near.collect();
        let enough_m = keep_m - ROUNDING_M;
        move |way| {
            let to = at + way * step_m;
            near.iter().all(|(solid, before_m)| {
                let leads_away = || *before_m < enough_m && solid.distance(to).0 > *before_m;
                solid.segment_distance_m(at, to, keep_m) >= enough_m || leads_away()
            })
        }
    }
}

/// The edges of a wall as solids without thickness.
fn edges_of(wall: &Boundary) -> Vec<Solid> {
    let corners = match wall {
        Boundary::Polygon { vertices } => vertices.clone(),
        Boundary::Circle { radius_m } => {
            let bearing_rad = |k: u32| TAU * f64::from(k) / f64::from(ROUND_EDGES);
            (0..ROUND_EDGES)
                .map(|k| Point::from(Rotation2::new(bearing_rad(k)) * Vector::x() * *radius_m))
                .collect()
        }
    };
    edges(&corners).map(|(a, b)| Solid::new(WALL, Part::segment(a, b))).collect()
}

/// The length of the path around a solid at a given distance from it, metres.
fn round_m(solid: &Solid, distance_m: f64) -> f64 {
    let corners: Vec<Point> = solid.corners().iter().map(|(corner, _)| *corner).collect();
    let widest_m = solid.corners().iter().map(|(_, radius_m)| *radius_m).fold(0.0, f64::max);
    edges(&corners).map(|(a, b)| (b - a).norm()).sum::<f64>() + TAU * (widest_m + distance_m)
}

/// Distance from its last choice of side at which the robot, on meeting an obstacle, chooses the side again, metres.
const CHOICE_M: f64 = 1.0;

/// A robot that follows outlines.
#[derive(Debug, Clone)]
pub struct Follow {
    /// The side on which the robot passes an obstacle that stops it.
    pub side: Side,
    keep_m: f64,
    /// The direction of the last move, while the robot follows an outline.
    along: Option<Vector>,
    /// The position at which the robot last chose a side.
    pub met: Option<Point>,
    nearest_m: f64,
    /// The position closest to the goal so far, and the move from there.
    nearest: Option<(Point, Vector)>,
    without_gain_m: f64,
}

impl Follow {
    /// Starts towards a goal. The robot's centre keeps as much distance from every outline as the goal has, within the
    /// two given limits, metres.
    pub fn new(goal: Point, outline: &Outline, side: Side, least_m: f64, most_m: f64) -> Self {
        let keep_m = outline.distance_m(goal).clamp(least_m, most_m);
        Self {
            side,
            keep_m,
            along: None,
            met: None,
            nearest_m: f64::INFINITY,
            nearest: None,
            without_gain_m: 0.0,
        }
    }

    /// The next move, at most one step long, metres; `None` if there is no path.
    pub fn step(&mut self, at: Point, goal: Point, outline: &mut Outline, step_m: f64) -> Option<Vector> {
        let missing_m = (goal - at).norm();
        let Some(ahead) = (goal - at).try_normalize(1e-12) else { return Some(Vector::zeros()) };
        // Steps are shorter than the distance to keep, so that the robot stays on the same outline.
        let step_m = step_m.min(self.keep_m / 2.0).min(missing_m);
        let is_nearer = missing_m < self.nearest_m - ROUNDING_M;
        self.without_gain_m = if is_nearer { 0.0 } else { self.without_gain_m + step_m };
        self.nearest_m = self.nearest_m.min(missing_m);
        if self.without_gain_m > ROUNDS * outline.length_m() || self.has_gone_round(at, step_m) {
            return None;
        }
        let first = self.along.map_or(ahead, |way| self.hand(at, way, outline));
        let keep_m = self.keep_m;
        let is_free = outline.steps(at, step_m, keep_m);
        if (is_nearer || self.along.is_none()) && is_free(&ahead) {
            self.along = None;
            return Some(ahead * step_m);
        }
        let mut tried =
            (0..DIRECTIONS).map(|k| self.turned(first, TAU * f64::from(k) / f64::from(DIRECTIONS)));
        let way = tried.find(|way| is_free(way))?;
        self.along = Some(way);
        if is_nearer {
            self.nearest = Some((at, way));
        }
        Some(way * step_m)
    }

    /// Whether the robot is back at its closest position to the goal and moving the same way.
    fn has_gone_round(&self, at: Point, step_m: f64) -> bool {
        let Some(((place, way), along)) = self.nearest.zip(self.along) else { return false };
        let is_there = (place - at).norm() < 2.0 * step_m && way.dot(&along) > 0.5;
        self.without_gain_m > ROUND_LEAST_M && is_there
    }

    /// Whether the step since `before` met an obstacle that requires a new choice of side.
    pub fn meets_something(&self, before: &Self, at: Point) -> bool {
        let is_far = self.met.is_none_or(|met| (met - at).norm() > CHOICE_M);
        self.along.is_some() && before.along.is_none() && is_far
    }

    /// The direction towards the outline that the robot follows: of the outlines within reach, the one that best
    /// matches the last move.
    fn hand(&self, at: Point, way: Vector, outline: &mut Outline) -> Vector {
        let share = |away: &Vector| self.side.along(*away).dot(&way);
        let out = outline.ways_out(at, self.keep_m + HAND_M).max_by(|a, b| share(a).total_cmp(&share(b)));
        out.map_or_else(|| self.turned(way, -HAND_RAD), |away| -away)
    }

    /// A direction turned by an angle away from the outline, radians.
    fn turned(&self, way: Vector, angle_rad: f64) -> Vector {
        Rotation2::new(self.side.sign() * angle_rad) * way
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::polyline;

    fn outline(corners: &[(f64, f64)]) -> Outline {
        let vertices = corners.iter().map(|(x, y)| Point::new(*x, *y)).collect();
        let map = KnownMap { solids: vec![], wall: Boundary::Polygon { vertices }, hull_m: 0.25 };
        Outline::new(&map, &Clusters::new(&map, 0.1), 0.1, 0.5)
    }

    fn walked(corners: &[(f64, f64)], start: Point, goal: Point, side: Side) -> (Vec<Point>, f64) {
        let mut outline = outline(corners);
        let mut follow = Follow::new(goal, &outline, side, 0.27, 0.35);
        let mut path = vec![start];
        while let Some(step) = follow.step(path[path.len() - 1], goal, &mut outline, 0.05) {
            path.push(path[path.len() - 1] + step);
            if (goal - path[path.len() - 1]).norm() < 0.01 {
                break;
            }
        }
        let least_m = path.iter().map(|at| outline.distance_m(*at)).fold(f64::INFINITY, f64::min);
        (path, least_m)
    }

    /// A floor of 8 m by 6 m with a wall of 4 m between two halves.
    const SPUR: [(f64, f64); 8] =
        [(0.0, 0.0), (3.9, 0.0), (3.9, 4.0), (4.1, 4.0), (4.1, 0.0), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0)];

    #[test]
    fn both_hands_lead_round_a_wall_that_hangs_on_the_outline() {
        let (start, goal) = (Point::new(1.0, 1.0), Point::new(7.0, 1.0));
        for (side, most_m) in [(Side::Left, 14.0), (Side::Right, 30.0)] {
            let (path, least_m) = walked(&SPUR, start, goal, side);
            assert!((goal - path[path.len() - 1]).norm() < 0.01, "{side:?}");
            assert!(least_m > 0.35 - 1e-6, "{side:?} {least_m}");
            assert!(polyline::length_m(&path) < most_m, "{side:?} {}", polyline::length_m(&path));
        }
    }

    #[test]
    fn without_a_way_it_goes_round_and_ends() {
        let closed =
            [(0.0, 0.0), (3.9, 0.0), (3.9, 5.5), (4.1, 5.5), (4.1, 0.0), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0)];
        let (path, _) = walked(&closed, Point::new(1.0, 1.0), Point::new(7.0, 1.0), Side::Left);
        assert!(path.iter().all(|at| at.x < 4.0));
    }

    #[test]
    fn a_passage_little_wider_than_what_is_kept_is_gone_through() {
        // 0.72 m wide, of which 0.70 are kept.
        let door = [
            (0.0, 0.0),
            (3.9, 0.0),
            (3.9, 5.28),
            (6.1, 5.28),
            (6.1, 0.0),
            (9.0, 0.0),
            (9.0, 6.0),
            (0.0, 6.0),
        ];
        let goal = Point::new(8.0, 1.0);
        for side in [Side::Left, Side::Right] {
            let (path, least_m) = walked(&door, Point::new(1.0, 1.0), goal, side);
            assert!((goal - path[path.len() - 1]).norm() < 0.01, "{side:?}");
            assert!(least_m > 0.35 - 1e-6);
        }
    }

    #[test]
    fn obstacles_without_a_passage_to_the_wall_hang_on_it() {
        let disc = |id: u32, x: f64| Solid::disc(id, Point::new(x, 3.0), 0.3);
        let corners = SPUR.iter().map(|(x, y)| Point::new(*x, *y)).collect();
        let solids = vec![disc(1, 0.5), disc(2, 1.3), disc(3, 2.8)];
        let map = KnownMap { solids, wall: Boundary::Polygon { vertices: corners }, hull_m: 0.25 };
        let outline = Outline::new(&map, &Clusters::new(&map, 0.1), 0.1, 0.5);
        assert_eq!([1, 2, 3].map(|id| outline.holds(id)), [true, true, false]);
    }
}
