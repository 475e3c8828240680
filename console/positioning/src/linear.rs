//! Linear least squares on differences of squared ranges (Wang et al. 2023, eq. 6-9).

use crate::{
    anchor::{Anchor, anchored},
    fix::{Fix, FixError, PositionSolver, Prior, Ranging},
    quality::assess,
};
use nalgebra::Matrix2;
use world::{Point, Station, Vector};

/// The largest condition number accepted; at 37, the mean error is already a quarter of the tank's radius.
pub const MAX_CONDITIONING: f64 = 50.0;

/// Stands for an infinite condition number, so that every number stays finite.
const SINGULAR: f64 = 1e12;

/// The method of the paper: subtracting the squared range of the last station makes the equations linear.
///
/// With three stations there are two equations with two unknowns, so nothing is averaged, and half of the information
/// is lost. [`crate::Nls`] uses all of the information.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LinearLs;

impl PositionSolver for LinearLs {
    fn solve(
        &self,
        ranges: &[Ranging],
        stations: &[Station],
        _prior: Option<Prior>,
    ) -> Result<Fix, FixError> {
        let anchors = anchored(ranges, stations)?;
        let solution = solve_linear(&anchors)?;
        assess(&anchors, solution.position, solution.covariance, solution.conditioning, None)
    }
}

/// The solution of the linear equations.
pub(crate) struct Linear {
    pub position: Point,
    pub covariance: Matrix2<f64>,
    pub conditioning: f64,
}

/// Solves `2 d_i . q = r_ref^2 - r_i^2 + |d_i|^2` for `q`, the position relative to the last station.
pub(crate) fn solve_linear(anchors: &[Anchor]) -> Result<Linear, FixError> {
    let Some((reference, others)) = anchors.split_last().filter(|(_, others)| others.len() >= 2) else {
        return Err(FixError::TooFewStations { have: anchors.len(), need: 3 });
    };
    let factors = Factors::of(anchors);
    let conditioning = factors.conditioning();
    if conditioning > MAX_CONDITIONING {
        return Err(FixError::Collinear { conditioning, limit: MAX_CONDITIONING });
    }
    let (mut position, mut covariance) = (reference.at, Matrix2::zeros());
    let mut by_reference = Vector::zeros();
    for other in others {
        let offset = other.at - reference.at;
        let column = factors.pseudo_inverse_column(offset);
        let squares = reference.range_m.powi(2) - other.range_m.powi(2) + offset.norm_squared();
        position += column * (squares / 2.0);
        let by_range = column * (other.range_m * other.sigma_m);
        covariance += by_range * by_range.transpose();
        by_reference += column * (reference.range_m * reference.sigma_m);
    }
    covariance += by_reference * by_reference.transpose();
    Ok(Linear { position, covariance, conditioning })
}

/// Returns the condition number of the linear equations of these stations, at most 1e12.
pub(crate) fn conditioning(anchors: &[Anchor]) -> f64 {
    if anchors.len() < 3 { SINGULAR } else { Factors::of(anchors).conditioning() }
}

/// QR factors of the rows `d_i` (station positions relative to the last station), with the longer column first.
struct Factors {
    swapped: bool,
    r11: f64,
    r12: f64,
    r22: f64,
}

impl Factors {
    fn of(anchors: &[Anchor]) -> Self {
        let reference = anchors[anchors.len() - 1].at;
        let rows = || anchors[..anchors.len() - 1].iter().map(|a| a.at - reference);
        let (xx, yy) = rows().fold((0.0, 0.0), |(xx, yy), d| (xx + d.x * d.x, yy + d.y * d.y));
        let mut factors = Self { swapped: yy > xx, r11: xx.max(yy).sqrt(), r12: 0.0, r22: 0.0 };
        if factors.r11 > 0.0 {
            factors.r12 = rows().map(|d| factors.ordered(d)).map(|(a, b)| a * b).sum::<f64>() / factors.r11;
            factors.r22 = rows().map(|d| factors.second_column(d).powi(2)).sum::<f64>().sqrt();
        }
        factors
    }

    fn ordered(&self, row: Vector) -> (f64, f64) {
        if self.swapped { (row.y, row.x) } else { (row.x, row.y) }
    }

    /// Returns the part of a row's second entry that is orthogonal to the first column.
    fn second_column(&self, row: Vector) -> f64 {
        let (a, b) = self.ordered(row);
        b - a * (self.r12 / self.r11)
    }

    /// Returns the column of the pseudo-inverse for a row.
    fn pseudo_inverse_column(&self, row: Vector) -> Vector {
        let second = self.second_column(row) / (self.r22 * self.r22);
        let first = (self.ordered(row).0 / self.r11 - self.r12 * second) / self.r11;
        if self.swapped { Vector::new(second, first) } else { Vector::new(first, second) }
    }

    /// Returns the ratio of the singular values of the triangular factor.
    fn conditioning(&self) -> f64 {
        let squares = self.r11.powi(2) + self.r12.powi(2) + self.r22.powi(2);
        let product = self.r11 * self.r22;
        let largest =
            f64::midpoint((squares + 2.0 * product).sqrt(), (squares - 2.0 * product).max(0.0).sqrt());
        if product > 0.0 { (largest * largest / product).min(SINGULAR) } else { SINGULAR }
    }
}

#[cfg(test)]
mod tests;
