//! Calibrates the speed of sound and the stations during a mission, from the last fixes and the motion between them.
//!
//! The unknowns are the position of each of the last fixes, its time of emission if that is unknown, the scale of all
//! ranges (constant, or linear in time), the share by which the robot slips, and the biases of stations that were found
//! wrong. Slip stretches the path as a wrong speed of sound does, so the stated error of the scale contains it. A bounded
//! number of Gauss-Newton steps per cycle fits the unknowns to the ranges and to the odometry between the fixes. All
//! biases at once cannot be told from a shift of the whole path, so a
//! bias is tested one station at a time, beside a free scale: its size over its standard deviation decides (Baarda
//! 1968).

mod system;
mod window;

use crate::{
    accuracy::checks::NOT_SEPARABLE,
    aggregate::Aggregation,
    calibration::MOST_SCALE,
    ekf::MotionNoise,
    fix::Ranging,
    noise::{RangeNoise, Timing},
    positioner::{Doubt, Estimate},
    quality::largest_sigma_m,
    session::CommonError,
    solver_kind::SolverKind,
};
use serde::{Deserialize, Serialize};
use window::{Candidate, Fitted, Node, Test, Window};
use world::{Odometry, Point, RangeSet, Station, StationId, Vector};

/// Number of standard deviations above which a bias is detected. Least detectable errors are forecast for 3.29 in a
/// single test; a mission tests every station in every cycle.
const DETECTED: f64 = 5.0;
/// Number of standard deviations above which a bias is suspected: floor scanned from then on is in doubt if the
/// suspicion is confirmed without a break.
const SUSPECTED: f64 = 2.5;
/// Number of standard deviations below which a suspicion or a detected bias is over.
const CLEARED: f64 = 2.0;
/// Correlation below which errors can be told apart again.
const SEPARABLE: f64 = 0.9;
/// The number of fixes before a bias can be detected, and of those without a bias before it is over.
const LEAST_FIXES: usize = 10;
/// The least lead of the station whose bias fits best over the next one, in the sum of squared residuals in units of
/// their variances: the odds are then exp(lead / 2), about 400 to 1.
const LEAST_LEAD: f64 = 12.0;
/// Number of standard deviations of an expected position within which the true one certainly lies.
const SURE_SIGMAS: f64 = 4.0;
/// Number of standard deviations of a station's residuals above which a known bias is estimated again: it has changed.
const CHANGED: f64 = 5.0;

/// How the speed of sound may change during the fixes that are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SoundSpeed {
    /// Not at all.
    #[default]
    Constant,
    /// Linearly in time.
    Linear,
}

/// What happens to the ranges of a station whose bias was detected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OnBias {
    /// They are not used.
    #[default]
    Exclude,
    /// The bias is subtracted.
    Correct,
}

/// The settings of a session calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct SessionConfig {
    /// How the speed of sound may change.
    pub sound_speed: SoundSpeed,
    /// What happens to a station with a bias.
    pub on_bias: OnBias,
    /// The number of fixes that are kept.
    pub fixes: usize,
}

impl SessionConfig {
    /// The least number of stations among which a wrong one shows; an unknown time of emission takes one more.
    pub const fn least_stations(is_emission_free: bool) -> usize {
        if is_emission_free { 5 } else { 4 }
    }
}

impl Default for SessionConfig {
    fn default() -> Self {
        Self { sound_speed: SoundSpeed::Constant, on_bias: OnBias::Exclude, fixes: 60 }
    }
}

/// A value with its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimated {
    /// The value.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: f64,
}

impl Estimated {
    fn score(self) -> f64 {
        self.value.abs() / self.sigma
    }
}

/// News about the stations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum News {
    /// The ranges of a station are wrong by a constant length, or by a different one than before.
    Biased {
        /// The station.
        station: StationId,
        /// The length by which its ranges are too long, metres.
        bias_m: Estimated,
        /// The earliest time at which the bias may have begun, seconds.
        since_s: f64,
    },
    /// The ranges of a station are right again.
    Sound {
        /// The station.
        station: StationId,
    },
    /// A bias of some station and an error of the speed of sound cannot be told apart, or the biases of two stations.
    NotSeparable {
        /// The largest correlation of a bias with the error of the speed of sound, 0 to 1.
        correlation: f64,
        /// Two stations of which one is wrong; `None` if no bias is significant.
        stations: Option<[StationId; 2]>,
    },
    /// They can be told apart again.
    Separable,
}

/// The expected place of a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Near {
    /// The position, tank frame, metres.
    pub at: Point,
    /// Its largest standard deviation in any direction, metres.
    pub sigma_m: f64,
    /// Standard deviation of the heading, radians.
    pub heading_sigma_rad: f64,
}

impl From<&Estimate> for Near {
    fn from(Estimate { pose, covariance }: &Estimate) -> Self {
        Self {
            at: pose.position,
            sigma_m: largest_sigma_m(&covariance.fixed_view::<2, 2>(0, 0).into_owned()),
            heading_sigma_rad: covariance[(2, 2)].max(0.0).sqrt(),
        }
    }
}

/// What is known about a station.
#[derive(Debug, Clone, Copy, Default)]
struct Known {
    /// If a bias is suspected or detected: the earliest time at which it may have begun, seconds.
    since_s: Option<f64>,
    /// The detected bias.
    bias_m: Option<Estimated>,
    /// Time from which the bias is estimated, seconds.
    from_s: f64,
}

/// Estimates the errors of the ranges from the last fixes of a mission. The same input gives the same estimates.
///
/// ```
/// use positioning::{
///     Aggregation, MotionNoise, Near, News, RangeNoise, SessionCalibration, SessionConfig, Timing,
/// };
/// use world::{Odometry, Point, RangeSet, Station, StationId};
/// let places = [(20.0, 0.0), (10.0, 17.0), (-10.0, 17.0), (-20.0, 0.0), (-10.0, -17.0), (10.0, -17.0)];
/// let stations: Vec<Station> = (1..).zip(places)
///     .map(|(id, (x, y))| Station { id: StationId(id), name: String::new(), position: Point::new(x, y) })
///     .collect();
/// let ways = (Aggregation::Mean, RangeNoise::Gaussian { sigma_ratio: 0.005 }, Timing::default());
/// let motion = MotionNoise::default();
/// let mut session = SessionCalibration::new(SessionConfig::default(), &stations, ways, motion);
/// let (mut at, mut named) = (Point::new(-15.0, -4.0), Vec::new());
/// for second in 0..60 {
///     // All ranges are 2 % too long, and those of the third station by 0.5 m as well from second 30 on.
///     let own_m = |id| if id == StationId(3) && second >= 30 { 0.5 } else { 0.0 };
///     let range_m = |s: &Station| (at - s.position).norm() * 1.02 + own_m(s.id);
///     let sets: Vec<RangeSet> =
///         stations.iter().map(|s| RangeSet { station: s.id, ranges_m: vec![range_m(s)] }).collect();
///     let near = Near { at, sigma_m: 0.1, heading_sigma_rad: 0.01 };
///     named.extend(session.take(&sets, near, f64::from(second)));
///     at.x += 0.5;
///     session.predict(&Odometry { forward_m: 0.5, ..Odometry::default() }, 0.0);
/// }
/// assert!((session.scale().value - 0.02).abs() < 0.002);
/// assert!(matches!(named[..], [News::Biased { station: StationId(3), .. }]));
/// ```
#[derive(Debug, Clone)]
pub struct SessionCalibration {
    config: SessionConfig,
    stations: Vec<Station>,
    known: Vec<Known>,
    window: Window,
    scale: Estimated,
    /// For each station: the scale according to the others.
    scale_without: Vec<Estimated>,
    /// The station for which the next cycle estimates it.
    turn: usize,
    slip_correlation: f64,
    aggregation: Aggregation,
    noise: RangeNoise,
    timing: Timing,
    motion: MotionNoise,
    /// Motion since the last fix: the displacement, and the length of the way, metres.
    moved: (Vector, f64),
    is_separable: bool,
    /// Cycles in a row in which a bias was significant, but fitted two stations nearly equally well, and these stations.
    unclear: Option<(usize, [StationId; 2])>,
    is_emission_free: bool,
}

impl SessionCalibration {
    /// Creates a calibration without any data.
    pub fn new(
        config: SessionConfig,
        stations: &[Station],
        (aggregation, noise, timing): (Aggregation, RangeNoise, Timing),
        motion: MotionNoise,
    ) -> Self {
        Self {
            config,
            stations: stations.to_vec(),
            known: vec![Known::default(); stations.len()],
            window: Window::new(config.fixes, config.sound_speed == SoundSpeed::Linear, motion.sigma_per_m),
            scale: Estimated { value: 0.0, sigma: window::SCALE_SIGMA },
            scale_without: vec![Estimated { value: 0.0, sigma: window::SCALE_SIGMA }; stations.len()],
            turn: 0,
            slip_correlation: 0.0,
            aggregation,
            noise,
            timing,
            motion,
            moved: (Vector::zeros(), 0.0),
            is_separable: true,
            unclear: None,
            is_emission_free: false,
        }
    }

    /// Takes the time of each emission as unknown: all ranges of a cycle are too long by one unknown length.
    #[must_use]
    pub fn with_free_emission(self) -> Self {
        Self { is_emission_free: true, ..self }
    }

    /// Adds the motion of a tick, which begins with this heading, radians.
    pub fn predict(&mut self, odometry: &Odometry, heading_rad: f64) {
        let (sin, cos) = (heading_rad + odometry.turn_rad / 2.0).sin_cos();
        let Odometry { forward_m, sideways_m, .. } = *odometry;
        self.moved.0 += Vector::new(cos * forward_m - sin * sideways_m, sin * forward_m + cos * sideways_m);
        self.moved.1 += forward_m.hypot(sideways_m);
    }

    /// Adds an unmeasured motion of at most this length, metres: the fixes before and after it are not connected.
    pub fn wander(&mut self, most_m: f64) {
        self.moved.1 += most_m / self.motion.sigma_per_m.max(1e-3);
    }

    /// The share by which all ranges are too long.
    pub fn scale(&self) -> Estimated {
        self.scale
    }

    /// The correlation of this share with the slip of the robot, if it is so large that the two cannot be told apart:
    /// above 0.95. Only differences of arrivals leave them together, because single ranges show the size of the path.
    pub fn slip_correlation(&self) -> Option<f64> {
        Some(self.slip_correlation).filter(|correlation| *correlation > NOT_SEPARABLE)
    }

    /// The stations with a detected bias: the length by which their ranges are too long, metres.
    pub fn biases_m(&self) -> impl Iterator<Item = (StationId, Estimated)> + '_ {
        self.stations.iter().zip(&self.known).filter_map(|(station, known)| Some((station.id, known.bias_m?)))
    }

    /// The share by which all ranges are too long according to all stations but one, which therefore cannot spoil it.
    /// Every cycle renews it for one station.
    pub fn scale_without(&self, station: StationId) -> Estimated {
        let index = self.stations.iter().position(|known| known.id == station);
        index.map_or(self.scale, |index| self.scale_without[index])
    }

    /// The errors that the corrected ranges probably still have.
    pub fn doubt(&self) -> Doubt {
        self.doubt_of(self.scale)
    }

    /// The errors that the ranges of the other stations, corrected without this one, probably still have.
    pub fn doubt_without(&self, station: StationId) -> Doubt {
        self.doubt_of(self.scale_without(station))
    }

    fn doubt_of(&self, scale: Estimated) -> Doubt {
        let biases_m = self.biases_m().filter(|_| self.config.on_bias == OnBias::Correct);
        let likely_m = biases_m.map(|(_, bias_m)| bias_m.sigma).fold(0.0, f64::hypot);
        let likely_errors = [CommonError::Share(scale.sigma), CommonError::default()];
        Doubt { likely_errors, likely_m, ..Doubt::default() }
    }

    /// Returns ranges without their known errors; those of a biased station are left out or corrected.
    pub fn corrected(&self, sets: &[RangeSet]) -> Vec<RangeSet> {
        self.corrected_by(sets, self.scale)
    }

    /// Returns the ranges of all stations but one without their errors as far as the other stations show them.
    pub fn corrected_without(&self, station: StationId, sets: &[RangeSet]) -> Vec<RangeSet> {
        let mut others = self.corrected_by(sets, self.scale_without(station));
        others.retain(|set| set.station != station);
        others
    }

    fn corrected_by(&self, sets: &[RangeSet], scale: Estimated) -> Vec<RangeSet> {
        let by = 1.0 / (1.0 + scale.value);
        let one = |set: &RangeSet| {
            let index = self.stations.iter().position(|station| station.id == set.station);
            let bias_m = index.and_then(|index| self.known[index].bias_m);
            if bias_m.is_some() && self.config.on_bias == OnBias::Exclude {
                return None;
            }
            let bias_m = bias_m.map_or(0.0, |bias_m| bias_m.value);
            let ranges_m = set.ranges_m.iter().map(|range_m| (range_m - bias_m) * by).collect();
            Some(RangeSet { station: set.station, ranges_m })
        };
        sets.iter().filter_map(one).collect()
    }

    /// Adds the uncorrected ranges of a cycle at time `t_s`, seconds, near an expected place. Returns what changed.
    ///
    /// A cycle with an unusable range, with fewer than three stations (four if emission times are unknown), or at a time that is not later than the last one
    /// changes nothing.
    pub fn take(&mut self, sets: &[RangeSet], near: Near, t_s: f64) -> Vec<News> {
        let Some(node) = self.node(sets, near, t_s) else { return Vec::new() };
        self.moved = (Vector::zeros(), 0.0);
        self.window.push(node);
        let Some(fitted) = self.fit() else { return Vec::new() };
        if fitted.scale.value.abs() < MOST_SCALE {
            (self.scale, self.slip_correlation) = (fitted.scale, fitted.slip_correlation);
        }
        if let Some(scale) = fitted.scale_without.filter(|scale| scale.value.abs() < MOST_SCALE) {
            self.scale_without[self.turn] = scale;
        }
        self.turn = (self.turn + 1) % self.stations.len();
        let mut news = self.judge(&fitted);
        news.extend(self.separable(&fitted));
        news
    }

    /// The stations with a detected bias, with the time from which it counts, seconds.
    fn active(&self) -> Vec<(usize, f64)> {
        let biased = self.known.iter().enumerate().filter(|(_, known)| known.bias_m.is_some());
        biased.map(|(station, known)| (station, known.from_s)).collect()
    }

    fn fit(&mut self) -> Option<Fitted> {
        let active = self.active();
        self.window.fit(self.stations.len(), &active, self.turn)
    }

    fn node(&self, sets: &[RangeSet], expected: Near, t_s: f64) -> Option<Node> {
        let is_later = self.window.last_s().is_none_or(|last_s| t_s > last_s);
        let mut ranges = self.aggregation.aggregate(sets, &self.noise).ok().filter(|_| is_later)?;
        let Near { heading_sigma_rad, .. } = expected;
        let near = self.place(&ranges, expected)?;
        let excess_m = if self.is_emission_free { Some(self.excess_m(&ranges, near)?) } else { None };
        self.timing.apply(&mut ranges, &self.noise, excess_m.unwrap_or(0.0));
        let heard = ranges.iter().filter_map(|range| {
            let station = self.stations.iter().position(|station| station.id == range.station)?;
            let at = self.stations[station].position;
            // The scatter belongs to the distance, not to the excess.
            let sigma_m = if self.is_emission_free {
                range.sigma_at_m((near - at).norm().max(window::NEAREST_M))
            } else {
                range.sigma_m
            };
            Some(window::Heard { station, at, range_m: range.range_m, sigma_m })
        });
        let (moved, way_m) = self.moved;
        let sigma_m = way_m * self.motion.sigma_per_m.hypot(heading_sigma_rad);
        let biases_m: Vec<f64> =
            self.known.iter().map(|known| known.bias_m.map_or(0.0, |b| b.value)).collect();
        let node = Node::new(t_s, (near, excess_m), heard.collect(), (moved, sigma_m))?;
        node.settled(self.scale.value, &biases_m)
    }

    /// The expected place; if it is too uncertain to begin from, the place of a fix from the ranges alone. `None` if they
    /// give no fix.
    fn place(&self, ranges: &[Ranging], expected: Near) -> Option<Point> {
        if SURE_SIGMAS * expected.sigma_m <= window::FARTHEST_M {
            return Some(expected.at);
        }
        let solver = if self.is_emission_free { SolverKind::Differences } else { SolverKind::Nls };
        solver.solve(ranges, &self.stations, &self.noise, None).ok().map(|fix| fix.position)
    }

    /// The median length by which ranges exceed the distances from a place, metres; `None` without any range.
    fn excess_m(&self, ranges: &[Ranging], near: Point) -> Option<f64> {
        let excess_m = |range: &Ranging| {
            let station = self.stations.iter().find(|station| station.id == range.station)?;
            Some(range.range_m - (near - station.position).norm())
        };
        let mut all: Vec<f64> = ranges.iter().filter_map(excess_m).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied()
    }

    /// Compares the largest correlation with its limit, and the time for which a wrong station was unclear.
    fn separable(&mut self, fitted: &Fitted) -> Option<News> {
        if self.window.len() < LEAST_FIXES {
            return None;
        }
        let correlation = fitted.tests.iter().flatten().map(|test| test.correlation).fold(0.0, f64::max);
        let unclear = self.unclear.filter(|(cycles, _)| *cycles >= LEAST_FIXES);
        let limit = if self.is_separable { NOT_SEPARABLE } else { SEPARABLE };
        let was_separable =
            std::mem::replace(&mut self.is_separable, correlation <= limit && unclear.is_none());
        match (was_separable, self.is_separable) {
            (true, false) => {
                let stations = unclear.map(|(_, stations)| stations);
                Some(News::NotSeparable { correlation, stations })
            }
            (false, true) => Some(News::Separable),
            _ => None,
        }
    }

    /// Updates what is known about each station. The most significant contradiction counts first, because it also shows in
    /// the residuals of the other stations: the change of a known bias, or a new one.
    fn judge(&mut self, fitted: &Fitted) -> Vec<News> {
        if let Some((station, changed_s)) = self.changed(fitted) {
            return self.begin_again(station, changed_s).into_iter().collect();
        }
        let mut news: Vec<News> = Vec::new();
        for (station, bias_m) in &fitted.biases_m {
            news.extend(self.follow(*station, *bias_m));
        }
        let begin_s = self.window.first_s();
        for (station, test) in fitted.tests.iter().enumerate() {
            if self.known[station].bias_m.is_some() {
                continue;
            }
            let score = separable_bias_m(*test).map_or(0.0, Estimated::score);
            let since_s = &mut self.known[station].since_s;
            *since_s = match *since_s {
                Some(since_s) if score >= CLEARED => Some(since_s),
                None if score >= SUSPECTED => Some(begin_s),
                _ => None,
            };
        }
        news.extend(self.detected(fitted));
        news
    }

    /// The station that shows most significantly that its known bias has changed, and the time of the change, seconds;
    /// `None` if a new bias is more significant.
    fn changed(&self, fitted: &Fitted) -> Option<(usize, f64)> {
        let change = |station: usize| {
            let (changed_s, score) = self.window.change(station);
            let is_later = changed_s > self.known[station].from_s;
            (score > CHANGED && is_later).then_some((station, changed_s, score))
        };
        let stations = fitted.biases_m.iter().map(|(station, _)| *station);
        let (station, changed_s, score) = stations.filter_map(change).max_by(|a, b| a.2.total_cmp(&b.2))?;
        let new = fitted.tests.iter().filter_map(|test| separable_bias_m(*test)).map(Estimated::score);
        (score >= new.fold(0.0, f64::max)).then_some((station, changed_s))
    }

    /// Sets the ranges with the old bias of a station aside, and estimates its bias from now on.
    fn begin_again(&mut self, index: usize, changed_s: f64) -> Option<News> {
        let first_s = self.window.first_s();
        self.window.set_aside(index, self.known[index].from_s, changed_s);
        self.known[index].from_s = changed_s;
        let refitted = self.fit()?;
        let bias_m = refitted.biases_m.iter().find(|(station, _)| *station == index)?.1;
        self.known[index].bias_m = Some(bias_m);
        let station = self.stations[index].id;
        (bias_m.score() >= CLEARED).then_some(News::Biased { station, bias_m, since_s: first_s })
    }

    /// Detects a bias that begins in the window. At most one is detected in a cycle, the one that fits best, and never in
    /// half of the stations: then nothing shows which half is right.
    ///
    /// The test counts the bias in the whole window, most of which may be from before it began. Therefore the stations are
    /// compared by a bias from its onset on. If two of them explain nearly as much, the next cycles decide. The window is
    /// fitted again with the bias that is found, which gives its size.
    fn detected(&mut self, fitted: &Fitted) -> Option<News> {
        let active = self.active();
        let is_testable = self.window.len() >= LEAST_FIXES && 2 * (active.len() + 1) < self.stations.len();
        let scores = fitted.tests.iter().filter_map(|test| Some(separable_bias_m(*test)?.score()));
        if !is_testable || scores.fold(0.0, f64::max) <= DETECTED {
            self.unclear = None;
            return None;
        }
        // A bias that cannot be told from a wrong speed of sound is not named, but it may be the true cause.
        let mut candidates = self.window.candidates(&active);
        candidates.sort_by(|a, b| b.explained.total_cmp(&a.explained));
        let mut candidates = candidates.into_iter();
        let Candidate { station, from_s, explained } = candidates.next()?;
        let is_separable = separable_bias_m(fitted.tests[station]).is_some();
        let is_clear = |next: &Candidate| is_separable && explained - next.explained >= LEAST_LEAD;
        if let Some(next) = candidates.next().filter(|next| !is_clear(next)) {
            let cycles = self.unclear.map_or(0, |(cycles, _)| cycles);
            self.unclear = Some((cycles + 1, [station, next.station].map(|index| self.stations[index].id)));
            return None;
        }
        self.unclear = None;
        let since_s = self.known[station].since_s.unwrap_or(self.window.first_s());
        let with: Vec<(usize, f64)> = active.into_iter().chain([(station, from_s)]).collect();
        let refitted = self.window.fit(self.stations.len(), &with, self.turn)?;
        let bias_m = refitted.biases_m.iter().find(|(index, _)| *index == station)?.1;
        self.known[station] = Known { since_s: Some(since_s), bias_m: Some(bias_m), from_s };
        Some(News::Biased { station: self.stations[station].id, bias_m, since_s })
    }

    /// Follows a detected bias until it is over.
    fn follow(&mut self, index: usize, bias_m: Estimated) -> Option<News> {
        let known = &mut self.known[index];
        known.bias_m = Some(bias_m);
        let is_over = bias_m.score() < CLEARED
            && self.window.heard(index, known.from_s) >= LEAST_FIXES.min(self.config.fixes);
        is_over.then(|| {
            *known = Known::default();
            News::Sound { station: self.stations[index].id }
        })
    }
}

/// The bias of a test, if it can be told from an error of the speed of sound.
fn separable_bias_m(test: Option<Test>) -> Option<Estimated> {
    test.filter(|test| test.correlation <= NOT_SEPARABLE).map(|test| test.bias_m)
}

#[cfg(test)]
mod tests;
