//! Random traps: U, triangle, spiral and double traps between start and goal, among free discs.
//!
//! A random benchmark for goal planners (Xu et al. 2022 show one trap of each kind but print no coordinates): a
//! square floor of 50 m, a trap made of discs without gaps, with its mouth towards the start, and 8 to 14 free discs.
//! A robot of radius 0.3 m can always pass: the gap between a free disc and anything else is at least 0.9 m.

use crate::discs;
use planner_api::{Boundary, Limits, Motion, Obstacle, Site};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use world::{
    Point, Vector, polyline,
    shape::rectangle,
    shortest::{NoWay, Way},
};

/// Side length of the square floor, metres.
pub const SIDE_M: f64 = 50.0;
/// Radius of the robot, metres.
pub const HULL_M: f64 = 0.3;
/// Step length of planners that walk in steps, metres.
pub const STEP_M: f64 = 0.05;
/// Minimum gap between a free disc and anything else, metres.
pub const LEAST_GAP_M: f64 = 0.9;
/// Minimum distance from start and goal to the outline of any disc, metres.
const KEEP_CLEAR_M: f64 = 1.5;

/// The form of a trap.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// Three sides of a rectangle.
    U,
    /// Two sides of a triangle.
    Triangle,
    /// A wall that winds inwards.
    Spiral,
    /// Two traps: one within the other, or one behind the other.
    Double,
}

impl Kind {
    /// Every kind of trap.
    pub const ALL: [Self; 4] = [Self::U, Self::Triangle, Self::Spiral, Self::Double];

    /// The name in tables.
    pub const fn id(self) -> &'static str {
        match self {
            Self::U => "u",
            Self::Triangle => "triangle",
            Self::Spiral => "spiral",
            Self::Double => "double",
        }
    }
}

/// A floor with one trap, free discs, a start and a goal.
#[derive(Debug, Clone, PartialEq)]
pub struct Trap {
    /// The form of the trap.
    pub kind: Kind,
    /// The start of the robot, metres, tank frame (origin in the middle of the square).
    pub start: Point,
    /// The goal.
    pub goal: Point,
    /// Centres and radii of the discs, metres: first the discs of the trap, then the free discs.
    pub discs: Vec<(Point, f64)>,
    /// Number of discs that belong to the trap.
    pub n_trap: usize,
}

impl Trap {
    /// The layout of this kind and seed.
    pub fn random(kind: Kind, seed: u64) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed.wrapping_mul(4).wrapping_add(kind as u64));
        let towards_rad = rng.random_range(0.0..std::f64::consts::TAU);
        let ahead = Vector::new(towards_rad.cos(), towards_rad.sin());
        let half_way_m = rng.random_range(15.0..21.0);
        let (start, goal) = (Point::from(-ahead * half_way_m), Point::from(ahead * half_way_m));
        let trap = walls(kind, &mut rng);
        let mirror = if rng.random() { 1.0 } else { -1.0 };
        let place = Vector::new(rng.random_range(-3.0..3.0), rng.random_range(-1.5..1.5));
        let aside = Vector::new(-ahead.y, ahead.x);
        let to_tank = |p: &Point| Point::from(ahead * (p.x + place.x) + aside * (p.y * mirror + place.y));
        let mut discs: Vec<(Point, f64)> = Vec::new();
        for wall in &trap {
            let radius_m = rng.random_range(0.4..0.8);
            let corners: Vec<Point> = wall.iter().map(to_tank).collect();
            // Neighbours overlap, so that even the smallest robot finds no gap.
            discs.extend(polyline::resampled(&corners, 1.6 * radius_m).into_iter().map(|at| (at, radius_m)));
        }
        let n_trap = discs.len();
        let n_free = rng.random_range(8..=14);
        while discs.len() < n_trap + n_free {
            discs.extend(free_disc(&mut rng, &discs, [start, goal]));
        }
        Self { kind, start, goal, discs, n_trap }
    }

    /// Corners of the floor.
    pub fn corners() -> Vec<Point> {
        let half = SIDE_M / 2.0;
        rectangle(Point::new(-half, -half), Point::new(half, half))
    }

    /// The discs in the form for planners, on the drawing or discovered on the way; ids from 0.
    pub fn obstacles(&self, discovered: bool) -> Vec<Obstacle<'static>> {
        discs::obstacles(&self.discs).into_iter().map(|one| Obstacle { discovered, ..one }).collect()
    }

    /// The site in the form for planners: `obstacles` are the obstacles known so far, `corners` the corners of the
    /// floor.
    pub fn site<'a>(corners: &'a [Point], obstacles: &'a [Obstacle<'a>], sensing_range_m: f64) -> Site<'a> {
        Site {
            revision: 0,
            boundary: Boundary::Polygon { vertices: corners },
            obstacles,
            zones: &[],
            limits: Limits {
                motion: Motion::Point,
                v_max_m_per_s: 1.0,
                w_max_rad_per_s: 1.0,
                radius_m: HULL_M,
                sensing_range_m,
                acceleration_m_per_s2: 100.0,
                tick_s: 0.1,
                amphibious: None,
            },
            swath_m: 1.0,
            clearance_m: 0.0,
            seed: 0,
        }
    }

    /// The exact shortest path from start to goal.
    ///
    /// # Errors
    /// There is no way out of the trap.
    pub fn shortest_path(&self) -> Result<Way, NoWay> {
        discs::shortest_path(&Self::corners(), &self.discs, HULL_M, self.start, self.goal)
    }

    /// The least distance between the hull and a disc or the wall on a path, metres; negative in a collision.
    pub fn clearance_m(&self, path: &[Point]) -> f64 {
        let wall_m =
            path.iter().map(|at| SIDE_M / 2.0 - at.x.abs().max(at.y.abs())).fold(f64::INFINITY, f64::min);
        discs::path_distance_m(&self.discs, path).min(wall_m) - HULL_M
    }
}

/// A free disc with gaps on all sides; `None` if there is no room at the place that was drawn.
fn free_disc(rng: &mut Pcg64Mcg, discs: &[(Point, f64)], ends: [Point; 2]) -> Option<(Point, f64)> {
    let radius_m = rng.random_range(0.5..2.0);
    let reach_m = SIDE_M / 2.0 - radius_m - LEAST_GAP_M;
    let center = Point::new(rng.random_range(-reach_m..reach_m), rng.random_range(-reach_m..reach_m));
    let apart = discs::distance_m(discs, center) - radius_m >= LEAST_GAP_M;
    let clear = ends.iter().all(|end| (center - end).norm() - radius_m >= KEEP_CLEAR_M);
    (apart && clear).then_some((center, radius_m))
}

/// The walls of a trap about the origin; the line from start to goal is along x.
fn walls(kind: Kind, rng: &mut Pcg64Mcg) -> Vec<Vec<Point>> {
    match kind {
        Kind::U => vec![u_wall(rng.random_range(5.0..10.0), rng.random_range(6.0..12.0), 0.0)],
        Kind::Triangle => vec![v_wall(rng.random_range(5.0..10.0), rng.random_range(7.0..14.0), 0.0)],
        Kind::Spiral => vec![spiral_wall(rng)],
        Kind::Double if rng.random() => nested_walls(rng),
        Kind::Double => walls_in_a_row(rng),
    }
}

/// A U of some depth and width, with its middle `x` metres ahead.
fn u_wall(depth_m: f64, width_m: f64, x: f64) -> Vec<Point> {
    let (half_depth, half_width) = (depth_m / 2.0, width_m / 2.0);
    [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)]
        .map(|(along, across)| Point::new(x + along * half_depth, across * half_width))
        .to_vec()
}

/// The two sides of a triangle of some depth and mouth, with its middle `x` metres ahead.
fn v_wall(depth_m: f64, width_m: f64, x: f64) -> Vec<Point> {
    let (half_depth, half_width) = (depth_m / 2.0, width_m / 2.0);
    vec![
        Point::new(x - half_depth, half_width),
        Point::new(x + half_depth, 0.0),
        Point::new(x - half_depth, -half_width),
    ]
}

/// A wall that winds inwards from its mouth, with 3 to 4 m between turns.
fn spiral_wall(rng: &mut Pcg64Mcg) -> Vec<Point> {
    let turns = rng.random_range(1.2..1.9);
    let pitch_m = rng.random_range(3.2..4.2);
    let inner_m = rng.random_range(1.2..2.2);
    let pieces = 60;
    let point = |k: i32| {
        let along = f64::from(k) / f64::from(pieces);
        let radius_m = inner_m + pitch_m * turns * (1.0 - along);
        let angle_rad = std::f64::consts::PI - std::f64::consts::TAU * turns * along;
        Point::new(radius_m * angle_rad.cos(), radius_m * angle_rad.sin())
    };
    (0..=pieces).map(point).collect()
}

/// A small trap in the mouth of a large one.
fn nested_walls(rng: &mut Pcg64Mcg) -> Vec<Vec<Point>> {
    let (depth_m, width_m) = (rng.random_range(9.0..12.0), rng.random_range(11.0..14.0));
    let inner_m = (depth_m - rng.random_range(4.5..5.5), width_m - rng.random_range(5.5..6.5));
    let inner =
        if rng.random() { u_wall(inner_m.0, inner_m.1, -0.5) } else { v_wall(inner_m.0, inner_m.1, -0.5) };
    vec![u_wall(depth_m, width_m, 0.0), inner]
}

/// Two traps, one behind the other, with a passage between them.
fn walls_in_a_row(rng: &mut Pcg64Mcg) -> Vec<Vec<Point>> {
    let mut wall = |x: f64| {
        let (depth_m, width_m) = (rng.random_range(3.5..6.0), rng.random_range(6.0..11.0));
        if rng.random() { u_wall(depth_m, width_m, x) } else { v_wall(depth_m, width_m, x) }
    };
    vec![wall(-4.5), wall(4.5)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> impl Iterator<Item = Trap> {
        (0..50).flat_map(|seed| Kind::ALL.map(|kind| Trap::random(kind, seed)))
    }

    #[test]
    fn the_same_seed_gives_the_same_layout_and_another_seed_another() {
        assert_eq!(Trap::random(Kind::U, 7), Trap::random(Kind::U, 7));
        assert_ne!(Trap::random(Kind::U, 7), Trap::random(Kind::U, 8));
    }

    #[test]
    fn start_and_goal_have_room_and_everything_lies_on_the_floor() {
        for trap in all() {
            assert!(trap.clearance_m(&[trap.start]) > 0.5 && trap.clearance_m(&[trap.goal]) > 0.5);
            assert!(trap.discs.iter().all(|(at, r)| at.x.abs().max(at.y.abs()) + r < SIDE_M / 2.0));
            assert!((8..=14).contains(&(trap.discs.len() - trap.n_trap)));
        }
    }

    #[test]
    fn the_straight_way_runs_into_the_trap() {
        let blocked = all().filter(|trap| {
            let way = [trap.start, trap.goal];
            trap.discs[..trap.n_trap].iter().any(|(at, r)| polyline::distance_m(&way, *at) < r + HULL_M)
        });
        assert_eq!(blocked.count(), 200);
    }

    #[test]
    fn a_free_disc_leaves_room_to_pass() {
        for trap in all() {
            for (index, (at, r)) in trap.discs.iter().enumerate().skip(trap.n_trap) {
                let others =
                    trap.discs[..index].iter().map(|(other, radius)| (at - other).norm() - r - radius);
                assert!(others.fold(f64::INFINITY, f64::min) >= LEAST_GAP_M);
            }
        }
    }
}
