//! Weighted nonlinear least squares on the ranges themselves.

use crate::{
    anchor::{Anchor, anchored, on_near_circle},
    fix::{ELLIPSE_95, Fix, FixError, PositionSolver, Prior, Ranging},
    linear::{conditioning, solve_linear},
    pair::solve_pair,
    quality::{assess, inverse_of},
    sides::MIRROR_CONDITIONING,
};
use nalgebra::Matrix2;
use world::{Point, Station, Vector};

/// The largest number of steps before the search gives up; five are usual.
const MAX_ITERATIONS: usize = 60;
/// The length of a step, as a share of the longest range, below which the search ends.
const STEP_TOLERANCE: f64 = 1e-9;
/// The difference in chi-squared below which a second position fits nearly as well.
const MIRROR_MARGIN: f64 = 9.0;

/// Least squares on relative range errors, `sum ((r_i - l_i) / (s_i l_i))^2` where `s_i` is the relative sigma of a
/// range.
///
/// Starts at the linear solution and continues with Newton steps under Levenberg-Marquardt damping. (Starting at the
/// tank's centre ends in a false minimum for 5 % of the places in a round tank.) Plain Gauss-Newton steps zigzag on the
/// small range circle of a station close by. Reaches the Cramér-Rao bound for normal noise.
///
/// Stations on one line need a prior to choose between the position and its mirror image. Two stations give both
/// crossings of their circles, one as position and the other as mirror image; here, too, a prior chooses. The prior has
/// no other influence on the fix.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Nls;

impl PositionSolver for Nls {
    fn solve(&self, ranges: &[Ranging], stations: &[Station], prior: Option<Prior>) -> Result<Fix, FixError> {
        solve_anchors(&anchored(ranges, stations)?, prior)
    }
}

/// Returns the least squares fit to the anchors. Two anchors give both crossings of their circles, and a prior
/// chooses.
pub(crate) fn solve_anchors(anchors: &[Anchor], prior: Option<Prior>) -> Result<Fix, FixError> {
    let prior = prior.filter(|(at, covariance)| at.iter().chain(covariance.iter()).all(|c| c.is_finite()));
    match anchors {
        [first, second] => solve_pair(first, second, prior.map(|(near, _)| near)),
        [] | [_] => Err(FixError::TooFewStations { have: anchors.len(), need: 2 }),
        _ => solve_many(anchors, prior),
    }
}

fn solve_many(anchors: &[Anchor], prior: Option<Prior>) -> Result<Fix, FixError> {
    let start = match (solve_linear(anchors), prior) {
        (Ok(linear), _) => linear.position,
        (Err(FixError::Collinear { .. }), Some((near, _))) => beside_the_line(anchors, near),
        (Err(error), _) => return Err(error),
    };
    let conditioning = conditioning(anchors);
    let found = descend(anchors, around_the_nearest(anchors, start))?;
    let (best, mirror) =
        if conditioning > MIRROR_CONDITIONING { choose_side(anchors, found, prior) } else { (found, None) };
    let covariance =
        inverse_of(&best.information).ok_or(FixError::NotConverged { iterations: best.iterations })?;
    assess(anchors, best.position, covariance, conditioning, mirror)
}

/// Returns a better start close to a station, where the original start can be on the wrong side: the best place on
/// the station's range circle.
///
/// The valley of such a small circle is narrow and curved, so a descent along it would take hundreds of steps.
fn around_the_nearest(anchors: &[Anchor], start: Point) -> Point {
    let cost = |position: Point| anchors.iter().map(|a| a.view_from(position).squared_error()).sum::<f64>();
    std::iter::once(start)
        .chain(on_near_circle(anchors))
        .min_by(|a, b| cost(*a).total_cmp(&cost(*b)))
        .unwrap_or(start)
}

/// The end of a descent.
#[derive(Debug, Clone, Copy)]
struct Minimum {
    position: Point,
    cost: f64,
    information: Matrix2<f64>,
    iterations: usize,
}

/// Looks for a second minimum on the other side of the line of stations; returns the better one first.
fn choose_side(anchors: &[Anchor], found: Minimum, prior: Option<Prior>) -> (Minimum, Option<Point>) {
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

/// Returns the mirror image of a place that fits, if the mirror image fits nearly as well; `None` if it does not, or if
/// the two places are the same within their errors.
pub(crate) fn mirror_of(anchors: &[Anchor], at: Point) -> Option<Point> {
    let cost = Slope::at(anchors, at).cost;
    let other = descend(anchors, reflected(anchors, at)).ok()?;
    let away = other.position - at;
    let is_other = away.dot(&(information_at(anchors, at) * away)) > ELLIPSE_95;
    (is_other && other.cost < cost + MIRROR_MARGIN).then_some(other.position)
}

/// Returns the normalised squared distance from a prior; in square metres if the covariance of the prior is unusable.
fn surprise_to((near, covariance): Prior, position: Point) -> f64 {
    let away = position - near;
    let inverse = inverse_of(&covariance).unwrap_or_else(Matrix2::identity);
    away.dot(&(inverse * away))
}

/// Returns the position reflected in the line that fits the stations best.
pub(crate) fn reflected(anchors: &[Anchor], position: Point) -> Point {
    let (middle, along) = line_of(anchors);
    let across = Vector::new(-along.y, along.x);
    position - across * (2.0 * across.dot(&(position - middle)))
}

/// Returns the centre of the stations and the direction of the line that fits them best.
fn line_of(anchors: &[Anchor]) -> (Point, Vector) {
    let n = anchors.len() as f64;
    let middle = Point::from(anchors.iter().map(|a| a.at.coords).sum::<Vector>() / n);
    let scatter: Matrix2<f64> = anchors.iter().map(|a| a.at - middle).map(|d| d * d.transpose()).sum();
    let angle = 0.5 * (2.0 * scatter[(0, 1)]).atan2(scatter[(0, 0)] - scatter[(1, 1)]);
    (middle, Vector::new(angle.cos(), angle.sin()))
}

/// Returns the place that the squared ranges give for stations on a line, on the same side as `near`.
///
/// Do not start the descent at `near` itself: the cost has a saddle on the line, where the descent does not converge.
fn beside_the_line(anchors: &[Anchor], near: Point) -> Point {
    /// Least distance from the line, as a share of the longest range.
    const OFF_THE_SADDLE: f64 = 1e-3;
    let (middle, along) = line_of(anchors);
    let across = Vector::new(-along.y, along.x);
    let stations = || anchors.iter().map(|a| (along.dot(&(a.at - middle)), a.range_m));
    // r^2 - s^2 = (x^2 + y^2) - 2 s x, where the positions s of the stations along the line have the mean 0.
    let spread: f64 = stations().map(|(s, _)| s * s).sum();
    let x = -stations().map(|(s, r)| s * (r * r - s * s)).sum::<f64>() / (2.0 * spread);
    let squared = stations().map(|(s, r)| r * r - s * s).sum::<f64>() / anchors.len() as f64;
    let longest = stations().map(|(_, r)| r).fold(0.0, f64::max);
    let y = (squared - x * x).max(0.0).sqrt().max(OFF_THE_SADDLE * longest);
    middle + along * x + across * y.copysign(across.dot(&(near - middle)))
}

/// Returns the end of a descent from `start`, with its sum of squared residuals in units of their variances. A place without
/// a minimum below it ends where the search gives up. `None` if the numbers have overflowed.
pub(crate) fn lowest(anchors: &[Anchor], start: Point) -> Option<(Point, f64)> {
    let end = walk(anchors, start);
    end.cost.is_finite().then_some((end.position, end.cost))
}

/// Descends from `start` until the steps are negligible.
fn descend(anchors: &[Anchor], start: Point) -> Result<Minimum, FixError> {
    let End { position, cost, settled_after } = walk(anchors, start);
    let iterations = settled_after.ok_or(FixError::NotConverged { iterations: MAX_ITERATIONS })?;
    Ok(Minimum { position, cost, information: information_at(anchors, position), iterations })
}

/// The end of a walk downhill.
struct End {
    position: Point,
    cost: f64,
    /// The number of steps after which the steps were negligible.
    settled_after: Option<usize>,
}

fn walk(anchors: &[Anchor], start: Point) -> End {
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
            return End { position, cost: here.cost, settled_after: Some(iterations) };
        }
        damping = if is_better { (damping * 0.1).max(1e-9) } else { (damping * 10.0).max(1e-4) };
    }
    End { position, cost: here.cost, settled_after: None }
}

/// The cost at a position with its derivatives.
pub(crate) struct Slope {
    pub cost: f64,
    pub gradient: Vector,
    /// The second derivatives in the Gauss-Newton approximation.
    pub curvature: Matrix2<f64>,
    /// The remaining part of the second derivatives: the curvature of the range circles, which matters close to a
    /// station.
    bend: Matrix2<f64>,
}

impl Slope {
    pub(crate) fn at(anchors: &[Anchor], position: Point) -> Self {
        let mut slope = Self {
            cost: 0.0,
            gradient: Vector::zeros(),
            curvature: Matrix2::zeros(),
            bend: Matrix2::zeros(),
        };
        for anchor in anchors {
            let view = anchor.view_from(position);
            let error = view.residual_m / view.sigma_m;
            let steepness = anchor.steepness(&view);
            let square = view.direction * view.direction.transpose();
            slope.cost += error * error;
            slope.gradient -= view.direction * (steepness * error);
            slope.curvature += square * steepness.powi(2);
            slope.bend += (square * 3.0 - Matrix2::identity()) * (error * steepness / view.distance_m);
        }
        slope
    }

    /// Returns the damped Newton step downhill; `None` if the numbers have overflowed.
    ///
    /// Scaling the damping by the trace also works if all stations lie in the same direction from the position.
    pub(crate) fn step(&self, damping: f64) -> Option<Vector> {
        let least = Matrix2::identity() * (damping * self.curvature.trace());
        let inverse = inverse_of(&(made_positive(self.curvature + self.bend) + least))?;
        Some(-(inverse * self.gradient)).filter(|step| step.iter().all(|c| c.is_finite()))
    }
}

/// Returns the symmetric matrix with the same axes and the absolute values of the eigenvalues; this turns a saddle into
/// a valley.
fn made_positive(matrix: Matrix2<f64>) -> Matrix2<f64> {
    let (trace, determinant) = (matrix.trace(), matrix.determinant());
    if determinant >= 0.0 {
        return matrix * trace.signum();
    }
    let gap = (matrix[(0, 0)] - matrix[(1, 1)]).hypot(2.0 * matrix[(0, 1)]);
    matrix * (trace / gap) - Matrix2::identity() * (2.0 * determinant / gap)
}

/// Returns the inverse of the covariance: `sum u_i u_i^T / sigma_i^2` where `u_i` are the directions from the stations.
pub(crate) fn information_at(anchors: &[Anchor], position: Point) -> Matrix2<f64> {
    anchors
        .iter()
        .map(|a| a.view_from(position))
        .map(|v| v.direction * v.direction.transpose() / v.sigma_m.powi(2))
        .sum()
}

#[cfg(test)]
mod tests;
