//! The second position that the ranges allow without one station: the mirror image in the line of the other stations.
//!
//! Four stations on a line and one beside it exclude the mirror image only together. If the station beside the line is
//! wrong, the solver may choose the wrong side, and no step from there finds the true position.

use crate::{
    anchor::Anchor,
    differences,
    nonlinear::{self, Slope, reflected},
};
use nalgebra::Matrix2;
use world::{Point, Vector};

/// The width of a layout as a share of its length, above which its ranges allow no second position.
const FLAT: f64 = 1.0 / 3.0;

/// The spread of stations around their mean. Each station has the weight of its range.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layout {
    mean: Vector,
    weight: f64,
    scatter: Matrix2<f64>,
}

impl Layout {
    /// Returns the layout of stations with the weights of their ranges.
    pub(crate) fn of(stations: impl Iterator<Item = (Point, f64)> + Clone) -> Self {
        let weight: f64 = stations.clone().map(|(_, weight)| weight).sum();
        let mean = stations.clone().map(|(at, weight)| at.coords * weight).sum::<Vector>() / weight;
        let scatter = stations.map(|(at, weight)| (at.coords - mean, weight));
        Self { mean, weight, scatter: scatter.map(|(away, w)| away * away.transpose() * w).sum() }
    }

    /// Whether the stations are nearly on a line, without the one at this place if one is given. Cost: 10 ns.
    pub(crate) fn is_flat(&self, without: Option<(Point, f64)>) -> bool {
        let scatter = without.map_or(self.scatter, |(at, weight)| {
            let away = at.coords - self.mean;
            self.scatter - away * away.transpose() * (weight * self.weight / (self.weight - weight))
        });
        let (a, b, c) = (scatter[(0, 0)], scatter[(0, 1)], scatter[(1, 1)]);
        let (middle, half) = (f64::midpoint(a, c), ((a - c).powi(2) / 4.0 + b * b).sqrt());
        middle - half < FLAT * FLAT * (middle + half)
    }
}

/// Returns the distance from a place, which fits the ranges best, to the place on the other side of the stations,
/// metres; 0 if the ranges exclude it. `None` if the numbers overflow.
///
/// The ranges exclude a place if the sum of their squared residuals there, in units of the variances, exceeds the least
/// sum by `limit`: so much more at the true position has a probability of at most exp(-limit / 2).
pub(crate) fn other_side_m(anchors: &[Anchor], at: Point, is_emission_free: bool, limit: f64) -> Option<f64> {
    if anchors.iter().any(|a| a.range_m <= 0.0) {
        return None;
    }
    let there = reflected(anchors, at);
    let (here, there) = if is_emission_free {
        let [here, there] = [at, there].map(|start| differences::lowest(anchors, start));
        (here?, there?)
    } else {
        let there = nonlinear::lowest(anchors, there)?;
        ((at, Slope::at(anchors, at).cost), there)
    };
    Some(if there.1 <= here.1 + limit { (there.0 - at).norm() } else { 0.0 })
}
