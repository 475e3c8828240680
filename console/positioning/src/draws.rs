//! Seeded truths and noise for the tests of this crate.

use crate::{Aggregation, RangeNoise, Ranging};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use world::{Point, RangeSet, Station, StationId};

/// Radius of the paper's tank, metres.
pub(crate) const RADIUS_M: f64 = 10.0;

/// Returns stations at the given places, numbered from 1.
pub(crate) fn stations(places: &[(f64, f64)]) -> Vec<Station> {
    (1..)
        .zip(places)
        .map(|(id, (x, y))| Station {
            id: StationId(id),
            name: format!("S{id}"),
            position: Point::new(*x, *y),
        })
        .collect()
}

/// Returns the layout of Wang et al. 2023; its circumcentre is the origin.
pub(crate) fn paper_stations() -> Vec<Station> {
    stations(&[(7.5, 0.0), (-7.5, 0.0), (0.0, 7.5)])
}

/// Returns a layout without any symmetry.
pub(crate) fn skew_stations() -> Vec<Station> {
    stations(&[(8.1, -1.2), (-5.3, 3.9), (1.7, 6.6)])
}

/// Returns stations evenly spaced on a ring.
pub(crate) fn ring(n: u32, radius_m: f64) -> Vec<Station> {
    let places: Vec<(f64, f64)> = (0..n)
        .map(|k| f64::from(k) * std::f64::consts::TAU / f64::from(n))
        .map(|angle| (radius_m * angle.cos(), radius_m * angle.sin()))
        .collect();
    stations(&places)
}

/// Uniform noise of the paper's eq. 13.
pub(crate) struct Draws {
    /// Largest error as a share of the distance.
    pub ratio: f64,
    /// Ranges per station.
    pub repetitions: usize,
    rng: Pcg64,
}

impl Draws {
    /// Creates noise from a seed.
    pub(crate) fn new(ratio: f64, repetitions: usize, seed: u64) -> Self {
        Self { ratio, repetitions, rng: Pcg64::seed_from_u64(seed) }
    }

    /// Returns a number uniformly distributed between -1 and 1.
    pub(crate) fn even(&mut self) -> f64 {
        self.rng.random_range(-1.0..1.0)
    }

    /// Returns an approximately normal number with mean 0 and variance 1.
    pub(crate) fn bell(&mut self) -> f64 {
        (0..12).map(|_| self.even() / 2.0).sum()
    }

    /// Returns a point uniformly distributed on the floor of the paper's tank.
    pub(crate) fn on_disc(&mut self) -> Point {
        loop {
            let point = Point::new(self.even(), self.even()) * RADIUS_M;
            if point.coords.norm() <= RADIUS_M {
                return point;
            }
        }
    }

    /// Returns one ranging cycle.
    pub(crate) fn cycle(&mut self, stations: &[Station], truth: Point) -> Vec<RangeSet> {
        let set = |station: &Station| {
            let distance = (truth - station.position).norm();
            let ranges_m =
                (0..self.repetitions).map(|_| distance * (1.0 + self.ratio * self.even())).collect();
            RangeSet { station: station.id, ranges_m }
        };
        stations.iter().map(set).collect()
    }

    /// Returns one ranging cycle, aggregated.
    pub(crate) fn rangings(&mut self, stations: &[Station], truth: Point, how: Aggregation) -> Vec<Ranging> {
        let noise = RangeNoise::Uniform { ratio: self.ratio };
        how.aggregate(&self.cycle(stations, truth), &noise).expect("true distances give usable ranges")
    }
}

/// Returns ranges without error and with a sigma of 3 cm.
pub(crate) fn exact(stations: &[Station], truth: Point) -> Vec<Ranging> {
    stations.iter().map(|s| Ranging::single(s.id, (truth - s.position).norm(), 0.03)).collect()
}
