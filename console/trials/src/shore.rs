//! Random floors with a shore, for a robot that walks and swims.
//!
//! After Yang et al. 2021, Figs 12 to 15: ten obstacles between start and goal, half of the floor flooded. The paper
//! prints neither the places nor the sizes; these are ours: a square of 10 m, the western half flooded, discs of 0.2 to
//! 0.6 m radius with room for the robot between them.

use planner_api::{Boundary, Limits, Motion, Obstacle, Outline, Site, Zone, ZoneKind};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use world::{Point, Shape, Vector};

/// Half the side of the floor, metres.
pub const HALF_SIDE_M: f64 = 5.0;
/// Radius of the robot, metres.
pub const HULL_M: f64 = 0.2;
/// Least gap between two discs that are not the block, metres.
pub const LEAST_GAP_M: f64 = 0.7;
/// Least distance from start and goal to a disc, metres.
const KEEP_CLEAR_M: f64 = 0.8;
/// Discs on the floor.
const N_DISCS: usize = 10;

/// Whether there is a trap.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Group {
    /// Ten discs anywhere (the paper's group 1).
    Free,
    /// Three of them make a block across the straight way (group 2).
    Block,
}

impl Group {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Free, Self::Block];

    /// Its name in tables.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Block => "block",
        }
    }
}

/// A floor with a shore along y through the middle, water in the west.
#[derive(Debug, Clone, PartialEq)]
pub struct Shore {
    /// Centres and radii of the discs, metres.
    pub discs: Vec<(Point, f64)>,
    /// Where the robot is put down, in the water.
    pub start: Point,
    /// Where it is to go, on land.
    pub goal: Point,
}

impl Shore {
    /// The layout of this group and seed.
    pub fn random(group: Group, seed: u64) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed.wrapping_mul(2).wrapping_add(group as u64));
        let (start, goal) = (Point::new(-4.5, -4.5), Point::new(4.5, 4.5));
        let mut discs = if group == Group::Block { block(&mut rng) } else { Vec::new() };
        while discs.len() < N_DISCS {
            let radius_m = rng.random_range(0.2..0.6);
            let reach_m = HALF_SIDE_M - radius_m - LEAST_GAP_M;
            let center = Point::new(rng.random_range(-reach_m..reach_m), rng.random_range(-reach_m..reach_m));
            let apart =
                |(other, radius): &(Point, f64)| (center - other).norm() - radius - radius_m >= LEAST_GAP_M;
            let clear = [start, goal].iter().all(|end| (center - end).norm() - radius_m >= KEEP_CLEAR_M);
            if clear && discs.iter().all(apart) {
                discs.push((center, radius_m));
            }
        }
        Self { discs, start, goal }
    }

    /// Corners of the floor.
    pub fn corners() -> [Point; 4] {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| Point::new(x * HALF_SIDE_M, y * HALF_SIDE_M))
    }

    /// Corners of the flooded part.
    pub fn water() -> [Point; 4] {
        [(-1.0, -1.0), (0.0, -1.0), (0.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| Point::new(x * HALF_SIDE_M, y * HALF_SIDE_M))
    }

    /// The flooded part as a zone.
    pub fn zones(water: &[Point]) -> [Zone<'_>; 1] {
        [Zone { kind: ZoneKind::Underwater, outline: Outline::Polygon { vertices: water } }]
    }

    /// The discs as a planner gets them; ids from 0.
    pub fn obstacles(&self) -> Vec<Obstacle<'static>> {
        let obstacle = |(id, &(center, radius_m)): (usize, &(Point, f64))| Obstacle {
            id: id as u32,
            outline: Outline::Disc { center, radius_m },
            discovered: false,
            velocity_m_per_s: Vector::zeros(),
        };
        self.discs.iter().enumerate().map(obstacle).collect()
    }

    /// The site as a planner gets it.
    pub fn site<'a>(corners: &'a [Point], obstacles: &'a [Obstacle<'a>], zones: &'a [Zone<'a>]) -> Site<'a> {
        Site {
            revision: 0,
            boundary: Boundary::Polygon { vertices: corners },
            obstacles,
            zones,
            limits: Limits {
                motion: Motion::Unicycle,
                v_max_m_per_s: 0.23,
                w_max_rad_per_s: 0.31,
                radius_m: HULL_M,
                sensing_range_m: 20.0,
            },
            swath_m: 1.0,
            clearance_m: 0.1,
            seed: 0,
        }
    }

    /// The discs as shapes of the world.
    pub fn shapes(&self) -> Vec<Shape> {
        self.discs.iter().map(|&(center, radius_m)| Shape::Disc { center, radius_m }).collect()
    }

    /// Distance from a robot's hull at a place to the nearest disc or the wall, metres; negative is a collision.
    pub fn hull_clearance_m(&self, at: Point) -> f64 {
        let wall = HALF_SIDE_M - at.x.abs().max(at.y.abs());
        self.discs.iter().map(|(center, radius)| (at - center).norm() - radius).fold(wall, f64::min) - HULL_M
    }
}

/// Three discs side by side across the diagonal, the outer ones a little nearer to the start: a shallow cup.
fn block(rng: &mut Pcg64Mcg) -> Vec<(Point, f64)> {
    let ahead = Vector::new(1.0, 1.0).normalize();
    let aside = Vector::new(-ahead.y, ahead.x);
    let middle = Point::from(ahead * rng.random_range(-2.0..2.0) + aside * rng.random_range(-0.2..0.2));
    let radius_m = rng.random_range(0.4..0.6);
    let outer = |side: f64| middle + aside * (side * 1.7 * radius_m) - ahead * (0.9 * radius_m);
    vec![(middle, radius_m), (outer(1.0), radius_m), (outer(-1.0), radius_m)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layouts_repeat_and_leave_room() {
        assert_eq!(Shore::random(Group::Block, 3), Shore::random(Group::Block, 3));
        for (group, seed) in Group::ALL.into_iter().flat_map(|group| (0..50).map(move |seed| (group, seed))) {
            let shore = Shore::random(group, seed);
            assert_eq!(shore.discs.len(), 10);
            assert!(
                shore.hull_clearance_m(shore.start) >= 0.29 && shore.hull_clearance_m(shore.goal) >= 0.29
            );
        }
    }

    #[test]
    fn the_block_stands_across_the_straight_way() {
        for seed in 0..50 {
            let shore = Shore::random(Group::Block, seed);
            let way = [shore.start, shore.goal];
            assert!(world::polyline::distance_m(&way, shore.discs[0].0) < shore.discs[0].1);
        }
    }
}
