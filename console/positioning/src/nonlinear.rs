//! Weighted nonlinear least squares on the ranges themselves.

use crate::{
    anchor::{Anchor, anchored},
    fix::{Fix, FixError, PositionSolver, Ranging},
    linear::{conditioning, solve_linear},
    pair::solve_pair,
    quality::{assess, inverse_of},
};
use nalgebra::Matrix2;
use world::{Point, Station, Vector};

/// Steps tried before giving up; five are usual.
const MAX_ITERATIONS: usize = 60;
/// The search ends when a step is shorter than this share of the longest range.
const STEP_TOLERANCE: f64 = 1e-9;
/// Stations nearer to a line than this condition number leave a second position that has to be looked at.
const MIRROR_CONDITIONING: f64 = 5.0;
/// A second position fits nearly as well if its chi-squared is worse by less than this.
const MIRROR_MARGIN: f64 = 9.0;

/// Least squares on relative range errors, `sum ((r_i - l_i) / (s_i l_i))^2` with `s_i` the relative sigma of a range.
///
/// Starts at the linear solution (starting at the tank's centre ends in a false minimum for 5 % of a round tank) and
/// goes on with Gauss-Newton steps under Levenberg-Marquardt damping. Reaches the Cramér-Rao bound of normal noise.
///
/// Stations on one line, and two stations, need a prior: there is a mirror solution, and the prior chooses. It has no
/// other influence on the fix.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Nls;

impl PositionSolver for Nls {
    fn solve(
        &self,
        ranges: &[Ranging],
        stations: &[Station],
        prior: Option<(Point, Matrix2<f64>)>,
    ) -> Result<Fix, FixError> {
        let anchors = anchored(ranges, stations)?;
        let prior =
            prior.filter(|(at, covariance)| at.iter().chain(covariance.iter()).all(|c| c.is_finite()));
        match (anchors.as_slice(), prior) {
            ([first, second], Some((near, _))) => solve_pair(first, second, near),
            ([] | [_] | [_, _], _) => Err(FixError::TooFewStations {
                have: anchors.len(),
                need: if prior.is_some() { 2 } else { 3 },
            }),
            _ => solve_many(&anchors, prior),
        }
    }
}

fn solve_many(anchors: &[Anchor], prior: Option<(Point, Matrix2<f64>)>) -> Result<Fix, FixError> {
    let start = match (solve_linear(anchors), prior) {
        (Ok(linear), _) => linear.position,
        (Err(FixError::Collinear { .. }), Some((near, _))) => near,
        (Err(error), _) => return Err(error),
    };
    let conditioning = conditioning(anchors);
    let found = descend(anchors, start)?;
    let (best, mirror) =
        if conditioning > MIRROR_CONDITIONING { choose_side(anchors, found, prior) } else { (found, None) };
    let covariance =
        inverse_of(&best.information).ok_or(FixError::NotConverged { iterations: best.iterations })?;
    assess(anchors, best.position, covariance, conditioning, mirror)
}

/// Where a descent ended.
#[derive(Debug, Clone, Copy)]
struct Minimum {
    position: Point,
    cost: f64,
    information: Matrix2<f64>,
    iterations: usize,
}

/// Looks for a second minimum behind the line of the stations; the better one first.
fn choose_side(
    anchors: &[Anchor],
    found: Minimum,
    prior: Option<(Point, Matrix2<f64>)>,
) -> (Minimum, Option<Point>) {
    let Ok(other) = descend(anchors, reflected(anchors, found.position)) else {
        return (found, None);
    };
    let apart = (other.position - found.position).norm();
    if apart < 1e-6 || other.cost > found.cost + MIRROR_MARGIN {
        return (found, None);
    }
    if other.cost < found.cost - MIRROR_MARGIN {
        return (other, None);
    }
    let surprise = |m: &Minimum| m.cost + prior.map_or(0.0, |p| surprise_to(p, m.position));
    if surprise(&other) < surprise(&found) {
        (other, Some(found.position))
    } else {
        (found, Some(other.position))
    }
}

/// Squared distance from a prior in its own sigmas; metres squared if it has no usable covariance.
fn surprise_to((near, covariance): (Point, Matrix2<f64>), position: Point) -> f64 {
    let away = position - near;
    let inverse = inverse_of(&covariance).unwrap_or_else(Matrix2::identity);
    away.dot(&(inverse * away))
}

/// The position behind the line that the stations stand on most nearly.
fn reflected(anchors: &[Anchor], position: Point) -> Point {
    let n = anchors.len() as f64;
    let middle = Point::from(anchors.iter().map(|a| a.at.coords).sum::<Vector>() / n);
    let scatter: Matrix2<f64> = anchors.iter().map(|a| a.at - middle).map(|d| d * d.transpose()).sum();
    let angle = 0.5 * (2.0 * scatter[(0, 1)]).atan2(scatter[(0, 0)] - scatter[(1, 1)]);
    let across = Vector::new(-angle.sin(), angle.cos());
    position - across * (2.0 * across.dot(&(position - middle)))
}

/// Goes down from `start` until the steps are negligible.
fn descend(anchors: &[Anchor], start: Point) -> Result<Minimum, FixError> {
    let scale = anchors.iter().map(|a| a.range_m).fold(0.0, f64::max);
    let (mut position, mut damping) = (start, 1e-9);
    let mut here = Slope::at(anchors, position);
    for iterations in 1..=MAX_ITERATIONS {
        let Some(step) = here.step(damping) else { break };
        let there = Slope::at(anchors, position + step);
        let is_better = there.cost <= here.cost;
        if is_better {
            position += step;
            here = there;
        }
        if step.norm() <= STEP_TOLERANCE * scale {
            let information = information_at(anchors, position);
            return Ok(Minimum { position, cost: here.cost, information, iterations });
        }
        damping = if is_better { (damping * 0.1).max(1e-9) } else { (damping * 10.0).max(1e-4) };
    }
    Err(FixError::NotConverged { iterations: MAX_ITERATIONS })
}

/// The cost at a position with its first derivatives.
struct Slope {
    cost: f64,
    gradient: Vector,
    curvature: Matrix2<f64>,
}

impl Slope {
    fn at(anchors: &[Anchor], position: Point) -> Self {
        let mut slope = Self { cost: 0.0, gradient: Vector::zeros(), curvature: Matrix2::zeros() };
        for anchor in anchors {
            let view = anchor.view_from(position);
            let error = view.residual_m / view.sigma_m;
            // d/dl of (r - l) / (s l) is -r / (s l^2).
            let slant = view.direction * (-anchor.range_m / (view.sigma_m * view.distance_m));
            slope.cost += error * error;
            slope.gradient += slant * error;
            slope.curvature += slant * slant.transpose();
        }
        slope
    }

    /// The damped Gauss-Newton step; none if the numbers have run away.
    fn step(&self, damping: f64) -> Option<Vector> {
        // Damping by the trace also holds where the stations see the position from one direction only.
        let damped = self.curvature + Matrix2::identity() * (damping * self.curvature.trace());
        inverse_of(&damped)
            .map(|inverse| -(inverse * self.gradient))
            .filter(|s| s.iter().all(|c| c.is_finite()))
    }
}

/// Inverse of the covariance: `sum u_i u_i^T / sigma_i^2` with `u_i` the directions from the stations.
fn information_at(anchors: &[Anchor], position: Point) -> Matrix2<f64> {
    anchors
        .iter()
        .map(|a| a.view_from(position))
        .map(|v| v.direction * v.direction.transpose() / v.sigma_m.powi(2))
        .sum()
}

#[cfg(test)]
mod tests;
