//! What a whole session reveals about the speed of sound and about the positions of the stations.

use crate::{
    anchor::{Anchor, anchored},
    fix::{FixError, Prior, Ranging},
    nonlinear::solve_anchors,
    quality::{ALARM_Z, chi_squared_quantile},
};
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, SMatrix, Vector3};
use serde::{Deserialize, Serialize};
use world::{Point, Station};

/// Largest error of the assumed sound speed that is believed, as a share.
const MOST_SCALE: f64 = 0.3;
/// Rounds of fitting position and scale together.
const ROUNDS: usize = 4;

/// What is to be found out, by how much it may be off.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Unknowns {
    /// Standard deviation of the error of the assumed speed of sound, as a share.
    pub sound_sigma_ratio: f64,
    /// Standard deviation of the surveyed places in x and in y, metres; 0: they are right.
    pub survey_sigma_m: f64,
}

impl Default for Unknowns {
    /// A speed of sound known to 2 %, and stations where the survey says.
    fn default() -> Self {
        Self { sound_sigma_ratio: 0.02, survey_sigma_m: 0.0 }
    }
}

/// Pools the cycles of a session: each alone says little about the scale of all ranges, together they say it exactly.
///
/// Every cycle is fitted with its position free; what is left over of its information goes into one system of linear
/// equations (a Schur complement), so a session costs the same memory however long it is. Cycles that contradict
/// themselves even with their scale free, as those with a wrong station do, are left out. Four stations are needed to
/// separate a scale from a position; the survey also needs a robot that moves about.
#[derive(Debug, Clone)]
pub struct Calibration {
    stations: Vec<Station>,
    unknowns: Unknowns,
    information: DMatrix<f64>,
    weighted: DVector<f64>,
    estimate: DVector<f64>,
    scale_sigma: f64,
    cycles: u64,
}

impl Calibration {
    /// A calibration of these stations that knows nothing yet.
    pub fn new(stations: &[Station], unknowns: Unknowns) -> Self {
        let surveys = unknowns.survey_sigma_m > 0.0 && unknowns.survey_sigma_m.is_finite();
        let n = 1 + if surveys { 2 * stations.len() } else { 0 };
        // `max` also turns what is no number into the least.
        let at_least = unknowns.sound_sigma_ratio.max(1e-6);
        let sound = at_least.min(1.0);
        let mut information = DMatrix::from_diagonal_element(n, n, unknowns.survey_sigma_m.powi(-2));
        information[(0, 0)] = sound.powi(-2);
        Self {
            stations: stations.to_vec(),
            unknowns,
            information,
            weighted: DVector::zeros(n),
            estimate: DVector::zeros(n),
            scale_sigma: sound,
            cycles: 0,
        }
    }

    /// By how much too long all ranges are, as a share, and its standard deviation.
    pub fn scale(&self) -> (f64, f64) {
        (self.estimate[0], self.scale_sigma)
    }

    /// The stations where the session says they are.
    pub fn stations(&self) -> Vec<Station> {
        let moved = |(i, station): (usize, &Station)| {
            let mut station = station.clone();
            if let (Some(x), Some(y)) = (self.estimate.get(1 + 2 * i), self.estimate.get(2 + 2 * i)) {
                station.position += nalgebra::Vector2::new(*x, *y);
            }
            station
        };
        self.stations.iter().enumerate().map(moved).collect()
    }

    /// How many cycles went into it.
    pub fn cycles(&self) -> u64 {
        self.cycles
    }

    /// What is being found out.
    pub fn unknowns(&self) -> Unknowns {
        self.unknowns
    }

    /// The ranges with their common error taken out; what is left of it widens their sigmas.
    pub fn corrected(&self, ranges: &[Ranging]) -> Vec<Ranging> {
        let (scale, sigma) = self.scale();
        let by = 1.0 / (1.0 + scale);
        let one = |r: &Ranging| Ranging {
            range_m: r.range_m * by,
            sigma_m: (r.sigma_m * by).hypot(r.range_m * sigma),
            least_m: r.least_m * by,
            most_m: r.most_m * by,
            ..*r
        };
        ranges.iter().map(one).collect()
    }

    /// Takes in the uncorrected ranges of one cycle; whether they could be used.
    ///
    /// # Errors
    /// See [`FixError`]: a cycle without a position contributes nothing.
    pub fn take(&mut self, ranges: &[Ranging], near: Option<Prior>) -> Result<bool, FixError> {
        let anchors = anchored(ranges, &self.stations())?;
        if anchors.len() < 4 {
            return Ok(false);
        }
        let Some(cycle) = Cycle::fitted(&anchors, self.scale().0, near)? else { return Ok(false) };
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
            if let Some(i) = index.filter(|_| n > 1) {
                by_unknown[1 + 2 * i] = -row.by_position.x;
                by_unknown[2 + 2 * i] = -row.by_position.y;
            }
            by_position += row.by_position * by_unknown.transpose() * row.weight;
            rows.push(by_unknown);
        }
        let mut right = nalgebra::Vector2::zeros();
        for (row, by_unknown) in cycle.rows.iter().zip(&rows) {
            // As seen from unknowns of zero, so that cycles taken at different estimates add up.
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
            let mut first = DVector::zeros(self.estimate.len());
            first[0] = 1.0;
            self.scale_sigma = factors.solve(&first)[0].max(0.0).sqrt();
        }
    }
}

/// One range of a cycle, linear about the fit.
struct Row {
    anchor: usize,
    by_position: nalgebra::Vector2<f64>,
    by_scale: f64,
    error: f64,
    weight: f64,
}

/// A cycle about its own best position.
struct Cycle {
    rows: Vec<Row>,
    position_inverse: Matrix2<f64>,
}

impl Cycle {
    /// The cycle at the given scale; `None` if it contradicts itself even with its scale free.
    fn fitted(anchors: &[Anchor], scale: f64, near: Option<Prior>) -> Result<Option<Self>, FixError> {
        let shrunk: Vec<Anchor> = anchors
            .iter()
            .map(|a| Anchor { range_m: a.range_m / (1.0 + scale), sigma_m: a.sigma_m / (1.0 + scale), ..*a })
            .collect();
        let position = solve_anchors(&shrunk, near)?.position;
        let own = own_scale_chi2(anchors, position, scale);
        let df = u32::try_from(anchors.len() - 3).unwrap_or(u32::MAX);
        if own.is_none_or(|chi2| chi2 > chi_squared_quantile(ALARM_Z, df)) {
            return Ok(None);
        }
        let rows: Vec<Row> = anchors.iter().enumerate().map(|(i, a)| row(i, a, position, scale)).collect();
        let information: Matrix2<f64> =
            rows.iter().map(|r| r.by_position * r.by_position.transpose() * r.weight).sum();
        Ok(information.try_inverse().map(|position_inverse| Self { rows, position_inverse }))
    }
}

fn row(index: usize, anchor: &Anchor, position: Point, scale: f64) -> Row {
    let view = anchor.view_from(position);
    Row {
        anchor: index,
        by_position: view.direction * (1.0 + scale),
        by_scale: view.distance_m,
        error: anchor.range_m - view.distance_m * (1.0 + scale),
        weight: (view.sigma_m * (1.0 + scale)).powi(-2),
    }
}

/// Sum of the squared residuals with position and scale of this one cycle free.
fn own_scale_chi2(anchors: &[Anchor], mut position: Point, mut scale: f64) -> Option<f64> {
    for _ in 0..ROUNDS {
        let mut normal = Matrix3::zeros();
        let mut right = Vector3::zeros();
        for row in anchors.iter().map(|a| row(0, a, position, scale)) {
            let by: SMatrix<f64, 3, 1> = Vector3::new(row.by_position.x, row.by_position.y, row.by_scale);
            normal += by * by.transpose() * row.weight;
            right += by * (row.weight * row.error);
        }
        let step = normal.cholesky()?.solve(&right);
        position += step.xy();
        scale = (scale + step.z).clamp(-MOST_SCALE, MOST_SCALE);
    }
    let chi2: f64 =
        anchors.iter().map(|a| row(0, a, position, scale)).map(|r| r.error.powi(2) * r.weight).sum();
    chi2.is_finite().then_some(chi2)
}

#[cfg(test)]
mod tests;
