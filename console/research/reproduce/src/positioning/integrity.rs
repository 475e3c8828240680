//! Protection levels against true errors: without a fault and with one wrong station, in random geometries, from ranges
//! and from differences between arrivals.

use super::setup::{RADIUS_M, on_disc, rng};
use crate::study::{Block, Job, Result, Row, Sample, Study};
use nalgebra::{Matrix3, Vector3};
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
    about: "protection levels against true errors, without a fault and with one wrong station, from ranges and from \
            differences, each in 40 random geometries; a draw is 1000 fixes in each",
    layouts: 25,
    run,
};

/// Number of geometries for ranges.
const GEOMETRIES: usize = 40;
/// Numbers of stations; every geometry has one of them.
const STATIONS: [u32; 4] = [4, 5, 6, 8];
/// Number of further geometries, which only differences use, because they need five stations.
const FURTHER: usize = 10;
/// Number of stations of the further geometries.
const FURTHER_STATIONS: u32 = 7;
/// The least number of stations for a level from differences.
const LEAST_FOR_DIFFERENCES: usize = 5;
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

/// The length by which all ranges are too long if the time of emission is unknown, metres.
const EXCESS_M: f64 = 200.0;
/// The error that a single test at a false alarm rate of 0.1 % detects in 80 % of the cases, in standard deviations of
/// the test (Baarda 1968).
const DETECTABLE: f64 = 4.13;
/// The share of a range's variance that must remain in its residual for the other ranges to check it.
const LEAST_SPARED: f64 = 1e-6;

/// The id of the totals over all geometries.
const ALL: &str = "all";
/// The largest share of fixes without a fault that may be beyond their level.
const MOST_BEYOND: f64 = 1e-5;
/// The largest level of the median geometry without a fault, relative to the error that one fix in 1000 exceeds.
const MOST_LEVEL_TO_ERROR: f64 = 2.5;

/// The share of the fixes that must name the right station if it is wrong by twice the detectable error, from this number of
/// stations on.
const LEAST_NAMED: f64 = 0.95;
const NAMED_FROM: usize = 5;

/// The error of a station.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    None,
    /// One station is wrong by up to [`MOST_WRONG`] standard deviations.
    Any,
    /// One station is wrong by twice the least error that one fix detects at this place.
    TwiceDetectable,
}

/// What is measured, whether the time of emission is unknown, and which station is wrong.
const METHODS: [(&str, bool, Fault); 6] = [
    ("ranges", false, Fault::None),
    ("ranges/one-fault", false, Fault::Any),
    ("ranges/twice-detectable", false, Fault::TwiceDetectable),
    ("differences", true, Fault::None),
    ("differences/one-fault", true, Fault::Any),
    ("differences/twice-detectable", true, Fault::TwiceDetectable),
];

struct Geometry {
    id: String,
    stations: Vec<Station>,
    /// Whether only differences use it.
    is_further: bool,
}

impl Geometry {
    /// Whether a method measures in this geometry.
    fn suits(&self, is_emission_free: bool) -> bool {
        if is_emission_free { self.stations.len() >= LEAST_FOR_DIFFERENCES } else { !self.is_further }
    }
}

fn geometries() -> Vec<Geometry> {
    let first = (0..GEOMETRIES).map(|k| geometry(k, STATIONS[k % STATIONS.len()], false));
    let further = (GEOMETRIES..GEOMETRIES + FURTHER).map(|k| geometry(k, FURTHER_STATIONS, true));
    first.chain(further).collect()
}

/// Stations at random places on the shell that are not too close to each other.
fn geometry(index: usize, n: u32, is_further: bool) -> Geometry {
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
    let stations = (1..).zip(&angles).map(station).collect();
    Geometry { id: format!("{n}-stations/{index:02}"), stations, is_further }
}

/// The results of many cycles.
#[derive(Default, Serialize, Deserialize)]
struct Tally {
    cycles: usize,
    /// Cycles with an alarm, or without a fix.
    alarms: usize,
    /// Fixes from which the solver left out a station, and those from which it left out the wrong one.
    excluded: usize,
    named: usize,
    /// Cycles in which the most likely wrong station is the right one, however it is found.
    likeliest: usize,
    /// Fixes with an error beyond their level.
    beyond: usize,
    errors_m: Vec<f32>,
    /// The levels of the protected fixes.
    levels_m: Vec<f32>,
}

impl Tally {
    fn add(&mut self, error_m: f64, level: Option<f64>) {
        self.errors_m.push(error_m as f32);
        if let Some(level_m) = level {
            self.levels_m.push(level_m as f32);
            self.beyond += usize::from(error_m > level_m);
        }
    }

    fn join<'a>(all: impl Iterator<Item = &'a Self>) -> Self {
        all.fold(Self::default(), |mut sum, one| {
            sum.cycles += one.cycles;
            sum.alarms += one.alarms;
            sum.excluded += one.excluded;
            sum.named += one.named;
            sum.likeliest += one.likeliest;
            sum.beyond += one.beyond;
            sum.errors_m.extend(&one.errors_m);
            sum.levels_m.extend(&one.levels_m);
            sum
        })
    }

    fn fixes(&self) -> usize {
        self.errors_m.len()
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

    /// The rows of these cycles; the error is that of all fixes, the level that of the protected ones.
    fn rows(&self, block: &Block<'_>, fault: Fault) -> Vec<Row> {
        let mut rows = self.rates(block, fault);
        rows.extend([
            block.row("level_median", self.level_m(), "m", self.levels_m.len()),
            block.row("error_p99_9", self.error_p99_9_m(), "m", self.fixes()),
            block.row("level_to_error", self.level_to_error(), "", self.fixes()),
        ]);
        rows
    }

    /// The shares of cycles and fixes.
    fn rates(&self, block: &Block<'_>, fault: Fault) -> Vec<Row> {
        let rate =
            |metric: &str, part: usize, of: usize| block.row(metric, part as f64 / of.max(1) as f64, "", of);
        let mut rows = vec![
            rate("beyond_rate", self.beyond, self.fixes()),
            rate("protected_rate", self.levels_m.len(), self.cycles),
            rate("alarm_rate", self.alarms, self.cycles),
            rate("excluded_rate", self.excluded, self.cycles),
        ];
        if fault != Fault::None {
            rows.push(rate("named_rate", self.named, self.cycles));
            rows.push(rate("named_rate_best", self.likeliest, self.cycles));
        }
        rows
    }
}

fn run(job: &Job<'_>) -> Result<Vec<Row>> {
    let chosen = job.cases(geometries().into_iter().map(Some).chain([None]), |one| id_of(one.as_ref()))?;
    // Alone, the totals are those of all geometries.
    let are_listed = chosen.iter().any(Option::is_some);
    let cases: Vec<Geometry> = if are_listed { chosen.into_iter().flatten().collect() } else { geometries() };
    let methods = job.methods(METHODS, |(id, ..)| (*id).into())?;
    let done = job.runner.grid(&cases, &job.seeds(), |_, geometry, seed| {
        Ok(methods.iter().map(|method| draw(geometry, method, *seed)).collect::<Vec<Tally>>())
    })?;
    let (mut totals, mut rows) = (Vec::new(), Vec::new());
    for (m, (method, _, fault)) in methods.iter().enumerate() {
        let of_case: Vec<Tally> =
            done.iter().map(|draws| Tally::join(draws.iter().map(|draw| &draw[m]))).collect();
        let listed = cases.iter().zip(&of_case).filter(|(_, tally)| are_listed && tally.cycles > 0);
        for (geometry, tally) in listed {
            rows.extend(tally.rows(&job.block(&geometry.id, method, ""), *fault));
        }
        let block = job.block(ALL, method, "");
        totals.extend(total_rows(&block, &of_case, *fault));
        if *fault == Fault::TwiceDetectable {
            totals.extend(named_rows(&block, &cases, &of_case));
        }
    }
    // The totals come first: they are the result.
    totals.extend(rows);
    Ok(totals)
}

/// The id of a geometry; that of the totals without one.
fn id_of(geometry: Option<&Geometry>) -> String {
    geometry.map_or_else(|| ALL.to_owned(), |geometry| geometry.id.clone())
}

/// The rows of a method over all geometries. The criteria are those of the design of the protection levels; the note of
/// a row with a criterion states whether it is met.
fn total_rows(block: &Block<'_>, of_case: &[Tally], fault: Fault) -> Vec<Row> {
    let (allowed, why) = match fault {
        Fault::None => (MOST_BEYOND, "the accepted risk"),
        _ => (MOST_BEYOND / Risk::default().prior(), "the accepted risk over the probability of a fault"),
    };
    let met = |is_met: bool| if is_met { "met" } else { "NOT MET" };
    let ratios: Sample = of_case.iter().filter_map(Tally::level_to_error).collect();
    let mut rows = Tally::join(of_case.iter()).rates(block, fault);
    if let Some(beyond) = rows.iter_mut().find(|row| row.metric == "beyond_rate") {
        let is_met = beyond.ours.is_some_and(|rate| rate <= allowed);
        beyond.note = format!("at most {allowed:e} allowed, {why}: {}", met(is_met));
    }
    let mut median = block.row("level_to_error_median", ratios.median(), "", ratios.len());
    if fault == Fault::None {
        let is_met = median.ours.is_some_and(|ratio| ratio <= MOST_LEVEL_TO_ERROR);
        median.note = format!("at most {MOST_LEVEL_TO_ERROR} allowed: {}", met(is_met));
    }
    rows.extend([
        block.row("beyond_allowed", allowed, "", 1),
        median,
        block.row("level_to_error_max", ratios.max(), "", ratios.len()),
    ]);
    rows
}

/// For each number of stations that can name a wrong one, how often they name the right one; the note states whether that is
/// enough, and how often the best test would.
fn named_rows(block: &Block<'_>, cases: &[Geometry], of_case: &[Tally]) -> Vec<Row> {
    let mut numbers: Vec<usize> = cases.iter().map(|geometry| geometry.stations.len()).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let row = |n: usize| {
        let all = cases.iter().zip(of_case).filter(|(geometry, _)| geometry.stations.len() == n);
        let tally = Tally::join(all.map(|(_, tally)| tally));
        let rate = |part: usize| part as f64 / tally.cycles as f64;
        let (named, best) = (rate(tally.named), rate(tally.likeliest));
        let met = if named >= LEAST_NAMED { "met" } else { "NOT MET" };
        let note =
            format!("at least {LEAST_NAMED} required: {met}; the best test names {:.1} %", 100.0 * best);
        (tally.cycles > 0)
            .then(|| block.row(&format!("named_rate_{n}_stations"), named, "", tally.cycles).note(note))
    };
    numbers.into_iter().filter(|n| *n >= NAMED_FROM).filter_map(row).collect()
}

/// One draw; without cycles in a geometry that does not suit the method.
fn draw(geometry: &Geometry, (id, is_emission_free, fault): &(&str, bool, Fault), seed: u64) -> Tally {
    let mut tally = Tally::default();
    if !geometry.suits(*is_emission_free) {
        return tally;
    }
    let purpose =
        geometry.id.bytes().chain(id.bytes()).fold(442, |sum: u64, b| sum * 31 % 1_000_003 + u64::from(b));
    let mut rng = rng(seed, purpose);
    for _ in 0..FIXES {
        let at = on_disc(&mut rng) * (1.0 - HULL_M / RADIUS_M);
        let mut ranges = heard(geometry, at, &mut rng);
        let wrong = spoil(&mut ranges, (geometry, at), (*is_emission_free, *fault), &mut rng);
        let likeliest = likeliest(&ranges, (geometry, at), *is_emission_free);
        tally.likeliest += usize::from(wrong.is_some() && likeliest == wrong);
        let fix = if *is_emission_free {
            for range in &mut ranges {
                range.range_m += EXCESS_M;
            }
            Screened(Differences).solve(&ranges, &geometry.stations, None)
        } else {
            Screened(Nls).solve(&ranges, &geometry.stations, None)
        };
        tally.cycles += 1;
        // Ranges that give no fix are an alarm, too.
        tally.alarms += usize::from(!fix.as_ref().is_ok_and(|fix| fix.integrity != Integrity::Alarm));
        let Ok(fix) = fix else { continue };
        let left_out: Vec<StationId> = fix.excluded.iter().map(|(id, _)| *id).collect();
        tally.excluded += usize::from(!left_out.is_empty());
        tally.named += usize::from(wrong.is_some() && left_out.first().copied() == wrong);
        tally.add((fix.position - at).norm(), level(&fix, geometry, *is_emission_free));
    }
    tally
}

/// Makes the range of a station wrong; returns the station.
fn spoil(
    ranges: &mut [Ranging],
    (geometry, at): (&Geometry, Point),
    (is_emission_free, fault): (bool, Fault),
    rng: &mut Pcg64,
) -> Option<StationId> {
    let n = ranges.len();
    let (index, bias_m) = match fault {
        Fault::None => return None,
        Fault::Any => {
            let bias_m = SIGMA_M * rng.random_range(-MOST_WRONG..=MOST_WRONG);
            (rng.random_range(0..n), bias_m)
        }
        Fault::TwiceDetectable => {
            let (index, is_long) = (rng.random_range(0..n), rng.random::<bool>());
            let detectable_m = detectable_m(&geometry.stations, at, index, is_emission_free)?;
            (index, 2.0 * detectable_m * if is_long { 1.0 } else { -1.0 })
        }
    };
    // A range stays longer than zero.
    ranges[index].range_m = (ranges[index].range_m + bias_m).max(0.01);
    Some(ranges[index].station)
}

/// The least error of the range of a station that one fix detects, metres; `None` if the others cannot check it.
pub(super) fn detectable_m(
    stations: &[Station],
    at: Point,
    index: usize,
    is_emission_free: bool,
) -> Option<f64> {
    let (by, covariance) = linearised(stations, at, is_emission_free)?;
    let spared = 1.0 - by[index].dot(&(covariance * by[index]));
    (spared > LEAST_SPARED).then(|| DETECTABLE * SIGMA_M / spared.sqrt())
}

/// The station that is wrong with the greatest likelihood, by the true errors of the ranges in the equations that are
/// linearised at the true place. If every station is equally likely to be wrong, by equally many standard deviations of
/// its test, then no test of one fix names the right station more often (the Bayes rule).
fn likeliest(
    ranges: &[Ranging],
    (geometry, at): (&Geometry, Point),
    is_emission_free: bool,
) -> Option<StationId> {
    let (by, covariance) = linearised(&geometry.stations, at, is_emission_free)?;
    let errors = ranges.iter().zip(&geometry.stations);
    let errors_m: Vec<f64> = errors.map(|(r, s)| r.range_m - (at - s.position).norm()).collect();
    let pull: Vector3<f64> = by.iter().zip(&errors_m).map(|(by, error_m)| by * *error_m).sum();
    let score = |index: usize| {
        let spared = 1.0 - by[index].dot(&(covariance * by[index]));
        let residual_m = errors_m[index] - by[index].dot(&(covariance * pull));
        (spared > LEAST_SPARED).then(|| (index, residual_m.abs() / spared.sqrt()))
    };
    let best = (0..by.len()).filter_map(score).max_by(|one, other| one.1.total_cmp(&other.1));
    best.map(|(index, _)| ranges[index].station)
}

/// The derivatives of the ranges by x, y and the common length at a place, and the covariance of these three unknowns for
/// ranges with a standard deviation of 1.
fn linearised(
    stations: &[Station],
    at: Point,
    is_emission_free: bool,
) -> Option<(Vec<Vector3<f64>>, Matrix3<f64>)> {
    let by = |station: &Station| {
        let away = (at - station.position).normalize();
        Vector3::new(away.x, away.y, f64::from(u8::from(is_emission_free)))
    };
    let by: Vec<Vector3<f64>> = stations.iter().map(by).collect();
    let mut information: Matrix3<f64> = by.iter().map(|by| by * by.transpose()).sum();
    // A known time of emission has a column of zeros.
    information[(2, 2)] += f64::from(u8::from(!is_emission_free));
    Some((by, information.try_inverse()?))
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
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn every_geometry_has_its_own_stations_and_the_same_draw_gives_the_same_figures() {
        let all = geometries();
        for is_emission_free in [false, true] {
            assert_eq!(all.iter().filter(|one| one.suits(is_emission_free)).count(), GEOMETRIES);
        }
        assert!(all.windows(2).all(|pair| pair[0].stations != pair[1].stations));
        let [first, again] = [0, 0].map(|_| draw(&all[2], &METHODS[1], 7));
        assert_eq!((first.errors_m, first.levels_m), (again.errors_m, again.levels_m));
        assert!(draw(&all[0], &METHODS[3], 7).cycles == 0, "differences need five stations");
    }

    #[test]
    fn the_totals_say_whether_their_criteria_are_met() {
        let block = Block { table: "integrity", case: ALL, method: "ranges", note: "" };
        let tally = |beyond| Tally {
            cycles: 1000,
            beyond,
            errors_m: vec![0.1; 1000],
            levels_m: vec![0.2; 1000],
            ..Tally::default()
        };
        let note = |beyond, fault, metric: &str| {
            let rows = total_rows(&block, &[tally(beyond)], fault);
            rows.iter().find(|row| row.metric == metric).unwrap().note.clone()
        };
        assert_eq!(note(0, Fault::None, "beyond_rate"), "at most 1e-5 allowed, the accepted risk: met");
        assert!(note(1, Fault::None, "beyond_rate").ends_with(": NOT MET"));
        assert!(note(1, Fault::Any, "beyond_rate").ends_with(": met"), "one in ten is allowed");
        assert_eq!(note(0, Fault::None, "level_to_error_median"), "at most 2.5 allowed: met");
    }

    #[test]
    fn the_share_of_named_stations_is_judged_for_each_number_of_stations() {
        let (cases, tally) = (geometries(), |named| Tally { cycles: 100, named, ..Tally::default() });
        let of_case: Vec<Tally> =
            cases.iter().map(|case| tally(if case.stations.len() == 5 { 90 } else { 97 })).collect();
        let block = Block { table: "integrity", case: ALL, method: "ranges", note: "" };
        let rows = named_rows(&block, &cases, &of_case);
        let told: Vec<(&str, bool)> =
            rows.iter().map(|row| (row.metric.as_str(), row.note.contains("NOT MET"))).collect();
        let expected = [5, 6, 7, 8].map(|n| (format!("named_rate_{n}_stations"), n == 5));
        assert_eq!(told, expected.each_ref().map(|(metric, is_missed)| (metric.as_str(), *is_missed)));
    }

    #[test]
    fn the_station_that_is_wrong_by_twice_the_detectable_error_is_named_by_most_fixes_of_eight_stations() {
        let all = geometries();
        for method in [&METHODS[2], &METHODS[5]] {
            let tally = draw(&all[3], method, 7);
            assert!(tally.named > 900 && tally.cycles == FIXES, "{}: {}", method.0, tally.named);
            // The solver, which linearises elsewhere, is as good as the best test.
            assert!(tally.likeliest + 20 > tally.named, "{}: {}", method.0, tally.likeliest);
        }
    }
}
