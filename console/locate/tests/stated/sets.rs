//! Seeded sets of readings with their truth.

use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use std::{
    f64::consts::{PI, TAU},
    fmt::Write as _,
};
use world::{Point, Pose, Vector};

/// The speed of sound, metres per second.
const SOUND_M_S: f64 = 1287.0;
/// The top speed of the robot, metres per second.
const TOP_M_S: f64 = 0.4;
/// The values that instruments write when they have heard nothing.
const SENTINELS: [&str; 8] = ["7132.146", "0", "-1", "9999", "65535", "nan", "0.0", "99999.9"];

/// The special property of a set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Sound,
    SoundDifferences,
    NoOdometry,
    OdometryGap,
    Sentinels,
    SentinelArrivals,
    Line,
    LineWrongStart,
    Twice,
    WrongSpeed,
    WrongSpeedOfRanges,
    FoundSpeed,
    LateStation,
    Jitter,
    Quantised,
    QuantisedDifferences,
    /// Each reading is written ten times.
    Copied,
    /// All ranges are too long or too short by one length.
    Offset,
    /// Measured motion with the wrong sign or in the wrong unit.
    WrongMotion,
}

impl Kind {
    pub(crate) const ALL: [Self; 19] = [
        Self::Sound,
        Self::SoundDifferences,
        Self::NoOdometry,
        Self::OdometryGap,
        Self::Sentinels,
        Self::SentinelArrivals,
        Self::Line,
        Self::LineWrongStart,
        Self::Twice,
        Self::WrongSpeed,
        Self::WrongSpeedOfRanges,
        Self::FoundSpeed,
        Self::LateStation,
        Self::Jitter,
        Self::Quantised,
        Self::QuantisedDifferences,
        Self::Copied,
        Self::Offset,
        Self::WrongMotion,
    ];

    /// Whether the readings have no errors that the scenario does not state.
    pub(crate) fn is_sound(self) -> bool {
        use Kind::{Jitter, NoOdometry, Quantised, QuantisedDifferences, Sound, SoundDifferences};
        matches!(self, Sound | SoundDifferences | NoOdometry | Jitter | Quantised | QuantisedDifferences)
    }

    /// The factors by which distances and turns are multiplied before they are written.
    fn units_of_motion(self, seed: u64) -> (f64, f64) {
        match (self, seed % 4) {
            (Self::WrongMotion, 0) => (1.0, -1.0),
            (Self::WrongMotion, 1) => (-1.0, 1.0),
            (Self::WrongMotion, 2) => (1.0, 180.0 / PI),
            (Self::WrongMotion, _) => (1.0 / 0.3048, 1.0),
            _ => (1.0, 1.0),
        }
    }

    fn is_differences(self) -> bool {
        use Kind::{FoundSpeed, QuantisedDifferences, SentinelArrivals, SoundDifferences, WrongSpeed};
        matches!(self, SoundDifferences | WrongSpeed | FoundSpeed | QuantisedDifferences | SentinelArrivals)
    }
}

/// A scenario and its readings.
pub(crate) struct Set {
    pub scenario: String,
    pub readings: String,
    pub sound_speed_m_s: Option<f64>,
    pub finds_sound_speed: bool,
    pub has_no_motion: bool,
}

/// The random choices from which a set is made.
struct Draw {
    rng: Pcg64,
    radius_m: f64,
    stations: Vec<Point>,
    ratio: f64,
    noise: &'static str,
    repetitions: u32,
}

impl Draw {
    fn new(kind: Kind, seed: u64) -> Self {
        let mut rng = Pcg64::seed_from_u64(seed ^ ((kind as u64) << 32));
        let radius_m = rng.random_range(5.0..20.0);
        let n: u32 = rng.random_range(6..=8);
        let on_line = matches!(kind, Kind::Line | Kind::LineWrongStart);
        let turn: f64 = rng.random_range(0.0..TAU);
        let stations = if on_line {
            let along = Vector::new(turn.cos(), turn.sin());
            let across = Vector::new(-along.y, along.x);
            // From exactly on a line to a hundredth of the radius beside it.
            let off = if seed.is_multiple_of(2) { 0.0 } else { 0.01 * radius_m };
            (0..4)
                .map(|k| {
                    along * (radius_m * (f64::from(k) / 1.5 - 1.0) * 0.98)
                        + across * rng.random_range(-1.0..1.0) * off
                })
                .map(Point::from)
                .collect()
        } else {
            (0..n)
                .map(|k| turn + TAU * (f64::from(k) + rng.random_range(-0.2..0.2)) / f64::from(n))
                .map(|angle| Point::new(radius_m * angle.cos(), radius_m * angle.sin()) * 0.999)
                .collect()
        };
        let noise = ["gaussian", "uniform", "triangular"][(seed % 3) as usize];
        let ratio = rng.random_range(0.005..0.03);
        let is_once = matches!(kind, Kind::Twice | Kind::Copied);
        let repetitions = if is_once { 1 } else { [1, 4, 10][(seed / 3 % 3) as usize] };
        Self { rng, radius_m, stations, ratio, noise, repetitions }
    }

    fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.rng)
    }

    /// An error of a range as a share of the distance.
    fn error(&mut self) -> f64 {
        match self.noise {
            "gaussian" => self.ratio * self.normal(),
            "uniform" => self.ratio * self.rng.random_range(-1.0..1.0),
            _ => {
                self.ratio * f64::midpoint(self.rng.random_range(-1.0..1.0), self.rng.random_range(-1.0..1.0))
            }
        }
    }

    fn scenario(&self, start: Pose, more: &str) -> String {
        let key = if self.noise == "gaussian" { "sigma_ratio" } else { "ratio" };
        let mut stations = String::new();
        for (k, at) in self.stations.iter().enumerate() {
            let _ = write!(stations, "{{ name = \"S{k}\", at_m = [{:.4}, {:.4}] }}, ", at.x, at.y);
        }
        format!(
            "name = \"set\"\n[tank]\nradius_m = {}\n[robot]\nstart_m = [{:.4}, {:.4}]\nstart_heading_deg = {:.3}\n\
             speed_max_m_per_s = {TOP_M_S}\n[ae]\nstations = [{stations}]\n\
             noise = {{ model = \"{}\", {key} = {}{more} }}\n[mission]\nkind = \"goto\"\ngoal_m = [0.0, 0.0]\n[planner]\nid = \"navfn\"\n",
            self.radius_m,
            start.position.x,
            start.position.y,
            start.heading_rad.to_degrees().rem_euclid(360.0),
            self.noise,
            self.ratio
        )
    }

    /// A drive that stays inside the tank, as one pose for each tenth of a second.
    fn drive(&mut self, ticks: u32, speed_m_s: f64) -> Vec<(Pose, f64)> {
        let at = self.rng.random_range(0.0..TAU);
        let from_m = 0.5 * self.radius_m;
        let mut pose = Pose::new(from_m * at.cos(), from_m * at.sin(), at + 1.5);
        let mut turn_rad = 0.0;
        (0..ticks)
            .map(|k| {
                if k % 40 == 0 {
                    turn_rad = self.rng.random_range(-0.02..0.02);
                }
                let ahead = pose.moved(1.5, 0.0, 0.0).position;
                let turn = if ahead.coords.norm() > 0.85 * self.radius_m { 0.08 } else { turn_rad };
                if k > 0 {
                    pose = pose.moved(speed_m_s * 0.1, 0.0, turn);
                }
                (pose, if k > 0 { turn } else { 0.0 })
            })
            .collect()
    }
}

impl Set {
    /// The set of a kind and a seed.
    pub(crate) fn new(kind: Kind, seed: u64) -> Self {
        if kind == Kind::NoOdometry {
            return Self::outage_of(seed, [10, 1][(seed % 2) as usize], 12.0);
        }
        let mut draw = Draw::new(kind, seed);
        let speed_m_s = draw.rng.random_range(0.1..0.38);
        let drive = draw.drive(600, speed_m_s);
        let start = drive[0].0;
        let (mut more, mut jitter_m, mut step_m) = (String::new(), 0.0, 0.0);
        match kind {
            Kind::Jitter => jitter_m = draw.rng.random_range(0.02..0.3),
            Kind::Quantised | Kind::QuantisedDifferences => step_m = draw.rng.random_range(0.05..0.4),
            _ => {}
        }
        if jitter_m > 0.0 || step_m > 0.0 {
            more = format!(", jitter_m = {jitter_m}, resolution_m = {step_m}");
        }
        let said = match kind {
            Kind::LineWrongStart => {
                let turned = draw.rng.random_range(0.0..TAU);
                let by_m = draw.rng.random_range(0.5..2.0);
                let off = Vector::new(turned.cos(), turned.sin()) * by_m;
                Pose { position: start.position + off, ..start }
            }
            _ => start,
        };
        let scale = match kind {
            Kind::WrongSpeed | Kind::WrongSpeedOfRanges | Kind::FoundSpeed => {
                let sign = if draw.rng.random_range(0.0..1.0) < 0.5 { -1.0 } else { 1.0 };
                sign * draw.rng.random_range(0.002..0.06)
            }
            _ => 0.0,
        };
        let late_m = if kind == Kind::LateStation { draw.rng.random_range(0.03..0.4) } else { 0.0 };
        let offset_m = if kind == Kind::Offset { draw.rng.random_range(-0.6..0.6) } else { 0.0 };
        let (way, turn) = kind.units_of_motion(seed);
        let has_gap = |k: u32| kind == Kind::OdometryGap && (200..400).contains(&k);
        let mut text = String::from(if kind.is_differences() {
            "t_s,emission,station,arrival_s,forward_m,sideways_m,turn_rad,true_x_m,true_y_m\n"
        } else {
            "t_s,station,range_m,forward_m,sideways_m,turn_rad,true_x_m,true_y_m\n"
        });
        let e = |k: u32| if kind.is_differences() { format!("e{k},") } else { String::new() };
        for (k, (pose, turn_rad)) in (0..).zip(&drive) {
            let t_s = f64::from(k) / 10.0;
            let Pose { position: at, .. } = *pose;
            let forward_m = if k > 0 { speed_m_s * 0.1 * (1.0 + 0.02 * draw.normal()) } else { 0.0 };
            let turn_rad = turn * turn_rad * (1.0 + 0.02 * draw.normal());
            let forward_m = way * forward_m;
            if has_gap(k) {
                let _ = writeln!(text, "{t_s},{},,,,,{},{}", e(k), at.x, at.y);
            } else {
                let _ = writeln!(text, "{t_s},{},,{forward_m},0,{turn_rad},{},{}", e(k), at.x, at.y);
            }
            let twice = kind == Kind::Twice && k % 20 == 10;
            let cycle = k % 10 == 0 || twice;
            if !cycle || (has_gap(k) && (250..350).contains(&k)) {
                continue;
            }
            let bad = if matches!(kind, Kind::Sentinels | Kind::SentinelArrivals)
                && draw.rng.random_range(0.0..1.0) < 0.3
            {
                draw.rng.random_range(0..draw.stations.len())
            } else {
                usize::MAX
            };
            for index in 0..draw.stations.len() {
                let station = draw.stations[index];
                for _ in 0..draw.repetitions {
                    let mut range_m = (at - station).norm() * (1.0 + draw.error()) + jitter_m * draw.normal();
                    range_m += offset_m;
                    if index == 0 {
                        range_m += late_m;
                    }
                    if step_m > 0.0 {
                        range_m = (range_m / step_m).round() * step_m;
                    }
                    let sentinel = SENTINELS[draw.rng.random_range(0..SENTINELS.len())];
                    let reading = match (index == bad, kind.is_differences()) {
                        (true, _) => sentinel.to_owned(),
                        (false, true) => format!("{:.9}", 1000.0 + t_s + range_m / SOUND_M_S),
                        (false, false) => format!("{:.6}", range_m.max(0.001) * (1.0 + scale)),
                    };
                    // A second emission recorded under the time of the first.
                    let t_s = if twice { f64::from(k - 10) / 10.0 } else { t_s };
                    let copies = if kind == Kind::Copied { 10 } else { 1 };
                    (0..copies).for_each(|_| {
                        let _ = writeln!(text, "{t_s},{}S{index},{reading},,,,,", e(k));
                    });
                }
            }
        }
        if kind == Kind::Twice {
            text = sorted(&text);
        }
        Self {
            scenario: draw.scenario(said, &more),
            readings: text,
            sound_speed_m_s: kind.is_differences().then_some(SOUND_M_S * (1.0 + scale)),
            finds_sound_speed: kind == Kind::FoundSpeed,
            has_no_motion: false,
        }
    }

    /// A set with ranges once a second and no other measurements, with an outage of 40 s; its rows come at this rate.
    pub(crate) fn outage(seed: u64, rate_hz: u32) -> Self {
        Self::outage_of(seed, rate_hz, 40.0)
    }

    fn outage_of(seed: u64, rate_hz: u32, outage_s: f64) -> Self {
        let mut draw = Draw::new(Kind::NoOdometry, seed);
        draw.radius_m = draw.radius_m.max(15.0);
        let share = draw.radius_m / draw.stations[0].coords.norm() * 0.999;
        draw.stations.iter_mut().for_each(|at| *at *= share);
        let speed_m_s = [TOP_M_S, 0.2, 0.05][(seed % 3) as usize];
        let drive = draw.drive(900, speed_m_s);
        let mut text = String::from("t_s,station,range_m,true_x_m,true_y_m\n");
        for (k, (pose, _)) in (0_u32..).zip(&drive) {
            let (t_s, at) = (f64::from(k) / 10.0, pose.position);
            let is_quiet = (20.0..20.0 + outage_s).contains(&t_s);
            let errors: Vec<f64> =
                (0..draw.stations.len() as u32 * draw.repetitions).map(|_| draw.error()).collect();
            if k % (10 / rate_hz) == 0 {
                let _ = writeln!(text, "{t_s},,,{},{}", at.x, at.y);
            }
            if k % 10 != 0 || k == 0 || is_quiet {
                continue;
            }
            for (index, errors) in errors.chunks(draw.repetitions as usize).enumerate() {
                for error in errors {
                    let range_m = (at - draw.stations[index]).norm() * (1.0 + error);
                    let _ = writeln!(text, "{t_s},S{index},{range_m},,");
                }
            }
        }
        Self {
            scenario: draw.scenario(drive[0].0, ""),
            readings: text,
            sound_speed_m_s: None,
            finds_sound_speed: false,
            has_no_motion: true,
        }
    }
}

/// The lines, earliest first.
fn sorted(text: &str) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    let t_s = |line: &str| line.split(',').next().and_then(|cell| cell.parse::<f64>().ok()).unwrap_or(-1.0);
    lines[1..].sort_by(|a, b| t_s(a).total_cmp(&t_s(b)));
    lines.join("\n") + "\n"
}
