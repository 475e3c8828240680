//! The session calibration with a wrong speed of sound and a station that goes wrong under way.
//!
//! The robot drives lanes in a tank with a radius of 20 m and six stations on the shell. The speed of sound is wrong by 2 %
//! from the begin, and one station by 15 cm from minute 10 on. The motion has slip and the errors of odometry.

use super::setup::rng;
use crate::study::{Block, Job, Result, Row, Sample, Study};
use positioning::{
    Aggregation, MotionNoise, Near, News, RangeNoise, SessionCalibration, SessionConfig, Timing,
};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use world::{Odometry, Point, RangeSet, Station, StationId, Vector};

pub(super) const STUDY: Study = Study {
    name: "session-calibration",
    about: "a speed of sound wrong by 2 % and a station wrong by 15 cm from minute 10 on: which station the session \
            calibration names, and when; six stations on even and uneven rings, from ranges and from differences",
    layouts: 200,
    run,
};

const STATIONS: usize = 6;
pub(super) const RADIUS_M: f64 = 20.0;
/// Half the length of a lane, and the distance between two lanes, metres.
pub(super) const LANE_M: f64 = 12.0;
const APART_M: f64 = 0.5;
/// Motion between two fixes, metres; there is one fix per second.
pub(super) const STEP_M: f64 = 0.4;
/// Standard deviation of a range, metres.
pub(super) const SIGMA_M: f64 = 0.1;
pub(super) const SCALE: f64 = 0.02;
const BIAS_M: f64 = 0.15;
/// Mission time at which the station goes wrong, and at which the session ends, seconds.
const FROM_S: f64 = 600.0;
const END_S: f64 = 900.0;
/// Number of fixes within which the errors must be found.
const WITHIN: f64 = 60.0;
/// Least and largest angle between neighbours on an uneven ring, degrees.
const GAPS_DEG: [f64; 2] = [12.0, 150.0];
/// Share by which the robot slips, and standard deviation of the odometry of a step, as a share.
const SLIP: f64 = 0.02;
const ODOMETRY: f64 = 0.02;
/// Standard deviation of the heading, radians.
const HEADING_RAD: f64 = 0.01;
/// The length by which all ranges are too long if the time of emission is unknown, metres.
const EXCESS_M: f64 = 200.0;
/// The share of the sessions in which the right station must be named first, and in time.
const LEAST: f64 = 0.95;

/// What is measured, whether the time of emission is unknown, and whether a station goes wrong.
const METHODS: [(&str, bool, bool); 4] = [
    ("ranges", false, true),
    ("ranges/no-fault", false, false),
    ("differences", true, true),
    ("differences/no-fault", true, false),
];

/// Where the stations are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Ring {
    Even,
    Uneven,
}

impl Ring {
    const ALL: [Self; 2] = [Self::Even, Self::Uneven];

    fn id(self) -> &'static str {
        match self {
            Self::Even => "even",
            Self::Uneven => "uneven",
        }
    }

    /// The places of `n` stations.
    pub(super) fn stations(self, n: usize, rng: &mut Pcg64) -> Vec<Station> {
        let angles: Vec<f64> = match self {
            Self::Even => (0..n).map(|k| TAU * k as f64 / n as f64).collect(),
            Self::Uneven => loop {
                let mut angles: Vec<f64> = (0..n).map(|_| rng.random_range(0.0..TAU)).collect();
                angles.sort_by(f64::total_cmp);
                let next = angles.iter().skip(1).copied().chain([angles[0] + TAU]);
                let [least, most] = GAPS_DEG.map(f64::to_radians);
                if angles.iter().zip(next).all(|(angle, next)| (least..most).contains(&(next - angle))) {
                    break angles;
                }
            },
        };
        let station = |(id, angle): (u32, &f64)| Station {
            id: StationId(id),
            name: format!("S{id}"),
            position: Point::new(RADIUS_M * angle.cos(), RADIUS_M * angle.sin()),
        };
        (1..).zip(&angles).map(station).collect()
    }
}

/// The findings of a session.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Found {
    /// Time from the begin of the fault to the alarm for the wrong station, seconds.
    right_after_s: Option<f64>,
    /// Whether the first alarm names the wrong station; `None` without an alarm.
    is_first_right: Option<bool>,
    /// Whether any sound station was named.
    is_sound_named: bool,
    /// The scale after 60 fixes, and its standard deviation.
    scale: [f64; 2],
}

fn run(job: &Job<'_>) -> Result<Vec<Row>> {
    let cases = job.cases(Ring::ALL, |ring| ring.id().to_owned())?;
    let methods = job.methods(METHODS, |(id, ..)| (*id).into())?;
    let done = job.runner.grid(&cases, &job.seeds(), |_, ring, seed| {
        let found =
            |(_, is_free, is_wrong): &(&str, bool, bool)| session(*ring, (*is_free, *is_wrong), *seed);
        Ok(methods.iter().map(found).collect::<Vec<Found>>())
    })?;
    let mut all = Vec::new();
    for (ring, draws) in cases.iter().zip(&done) {
        for (m, (method, _, is_wrong)) in methods.iter().enumerate() {
            let found: Vec<&Found> = draws.iter().map(|draw| &draw[m]).collect();
            all.extend(rows(&job.block(ring.id(), method, ""), &found, *is_wrong));
        }
    }
    Ok(all)
}

fn rows(block: &Block<'_>, all: &[&Found], is_wrong: bool) -> Vec<Row> {
    let rate = |metric: &str, is: &dyn Fn(&Found) -> bool| {
        let hits = all.iter().filter(|found| is(found)).count();
        block.row(metric, hits as f64 / all.len().max(1) as f64, "", all.len())
    };
    let required = |row: Row| {
        let met = if row.ours.is_some_and(|rate| rate >= LEAST) { "met" } else { "NOT MET" };
        row.note(format!("at least {LEAST} required: {met}"))
    };
    let sigma: Sample = all.iter().map(|found| found.scale[1]).collect();
    let is_within = |found: &Found| (found.scale[0] - SCALE).abs() <= 1.96 * found.scale[1];
    let mut rows = vec![
        rate("sound_named_rate", &|found| found.is_sound_named),
        rate("scale_in_interval_rate", &is_within),
        block.row("scale_sigma_median", sigma.median(), "", all.len()),
    ];
    if is_wrong {
        let after: Sample = all.iter().filter_map(|found| found.right_after_s).collect();
        rows.extend([
            required(rate("found_within_60_rate", &|found| found.right_after_s.is_some_and(|s| s <= WITHIN))),
            required(rate("right_first_rate", &|found| found.is_first_right == Some(true))),
            block.row("right_after_median", after.median(), "s", after.len()),
        ]);
    }
    rows
}

/// The robot on its lanes.
pub(super) struct Robot {
    pub at: Point,
    pub heading_rad: f64,
    /// Motion between two fixes, metres.
    pub step_m: f64,
}

impl Robot {
    /// Moves to the place of the next fix; returns the motion as the robot measures it, and the heading that it assumes.
    pub(super) fn drive(&mut self, rng: &mut Pcg64) -> Vec<(Odometry, f64)> {
        let mut bell = || -> f64 { StandardNormal.sample(rng) };
        let mut motions = Vec::new();
        if self.at.x.abs() > LANE_M {
            self.at.x = self.at.x.clamp(-LANE_M, LANE_M);
            self.heading_rad = TAU / 2.0 - self.heading_rad;
            self.at.y += APART_M;
            motions.push((forward(APART_M), TAU / 4.0));
        }
        self.at += Vector::new(self.heading_rad.cos(), 0.0) * self.step_m;
        let measured_m = self.step_m * (1.0 + ODOMETRY * bell());
        motions.push((forward(measured_m), self.heading_rad + HEADING_RAD * bell()));
        motions
    }
}

/// Odometry of a robot that slips on a way of this length, metres.
fn forward(way_m: f64) -> Odometry {
    Odometry { forward_m: way_m / (1.0 - SLIP), ..Odometry::default() }
}

/// The errors of single ranges.
pub(super) const NOISE: (RangeNoise, Timing) =
    (RangeNoise::Gaussian { sigma_ratio: 1e-6 }, Timing { jitter_m: SIGMA_M, resolution_m: 0.0 });

/// The calibration of a session without any fix.
pub(super) fn calibration(stations: &[Station], is_free: bool) -> SessionCalibration {
    let motion = MotionNoise { sigma_per_m: ODOMETRY.hypot(SLIP), ..MotionNoise::default() };
    let ways = (Aggregation::Mean, NOISE.0, NOISE.1);
    let plain = SessionCalibration::new(SessionConfig::default(), stations, ways, motion);
    if is_free { plain.with_free_emission() } else { plain }
}

/// The place at which a robot expects to be.
pub(super) fn near(at: Point, rng: &mut Pcg64) -> Near {
    let mut off_m = || -> f64 { SIGMA_M * Distribution::<f64>::sample(&StandardNormal, rng) };
    let at = at + Vector::new(off_m(), off_m());
    Near { at, sigma_m: SIGMA_M, heading_sigma_rad: HEADING_RAD }
}

fn session(ring: Ring, (is_free, is_wrong): (bool, bool), seed: u64) -> Found {
    let purpose = 451 + 4 * u64::from(ring == Ring::Uneven) + 2 * u64::from(is_free) + u64::from(is_wrong);
    // The layout depends on the seed alone, so the methods share it.
    let stations = ring.stations(STATIONS, &mut rng(seed, 450));
    let mut rng = rng(seed, purpose);
    let wrong = stations[rng.random_range(0..STATIONS)].id;
    let mut calibration = calibration(&stations, is_free);
    let mut robot = Robot { at: Point::new(-LANE_M, -LANE_M), heading_rad: 0.0, step_m: STEP_M };
    let mut found =
        Found { right_after_s: None, is_first_right: None, is_sound_named: false, scale: [0.0; 2] };
    for second in 1..=END_S as u32 {
        let t_s = f64::from(second);
        for (odometry, heading_rad) in robot.drive(&mut rng) {
            calibration.predict(&odometry, heading_rad);
        }
        let bias_m = if is_wrong && t_s > FROM_S { BIAS_M } else { 0.0 };
        let sets = heard(&stations, robot.at, (is_free, wrong, bias_m), &mut rng);
        for news in calibration.take(&sets, near(robot.at, &mut rng), t_s) {
            let News::Biased { station, .. } = news else { continue };
            let is_right = station == wrong && t_s > FROM_S && is_wrong;
            found.is_first_right.get_or_insert(is_right);
            found.is_sound_named |= !is_right;
            if is_right {
                found.right_after_s.get_or_insert(t_s - FROM_S);
            }
        }
        if t_s <= WITHIN {
            let scale = calibration.scale();
            found.scale = [scale.value, scale.sigma];
        }
    }
    found
}

/// The ranges of a cycle, in which those of a station are wrong by a length, metres.
pub(super) fn heard(
    stations: &[Station],
    at: Point,
    (is_free, wrong, bias_m): (bool, StationId, f64),
    rng: &mut Pcg64,
) -> Vec<RangeSet> {
    let excess_m = if is_free { EXCESS_M + rng.random_range(-50.0..50.0) } else { 0.0 };
    let set = |station: &Station| {
        let noise: f64 = StandardNormal.sample(rng);
        let own_m = if station.id == wrong { bias_m } else { 0.0 };
        let range_m = ((at - station.position).norm() + excess_m) * (1.0 + SCALE) + own_m + SIGMA_M * noise;
        RangeSet { station: station.id, ranges_m: vec![range_m] }
    };
    stations.iter().map(set).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn the_right_station_is_found_in_time_in_most_sessions_and_the_same_seed_gives_the_same() {
        let found: Vec<Found> = (0..8).map(|seed| session(Ring::Uneven, (false, true), seed)).collect();
        assert_eq!(found[0], session(Ring::Uneven, (false, true), 0));
        let in_time = found.iter().filter(|found| found.right_after_s.is_some_and(|s| s <= WITHIN)).count();
        assert!(in_time >= 6, "{found:?}");
        let sound = session(Ring::Even, (false, false), 3);
        assert!(!sound.is_sound_named && (sound.scale[0] - SCALE).abs() < 5.0 * sound.scale[1], "{sound:?}");
    }

    #[test]
    fn a_row_says_whether_its_criterion_is_met() {
        let block = Block { table: "session-calibration", case: "even", method: "ranges", note: "" };
        let found = |right_after_s| Found {
            right_after_s,
            is_first_right: right_after_s.map(|_| true),
            is_sound_named: false,
            scale: [SCALE, 0.001],
        };
        let note = |all: &[Found], metric: &str| {
            let all: Vec<&Found> = all.iter().collect();
            rows(&block, &all, true).into_iter().find(|row| row.metric == metric).unwrap().note
        };
        let good = vec![found(Some(30.0)); 20];
        assert!(note(&good, "found_within_60_rate").ends_with(": met"));
        let late: Vec<Found> = good.into_iter().chain(vec![found(Some(90.0)); 2]).collect();
        assert!(note(&late, "found_within_60_rate").ends_with(": NOT MET"));
        assert!(note(&late, "right_first_rate").ends_with(": met"));
    }
}
