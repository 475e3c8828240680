//! Tanks with columns for coverage planners.
//!
//! Three of the tanks are like those of the study on which the planners are based (round tanks of radius 10 m with 14
//! and 28 columns, a square of 18 m with 18 columns, anchor in the middle); the others are random: radius 5 to 50 m,
//! 0 to 120 columns, anchor at the centre or at the shell.

use crate::discs;
use planner_api::{Limits, Motion, Site};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::ops::Range;
use world::{Boundary, Point, Vector, World, shape::rectangle};

/// Width of the floor scanned in one pass, metres.
pub const SWATH_M: f64 = 0.6;
/// Radius of the hull, metres.
pub const HULL_M: f64 = 0.25;
/// Distance between hull and anything solid, metres; together with the hull's radius, it gives the 0.3 m of the study.
pub const CLEARANCE_M: f64 = 0.05;
/// Edge length of a cell for counting coverage, metres.
pub const CELL_M: f64 = 0.05;
/// Minimum gap between columns, and between a column and the wall, metres.
const LEAST_GAP_M: f64 = 0.8;
/// Minimum distance of a column from the anchor, metres.
const ANCHOR_FREE_M: f64 = 0.8;

/// The named tanks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Known {
    /// Round, radius 10 m, 14 columns.
    E1,
    /// Round, radius 10 m, 28 columns.
    E2,
    /// Square, 18 m, 18 columns.
    E3,
}

impl Known {
    /// All named tanks.
    pub const ALL: [Self; 3] = [Self::E1, Self::E2, Self::E3];

    /// The name in tables.
    pub const fn id(self) -> &'static str {
        match self {
            Self::E1 => "E1-circle-14",
            Self::E2 => "E2-circle-28",
            Self::E3 => "E3-square-18",
        }
    }

    /// A tank of this kind.
    pub fn tank(self, seed: u64) -> Tank {
        let mut rng = Pcg64Mcg::seed_from_u64(seed.wrapping_mul(3).wrapping_add(self as u64));
        let square = || rectangle(Point::new(-9.0, -9.0), Point::new(9.0, 9.0));
        let (boundary, n) = match self {
            Self::E1 => (Boundary::Circle { radius_m: 10.0 }, 14),
            Self::E2 => (Boundary::Circle { radius_m: 10.0 }, 28),
            Self::E3 => (Boundary::Polygon { vertices: square() }, 18),
        };
        Tank::drawn(boundary, Point::origin(), n, &mut rng)
    }
}

/// A floor with columns and an anchor.
#[derive(Debug, Clone, PartialEq)]
pub struct Tank {
    /// The wall.
    pub boundary: Boundary,
    /// Centres and radii of the columns, metres.
    pub columns: Vec<(Point, f64)>,
    /// The place where the tether enters and the robot starts and ends.
    pub anchor: Point,
}

impl Tank {
    /// A tank of any size; one in three has its anchor at the shell.
    pub fn random(seed: u64) -> Self {
        Self::of_radius(5.0..50.0, seed)
    }

    /// A tank whose radius is in a given range, metres; one in three has its anchor at the shell.
    pub fn of_radius(radii_m: Range<f64>, seed: u64) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed.wrapping_mul(2_654_435_761).wrapping_add(17));
        let radius_m = rng.random_range(radii_m);
        let most = (0.09 * radius_m * radius_m) as usize;
        let n = rng.random_range(0..=120.min(most));
        let bearing_rad = rng.random_range(0.0..std::f64::consts::TAU);
        let at_shell = rng.random_range(0..3) == 0;
        let reach_m = if at_shell { radius_m - HULL_M - CLEARANCE_M - 0.1 } else { 0.0 };
        let anchor = Point::from(Vector::new(bearing_rad.cos(), bearing_rad.sin()) * reach_m);
        Self::drawn(Boundary::Circle { radius_m }, anchor, n, &mut rng)
    }

    fn drawn(boundary: Boundary, anchor: Point, n: usize, rng: &mut Pcg64Mcg) -> Self {
        let (low, high) = boundary.bounds();
        let mut columns: Vec<(Point, f64)> = Vec::new();
        // A crowded tank gets as many columns as fit.
        for _ in 0..400 * (n + 1) {
            if columns.len() == n {
                break;
            }
            let radius_m = rng.random_range(0.15..0.3);
            let at = Point::new(rng.random_range(low.x..high.x), rng.random_range(low.y..high.y));
            let is_clear = boundary.wall_distance_m(at) >= radius_m + LEAST_GAP_M
                && (at - anchor).norm() >= radius_m + ANCHOR_FREE_M
                && columns.iter().all(|(other, r)| (at - other).norm() >= radius_m + r + LEAST_GAP_M);
            if is_clear {
                columns.push((at, radius_m));
            }
        }
        Self { boundary, columns, anchor }
    }

    /// The columns in the form for planners; ids from 0.
    pub fn obstacles(&self) -> Vec<planner_api::Obstacle<'static>> {
        discs::obstacles(&self.columns)
    }

    /// The site in the form for planners.
    pub fn site<'a>(&'a self, obstacles: &'a [planner_api::Obstacle<'a>]) -> Site<'a> {
        Site {
            revision: 0,
            boundary: self.boundary.as_ref(),
            obstacles,
            zones: &[],
            limits: Limits {
                motion: Motion::Unicycle,
                v_max_m_per_s: 0.3,
                w_max_rad_per_s: 1.0,
                radius_m: HULL_M,
                sensing_range_m: 3.0,
                acceleration_m_per_s2: 100.0,
                tick_s: 0.1,
                amphibious: None,
            },
            swath_m: SWATH_M,
            clearance_m: CLEARANCE_M,
            seed: 0,
        }
    }

    /// The tank in the form of `world`.
    pub fn world(&self) -> World {
        discs::world(self.boundary.clone(), &self.columns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_seed_gives_the_same_tank() {
        assert_eq!(Known::E2.tank(7), Known::E2.tank(7));
        assert_ne!(Known::E2.tank(7), Known::E2.tank(8));
        assert_eq!(Known::ALL.map(|k| k.tank(1).columns.len()), [14, 28, 18]);
    }

    #[test]
    fn random_tanks_are_of_every_kind() {
        let tanks: Vec<Tank> = (0..60).map(Tank::random).collect();
        assert!(tanks.iter().any(|t| t.anchor == Point::origin()));
        assert!(tanks.iter().any(|t| t.anchor != Point::origin()));
        assert!(tanks.iter().any(|t| t.columns.len() < 5) && tanks.iter().any(|t| t.columns.len() > 80));
    }

    #[test]
    fn a_straight_pass_and_back_scans_one_strip() {
        let tank = Tank { columns: Vec::new(), ..Known::E1.tank(0) };
        let path = [Point::origin(), Point::new(9.0, 0.0), Point::origin()];
        let scan = tank.score(&path, &[], 0.1).unwrap();
        let strip = (9.0 * SWATH_M + 0.5 * std::f64::consts::PI * 0.09) / (std::f64::consts::PI * 100.0);
        assert!((scan.coverage_whole - strip).abs() < 2e-3, "{}", scan.coverage_whole);
        assert!((scan.rotation_turns - 0.5).abs() < 1e-9 && scan.turns == 1);
        assert!(scan.certificate.certified, "{:?}", scan.certificate.reasons);
    }
}
