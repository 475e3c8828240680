//! The path of sound from the robot to a station.

use crate::{config::BehindColumns, sight::outline_points};
use geometry::{polyline::edges, unit_vector};
use std::f64::consts::TAU;
use world::{Boundary, Obstacle, ObstacleMap, Point, Vector, World};

/// Distance, metres, within which a ray counts as having reached a station: a station may be mounted on a column.
const REACHED_M: f64 = 1e-3;
/// Number of points on a round wall at which an echo is sought.
const WALL_POINTS: u32 = 720;
/// Distance from a station, metres, within which a reflected echo counts as the direct sound.
const OWN_WALL_M: f64 = 0.1;

/// A path of sound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SoundPath {
    /// Length of the path, metres.
    pub length_m: f64,
    /// Whether an extra delay is added to the path.
    pub is_late: bool,
}

/// The wall and the obstacles that affect the propagation of sound.
#[derive(Clone)]
pub(crate) struct Propagation {
    boundary: Boundary,
    all: ObstacleMap,
    /// Each obstacle on its own, with points on its outline.
    single: Vec<(ObstacleMap, Vec<Point>)>,
}

impl Propagation {
    pub(super) fn new(world: &World) -> Self {
        let map = |obstacles: &[Obstacle]| ObstacleMap::new(&world.boundary, obstacles);
        let alone = |o: &Obstacle| (map(std::slice::from_ref(o)), outline_points(&o.shape));
        Self {
            boundary: world.boundary.clone(),
            all: map(&world.obstacles),
            single: world.obstacles.iter().map(alone).collect(),
        }
    }

    /// The path from a robot to a station; `None` if nothing is heard.
    pub(super) fn path(&self, from: Point, to: Point, behind: BehindColumns) -> Option<SoundPath> {
        let direct_m = (to - from).norm();
        if behind == BehindColumns::Heard || !is_blocked(&self.all, from, to) {
            return Some(SoundPath { length_m: direct_m, is_late: false });
        }
        let (length_m, is_late) = match behind {
            BehindColumns::Silent => return None,
            BehindColumns::WallEcho => (self.echo_m(from, to)?, false),
            BehindColumns::Creeping => (self.creeping_m(from, to), false),
            BehindColumns::Late | BehindColumns::Heard => (direct_m, true),
        };
        Some(SoundPath { length_m, is_late })
    }

    /// Length of a taut line from one point to the other round all obstacles in between, on the shorter side.
    fn creeping_m(&self, from: Point, to: Point) -> f64 {
        let direct = to - from;
        let outline: Vec<Point> = self
            .single
            .iter()
            .filter(|(map, _)| is_blocked(map, from, to))
            .flat_map(|(_, outline)| outline.iter().copied())
            .collect();
        let side = |sign: f64| {
            let beside = |p: &Point| direct.perp(&(p - from)) * sign > 0.0;
            taut_m(from, to, outline.iter().copied().filter(beside).collect(), sign)
        };
        side(1.0).min(side(-1.0))
    }

    /// Length of the shortest echo from the wall with a path that is not blocked itself.
    fn echo_m(&self, from: Point, to: Point) -> Option<f64> {
        let mut echoes: Vec<(f64, Point)> = match &self.boundary {
            Boundary::Circle { radius_m } => round_echoes(*radius_m, from, to),
            Boundary::Polygon { vertices } => straight_echoes(vertices, from, to),
        };
        echoes.retain(|(_, at)| (at - to).norm() > OWN_WALL_M);
        echoes.sort_by(|a, b| a.0.total_cmp(&b.0));
        let is_free = |at: Point| !is_blocked(&self.all, from, at) && !is_blocked(&self.all, at, to);
        echoes.into_iter().find(|(_, at)| is_free(*at)).map(|(length_m, _)| length_m)
    }
}

fn is_blocked(map: &ObstacleMap, from: Point, to: Point) -> bool {
    let way = to - from;
    let distance_m = way.norm();
    distance_m > REACHED_M
        && map.ray_m(from, way / distance_m, distance_m).is_some_and(|hit_m| hit_m < distance_m - REACHED_M)
}

/// Length of a taut string from `from` to `to` round points that are all on one side of the straight line: one side of
/// the convex hull.
fn taut_m(from: Point, to: Point, mut around: Vec<Point>, sign: f64) -> f64 {
    let direct = to - from;
    around.push(to);
    around.sort_by(|a, b| (a - from).dot(&direct).total_cmp(&(b - from).dot(&direct)));
    let mut chain = vec![from];
    for point in around {
        while let [.., before, last] = chain[..]
            && (last - before).perp(&(point - last)) * sign >= 0.0
        {
            chain.pop();
        }
        chain.push(point);
    }
    chain.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
}

/// Echoes from a round wall. Sound is reflected where the length of the path via the wall has an extremum (Fermat's
/// principle).
fn round_echoes(radius_m: f64, from: Point, to: Point) -> Vec<(f64, Point)> {
    let at = |k: u32| Point::from(unit_vector(TAU * f64::from(k) / f64::from(WALL_POINTS)) * radius_m);
    let length_m = |p: Point| (p - from).norm() + (to - p).norm();
    (0..WALL_POINTS)
        .map(|k| (k + WALL_POINTS - 1, k, k + 1))
        .filter(|(before, here, after)| {
            let [a, b, c] = [*before, *here, *after].map(|k| length_m(at(k % WALL_POINTS)));
            (b - a) * (c - b) <= 0.0
        })
        .map(|(_, here, _)| (length_m(at(here)), at(here)))
        .collect()
}

/// Echoes from straight walls, computed with mirror images.
fn straight_echoes(vertices: &[Point], from: Point, to: Point) -> Vec<(f64, Point)> {
    edges(vertices)
        .filter_map(|(a, b)| {
            let along = (b - a).try_normalize(1e-9)?;
            let across = Vector::new(-along.y, along.x);
            let (d1, d2) = (across.dot(&(from - a)), across.dot(&(to - a)));
            let share = d1 / (d1 + d2);
            let foot = |p: Point| along.dot(&(p - a));
            let s = foot(from) + (foot(to) - foot(from)) * share;
            let is_on_wall = d1 * d2 > 0.0 && (0.0..=(b - a).norm()).contains(&s);
            let at = a + along * s;
            is_on_wall.then(|| ((at - from).norm() + (to - at).norm(), at))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::{ObstacleId, Shape};

    fn around(boundary: Boundary, shapes: Vec<Shape>) -> Propagation {
        let obstacle = |(id, shape)| Obstacle { id: ObstacleId(id), name: String::new(), shape, known: true };
        let obstacles = (1..).zip(shapes).map(obstacle).collect();
        Propagation::new(&World { boundary, obstacles, stations: vec![], zones: vec![] })
    }

    fn column(radius_m: f64) -> Vec<Shape> {
        vec![Shape::Disc { center: Point::origin(), radius_m }]
    }

    const ROUND: Boundary = Boundary::Circle { radius_m: 10.0 };

    #[test]
    fn sound_creeps_around_a_column_by_tangents_and_an_arc() {
        let around = around(ROUND, column(1.0));
        let way = around.path(Point::new(-5.0, 0.0), Point::new(5.0, 0.0), BehindColumns::Creeping);
        let touch = (1.0_f64 / 5.0).asin();
        let expected = 2.0 * (24.0_f64.sqrt() + touch);
        let length_m = way.expect("heard").length_m;
        assert!((length_m / expected - 1.0).abs() < 3e-3, "{length_m} for {expected}");
        assert!(length_m > 10.0);
    }

    #[test]
    fn the_echo_in_a_round_tank_is_a_reflection() {
        let around = around(ROUND, column(1.0));
        let length_m = around.echo_m(Point::new(-3.0, 0.0), Point::new(3.0, 0.0)).expect("an echo");
        // The echo comes from the wall at the side, because the path to the wall ahead is blocked.
        assert!((length_m - 2.0 * 109.0_f64.sqrt()).abs() < 1e-3, "{length_m}");
    }

    #[test]
    fn the_echo_of_a_straight_wall_comes_from_the_mirror_image() {
        let corner = |x: f64, y: f64| Point::new(x, y);
        let vertices = vec![corner(-5.0, -4.0), corner(5.0, -4.0), corner(5.0, 4.0), corner(-5.0, 4.0)];
        let around = around(Boundary::Polygon { vertices }, column(0.5));
        let length_m = around.echo_m(Point::new(-3.0, 0.0), Point::new(3.0, 0.0)).expect("an echo");
        assert!((length_m - 10.0).abs() < 1e-9, "{length_m}");
    }

    #[test]
    fn a_station_on_a_column_hears_its_own_side() {
        let around = around(ROUND, column(1.0));
        let hears = |from: Point| around.path(from, Point::new(1.0, 0.0), BehindColumns::Silent).is_some();
        assert!(hears(Point::new(5.0, 0.5)));
        assert!(!hears(Point::new(-5.0, 0.5)));
    }
}
