//! The last fixes, and their fit to the errors of the ranges.

use super::{
    Estimated,
    system::{Column, System},
};
use nalgebra::{Matrix2, Vector2};
use std::collections::VecDeque;
use world::{Point, Vector};

/// Standard deviation of the speed of sound before any fix, as a share.
pub(super) const SCALE_SIGMA: f64 = 0.03;
/// Standard deviation of the change of the speed of sound, as a share per hour.
const DRIFT_SIGMA: f64 = 0.02;
/// Least standard deviation of the slip before any fix, as a share; keeps the equations solvable.
const LEAST_SLIP_SIGMA: f64 = 1e-4;
/// Standard deviation of a bias before any fix, metres.
const BIAS_SIGMA_M: f64 = 10.0;
/// Standard deviation of the motion between two fixes, beside that of odometry, metres.
const MOTION_SIGMA_M: f64 = 0.01;
/// The number of Gauss-Newton steps of a cycle, and of those that settle the position of a new fix.
const ROUNDS: usize = 2;
const SETTLING_ROUNDS: usize = 6;
/// Number of standard deviations beyond which a residual counts less, in inverse proportion to its size.
const HUBER: f64 = 3.0;
/// Number of standard deviations beyond which a range counts as an outlier of its cycle.
const OUTLIER: f64 = 30.0;
/// Largest distance of a fix from the expected position, metres: ranges that lead further away cannot be right.
pub(super) const FARTHEST_M: f64 = 5.0;
/// The least number of ranges of a fix; an unknown time of emission needs one more.
const LEAST_RANGES: usize = 3;
/// The shortest distance to a station that is used, metres.
pub(super) const NEAREST_M: f64 = 0.05;

/// A range of a fix.
#[derive(Debug, Clone)]
pub(super) struct Heard {
    /// Index of the station.
    pub station: usize,
    /// Place of the station, metres.
    pub at: Point,
    pub range_m: f64,
    pub sigma_m: f64,
}

/// A fix, with the motion since the one before.
#[derive(Debug, Clone)]
pub(super) struct Node {
    t_s: f64,
    at: Point,
    /// The length by which all ranges are too long because the time of emission is unknown, metres; `None` if it is
    /// known.
    excess_m: Option<f64>,
    heard: Vec<Heard>,
    moved: Vector,
    moved_sigma_m: f64,
}

/// The residual of a range with its weight, and the direction and distance of the station.
struct Seen {
    direction: Vector2<f64>,
    distance_m: f64,
    residual_m: f64,
    weight: f64,
}

impl Heard {
    /// Returns the range as seen from a place, without an excess length, metres.
    fn seen(&self, from: Point, stretch: f64, excess_m: f64) -> Seen {
        let away = from - self.at;
        let distance_m = away.norm().max(NEAREST_M);
        let residual_m = self.range_m - distance_m * stretch - excess_m;
        Seen {
            direction: away / distance_m,
            distance_m,
            residual_m,
            weight: weight(residual_m.abs(), self.sigma_m),
        }
    }
}

/// The weight of a residual with this standard deviation (Huber 1964).
fn weight(size: f64, sigma: f64) -> f64 {
    let full = sigma.powi(-2);
    if size > HUBER * sigma { full * HUBER * sigma / size } else { full }
}

impl Node {
    /// `excess_m` is an estimate of the length by which all ranges are too long, metres, if the time of emission is
    /// unknown.
    ///
    /// `None` if the time, the place, the excess or the motion is not a number, or too few stations were heard.
    pub(super) fn new(
        t_s: f64,
        (at, excess_m): (Point, Option<f64>),
        heard: Vec<Heard>,
        (moved, sigma_m): (Vector, f64),
    ) -> Option<Self> {
        let numbers = [t_s, at.x, at.y, excess_m.unwrap_or(0.0), moved.x, moved.y, sigma_m];
        let moved_sigma_m = sigma_m.hypot(MOTION_SIGMA_M);
        let node = Self { t_s, at, excess_m, heard, moved, moved_sigma_m };
        (node.has_enough() && numbers.iter().all(|number| number.is_finite())).then_some(node)
    }

    fn has_enough(&self) -> bool {
        self.heard.len() >= LEAST_RANGES + usize::from(self.excess_m.is_some())
    }

    /// Returns a range as seen from the position of the fix.
    fn seen(&self, heard: &Heard, stretch: f64, bias_m: f64) -> Seen {
        heard.seen(self.at, stretch, bias_m + self.excess_m.unwrap_or(0.0))
    }

    /// Returns the fix at the position that fits its ranges best, without outliers; `None` if too few ranges are left or
    /// they give no position.
    pub(super) fn settled(mut self, scale: f64, biases_m: &[f64]) -> Option<Self> {
        let expected = self.at;
        for _ in 0..SETTLING_ROUNDS {
            self.step(1.0 + scale, biases_m)?;
        }
        let fits = |heard: &Heard| {
            let distance_m = heard.range_m - self.excess_m.unwrap_or(0.0);
            let residual_m = self.seen(heard, 1.0 + scale, biases_m[heard.station]).residual_m;
            residual_m.abs() <= OUTLIER * heard.sigma_m.hypot(SCALE_SIGMA * distance_m / OUTLIER)
        };
        let heard = self.heard.iter().filter(|heard| fits(heard)).cloned().collect();
        let is_near = (self.at - expected).norm() <= FARTHEST_M;
        Some(Self { heard, ..self }).filter(|node| is_near && node.has_enough())
    }

    /// Moves the position, and the excess if it is unknown, by a Gauss-Newton step.
    fn step(&mut self, stretch: f64, biases_m: &[f64]) -> Option<()> {
        let (mut information, mut pull) = (Matrix2::zeros(), Vector2::zeros());
        let (mut common, mut residual, mut weight) = (Vector2::zeros(), 0.0, 0.0);
        for heard in &self.heard {
            let seen = self.seen(heard, stretch, biases_m[heard.station]);
            information += seen.direction * seen.direction.transpose() * seen.weight;
            pull += seen.direction * (seen.weight * seen.residual_m);
            common += seen.direction * seen.weight;
            (residual, weight) = (residual + seen.weight * seen.residual_m, weight + seen.weight);
        }
        if self.excess_m.is_some() {
            information -= common * common.transpose() / weight;
            pull -= common * (residual / weight);
        }
        let step = information.try_inverse()? * pull;
        self.at += step;
        self.excess_m = self.excess_m.map(|excess_m| excess_m + (residual - common.dot(&step)) / weight);
        Some(())
    }
}

/// The test of a station for a bias.
#[derive(Debug, Clone, Copy)]
pub(super) struct Test {
    /// The bias that fits best, beside a free scale.
    pub bias_m: Estimated,
    /// Correlation of the bias with the scale, 0 to 1.
    pub correlation: f64,
}

/// A station that may have a bias.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    pub station: usize,
    /// Time from which the bias counts, seconds.
    pub from_s: f64,
    /// What the bias takes off the sum of the squared residuals, in units of their variances.
    pub explained: f64,
}

/// The errors that fit the fixes best.
#[derive(Debug)]
pub(super) struct Fitted {
    /// At the last fix.
    pub scale: Estimated,
    /// Correlation of the scale with the slip of the robot, 0 to 1.
    pub slip_correlation: f64,
    /// The biases of the active stations, by the index of the station.
    pub biases_m: Vec<(usize, Estimated)>,
    /// For each station that is not active.
    pub tests: Vec<Option<Test>>,
    /// The scale according to the other stations, for the station that was asked for.
    pub scale_without: Option<Estimated>,
}

/// The last fixes.
#[derive(Debug, Clone)]
pub(super) struct Window {
    most: usize,
    is_linear: bool,
    nodes: VecDeque<Node>,
    scale: f64,
    /// Change of the scale, per hour.
    drift: f64,
    /// The share by which the robot moves less than measured, and its standard deviation before any fix.
    slip: f64,
    slip_sigma: f64,
    /// Sizes of the active biases, metres, with the times from which they count, by station.
    biases: Vec<Option<(f64, f64)>>,
}

impl Window {
    /// A window of at most `most` fixes. `slip_sigma` is the standard deviation of the share by which the robot moves less
    /// than measured.
    pub(super) fn new(most: usize, is_linear: bool, slip_sigma: f64) -> Self {
        Self {
            most: most.max(1),
            is_linear,
            nodes: VecDeque::with_capacity(most + 1),
            scale: 0.0,
            drift: 0.0,
            slip: 0.0,
            slip_sigma: slip_sigma.max(LEAST_SLIP_SIGMA),
            biases: Vec::new(),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Time of the first fix, seconds; 0 without a fix.
    pub(super) fn first_s(&self) -> f64 {
        self.nodes.front().map_or(0.0, |node| node.t_s)
    }

    /// Time of the last fix, seconds.
    pub(super) fn last_s(&self) -> Option<f64> {
        self.nodes.back().map(|node| node.t_s)
    }

    pub(super) fn push(&mut self, node: Node) {
        self.nodes.push_back(node);
        if self.nodes.len() > self.most {
            self.nodes.pop_front();
        }
    }

    /// Forgets the ranges of a station from a time on, before another time, seconds.
    pub(super) fn set_aside(&mut self, station: usize, from_s: f64, until_s: f64) {
        for node in self.nodes.iter_mut().filter(|node| (from_s..until_s).contains(&node.t_s)) {
            node.heard.retain(|heard| heard.station != station);
        }
    }

    /// Fits positions, scale and the biases of the active stations, each from its time on, seconds; also estimates the
    /// scale without the station `without`.
    pub(super) fn fit(
        &mut self,
        n_stations: usize,
        active: &[(usize, f64)],
        without: usize,
    ) -> Option<Fitted> {
        let before = std::mem::take(&mut self.biases);
        self.biases = vec![None; n_stations];
        for (station, from_s) in active {
            let bias_m = before.get(*station).copied().flatten().map_or(0.0, |(bias_m, _)| bias_m);
            self.biases[*station] = Some((bias_m, *from_s));
        }
        let columns = self.columns(active);
        let mut found = None;
        for _ in 0..ROUNDS {
            self.centre();
            let mut system = self.system(None);
            system.eliminate();
            let solved = system.solve(&columns)?;
            let steps = system.back(&columns, &solved);
            for (node, step) in self.nodes.iter_mut().zip(&steps) {
                node.at += step;
            }
            self.scale += solved.step[0];
            self.slip += solved.step[1];
            self.drift += if self.is_linear { solved.step[2] } else { 0.0 };
            let first = columns.len() - active.len();
            for ((station, _), step) in active.iter().zip(solved.step.iter().skip(first)) {
                self.biases[*station].iter_mut().for_each(|(bias_m, _)| *bias_m += step);
            }
            found = Some((system, solved));
        }
        self.centre();
        let (system, solved) = found?;
        let first = columns.len() - active.len();
        let bias = |(index, (station, _)): (usize, &(usize, f64))| {
            let (bias_m, _) = self.biases[*station]?;
            Some((*station, Estimated { value: bias_m, sigma: solved.sigma(first + index) }))
        };
        let test = |station: usize| {
            let is_active = self.biases[station].is_some();
            let (bias_m, sigma, correlation) =
                system.test(&columns, Column::bias(station)).filter(|_| !is_active)?;
            Some(Test { bias_m: Estimated { value: bias_m, sigma }, correlation })
        };
        let fitted = Fitted {
            scale: Estimated { value: self.scale, sigma: solved.sigma(0) },
            slip_correlation: system.correlation(Column::SCALE, Column::SLIP),
            biases_m: active.iter().enumerate().filter_map(bias).collect(),
            tests: (0..n_stations).map(test).collect(),
            scale_without: self.scale_without(&columns, without),
        };
        let is_finite = |node: &Node| {
            node.at.iter().all(|number| number.is_finite()) && node.excess_m.is_none_or(f64::is_finite)
        };
        let is_sound = self.nodes.iter().all(is_finite);
        let shared = [self.scale, self.drift, self.slip];
        if !(is_sound && shared.iter().all(|number| number.is_finite())) {
            // The next fixes begin again.
            *self = Self::new(self.most, self.is_linear, self.slip_sigma);
            return None;
        }
        Some(fitted)
    }

    /// Returns the scale that the ranges of the other stations give: the next step of a fit without this station.
    fn scale_without(&self, columns: &[Column], station: usize) -> Option<Estimated> {
        let mut system = self.system(Some(station));
        system.eliminate();
        let others: Vec<Column> = columns.iter().copied().filter(|c| *c != Column::bias(station)).collect();
        let solved = system.solve(&others)?;
        Some(Estimated { value: self.scale + solved.step[0], sigma: solved.sigma(0) })
    }

    /// Sets the unknown excess of each fix to the one that fits its ranges best.
    fn centre(&mut self) {
        let excess_m = |node: &Node| {
            let (mut sum, mut information) = (0.0, 0.0);
            let stretch = self.stretch_at(node.t_s);
            for heard in &node.heard {
                let bias_m = self.bias_at(heard.station, node.t_s).unwrap_or(0.0);
                let seen = node.seen(heard, stretch, bias_m);
                (sum, information) = (sum + seen.weight * seen.residual_m, information + seen.weight);
            }
            // A fix whose ranges were all set aside keeps its excess.
            node.excess_m
                .map(|excess_m| if information > 0.0 { excess_m + sum / information } else { excess_m })
        };
        let found: Vec<Option<f64>> = self.nodes.iter().map(excess_m).collect();
        for (node, excess_m) in self.nodes.iter_mut().zip(found) {
            node.excess_m = excess_m;
        }
    }

    /// The factor between distances and ranges at a time, seconds.
    fn stretch_at(&self, t_s: f64) -> f64 {
        1.0 + self.scale + self.drift * self.hours_at(t_s)
    }

    /// A time relative to the last fix, hours.
    fn hours_at(&self, t_s: f64) -> f64 {
        (t_s - self.last_s().unwrap_or(0.0)) / 3600.0
    }

    /// The linearised equations at the present estimates, without the ranges of the station `without`.
    fn system(&self, without: Option<usize>) -> System {
        let mut system = System::new(self.nodes.len(), self.biases.len());
        system.prior(Column::SCALE, self.scale, SCALE_SIGMA);
        system.prior(Column::DRIFT, self.drift, DRIFT_SIGMA);
        system.prior(Column::SLIP, self.slip, self.slip_sigma);
        for (station, bias) in self.biases.iter().enumerate() {
            system.prior(Column::bias(station), bias.map_or(0.0, |(bias_m, _)| bias_m), BIAS_SIGMA_M);
        }
        for (index, node) in self.nodes.iter().enumerate() {
            let (hours, stretch) = (self.hours_at(node.t_s), self.stretch_at(node.t_s));
            let mut common = node.excess_m.map(|_| system.common());
            for heard in node.heard.iter().filter(|heard| Some(heard.station) != without) {
                let bias_m = self.bias_at(heard.station, node.t_s);
                let seen = node.seen(heard, stretch, bias_m.unwrap_or(0.0));
                let by = [seen.distance_m, seen.distance_m * hours];
                let by = (seen.direction * stretch, by, bias_m.map(|_| Column::bias(heard.station)));
                system.range(index, by, seen.residual_m, seen.weight);
                if let Some(common) = &mut common {
                    common.range(by, seen.residual_m, seen.weight);
                }
            }
            if let Some(common) = &common {
                system.free_length(index, common);
            }
        }
        for (index, (before, node)) in self.nodes.iter().zip(self.nodes.iter().skip(1)).enumerate() {
            let off = node.at - before.at - node.moved * (1.0 - self.slip);
            system.link(index, (node.moved, off), weight(off.norm(), node.moved_sigma_m));
        }
        system
    }

    /// The stations that may have a bias, each from the time on that suits its residuals best, beside the active biases.
    ///
    /// Cost: that of one linear system for all stations together.
    pub(super) fn candidates(&mut self, active: &[(usize, f64)]) -> Vec<Candidate> {
        let columns = self.columns(active);
        let quiet: Vec<(usize, f64)> = (0..self.biases.len())
            .filter(|station| self.biases[*station].is_none())
            .map(|station| (station, self.change(station).0))
            .collect();
        for (station, from_s) in &quiet {
            self.biases[*station] = Some((0.0, *from_s));
        }
        let mut system = self.system(None);
        system.eliminate();
        let candidate = |(station, from_s): (usize, f64)| {
            let (bias_m, sigma, _) = system.test(&columns, Column::bias(station))?;
            Some(Candidate { station, from_s, explained: (bias_m / sigma).powi(2) })
        };
        let found = quiet.iter().copied().filter_map(candidate).collect();
        for (station, _) in quiet {
            self.biases[station] = None;
        }
        found
    }

    /// The errors that are free beside the positions.
    fn columns(&self, active: &[(usize, f64)]) -> Vec<Column> {
        let mut columns = vec![Column::SCALE, Column::SLIP];
        columns.extend(self.is_linear.then_some(Column::DRIFT));
        columns.extend(active.iter().map(|(station, _)| Column::bias(*station)));
        columns
    }

    /// The bias that the ranges of a station have at a time; `None` before the time from which it counts.
    fn bias_at(&self, station: usize, t_s: f64) -> Option<f64> {
        match self.biases[station] {
            None => Some(0.0),
            Some((bias_m, from_s)) => (t_s >= from_s).then_some(bias_m),
        }
    }

    /// The number of fixes with a range of a station from a time on, seconds.
    pub(super) fn heard(&self, station: usize, from_s: f64) -> usize {
        let has = |node: &&Node| node.heard.iter().any(|heard| heard.station == station);
        self.nodes.iter().filter(|node| node.t_s >= from_s).filter(has).count()
    }

    /// Returns the time from which the residuals of a station differ most from zero, seconds, and by how many standard
    /// deviations.
    pub(super) fn change(&self, station: usize) -> (f64, f64) {
        let (mut sum, mut information) = (0.0, 0.0);
        let mut best = (self.first_s(), 0.0);
        for node in self.nodes.iter().rev() {
            let stretch = self.stretch_at(node.t_s);
            let bias_m = self.bias_at(station, node.t_s).unwrap_or(0.0);
            for heard in node.heard.iter().filter(|heard| heard.station == station) {
                let seen = node.seen(heard, stretch, bias_m);
                (sum, information) = (sum + seen.weight * seen.residual_m, information + seen.weight);
            }
            let score = if information > 0.0 { sum.abs() / information.sqrt() } else { 0.0 };
            if score > best.1 {
                best = (node.t_s, score);
            }
        }
        best
    }
}
