//! Tanks, stations, true positions and their ranges, all generated from seeds.

use positioning::RangeNoise;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use sim::{AeConfig, Disturbances, NoiseModel, Sounder, StationFault};
use std::f64::consts::{PI, TAU};
use world::{Boundary, Obstacle, ObstacleId, Point, RangeSet, Shape, Station, StationId, World};

/// Radius of the paper's tank, metres.
pub(super) const RADIUS_M: f64 = 10.0;
/// Radius of the columns of a case with columns, metres.
const COLUMN_M: f64 = 0.35;
/// Radius of the robot, which must fit beside the columns, metres.
const HULL_M: f64 = 0.25;
/// Number of cycles of a session.
pub(super) const SESSION: usize = 250;

/// The arrangement of the stations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Layout {
    /// The paper's three stations.
    Paper,
    /// This number of stations on a ring of this radius, metres.
    Ring(u32, f64),
}

impl Layout {
    /// The stations.
    pub(super) fn stations(self) -> Vec<Station> {
        let places: Vec<Point> = match self {
            Self::Paper => vec![Point::new(7.5, 0.0), Point::new(-7.5, 0.0), Point::new(0.0, 7.5)],
            Self::Ring(n, radius_m) => on_ring(n, radius_m, 0.0),
        };
        let station = |(id, position)| Station { id: StationId(id), name: format!("S{id}"), position };
        (1..).zip(places).map(station).collect()
    }

    /// The part of a case's id that names the arrangement.
    pub(super) fn id(self) -> String {
        match self {
            Self::Paper => "3-stations".into(),
            Self::Ring(n, radius_m) if radius_m >= RADIUS_M => format!("{n}-stations-wall"),
            Self::Ring(n, _) => format!("{n}-stations"),
        }
    }
}

fn on_ring(n: u32, radius_m: f64, turned_rad: f64) -> Vec<Point> {
    (0..n)
        .map(|k| TAU * f64::from(k) / f64::from(n) + turned_rad)
        .map(|angle| Point::new(radius_m * angle.cos(), radius_m * angle.sin()))
        .collect()
}

/// The measurement setup of a case.
#[derive(Debug, Clone)]
pub(super) struct Setup {
    /// The stations at their surveyed positions.
    pub stations: Vec<Station>,
    /// The ranging model.
    pub ae: AeConfig,
    /// Whether there are six columns in the tank.
    pub has_columns: bool,
    /// Whether one station, chosen by the seed, measures 1 m too much.
    pub is_biased: bool,
}

/// A true position, and the ranges measured from it.
pub(super) struct Cycle {
    /// The true position of the robot.
    pub truth: Point,
    /// The ranges, one for each station and repetition.
    pub sets: Vec<RangeSet>,
}

impl Setup {
    /// Undisturbed ranges with this noise and this number of repetitions per cycle.
    pub(super) fn new(layout: Layout, noise: NoiseModel, repetitions: u32) -> Self {
        let ae = AeConfig {
            period_s: 1.0,
            repetitions,
            noise,
            timing: sim::TimingErrors::default(),
            clocks: sim::Clocks::default(),
            pulse_rest_s: None,
            dropout_probability: 0.0,
            outages_s: Vec::new(),
            disturbances: Disturbances::default(),
        };
        Self { stations: layout.stations(), ae, has_columns: false, is_biased: false }
    }

    /// The noise parameters that an estimator receives.
    pub(super) fn noise(&self) -> RangeNoise {
        match self.ae.noise {
            NoiseModel::None => RangeNoise::Gaussian { sigma_ratio: 1e-3 },
            NoiseModel::Uniform { ratio } => RangeNoise::Uniform { ratio },
            NoiseModel::Triangular { ratio } => RangeNoise::Triangular { ratio },
            NoiseModel::Gaussian { sigma_ratio } => RangeNoise::Gaussian { sigma_ratio },
            NoiseModel::HeavyTailed { sigma_ratio } => RangeNoise::HeavyTailed { sigma_ratio },
        }
    }

    fn obstacles(&self) -> Vec<Obstacle> {
        if !self.has_columns {
            return Vec::new();
        }
        let column = |(id, center)| Obstacle {
            id: ObstacleId(id),
            name: format!("C{id}"),
            shape: Shape::Disc { center, radius_m: COLUMN_M },
            known: true,
        };
        (1..).zip(on_ring(6, 5.0, PI / 12.0)).map(column).collect()
    }

    /// The simulated ranging system.
    pub(super) fn sounder(&self, seed: u64) -> Sounder {
        let world = World {
            boundary: Boundary::Circle { radius_m: RADIUS_M },
            obstacles: self.obstacles(),
            stations: self.stations.clone(),
            zones: Vec::new(),
        };
        let mut ae = self.ae.clone();
        if self.is_biased {
            let station = StationId((seed % self.stations.len() as u64) as u32 + 1);
            ae.disturbances.faults =
                vec![StationFault { station, from_s: 0.0, to_s: 1.0, excess_range_m: Some(1.0) }];
        }
        Sounder::new(ae, &world, seed)
    }

    /// A cycle of ranges at each of these true positions in turn.
    pub(super) fn cycles(&self, truths: &[Point], seed: u64) -> Vec<Cycle> {
        let mut sounder = self.sounder(seed);
        truths.iter().map(|truth| Cycle { truth: *truth, sets: sounder.cycle(0.0, *truth) }).collect()
    }

    /// For each seed, a cycle of ranges at a random place on the free floor.
    pub(super) fn session(&self, seeds: &[u64]) -> Vec<Cycle> {
        let obstacles = self.obstacles();
        let is_free = |at: &Point| obstacles.iter().all(|o| o.shape.distance_m(*at) > HULL_M);
        let cycle = |seed: &u64| {
            let mut rng = rng(*seed, 1);
            let truth = std::iter::repeat_with(|| on_disc(&mut rng)).find(is_free).unwrap_or_default();
            Cycle { truth, sets: self.sounder(*seed).cycle(0.0, truth) }
        };
        seeds.iter().map(cycle).collect()
    }
}

/// The random number generator for one purpose of one draw.
pub(super) fn rng(seed: u64, purpose: u64) -> Pcg64 {
    Pcg64::seed_from_u64(
        seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ purpose.wrapping_mul(0xbf58_476d_1ce4_e5b9),
    )
}

/// A random point, uniform on the floor.
pub(super) fn on_disc(rng: &mut Pcg64) -> Point {
    loop {
        let point = in_square(rng);
        if point.coords.norm() <= RADIUS_M {
            return point;
        }
    }
}

/// A random point, uniform in the square around the floor.
pub(super) fn in_square(rng: &mut Pcg64) -> Point {
    Point::new(rng.random_range(-RADIUS_M..=RADIUS_M), rng.random_range(-RADIUS_M..=RADIUS_M))
}

/// The paper's spiral of 500 points, from the wall to the middle.
pub(super) fn spiral() -> Vec<Point> {
    (0..500)
        .map(f64::from)
        .map(|k| (RADIUS_M - 0.02 * k, 0.1 * k))
        .map(|(radius, angle)| Point::new(radius * angle.cos(), radius * angle.sin()))
        .collect()
}
