//! Estimates the clocks of stations that share no common clock, while the time of emission is unknown.
//!
//! Every station has an offset, and a drift of this offset; both make its arrivals late by a length that grows linearly
//! in time. One fix cannot tell offsets from a shift of the robot, but a path can: the offsets stay while the directions
//! to the stations change. A Kalman filter over the position, the offsets and the drifts therefore takes the differences
//! of each cycle, and the motion between the cycles (simultaneous localisation and calibration, as in Thrun, Burgard
//! and Fox 2005, chapter 10, with offsets in the place of landmarks). The surveyed start fixes the offsets at first.
//!
//! Only differences between offsets show; a length that all offsets share belongs to the unknown time of emission.

use crate::{
    anchor::{Anchor, anchored},
    fix::{Fix, Ranging},
    pulses::PulseTest,
    quality::{ALARM_Z, chi_squared_quantile},
    session::position_by_range,
    session_calibration::Estimated,
};
use nalgebra::{DMatrix, DVector, Matrix2};
use serde::{Deserialize, Serialize};
use world::{Point, Station, StationId, Vector};

/// The least number of stations: four for a fix from differences, and one to check the clocks.
pub const LEAST_STATIONS: usize = 5;
/// The number of steps of an update; the differences are linearised again in each.
const ROUNDS: usize = 2;
/// Standard deviation of a motion that the ranges contradict, metres: it counts as unmeasured.
const UNMEASURED_M: f64 = 5.0;
/// Largest standard deviation of the position, metres; keeps the numbers finite.
const MOST_SIGMA_M: f64 = 1e4;
/// Index of the first offset in the state.
const OFFSETS: usize = 2;

/// What is known about the clocks of the stations before a mission.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ClockConfig {
    /// Standard deviation of the offset of a station, as a length that sound travels, metres.
    pub offset_sigma_m: f64,
    /// Standard deviation of the change of an offset in a tick, metres; it stays the same for the whole mission.
    pub drift_sigma_m_per_tick: f64,
}

/// The estimated clocks, with the position and their correlations. The same input gives the same estimates.
///
/// ```
/// use positioning::{ClockConfig, Ranging, StationClocks};
/// use world::{Point, Station, StationId, Vector};
/// let places = [(10.0, 0.0), (3.0, 9.5), (-8.0, 6.0), (-8.0, -6.0), (3.0, -9.5)];
/// let stations: Vec<Station> = (0..)
///     .zip(places)
///     .map(|(id, (x, y))| Station { id: StationId(id), name: String::new(), position: Point::new(x, y) })
///     .collect();
/// let config = ClockConfig { offset_sigma_m: 3.0, drift_sigma_m_per_tick: 0.0 };
/// let mut clocks = StationClocks::new(config, &stations, Point::origin(), 0.02);
/// let late_m = [1.0, -2.0, 0.0, 4.0, 0.5];
/// let range = |(station, late_m): (&Station, &f64)| {
///     Ranging::single(station.id, station.position.coords.norm() + late_m + 50.0, 0.01)
/// };
/// let heard: Vec<Ranging> = stations.iter().zip(&late_m).map(range).collect();
/// clocks.take(&heard);
/// let offsets: Vec<f64> = clocks.offsets_m().map(|(_, offset)| offset.value).collect();
/// // Relative to their mean, which is 0.7 m.
/// assert!(offsets.iter().zip(late_m).all(|(found_m, late_m)| (found_m - (late_m - 0.7)).abs() < 0.05));
/// ```
#[derive(Debug, Clone)]
pub struct StationClocks {
    stations: Vec<Station>,
    /// Position, offsets and drifts per tick, metres.
    state: DVector<f64>,
    covariance: DMatrix<f64>,
    /// Motion since the last cycle, metres: the displacement, and the sum of its standard deviations.
    moved: (Vector, f64),
    /// Ticks since the last cycle.
    ticks: u32,
    /// Standard deviation of an offset before the mission, metres.
    offset_sigma_m: f64,
}

impl StationClocks {
    /// Creates the estimate at the start of a mission, metres, with the standard deviation of this position.
    pub fn new(config: ClockConfig, stations: &[Station], start: Point, start_sigma_m: f64) -> Self {
        let n = stations.len();
        let sigma = |index: usize| match index {
            0 | 1 => start_sigma_m,
            _ if index < OFFSETS + n => config.offset_sigma_m,
            _ => config.drift_sigma_m_per_tick,
        };
        let mut state = DVector::zeros(OFFSETS + 2 * n);
        (state[0], state[1]) = (start.x, start.y);
        let variances = DVector::from_fn(state.len(), |index, _| sigma(index).powi(2));
        Self {
            stations: stations.to_vec(),
            state,
            covariance: DMatrix::from_diagonal(&variances),
            moved: (Vector::zeros(), 0.0),
            ticks: 0,
            offset_sigma_m: config.offset_sigma_m,
        }
    }

    /// Adds the motion of a tick in the tank frame, metres, with its standard deviation.
    pub fn predict(&mut self, moved: Vector, sigma_m: f64) {
        self.moved.0 += moved;
        // Slip and heading persist from tick to tick, so the standard deviations add up.
        self.moved.1 += sigma_m;
        self.ticks = self.ticks.saturating_add(1);
    }

    /// Adds an unmeasured motion of at most this length, metres.
    pub fn wander(&mut self, most_m: f64) {
        self.moved.1 += most_m;
    }

    /// The offset of each station at the last cycle, relative to the mean of all offsets, metres.
    pub fn offsets_m(&self) -> impl Iterator<Item = (StationId, Estimated)> + '_ {
        let n = self.stations.len();
        let mean = 1.0 / n.max(1) as f64;
        self.stations.iter().enumerate().map(move |(own, station)| {
            let part = |index: usize| f64::from(u8::from(index == own)) - mean;
            let value = (0..n).map(|index| part(index) * self.state[OFFSETS + index]).sum();
            let covariance = |i: usize, j: usize| self.covariance[(OFFSETS + i, OFFSETS + j)];
            let pairs = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
            let variance: f64 = pairs.map(|(i, j)| part(i) * covariance(i, j) * part(j)).sum();
            (station.id, Estimated { value, sigma: variance.max(0.0).sqrt() })
        })
    }

    /// The offset of each station at present, relative to the mean of all offsets, metres.
    pub fn present_offsets_m(&self) -> Vec<(StationId, Estimated)> {
        let mut present = self.clone();
        present.advance();
        present.offsets_m().collect()
    }

    /// The present offset of each station, metres, and its change in a tick, metres.
    pub fn clocks_m(&self) -> Vec<(StationId, f64, f64)> {
        let n = self.stations.len();
        let of = |(index, station): (usize, &Station)| {
            let (offset_m, drift_m) = (self.state[OFFSETS + index], self.state[OFFSETS + n + index]);
            (station.id, offset_m + f64::from(self.ticks) * drift_m, drift_m)
        };
        self.stations.iter().enumerate().map(of).collect()
    }

    /// Returns ranges without the offsets of their stations.
    pub fn corrected(&self, ranges: &[Ranging]) -> Vec<Ranging> {
        let one = |range: &Ranging| {
            let offset_m = self.index(range.station).map_or(0.0, |index| self.state[OFFSETS + index]);
            Ranging {
                range_m: range.range_m - offset_m,
                least_m: range.least_m - offset_m,
                most_m: range.most_m - offset_m,
                ..*range
            }
        };
        ranges.iter().map(one).collect()
    }

    /// Returns the covariance that the uncertain offsets add to a fix, square metres. Later fixes share this error.
    pub fn spread(&self, fix: &Fix) -> Matrix2<f64> {
        let Some(by_range) = position_by_range(fix, &self.stations, true) else { return Matrix2::zeros() };
        let known = |(id, by)| self.index(id).map(|index| (OFFSETS + index, by));
        let parts: Vec<(usize, nalgebra::Vector2<f64>)> = by_range.into_iter().filter_map(known).collect();
        let pairs = parts.iter().flat_map(|a| parts.iter().map(move |b| (a, b)));
        pairs.map(|((i, a), (j, b))| a * b.transpose() * self.covariance[(*i, *j)]).sum()
    }

    /// Updates the estimate with the ranges of a cycle, all of which are too long by one unknown length.
    ///
    /// If they contradict the estimate, the one station without which they do not is left out; if there is none, the
    /// motion since the last cycle counts as unmeasured. Ranges that contradict even this change nothing.
    pub fn take(&mut self, ranges: &[Ranging]) {
        self.advance();
        let Ok(anchors) = anchored(ranges, &self.stations) else { return };
        let least_of_others = || {
            let others = (0..anchors.len()).filter_map(|left_out| {
                let mut others = anchors.clone();
                others.remove(left_out);
                self.met(&others)
            });
            others.min_by(|a, b| a.1.total_cmp(&b.1))
        };
        let unmeasured = || {
            let mut lost = self.clone();
            lost.widen(UNMEASURED_M);
            lost.met(&anchors)
        };
        let met = self.met(&anchors).or_else(least_of_others).or_else(unmeasured);
        if let Some((met, _)) = met {
            *self = met;
        }
    }

    /// Takes the offsets that a pulse test has measured, relative to their mean. Offsets that contradict the estimate
    /// replace it: the pulses measure the clocks alone.
    pub fn take_pulses(&mut self, test: &PulseTest) {
        self.advance();
        // The ranges are corrected by the speed of sound, so the offsets are, too.
        let by = 1.0 / (1.0 + test.scale.value);
        let measured: Vec<(usize, Estimated)> = test
            .offsets_m
            .iter()
            .filter_map(|(id, offset)| Some((OFFSETS + self.index(*id)?, *offset)))
            .map(|(index, offset)| (index, Estimated { value: offset.value * by, sigma: offset.sigma * by }))
            .collect();
        let jumped = || {
            let mut jumped = self.clone();
            for (index, _) in &measured {
                jumped.covariance[(*index, *index)] += self.offset_sigma_m.powi(2);
            }
            jumped.measured(&measured)
        };
        if let Some(met) = self.measured(&measured).or_else(jumped) {
            *self = met;
        }
    }

    /// Returns the estimate after an update with differences of offsets from the first one; `None` if they contradict it.
    fn measured(&self, offsets: &[(usize, Estimated)]) -> Option<Self> {
        let ((own, first), others) = offsets.split_first()?;
        let n = others.len();
        let mut by_state = DMatrix::zeros(n, self.state.len());
        let mut noise = DMatrix::from_element(n, n, first.sigma.powi(2));
        let mut error = DVector::zeros(n);
        for (row, (index, offset)) in others.iter().enumerate() {
            (by_state[(row, *index)], by_state[(row, *own)]) = (1.0, -1.0);
            noise[(row, row)] += offset.sigma.powi(2);
            error[row] = offset.value - first.value - (self.state[*index] - self.state[*own]);
        }
        let (met, score) = self.corrected_by(&self.state, (&error, &by_state, &noise))?;
        let limit = chi_squared_quantile(ALARM_Z, u32::try_from(n).ok().filter(|n| *n > 0)?);
        (score <= limit).then_some(met)
    }

    fn index(&self, id: StationId) -> Option<usize> {
        self.stations.iter().position(|station| station.id == id)
    }

    /// Moves position and offsets on to the present cycle.
    fn advance(&mut self) {
        let n = self.stations.len();
        let ticks = f64::from(std::mem::take(&mut self.ticks));
        let (moved, sigma_m) = std::mem::take(&mut self.moved);
        if moved.iter().all(|number| number.is_finite()) {
            (self.state[0], self.state[1]) = (self.state[0] + moved.x, self.state[1] + moved.y);
        }
        for index in OFFSETS..OFFSETS + n {
            self.state[index] += ticks * self.state[index + n];
            let drift = self.covariance.row(index + n) * ticks;
            let mut row = self.covariance.row_mut(index);
            row += drift;
            let drift = self.covariance.column(index + n) * ticks;
            let mut column = self.covariance.column_mut(index);
            column += drift;
        }
        self.widen(sigma_m);
    }

    /// Adds a standard deviation to the position, metres.
    fn widen(&mut self, sigma_m: f64) {
        // `min` also replaces NaN.
        let variance = sigma_m.abs().min(MOST_SIGMA_M).powi(2);
        for axis in 0..OFFSETS {
            let limited = (self.covariance[(axis, axis)] + variance).min(MOST_SIGMA_M.powi(2));
            self.covariance[(axis, axis)] = limited;
        }
    }

    /// Returns the estimate after an update, and the squared error of the differences in units of their variance;
    /// `None` if they contradict the estimate.
    fn met(&self, anchors: &[Anchor]) -> Option<(Self, f64)> {
        let n = anchors.len().checked_sub(1).filter(|n| *n > 0)?;
        let limit = chi_squared_quantile(ALARM_Z, u32::try_from(n).ok()?);
        let (mut met, mut score) = (self.clone(), 0.0);
        for _ in 0..ROUNDS {
            let (error, by_state, noise) = self.differences(anchors, &met.state)?;
            (met, score) = self.corrected_by(&met.state, (&error, &by_state, &noise))?;
        }
        (score <= limit).then_some((met, score))
    }

    /// A Kalman update with a measurement that is linearised at a state: its error there, its derivatives by the state,
    /// and its covariance. Returns the new estimate, and the squared error in units of its variance.
    fn corrected_by(
        &self,
        at: &DVector<f64>,
        (error, by_state, noise): (&DVector<f64>, &DMatrix<f64>, &DMatrix<f64>),
    ) -> Option<(Self, f64)> {
        let expected = by_state * &self.covariance * by_state.transpose() + noise;
        let inverse = expected.cholesky()?.inverse();
        let error = error - by_state * (&self.state - at);
        let gain = &self.covariance * by_state.transpose() * &inverse;
        let rest = DMatrix::identity(self.state.len(), self.state.len()) - &gain * by_state;
        let score = error.dot(&(&inverse * &error));
        let mut met = self.clone();
        met.state = &self.state + &gain * error;
        // The Joseph form stays positive where the short form may not.
        met.covariance = &rest * &self.covariance * rest.transpose() + &gain * noise * gain.transpose();
        let is_sound = met.state.iter().chain(met.covariance.iter()).all(|number| number.is_finite());
        is_sound.then_some((met, score))
    }

    /// The differences of all ranges from the first one: their errors at a state, their derivatives by the state, and
    /// their covariance.
    fn differences(
        &self,
        anchors: &[Anchor],
        at: &DVector<f64>,
    ) -> Option<(DVector<f64>, DMatrix<f64>, DMatrix<f64>)> {
        let place = Point::new(at[0], at[1]);
        let (first, others) = anchors.split_first()?;
        let own = self.index(first.station)?;
        let (mut error, mut by_state) =
            (DVector::zeros(others.len()), DMatrix::zeros(others.len(), at.len()));
        let base = first.view_from(place);
        // All ranges share the noise of the first one.
        let mut noise = DMatrix::from_element(others.len(), others.len(), base.sigma_m.powi(2));
        for (row, anchor) in others.iter().enumerate() {
            let (index, view) = (self.index(anchor.station)?, anchor.view_from(place));
            error[row] = view.residual_m - at[OFFSETS + index] - (base.residual_m - at[OFFSETS + own]);
            for axis in 0..OFFSETS {
                by_state[(row, axis)] = view.direction[axis] - base.direction[axis];
            }
            (by_state[(row, OFFSETS + index)], by_state[(row, OFFSETS + own)]) = (1.0, -1.0);
            noise[(row, row)] += view.sigma_m.powi(2);
        }
        Some((error, by_state, noise))
    }
}

#[cfg(test)]
mod tests;
