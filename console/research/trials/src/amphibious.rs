//! Random floors, half of them flooded, for an amphibious robot.
//!
//! After Yang et al. 2021, Figs 12 to 15: ten obstacles between start and goal, half of the floor flooded. The paper
//! prints neither places nor sizes. Ours are: a square of 10 m, the western half flooded, discs of 0.2 to 0.6 m
//! radius with room for the robot between them.

use crate::discs;
use planner_api::{Boundary, Limits, Motion, Obstacle, Outline, Site, Zone, ZoneKind};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use world::{
    Amphibious, Point, Vector,
    shape::rectangle,
    shortest::{NoWay, Way},
};

/// Half the side length of the floor, metres.
pub const HALF_SIDE_M: f64 = 5.0;
/// Radius of the robot, metres.
pub const HULL_M: f64 = 0.2;
/// Minimum gap between two discs that are not part of the block, metres.
pub const LEAST_GAP_M: f64 = 0.7;
/// Minimum distance from start and goal to a disc, metres.
const KEEP_CLEAR_M: f64 = 0.8;
/// Number of discs on the floor.
const N_DISCS: usize = 10;

/// The arrangement of the discs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Group {
    /// Ten discs anywhere (the paper's group 1).
    Free,
    /// Three of the discs form a block across the straight line to the goal (group 2).
    Block,
}

impl Group {
    /// Both groups.
    pub const ALL: [Self; 2] = [Self::Free, Self::Block];

    /// The name in tables.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Block => "block",
        }
    }
}

/// A floor with a shoreline along y through the middle, water in the west.
#[derive(Debug, Clone, PartialEq)]
pub struct AmphibiousLayout {
    /// Centres and radii of the discs, metres.
    pub discs: Vec<(Point, f64)>,
    /// The start of the robot, in the water.
    pub start: Point,
    /// The goal, on land.
    pub goal: Point,
}

impl AmphibiousLayout {
    /// The layout of this group and seed.
    pub fn random(group: Group, seed: u64) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed.wrapping_mul(2).wrapping_add(group as u64));
        let (start, goal) = (Point::new(-4.5, -4.5), Point::new(4.5, 4.5));
        let mut discs = if group == Group::Block { block(&mut rng) } else { Vec::new() };
        while discs.len() < N_DISCS {
            let radius_m = rng.random_range(0.2..0.6);
            let reach_m = HALF_SIDE_M - radius_m - LEAST_GAP_M;
            let center = Point::new(rng.random_range(-reach_m..reach_m), rng.random_range(-reach_m..reach_m));
            let apart = discs::distance_m(&discs, center) - radius_m >= LEAST_GAP_M;
            let clear = [start, goal].iter().all(|end| (center - end).norm() - radius_m >= KEEP_CLEAR_M);
            if clear && apart {
                discs.push((center, radius_m));
            }
        }
        Self { discs, start, goal }
    }

    /// Corners of the floor.
    pub fn corners() -> Vec<Point> {
        rectangle(Point::new(-HALF_SIDE_M, -HALF_SIDE_M), Point::new(HALF_SIDE_M, HALF_SIDE_M))
    }

    /// Corners of the flooded part.
    pub fn water() -> Vec<Point> {
        rectangle(Point::new(-HALF_SIDE_M, -HALF_SIDE_M), Point::new(0.0, HALF_SIDE_M))
    }

    /// The flooded part as a zone.
    pub fn zones(water: &[Point]) -> [Zone<'_>; 1] {
        [Zone { kind: ZoneKind::Underwater, outline: Outline::Polygon { vertices: water } }]
    }

    /// The discs in the form for planners; ids from 0.
    pub fn obstacles(&self) -> Vec<Obstacle<'static>> {
        discs::obstacles(&self.discs)
    }

    /// The site in the form for planners.
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
                acceleration_m_per_s2: 0.1,
                tick_s: 0.1,
                amphibious: Some(Amphibious::YANG_2021),
            },
            swath_m: 1.0,
            clearance_m: 0.1,
            seed: 0,
        }
    }

    /// The exact shortest path from start to goal.
    ///
    /// # Errors
    /// No path exists between the discs.
    pub fn shortest_path(&self) -> Result<Way, NoWay> {
        discs::shortest_path(&Self::corners(), &self.discs, HULL_M, self.start, self.goal)
    }

    /// Distance from the hull of a robot at a place to the nearest disc or the wall, metres; negative in a collision.
    pub fn hull_clearance_m(&self, at: Point) -> f64 {
        discs::distance_m(&self.discs, at).min(HALF_SIDE_M - at.x.abs().max(at.y.abs())) - HULL_M
    }
}

/// Three discs side by side across the diagonal, the outer discs slightly nearer to the start: a shallow cup.
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
        assert_eq!(AmphibiousLayout::random(Group::Block, 3), AmphibiousLayout::random(Group::Block, 3));
        for (group, seed) in Group::ALL.into_iter().flat_map(|group| (0..50).map(move |seed| (group, seed))) {
            let layout = AmphibiousLayout::random(group, seed);
            assert_eq!(layout.discs.len(), 10);
            assert!(
                layout.hull_clearance_m(layout.start) >= 0.29 && layout.hull_clearance_m(layout.goal) >= 0.29
            );
        }
    }

    #[test]
    fn the_block_stands_across_the_straight_way() {
        for seed in 0..50 {
            let layout = AmphibiousLayout::random(Group::Block, seed);
            let way = [layout.start, layout.goal];
            assert!(world::polyline::distance_m(&way, layout.discs[0].0) < layout.discs[0].1);
        }
    }
}
