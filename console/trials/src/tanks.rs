//! Tanks with columns for coverage planners, and the figures of a path over their floor.
//!
//! Three of them are of the make of the study behind the planners (round tanks of radius 10 m with 14 and 28 columns,
//! a square of 18 m with 18 columns, anchor in the middle); the others are drawn: radius 5 to 50 m, 0 to 120 columns,
//! anchor at the centre or at the shell.

use planner_api::{Limits, Motion, Outline, Site};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use world::{
    Boundary, CoverageGrid, Floor, Obstacle, ObstacleId, Point, Pose, Shape, Vector, World,
    coverage::Tool,
    polyline,
    tether::{self, Case, Certificate, TetherError, certify},
};

/// Width of the floor scanned in one pass, metres.
pub const SWATH_M: f64 = 0.6;
/// Radius of the hull, metres.
pub const HULL_M: f64 = 0.25;
/// Distance between hull and anything solid, metres; with the hull the 0.3 m of the study.
pub const CLEARANCE_M: f64 = 0.05;
/// Edge of a cell in which coverage is counted, metres.
pub const CELL_M: f64 = 0.05;
/// Least gap between columns, and between a column and the wall, metres.
const LEAST_GAP_M: f64 = 0.8;
/// No column stands nearer to the anchor than this, metres.
const ANCHOR_FREE_M: f64 = 0.8;

/// The tanks that have a name.
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
    /// All of them.
    pub const ALL: [Self; 3] = [Self::E1, Self::E2, Self::E3];

    /// Its name in tables.
    pub const fn id(self) -> &'static str {
        match self {
            Self::E1 => "E1-circle-14",
            Self::E2 => "E2-circle-28",
            Self::E3 => "E3-square-18",
        }
    }

    /// A tank of this make.
    pub fn tank(self, seed: u64) -> Tank {
        let mut rng = Pcg64Mcg::seed_from_u64(seed.wrapping_mul(3).wrapping_add(self as u64));
        let square = [(-9.0, -9.0), (9.0, -9.0), (9.0, 9.0), (-9.0, 9.0)];
        let (boundary, n) = match self {
            Self::E1 => (Boundary::Circle { radius_m: 10.0 }, 14),
            Self::E2 => (Boundary::Circle { radius_m: 10.0 }, 28),
            Self::E3 => (Boundary::Polygon { vertices: square.map(|(x, y)| Point::new(x, y)).to_vec() }, 18),
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
    /// Where the tether comes in and the robot starts and ends.
    pub anchor: Point,
}

impl Tank {
    /// A tank of any size; one in three has its anchor at the shell.
    pub fn random(seed: u64) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed.wrapping_mul(2_654_435_761).wrapping_add(17));
        let radius_m = rng.random_range(5.0..50.0);
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
        // A crowded tank gets as many as fit.
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

    /// The columns as a planner gets them; ids from 0.
    pub fn obstacles(&self) -> Vec<planner_api::Obstacle<'static>> {
        let obstacle = |(id, &(center, radius_m)): (usize, &(Point, f64))| planner_api::Obstacle {
            id: id as u32,
            outline: Outline::Disc { center, radius_m },
            discovered: false,
            velocity_m_per_s: Vector::zeros(),
        };
        self.columns.iter().enumerate().map(obstacle).collect()
    }

    /// The site as a planner gets it.
    pub fn site<'a>(&'a self, obstacles: &'a [planner_api::Obstacle<'a>]) -> Site<'a> {
        let boundary = match &self.boundary {
            Boundary::Circle { radius_m } => planner_api::Boundary::Circle { radius_m: *radius_m },
            Boundary::Polygon { vertices } => planner_api::Boundary::Polygon { vertices },
        };
        Site {
            revision: 0,
            boundary,
            obstacles,
            zones: &[],
            limits: Limits {
                motion: Motion::Unicycle,
                v_max_m_per_s: 0.3,
                w_max_rad_per_s: 1.0,
                radius_m: HULL_M,
                sensing_range_m: 3.0,
            },
            swath_m: SWATH_M,
            clearance_m: CLEARANCE_M,
            seed: 0,
        }
    }

    /// The tank as the world has it.
    pub fn world(&self) -> World {
        let obstacle = |(id, &(center, radius_m)): (usize, &(Point, f64))| Obstacle {
            id: ObstacleId(id as u32),
            name: format!("C{id}"),
            shape: Shape::Disc { center, radius_m },
            known: true,
        };
        let obstacles = self.columns.iter().enumerate().map(obstacle).collect();
        World { boundary: self.boundary.clone(), obstacles, stations: Vec::new(), zones: Vec::new() }
    }

    /// The figures of a path that starts and ends at the anchor, counted in cells of `cell_m`.
    ///
    /// # Errors
    /// The tether has no anchor.
    pub fn score(&self, path: &[Point], cuts: &[Vec<Point>], cell_m: f64) -> Result<Scan, TetherError> {
        let world = self.world();
        let room_m = HULL_M + CLEARANCE_M;
        let floor = Floor::new(&world, cell_m, room_m, SWATH_M, self.anchor);
        let mut grid = CoverageGrid::new(floor);
        sweep(&mut grid, path);
        let counts = grid.counts();
        let limits = tether::Limits {
            reel_length_m: f64::INFINITY,
            wrap_max_rad: f64::INFINITY,
            wrap_total_max_rad: f64::INFINITY,
        };
        let certificate = certify(&Case {
            path,
            anchor: self.anchor,
            cable: None,
            boundary: &self.boundary,
            obstacles: &world.obstacles,
            room_m,
            limits,
            returns: true,
            cuts,
        })?;
        let length_m = polyline::length_m(path);
        let area_m2 = counts.reachable as f64 * cell_m * cell_m;
        Ok(Scan {
            coverage_reachable: grid.fraction_reachable(),
            coverage_whole: grid.fraction_whole(),
            length_m,
            length_over_lower_bound: length_m / (area_m2 / SWATH_M),
            turns: headings(path).windows(2).filter(|w| angle_rad(w[0], w[1]) > 30_f64.to_radians()).count(),
            rotation_turns: rotation_turns(path),
            certificate,
        })
    }
}

/// How a path over a floor went.
#[derive(Debug, Clone, PartialEq)]
pub struct Scan {
    /// Scanned share of the floor that the tool can reach.
    pub coverage_reachable: f64,
    /// Scanned share of the whole floor.
    pub coverage_whole: f64,
    /// Length, metres.
    pub length_m: f64,
    /// Length over reachable area by swath.
    pub length_over_lower_bound: f64,
    /// Changes of heading by more than 30 degrees.
    pub turns: usize,
    /// Sum of the changes of heading, in whole turns.
    pub rotation_turns: f64,
    /// What the tether says, without limits.
    pub certificate: Certificate,
}

/// Marks what a bar across the heading scans along a path; it also scans when the robot turns in place.
fn sweep(grid: &mut CoverageGrid, path: &[Point]) {
    let tool = Tool::Bar { swath_m: SWATH_M };
    let mut before: Option<f64> = None;
    for pair in path.windows(2).filter(|pair| (pair[1] - pair[0]).norm() > 1e-9) {
        let way = pair[1] - pair[0];
        let heading_rad = way.y.atan2(way.x);
        let at = |position: Point, heading_rad: f64| Pose { position, heading_rad };
        if let Some(from_rad) = before {
            let turn = world::geometry::wrap_angle_rad(heading_rad - from_rad);
            let n = (turn.abs() / 0.2).ceil().max(1.0);
            for k in 0..n as usize {
                let heading = |k: f64| at(pair[0], from_rad + turn * k / n);
                grid.mark(tool, heading(k as f64), heading(k as f64 + 1.0));
            }
        }
        grid.mark(tool, at(pair[0], heading_rad), at(pair[1], heading_rad));
        before = Some(heading_rad);
    }
}

fn headings(path: &[Point]) -> Vec<Vector> {
    path.windows(2).filter_map(|w| (w[1] - w[0]).try_normalize(1e-9)).collect()
}

fn angle_rad(a: Vector, b: Vector) -> f64 {
    a.perp(&b).atan2(a.dot(&b)).abs()
}

/// Sum of the changes of heading along a path, in whole turns.
pub fn rotation_turns(path: &[Point]) -> f64 {
    headings(path).windows(2).map(|w| angle_rad(w[0], w[1])).sum::<f64>() / std::f64::consts::TAU
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
