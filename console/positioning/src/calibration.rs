//! Estimates the speed of sound, the clock offset and the positions of the stations from a whole session.

use crate::{
    anchor::{Anchor, anchored},
    fix::{FixError, Prior, Ranging},
    nonlinear::solve_anchors,
    quality::{ALARM_Z, chi_squared_quantile},
};
use nalgebra::{DMatrix, DVector, Matrix2, Matrix4, Vector4};
use serde::{Deserialize, Serialize};
use world::{Point, Station};

/// The largest error that is accepted in the assumed speed of sound, as a share.
pub(crate) const MOST_SCALE: f64 = 0.3;
/// The largest scale error that counts as zero, as a share.
const LEAST_SCALE: f64 = 1e-6;
/// The number of iterations in which the position is fitted together with the common errors of a cycle.
const ROUNDS: usize = 6;

/// The quantities to estimate, each with its prior uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Unknowns {
    /// Standard deviation of the error of the assumed speed of sound, as a share.
    pub sound_sigma_ratio: f64,
    /// Standard deviation of the surveyed station positions in x and in y, metres; 0 if they are exact.
    pub survey_sigma_m: f64,
    /// Standard deviation of the length by which all ranges are too long because of a clock offset, metres; 0 if the
    /// clocks agree.
    #[serde(default)]
    pub offset_sigma_m: f64,
}

impl Default for Unknowns {
    /// A speed of sound known to 2 %, exact station positions, and clocks that agree.
    fn default() -> Self {
        Self { sound_sigma_ratio: 0.02, survey_sigma_m: 0.0, offset_sigma_m: 0.0 }
    }
}

impl Unknowns {
    /// Whether the speed of sound is estimated; a scale error of a millionth counts as zero.
    fn has_scale(&self) -> bool {
        self.sound_sigma_ratio > LEAST_SCALE
    }

    fn has_offset(&self) -> bool {
        is_positive(self.offset_sigma_m)
    }

    fn has_survey(&self) -> bool {
        is_positive(self.survey_sigma_m)
    }
}

fn is_positive(sigma: f64) -> bool {
    sigma > 0.0 && sigma.is_finite()
}

/// Pools the cycles of a session: a single cycle reveals little about the scale of all ranges, but together they
/// determine it exactly.
///
/// Every cycle is fitted with a free position. Its remaining information goes into one system of linear equations (a
/// Schur complement), so memory does not grow with the length of a session. Cycles that contradict themselves even with
/// a free scale, such as those with a wrong station, are left out. It takes four stations to separate either a scale or
/// an offset from a position, and five to separate both. Estimating the station positions also needs a robot that moves
/// about.
#[derive(Debug, Clone)]
pub struct Calibration {
    stations: Vec<Station>,
    unknowns: Unknowns,
    information: DMatrix<f64>,
    weighted: DVector<f64>,
    estimate: DVector<f64>,
    scale_sigma: f64,
    offset_sigma_m: f64,
    cycles: u64,
}

impl Calibration {
    /// Creates a calibration of these stations without any data.
    pub fn new(stations: &[Station], unknowns: Unknowns) -> Self {
        let surveyed = if unknowns.has_survey() { 2 * stations.len() } else { 0 };
        let n = 1 + surveyed + usize::from(unknowns.has_offset());
        // `max` also replaces NaN with the minimum.
        let at_least = unknowns.sound_sigma_ratio.max(LEAST_SCALE);
        let sound = at_least.min(1.0);
        let mut information = DMatrix::from_diagonal_element(n, n, unknowns.survey_sigma_m.powi(-2));
        information[(0, 0)] = sound.powi(-2);
        if unknowns.has_offset() {
            information[(n - 1, n - 1)] = unknowns.offset_sigma_m.powi(-2);
        }
        Self {
            stations: stations.to_vec(),
            unknowns,
            information,
            weighted: DVector::zeros(n),
            estimate: DVector::zeros(n),
            scale_sigma: sound,
            offset_sigma_m: unknowns.offset_sigma_m,
            cycles: 0,
        }
    }

    /// The share by which all ranges are too long, and its standard deviation.
    pub fn scale(&self) -> (f64, f64) {
        (self.estimate[0], self.scale_sigma)
    }

    /// The length by which all ranges are too long, and its standard deviation, metres.
    pub fn offset_m(&self) -> (f64, f64) {
        (self.common().offset_m, self.offset_sigma_m)
    }

    /// Returns a calibration without data that starts from the estimate of this one. Each cycle is linearised about the
    /// estimate at the time when the cycle is added, so a second pass over the session removes the errors of the first.
    #[must_use]
    pub fn again(&self) -> Self {
        Self { estimate: self.estimate.clone(), ..Self::new(&self.stations, self.unknowns) }
    }

    /// Returns the current estimate of the common errors.
    fn common(&self) -> Common {
        let offset_m = if self.unknowns.has_offset() { self.estimate[self.estimate.len() - 1] } else { 0.0 };
        Common { scale: self.estimate[0], offset_m }
    }

    /// The stations at their estimated positions.
    pub fn stations(&self) -> Vec<Station> {
        let moved = |(i, station): (usize, &Station)| {
            let mut station = station.clone();
            if self.unknowns.has_survey()
                && let (Some(x), Some(y)) = (self.estimate.get(1 + 2 * i), self.estimate.get(2 + 2 * i))
            {
                station.position += nalgebra::Vector2::new(*x, *y);
            }
            station
        };
        self.stations.iter().enumerate().map(moved).collect()
    }

    /// The number of cycles used.
    pub fn cycles(&self) -> u64 {
        self.cycles
    }

    /// The quantities being estimated.
    pub fn unknowns(&self) -> Unknowns {
        self.unknowns
    }

    /// Returns the ranges with their common error removed; the remaining uncertainty of that error widens their sigmas.
    pub fn corrected(&self, ranges: &[Ranging]) -> Vec<Ranging> {
        let Common { scale, offset_m } = self.common();
        let by = 1.0 / (1.0 + scale);
        let one = |r: &Ranging| Ranging {
            range_m: (r.range_m - offset_m) * by,
            sigma_m: (r.sigma_m * by).hypot(r.range_m * self.scale_sigma).hypot(self.offset_sigma_m),
            timing_sigma_m: r.timing_sigma_m * by,
            least_m: (r.least_m - offset_m) * by,
            most_m: (r.most_m - offset_m) * by,
            ..*r
        };
        ranges.iter().map(one).collect()
    }

    /// Adds the uncorrected ranges of one cycle; returns whether they could be used.
    ///
    /// # Errors
    /// See [`FixError`]: a cycle without a position contributes nothing.
    pub fn take(&mut self, ranges: &[Ranging], near: Option<Prior>) -> Result<bool, FixError> {
        let anchors = anchored(ranges, &self.stations())?;
        let free = Free::of(&self.unknowns);
        if anchors.len() < 3 + free.count() {
            return Ok(false);
        }
        let Some(cycle) = Cycle::fitted(&anchors, self.common(), free, near)? else { return Ok(false) };
        self.add(&cycle, &anchors);
        self.solve();
        self.cycles += 1;
        Ok(true)
    }

    fn add(&mut self, cycle: &Cycle, anchors: &[Anchor]) {
        let n = self.estimate.len();
        let mut rows: Vec<DVector<f64>> = Vec::with_capacity(anchors.len());
        let mut by_position = DMatrix::zeros(2, n);
        for row in &cycle.rows {
            let mut by_unknown = DVector::zeros(n);
            by_unknown[0] = row.by_scale;
            let index = self.stations.iter().position(|s| s.id == anchors[row.anchor].station);
            if self.unknowns.has_offset() {
                by_unknown[n - 1] = 1.0;
            }
            if let Some(i) = index.filter(|_| self.unknowns.has_survey()) {
                by_unknown[1 + 2 * i] = -row.by_position.x;
                by_unknown[2 + 2 * i] = -row.by_position.y;
            }
            by_position += row.by_position * by_unknown.transpose() * row.weight;
            rows.push(by_unknown);
        }
        let mut right = nalgebra::Vector2::zeros();
        for (row, by_unknown) in cycle.rows.iter().zip(&rows) {
            // The error is expressed relative to unknowns that are all zero, so that cycles linearised at different
            // estimates can be summed.
            let error = row.error + by_unknown.dot(&self.estimate);
            self.information += by_unknown * by_unknown.transpose() * row.weight;
            self.weighted += by_unknown * (row.weight * error);
            right += row.by_position * (row.weight * error);
        }
        let gain = by_position.transpose() * cycle.position_inverse;
        self.information -= &gain * &by_position;
        self.weighted -= gain * right;
    }

    fn solve(&mut self) {
        let Some(factors) = self.information.clone().cholesky() else { return };
        let estimate = factors.solve(&self.weighted);
        if estimate.iter().all(|number| number.is_finite()) && estimate[0].abs() < MOST_SCALE {
            self.estimate = estimate;
            let sigma = |index: usize| {
                let mut only = DVector::zeros(self.estimate.len());
                only[index] = 1.0;
                factors.solve(&only)[index].max(0.0).sqrt()
            };
            self.scale_sigma = sigma(0);
            if self.unknowns.has_offset() {
                self.offset_sigma_m = sigma(self.estimate.len() - 1);
            }
        }
    }
}

/// The common errors of all ranges: `range = distance * (1 + scale) + offset`.
#[derive(Debug, Clone, Copy)]
struct Common {
    scale: f64,
    offset_m: f64,
}

/// The quantities that are free when a cycle is checked for contradictions.
#[derive(Debug, Clone, Copy)]
struct Free {
    scale: bool,
    offset: bool,
}

impl Free {
    fn of(unknowns: &Unknowns) -> Self {
        let offset = unknowns.has_offset();
        Self { scale: unknowns.has_scale() || !offset, offset }
    }

    fn count(self) -> usize {
        usize::from(self.scale) + usize::from(self.offset)
    }
}

/// One range of a cycle, linearised about the fit.
struct Row {
    anchor: usize,
    by_position: nalgebra::Vector2<f64>,
    by_scale: f64,
    error: f64,
    weight: f64,
}

/// A cycle, linearised about its own best position.
struct Cycle {
    rows: Vec<Row>,
    position_inverse: Matrix2<f64>,
}

impl Cycle {
    /// Fits the cycle with the given common errors; `None` if the cycle contradicts itself even when these errors are
    /// free.
    fn fitted(
        anchors: &[Anchor],
        common: Common,
        free: Free,
        near: Option<Prior>,
    ) -> Result<Option<Self>, FixError> {
        let by = 1.0 / (1.0 + common.scale);
        let shrunk: Vec<Anchor> = anchors
            .iter()
            .map(|a| {
                let range_m = (a.range_m - common.offset_m) * by;
                Anchor::new(a.station, a.at, range_m, a.sigma_m * by, a.timing_sigma_m * by)
            })
            .collect();
        if shrunk.iter().any(|a| a.range_m <= 0.0) {
            return Ok(None);
        }
        let position = solve_anchors(&shrunk, near)?.position;
        let own = own_chi2(anchors, position, common, free);
        let df = u32::try_from(anchors.len() - 2 - free.count()).unwrap_or(u32::MAX);
        if own.is_none_or(|chi2| chi2 > chi_squared_quantile(ALARM_Z, df)) {
            return Ok(None);
        }
        let rows: Vec<Row> = anchors.iter().enumerate().map(|(i, a)| row(i, a, position, common)).collect();
        let information: Matrix2<f64> =
            rows.iter().map(|r| r.by_position * r.by_position.transpose() * r.weight).sum();
        Ok(information.try_inverse().map(|position_inverse| Self { rows, position_inverse }))
    }
}

fn row(index: usize, anchor: &Anchor, position: Point, common: Common) -> Row {
    let view = anchor.view_from(position);
    let stretch = 1.0 + common.scale;
    Row {
        anchor: index,
        by_position: view.direction * stretch,
        by_scale: view.distance_m,
        error: anchor.range_m - view.distance_m * stretch - common.offset_m,
        weight: (view.sigma_m * stretch).powi(-2),
    }
}

/// Returns the sum of the squared residuals of a cycle, with all permitted quantities free.
fn own_chi2(anchors: &[Anchor], mut position: Point, mut common: Common, free: Free) -> Option<f64> {
    for _ in 0..ROUNDS {
        let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
        // A fixed quantity has a column of zeros; a 1 on the diagonal keeps its value.
        normal[(2, 2)] = f64::from(u8::from(!free.scale));
        normal[(3, 3)] = f64::from(u8::from(!free.offset));
        for row in anchors.iter().map(|a| row(0, a, position, common)) {
            let by_scale = if free.scale { row.by_scale } else { 0.0 };
            let by_offset = f64::from(u8::from(free.offset));
            let by = Vector4::new(row.by_position.x, row.by_position.y, by_scale, by_offset);
            normal += by * by.transpose() * row.weight;
            right += by * (row.weight * row.error);
        }
        let step = normal.cholesky()?.solve(&right);
        position += step.xy();
        common.scale = (common.scale + step.z).clamp(-MOST_SCALE, MOST_SCALE);
        common.offset_m += step.w;
    }
    let residuals = anchors.iter().map(|a| row(0, a, position, common));
    let chi2: f64 = residuals.map(|r| r.error.powi(2) * r.weight).sum();
    chi2.is_finite().then_some(chi2)
}

#[cfg(test)]
mod tests;
