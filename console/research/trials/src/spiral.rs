//! Round tanks with columns and a preset spiral.

use crate::discs;
use planner_api::{Boundary, Limits, Motion, Obstacle, Site};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use world::{Point, spiral::Spiral};

/// A round tank with columns and a preset path.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Radius of the tank, metres.
    pub radius_m: f64,
    /// Columns: centre and radius.
    pub columns: Vec<(Point, f64)>,
    /// The preset path.
    pub path: Vec<Point>,
    /// Radius of the robot, metres.
    pub hull_m: f64,
    /// Distance to keep, metres.
    pub clearance_m: f64,
}

impl Layout {
    /// A tank of radius 4 to 10 m with a spiral of pitch 0.8 to 1.3 m and 6 to 40 columns of radius 0.15 to 0.4 m, at
    /// most one per seven square metres, anywhere except at the start; for a robot of radius 0.25 m.
    pub fn random(seed: u64) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let radius_m: f64 = rng.random_range(4.0..10.0);
        let pitch_m = rng.random_range(0.8..1.3);
        let room = (std::f64::consts::PI * radius_m * radius_m / 7.0) as usize;
        let n_columns = rng.random_range(6..=room.clamp(7, 40));
        let (hull_m, clearance_m) = (0.25, 0.05);
        let outer_radius_m = radius_m - hull_m - 0.25;
        let path =
            Spiral { outer_radius_m, inner_radius_m: 0.1, pitch_m, step_rad: 0.1 / outer_radius_m }.points();
        let mut columns = Vec::new();
        while columns.len() < n_columns {
            let radius = rng.random_range(0.15..0.4);
            let center = in_disk(&mut rng, radius_m);
            if (center - path[0]).norm() > 1.2 + radius {
                columns.push((center, radius));
            }
        }
        Self { radius_m, columns, path, hull_m, clearance_m }
    }

    /// Wang et al. 2023: point obstacles in a tank of radius 10 m, uniform in the disk or, as printed, in the square
    /// around it.
    pub fn of_the_paper(seed: u64, n_points: usize, in_square: bool) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let radius_m = 10.0;
        let mut columns = Vec::new();
        while columns.len() < n_points {
            let square = Point::new(rng.random_range(-10.0..10.0), rng.random_range(-10.0..10.0));
            let center = if in_square { square } else { in_disk(&mut rng, radius_m) };
            if center.coords.norm() > 0.2 {
                columns.push((center, 0.0));
            }
        }
        Self { radius_m, columns, path: Spiral::WANG_2023.points(), hull_m: 0.0, clearance_m: 0.0 }
    }

    /// The columns in the form for planners.
    pub fn obstacles(&self) -> Vec<Obstacle<'static>> {
        discs::obstacles(&self.columns)
    }

    /// The site in the form for planners.
    pub fn site<'a>(&self, obstacles: &'a [Obstacle<'a>], motion: Motion) -> Site<'a> {
        Site {
            revision: 0,
            boundary: Boundary::Circle { radius_m: self.radius_m },
            obstacles,
            zones: &[],
            limits: Limits {
                motion,
                v_max_m_per_s: 0.35,
                w_max_rad_per_s: 0.8,
                radius_m: self.hull_m,
                sensing_range_m: 3.0,
                acceleration_m_per_s2: 100.0,
                tick_s: 0.1,
                amphibious: None,
            },
            swath_m: 1.0,
            clearance_m: self.clearance_m,
            seed: 0,
        }
    }

    /// Distance from the hull of a robot at a place to the nearest column or the wall, metres.
    pub fn hull_clearance_m(&self, at: Point) -> f64 {
        discs::distance_m(&self.columns, at).min(self.radius_m - at.coords.norm()) - self.hull_m
    }
}

fn in_disk(rng: &mut Pcg64Mcg, radius_m: f64) -> Point {
    loop {
        let point = Point::new(rng.random_range(-radius_m..radius_m), rng.random_range(-radius_m..radius_m));
        if point.coords.norm() < radius_m {
            return point;
        }
    }
}
