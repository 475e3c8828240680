//! The least detectable errors of stations, measured and forecast, and whether windows in which a wrong station looks like a
//! wrong speed of sound are said to be so.

use super::{
    integrity::detectable_m,
    sessions::{LANE_M, NOISE, RADIUS_M, Ring, Robot, SCALE, SIGMA_M, STEP_M, calibration, heard, near},
    setup::rng,
};
use crate::study::{Block, Job, Result, Row, Sample, Study};
use nalgebra::{Matrix4, Vector2, Vector4};
use positioning::{
    Differences, Forecast, Integrity, News, Nls, PositionSolver, Ranging, Risk, Screened,
    accuracy::checks::{NOT_SEPARABLE, SESSION_FIXES},
};
use rand::RngExt;
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use world::{Boundary, ObstacleMap, Odometry, Point, RangeSet, Station, StationId};

pub(super) const STUDY: Study = Study {
    name: "detectable",
    about: "the least detectable error of a station, measured and forecast, with one fix and with a session; and whether \
            sessions in which a wrong station looks like a wrong speed of sound are said to be so; random rings",
    layouts: 100,
    run,
};

/// Numbers of stations, and whether the time of emission is unknown.
const CASES: [(usize, bool); 6] = [(5, false), (6, false), (8, false), (5, true), (6, true), (8, true)];
/// Errors of the worst station, as multiples of the forecast.
const FACTORS: [f64; 8] = [0.6, 0.8, 0.9, 1.0, 1.1, 1.2, 1.4, 1.6];
/// The share of the errors that the least detectable one is detected with.
const POWER: f64 = 0.8;
/// The largest deviation of the measured least detectable error from the forecast, as a share.
const WITHIN: f64 = 0.1;
/// Number of places of a ring with one fix each for every factor.
const PLACES: usize = 100;
/// Least distance of the robot's centre from the shell, metres.
const HULL_M: f64 = 0.5;
/// The correlation below which a session must seldom be called not separable, and how seldom.
const CLEAR: f64 = 0.8;
const MOST_CLEAR_SAID: f64 = 0.02;
/// Least and largest motion between two fixes in a session that may not be separable, metres.
const STEPS_M: [f64; 2] = [0.005, 0.4];

/// What is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Measured {
    Fix,
    Session,
    Separable,
}

const METHODS: [(&str, Measured); 3] =
    [("one-fix", Measured::Fix), ("session", Measured::Session), ("separable", Measured::Separable)];

/// The findings of one ring.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
enum Found {
    /// For each factor: the number of trials, and of those that detect the error.
    Detected(Vec<(usize, usize)>),
    /// The correlation of a wrong station with a wrong speed of sound, and whether the session is said not to be separable.
    Said(Option<(f64, bool)>),
}

fn run(job: &Job<'_>) -> Result<Vec<Row>> {
    let cases = job.cases(CASES, |(n, is_free)| {
        format!("{n}-stations-{}", if *is_free { "differences" } else { "ranges" })
    })?;
    let methods = job.methods(METHODS, |(id, _)| (*id).into())?;
    let done = job.runner.grid(&cases, &job.seeds(), |_, (n, is_free), seed| {
        let stations = Ring::Uneven.stations(*n, &mut rng(*seed, 460 + *n as u64));
        let found = |(k, (_, what)): (usize, &(&str, Measured))| {
            let mut rng = rng(*seed, 470 + 10 * *n as u64 + 4 * u64::from(*is_free) + k as u64);
            match what {
                Measured::Fix => Found::Detected(fixes(&stations, *is_free, &mut rng)),
                Measured::Session => Found::Detected(sessions(&stations, *is_free, &mut rng)),
                Measured::Separable => Found::Said(separable(&stations, *is_free, &mut rng)),
            }
        };
        Ok(methods.iter().enumerate().map(found).collect::<Vec<Found>>())
    })?;
    let mut rows = Vec::new();
    for ((n, is_free), draws) in cases.iter().zip(&done) {
        let case = format!("{n}-stations-{}", if *is_free { "differences" } else { "ranges" });
        for (m, (method, what)) in methods.iter().enumerate() {
            let all: Vec<&Found> = draws.iter().map(|draw| &draw[m]).collect();
            let block = job.block(&case, method, "");
            rows.extend(if *what == Measured::Separable {
                said_rows(&block, &all)
            } else {
                detected_rows(&block, &all)
            });
        }
    }
    Ok(rows)
}

/// For each factor the share of the errors that were detected, and the factor with the power of the forecast.
fn detected_rows(block: &Block<'_>, all: &[&Found]) -> Vec<Row> {
    let mut sums = vec![(0, 0); FACTORS.len()];
    for found in all {
        let Found::Detected(counts) = found else { continue };
        for (sum, (trials, detected)) in sums.iter_mut().zip(counts) {
            *sum = (sum.0 + trials, sum.1 + detected);
        }
    }
    let rates: Vec<f64> = sums.iter().map(|(n, detected)| *detected as f64 / (*n).max(1) as f64).collect();
    let n = sums.iter().map(|(n, _)| n).sum();
    let measured = factor_with_power(&rates);
    let met = match measured {
        Some(factor) if (factor - 1.0).abs() <= WITHIN => "met",
        Some(_) | None => "NOT MET",
    };
    let listed = FACTORS.iter().zip(&sums).zip(&rates);
    let mut rows: Vec<Row> = listed
        .map(|((factor, (n, _)), rate)| block.row(&format!("detected_rate_at_{factor}"), *rate, "", *n))
        .collect();
    rows.push(
        block
            .row("measured_to_forecast", measured, "", n)
            .note(format!("within {WITHIN} of 1 required: {met}")),
    );
    rows
}

/// The factor at which the errors are detected with the power of the forecast, between two factors; `None` if it is beyond
/// them.
fn factor_with_power(rates: &[f64]) -> Option<f64> {
    let at = rates.windows(2).position(|pair| pair[0] < POWER && pair[1] >= POWER)?;
    let share = (POWER - rates[at]) / (rates[at + 1] - rates[at]);
    Some(FACTORS[at] + share * (FACTORS[at + 1] - FACTORS[at]))
}

fn said_rows(block: &Block<'_>, all: &[&Found]) -> Vec<Row> {
    let known = || all.iter().filter_map(|found| if let Found::Said(said) = found { *said } else { None });
    let rate = |metric: &str, is: &dyn Fn(f64) -> bool, is_met: &dyn Fn(f64) -> bool, required: String| {
        let said: Sample = known()
            .filter(|(correlation, _)| is(*correlation))
            .map(|(_, said)| f64::from(u8::from(said)))
            .collect();
        let met = match said.mean() {
            None => "no such session",
            Some(rate) if is_met(rate) => "met",
            Some(_) => "NOT MET",
        };
        block.row(metric, said.mean(), "", said.len()).note(format!("{required}: {met}"))
    };
    vec![
        rate("said_above_0.95", &|c| c > NOT_SEPARABLE, &|rate| rate >= 1.0, "1 required".into()),
        rate(
            "said_below_0.8",
            &|c| c < CLEAR,
            &|rate| rate <= MOST_CLEAR_SAID,
            format!("at most {MOST_CLEAR_SAID} allowed"),
        ),
    ]
}

fn forecast(is_free: bool) -> Forecast {
    Forecast {
        noise: NOISE.0,
        timing: NOISE.1,
        repetitions: 1,
        needs_line_of_sight: false,
        is_emission_unknown: is_free,
        cell_m: 1.0,
    }
}

fn open_tank() -> ObstacleMap {
    ObstacleMap::new(&Boundary::Circle { radius_m: RADIUS_M }, &[])
}

/// Single fixes at random places, with the worst station wrong by each multiple of the forecast at that place.
fn fixes(stations: &[Station], is_free: bool, rng: &mut Pcg64) -> Vec<(usize, usize)> {
    let (forecast, map) = (forecast(is_free), open_tank());
    let mut counts = vec![(0, 0); FACTORS.len()];
    for _ in 0..PLACES {
        let (angle, share): (f64, f64) = (rng.random_range(0.0..TAU), rng.random_range(0.0..1.0));
        let at = Point::from(Vector2::new(angle.cos(), angle.sin()) * ((RADIUS_M - HULL_M) * share.sqrt()));
        let checks = forecast.checks_at(at, stations, &map, &Risk::default());
        let Some(least_m) = checks.and_then(|checks| checks.detectable_m) else { continue };
        let Some(worst) = worst(stations, at, is_free) else { continue };
        for (factor, (trials, detected)) in FACTORS.iter().zip(&mut counts) {
            let sign = if rng.random::<bool>() { 1.0 } else { -1.0 };
            *trials += 1;
            *detected += usize::from(is_seen(stations, at, (worst, sign * factor * least_m), is_free, rng));
        }
    }
    counts
}

/// The index of the station whose error shows least in a fix.
fn worst(stations: &[Station], at: Point, is_free: bool) -> Option<usize> {
    let of = |index: usize| Some((index, detectable_m(stations, at, index, is_free)?));
    (0..stations.len()).filter_map(of).max_by(|a, b| a.1.total_cmp(&b.1)).map(|(index, _)| index)
}

/// Whether a fix leaves a station out or gives an alarm, if the range of one station is wrong by a length, metres.
fn is_seen(
    stations: &[Station],
    at: Point,
    (wrong, error_m): (usize, f64),
    is_free: bool,
    rng: &mut Pcg64,
) -> bool {
    let sets = heard(stations, at, (is_free, stations[wrong].id, error_m), rng);
    let range = |set: &RangeSet| Ranging {
        timing_sigma_m: SIGMA_M,
        ..Ranging::single(set.station, (set.ranges_m[0] / (1.0 + SCALE)).max(0.01), SIGMA_M)
    };
    let ranges: Vec<Ranging> = sets.iter().map(range).collect();
    let fix = if is_free {
        Screened(Differences).solve(&ranges, stations, None)
    } else {
        Screened(Nls).solve(&ranges, stations, None)
    };
    fix.map_or(true, |fix| !fix.excluded.is_empty() || fix.integrity == Integrity::Alarm)
}

/// A stretch of a mission: the true places of the fixes, each with the measured motion to it.
struct Way(Vec<(Point, Vec<(Odometry, f64)>)>);

impl Way {
    /// Drives for this number of fixes from a random lane on.
    fn new(fixes: usize, step_m: f64, rng: &mut Pcg64) -> Self {
        let [x, y] = [(); 2].map(|()| rng.random_range(-LANE_M..LANE_M));
        let mut robot = Robot { at: Point::new(x, y / 2.0), heading_rad: 0.0, step_m };
        let mut one = |_| {
            let motions = robot.drive(rng);
            (robot.at, motions)
        };
        Self((0..fixes).map(&mut one).collect())
    }

    /// The true places of the last fixes of a session.
    fn last(&self) -> Vec<Point> {
        self.0.iter().rev().take(SESSION_FIXES).rev().map(|(at, _)| *at).collect()
    }

    /// Calibrates along the way, while a station is wrong by a length from a fix on; returns the news of each fix.
    fn calibrate(
        &self,
        stations: &[Station],
        (wrong, error_m, from): (StationId, f64, usize),
        is_free: bool,
        rng: &mut Pcg64,
    ) -> Vec<(usize, News)> {
        let mut session = calibration(stations, is_free);
        let mut all = Vec::new();
        for (k, (at, motions)) in self.0.iter().enumerate() {
            for (odometry, heading_rad) in motions {
                session.predict(odometry, *heading_rad);
            }
            let own_m = if k >= from { error_m } else { 0.0 };
            let sets = heard(stations, *at, (is_free, wrong, own_m), rng);
            let news = session.take(&sets, near(*at, rng), k as f64);
            all.extend(news.into_iter().map(|news| (k, news)));
        }
        all
    }
}

/// Sessions in which the worst station is wrong by each multiple of the forecast from the middle on; detected if it is named
/// within the fixes of the forecast.
fn sessions(stations: &[Station], is_free: bool, rng: &mut Pcg64) -> Vec<(usize, usize)> {
    let way = Way::new(2 * SESSION_FIXES, STEP_M, rng);
    let checks = forecast(is_free).session_checks(&way.last(), stations, &open_tank());
    let known = checks.filter(|checks| checks.is_separable).and_then(|c| c.worst.zip(c.detectable_m));
    let Some((worst, least_m)) = known else { return vec![(0, 0); FACTORS.len()] };
    let mut one = |factor: &f64| {
        let sign = if rng.random::<bool>() { 1.0 } else { -1.0 };
        let news = way.calibrate(stations, (worst, sign * factor * least_m, SESSION_FIXES), is_free, rng);
        let is_named = |(k, news): &(usize, News)| {
            *k >= SESSION_FIXES && matches!(news, News::Biased { station, .. } if *station == worst)
        };
        (1, usize::from(news.iter().any(is_named)))
    };
    FACTORS.iter().map(&mut one).collect()
}

/// A session of a slow or fast robot without a wrong station: the correlation according to its true places, and whether it is
/// said not to be separable at its end.
fn separable(stations: &[Station], is_free: bool, rng: &mut Pcg64) -> Option<(f64, bool)> {
    let [least, most] = STEPS_M.map(f64::ln);
    let step_m = rng.random_range(least..most).exp();
    let way = Way::new(SESSION_FIXES, step_m, rng);
    let correlation = correlation(stations, &way.last(), is_free)?;
    let news = way.calibrate(stations, (stations[0].id, 0.0, 0), is_free, rng);
    let said = news.iter().rev().find_map(|(_, news)| match news {
        News::NotSeparable { .. } => Some(true),
        News::Separable => Some(false),
        _ => None,
    });
    Some((correlation, said.unwrap_or(false)))
}

/// The largest correlation of the error of a station with an error of the speed of sound over fixes whose places are known
/// relative to the first one, which is free; so is the time of each emission, if it is unknown.
fn correlation(stations: &[Station], places: &[Point], is_free: bool) -> Option<f64> {
    let of = |wrong: usize| {
        let mut information = Matrix4::<f64>::zeros();
        for at in places {
            let row = |(index, station): (usize, &Station)| {
                let away = at - station.position;
                let unit = away.normalize();
                Vector4::new(unit.x, unit.y, away.norm(), f64::from(u8::from(index == wrong)))
            };
            let rows: Vec<Vector4<f64>> = stations.iter().enumerate().map(row).collect();
            let mean = rows.iter().sum::<Vector4<f64>>() / rows.len() as f64;
            let centre = if is_free { mean } else { Vector4::zeros() };
            information +=
                rows.iter().map(|row| (row - centre) * (row - centre).transpose()).sum::<Matrix4<f64>>();
        }
        let covariance = information.try_inverse()?;
        let both = (covariance[(2, 2)] * covariance[(3, 3)]).sqrt();
        Some((covariance[(2, 3)] / both).abs())
    };
    let all: Option<Vec<f64>> = (0..stations.len()).map(of).collect();
    all.map(|all| all.into_iter().fold(0.0, f64::max))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn the_worst_station_of_a_fix_is_that_of_the_forecast() {
        let stations = Ring::Uneven.stations(6, &mut rng(3, 1));
        for is_free in [false, true] {
            // A fix raises its alarm later than a test of the station alone would, by the same share everywhere.
            let ratio = |at: Point| {
                let worst = worst(&stations, at, is_free).unwrap();
                let own_m = detectable_m(&stations, at, worst, is_free).unwrap();
                let checks = forecast(is_free).checks_at(at, &stations, &open_tank(), &Risk::default());
                checks.unwrap().detectable_m.unwrap() / own_m
            };
            let [one, other] = [Point::new(4.0, -7.0), Point::new(-9.0, 2.0)].map(ratio);
            assert!((one / other - 1.0).abs() < 1e-3 && (1.0..1.4).contains(&one), "{one}, {other}");
        }
    }

    #[test]
    fn a_robot_that_stands_still_cannot_be_separated_and_one_that_drives_can() {
        let stations = Ring::Even.stations(6, &mut rng(3, 1));
        let still = vec![Point::new(9.0, 3.0); SESSION_FIXES];
        assert!(correlation(&stations, &still, false).unwrap() < 1.0);
        let way = Way::new(SESSION_FIXES, STEP_M, &mut rng(3, 2)).last();
        assert!(correlation(&stations, &way, false).unwrap() < NOT_SEPARABLE);
    }

    #[test]
    fn the_factor_with_the_power_lies_between_two_factors() {
        let rates = [0.1, 0.3, 0.5, 0.7, 0.9, 1.0, 1.0, 1.0];
        assert!((factor_with_power(&rates).unwrap() - 1.05).abs() < 1e-9);
        assert_eq!(factor_with_power(&[0.1; 8]), None);
    }
}
