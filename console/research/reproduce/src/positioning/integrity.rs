//! Protection levels against true errors: without a fault and with one wrong station, in random geometries.

use super::setup::{RADIUS_M, on_disc, rng};
use crate::study::{Block, Job, Result, Row, Sample, Study};
use positioning::{
    Differences, Fix, Integrity, Nls, PositionSolver, Ranging, Risk, Screened, protection::level_m,
};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use world::{Point, Station, StationId};

pub(super) const STUDY: Study = Study {
    name: "integrity",
    about: "protection levels against true errors, without a fault and with one wrong station, in 40 random \
            geometries; a draw is 1000 fixes in each",
    layouts: 25,
    run,
};

/// Number of geometries.
const GEOMETRIES: usize = 40;
/// Numbers of stations; every geometry has one of them.
const STATIONS: [u32; 4] = [4, 5, 6, 8];
/// Number of fixes of a draw.
const FIXES: usize = 1_000;
/// Standard deviation of a range, metres.
const SIGMA_M: f64 = 0.1;
/// The largest error of a wrong station, in standard deviations.
const MOST_WRONG: f64 = 10.0;
/// Least distance of the robot's centre from the shell, metres: the stations are on the shell.
const HULL_M: f64 = 0.5;
/// Least distance between two stations, as a share of the distance in an even ring.
const LEAST_APART: f64 = 0.3;

/// What is measured, and whether a station is wrong.
const METHODS: [(&str, bool, bool); 4] = [
    ("ranges", false, false),
    ("ranges/one-fault", false, true),
    ("differences", true, false),
    ("differences/one-fault", true, true),
];

struct Geometry {
    id: String,
    stations: Vec<Station>,
}

fn geometries() -> Vec<Geometry> {
    (0..GEOMETRIES).map(|k| geometry(k, STATIONS[k % STATIONS.len()])).collect()
}

/// Stations at random places on the shell that are not too close to each other.
fn geometry(index: usize, n: u32) -> Geometry {
    let mut rng = rng(index as u64, 441);
    let least = LEAST_APART * TAU / f64::from(n);
    let mut angles: Vec<f64> = Vec::new();
    while angles.len() < n as usize {
        let angle = rng.random_range(0.0..TAU);
        let apart = |other: &f64| (angle - other).abs().min(TAU - (angle - other).abs());
        if angles.iter().all(|other| apart(other) > least) {
            angles.push(angle);
        }
    }
    let station = |(id, angle): (u32, &f64)| Station {
        id: StationId(id),
        name: format!("S{id}"),
        position: Point::new(RADIUS_M * angle.cos(), RADIUS_M * angle.sin()),
    };
    Geometry { id: format!("{n}-stations/{index:02}"), stations: (1..).zip(&angles).map(station).collect() }
}

/// The results of many fixes.
#[derive(Default, Serialize, Deserialize)]
struct Tally {
    fixes: usize,
    /// Fixes with an error beyond their level.
    beyond: usize,
    errors_m: Vec<f32>,
    /// The levels of the protected fixes.
    levels_m: Vec<f32>,
}

impl Tally {
    fn add(&mut self, error_m: f64, level: Option<f64>) {
        self.fixes += 1;
        self.errors_m.push(error_m as f32);
        if let Some(level_m) = level {
            self.levels_m.push(level_m as f32);
            self.beyond += usize::from(error_m > level_m);
        }
    }

    fn join<'a>(all: impl Iterator<Item = &'a Self>) -> Self {
        all.fold(Self::default(), |mut sum, one| {
            (sum.fixes, sum.beyond) = (sum.fixes + one.fixes, sum.beyond + one.beyond);
            sum.errors_m.extend(&one.errors_m);
            sum.levels_m.extend(&one.levels_m);
            sum
        })
    }

    fn level_m(&self) -> Option<f64> {
        self.levels_m.iter().copied().map(f64::from).collect::<Sample>().median()
    }

    fn error_p99_9_m(&self) -> Option<f64> {
        self.errors_m.iter().copied().map(f64::from).collect::<Sample>().quantile(0.999)
    }

    /// Median level over the error that one fix in 1000 exceeds.
    fn level_to_error(&self) -> Option<f64> {
        self.level_m().zip(self.error_p99_9_m()).map(|(level_m, error_m)| level_m / error_m)
    }

    /// The rows of these fixes; the error is that of all fixes, the level that of the protected ones.
    fn rows(&self, block: &Block<'_>) -> Vec<Row> {
        let share = |part: usize| part as f64 / self.fixes.max(1) as f64;
        vec![
            block.row("beyond_rate", share(self.beyond), "", self.fixes),
            block.row("protected_rate", share(self.levels_m.len()), "", self.fixes),
            block.row("level_median", self.level_m(), "m", self.levels_m.len()),
            block.row("error_p99_9", self.error_p99_9_m(), "m", self.fixes),
            block.row("level_to_error", self.level_to_error(), "", self.fixes),
        ]
    }
}

fn run(job: &Job<'_>) -> Result<Vec<Row>> {
    let cases = job.cases(geometries(), |geometry| geometry.id.clone())?;
    let methods = job.methods(METHODS, |(id, ..)| (*id).into())?;
    let done = job.runner.grid(&cases, &job.seeds(), |_, geometry, seed| {
        Ok(methods.iter().map(|method| draw(geometry, method, *seed)).collect::<Vec<Tally>>())
    })?;
    let mut rows = Vec::new();
    for (m, (method, ..)) in methods.iter().enumerate() {
        let of_case: Vec<Tally> =
            done.iter().map(|draws| Tally::join(draws.iter().map(|draw| &draw[m]))).collect();
        for (geometry, tally) in cases.iter().zip(&of_case).filter(|(_, tally)| tally.fixes > 0) {
            rows.extend(tally.rows(&job.block(&geometry.id, method, "")));
        }
        let all = Tally::join(of_case.iter());
        let block =
            job.block("all", method, "with a fault: 1e-5 over the probability that this station is wrong");
        let allowed = if method.ends_with("fault") { 1e-5 / Risk::default().prior() } else { 1e-5 };
        let ratios: Sample = of_case.iter().filter_map(Tally::level_to_error).collect();
        rows.push(block.row("beyond_rate", all.beyond as f64 / all.fixes.max(1) as f64, "", all.fixes));
        rows.push(block.row("beyond_allowed", allowed, "", all.fixes));
        rows.push(block.row("level_to_error_median", ratios.median(), "", ratios.len()));
        rows.push(block.row("level_to_error_max", ratios.max(), "", ratios.len()));
    }
    Ok(rows)
}

/// One draw; without fixes if the geometry has too few stations for a level.
fn draw(geometry: &Geometry, (id, is_emission_free, is_wrong): &(&str, bool, bool), seed: u64) -> Tally {
    let mut tally = Tally::default();
    let n = geometry.stations.len();
    if *is_emission_free && n < 5 {
        return tally;
    }
    let purpose =
        geometry.id.bytes().chain(id.bytes()).fold(442, |sum: u64, b| sum * 31 % 1_000_003 + u64::from(b));
    let mut rng = rng(seed, purpose);
    for _ in 0..FIXES {
        let at = on_disc(&mut rng) * (1.0 - HULL_M / RADIUS_M);
        let mut ranges = heard(geometry, at, &mut rng);
        if *is_wrong {
            let bias_m = SIGMA_M * rng.random_range(-MOST_WRONG..=MOST_WRONG);
            ranges[rng.random_range(0..n)].range_m += bias_m;
        }
        let fix = if *is_emission_free {
            Screened(Differences).solve(&ranges, &geometry.stations, None)
        } else {
            Screened(Nls).solve(&ranges, &geometry.stations, None)
        };
        // Ranges that give no fix are an alarm, too.
        let Ok(fix) = fix else { continue };
        let level = level(&fix, geometry, *is_emission_free);
        tally.add((fix.position - at).norm(), level);
    }
    tally
}

/// The level of a fix without an alarm.
fn level(fix: &Fix, geometry: &Geometry, is_emission_free: bool) -> Option<f64> {
    (fix.integrity != Integrity::Alarm)
        .then(|| level_m(fix, &geometry.stations, &Risk::default(), is_emission_free))
        .flatten()
}

fn heard(geometry: &Geometry, at: Point, rng: &mut Pcg64) -> Vec<Ranging> {
    let range = |station: &Station| {
        let noise: f64 = StandardNormal.sample(rng);
        // No range is shorter than one centimetre: the robot is a hull away from every station.
        let range_m = ((at - station.position).norm() + SIGMA_M * noise).max(0.01);
        Ranging { timing_sigma_m: SIGMA_M, ..Ranging::single(station.id, range_m, SIGMA_M) }
    };
    geometry.stations.iter().map(range).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_geometry_has_its_own_stations_and_the_same_draw_gives_the_same_figures() {
        let all = geometries();
        assert_eq!(all.len(), GEOMETRIES);
        assert!(all.windows(2).all(|pair| pair[0].stations != pair[1].stations));
        let [first, again] = [0, 0].map(|_| draw(&all[2], &METHODS[1], 7));
        assert_eq!((first.errors_m, first.levels_m), (again.errors_m, again.levels_m));
        assert!(draw(&all[0], &METHODS[2], 7).fixes == 0, "differences need five stations");
    }
}
