//! Computes positions from arrivals with unknown emission times: only the differences count.

use crate::{
    anchor::{Anchor, anchored},
    fix::{Fix, FixError, Integrity, PositionSolver, Prior, Ranging},
    linear::conditioning,
    quality::{assess_excess, integrity_of},
};
use nalgebra::{Matrix3, Vector3, Vector4};
use world::{Point, Station};

/// The number of stations needed: two for the position, one for the emission time, one to exclude mirror images.
const NEEDED: usize = 4;
/// The largest number of steps before the search gives up; six are usual.
const MAX_ITERATIONS: usize = 60;
/// The length of a step, metres, below which the search ends.
const SETTLED_M: f64 = 1e-6;

/// Least squares on ranges that are all too long by one unknown length, such as arrival times without the emission
/// time. Position and length are both free, and the covariance of the position includes the uncertainty of the
/// length.
///
/// The scatter of a range is the given share of the range, scaled to the true distance. A search on differences of
/// distances can end in a valley behind a station, so several starts are tried and the best result is used, unless five
/// or more stations agree with the result of the first start. A prior is only one of the starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Differences;

impl PositionSolver for Differences {
    fn excess_m(&self, fix: &Fix, ranges: &[Ranging], stations: &[Station]) -> f64 {
        common_excess_m(fix, ranges, stations).unwrap_or_default()
    }

    fn solve(&self, ranges: &[Ranging], stations: &[Station], prior: Option<Prior>) -> Result<Fix, FixError> {
        let anchors = anchored(ranges, stations)?;
        if anchors.len() < NEEDED {
            return Err(FixError::TooFewStations { have: anchors.len(), need: NEEDED });
        }
        let found = near(&anchors)
            .or_else(|| best(&anchors, prior))
            .ok_or(FixError::NotConverged { iterations: MAX_ITERATIONS })?;
        let ranges: Vec<Anchor> = anchors.iter().map(|a| a.at_range(a.range_m - found.excess_m)).collect();
        if ranges.iter().any(|a| a.range_m <= 0.0) {
            return Err(FixError::NotConverged { iterations: MAX_ITERATIONS });
        }
        let covariance = found.covariance.fixed_view::<2, 2>(0, 0).into_owned();
        assess_excess(&ranges, found.position, covariance, conditioning(&ranges))
    }
}

/// Returns the length by which all ranges of a fix by [`Differences`] are too long, metres.
pub(crate) fn common_excess_m(fix: &Fix, ranges: &[Ranging], stations: &[Station]) -> Option<f64> {
    let residual = fix.residuals.first()?;
    let range = ranges.iter().find(|range| range.station == residual.station)?;
    let station = stations.iter().find(|station| station.id == residual.station)?;
    Some(range.range_m - residual.residual_m - (fix.position - station.position).norm())
}

/// A minimum: position, common excess of the ranges, and their covariance.
struct Minimum {
    position: Point,
    excess_m: f64,
    cost: f64,
    covariance: Matrix3<f64>,
}

/// Returns the minimum from the solution of the squared equations, if it fits the ranges and cannot have a mirror image
/// that fits better: with five stations, at least two differences check the position.
fn near(anchors: &[Anchor]) -> Option<Minimum> {
    let spare = anchors.len().checked_sub(NEEDED).filter(|spare| *spare > 0)?;
    let found = descend(anchors, squared(anchors)?)?;
    let degrees_of_freedom = u32::try_from(spare + 1).ok()?;
    (integrity_of(found.cost, degrees_of_freedom) == Integrity::Ok).then_some(found)
}

/// Returns the least minimum of all starts.
fn best(anchors: &[Anchor], prior: Option<Prior>) -> Option<Minimum> {
    let minima = starts(anchors, prior).filter_map(|start| descend(anchors, start));
    minima.min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// Returns the starts: the solution of the squared equations, the prior, the centre of the stations, and points
/// around it.
fn starts(anchors: &[Anchor], prior: Option<Prior>) -> impl Iterator<Item = Point> {
    let n = anchors.len() as f64;
    let middle = Point::from(anchors.iter().map(|a| a.at.coords).sum::<world::Vector>() / n);
    let round = anchors.iter().map(move |a| middle + (a.at - middle) * 0.5);
    let believed = prior.map(|(at, _)| at).filter(|at| at.iter().all(|c| c.is_finite()));
    squared(anchors).into_iter().chain(believed).chain([middle]).chain(round.collect::<Vec<_>>())
}

/// Solves the equations that are linear in the position, the excess, and the difference of their squares.
fn squared(anchors: &[Anchor]) -> Option<Point> {
    // Relative to the mean, the equation of each anchor has no constant, and the numbers are of similar size.
    let by = 1.0 / anchors.len() as f64;
    let row = |anchor: &Anchor| {
        let Anchor { at, range_m, .. } = anchor;
        Vector4::new(at.x, at.y, -range_m, 0.5 * (at.coords.norm_squared() - range_m * range_m))
    };
    let mean = anchors.iter().map(row).sum::<Vector4<f64>>() * by;
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for anchor in anchors {
        let row = row(anchor) - mean;
        let unknown = row.xyz();
        normal += unknown * unknown.transpose();
        right += unknown * row.w;
    }
    let solved = normal.cholesky()?.solve(&right);
    Some(Point::new(solved.x, solved.y)).filter(|at| at.iter().all(|c| c.is_finite()))
}

/// Returns the end of a descent from `start`, with its sum of squared residuals in units of their variances. A place without
/// a minimum below it ends where the search gives up. `None` if the numbers have overflowed.
pub(crate) fn lowest(anchors: &[Anchor], start: Point) -> Option<(Point, f64)> {
    let end = walk(anchors, start)?;
    end.slope.cost.is_finite().then(|| (Point::new(end.state.x, end.state.y), end.slope.cost))
}

/// Descends from a place to a minimum.
fn descend(anchors: &[Anchor], start: Point) -> Option<Minimum> {
    let End { state, slope, is_settled } = walk(anchors, start)?;
    let covariance = slope.curvature.try_inverse().filter(|_| is_settled)?;
    Some(Minimum { position: Point::new(state.x, state.y), excess_m: state.z, cost: slope.cost, covariance })
}

/// The end of a walk downhill.
struct End {
    /// Position and common excess of the ranges, metres.
    state: Vector3<f64>,
    slope: Slope,
    /// Whether the last step was negligible.
    is_settled: bool,
}

/// Walks downhill from a place in Gauss-Newton steps with Levenberg-Marquardt damping. `None` if a step cannot be computed.
fn walk(anchors: &[Anchor], start: Point) -> Option<End> {
    let mut state = Vector3::new(start.x, start.y, 0.0);
    state.z = best_excess_m(anchors, start);
    let (mut damping, mut here) = (1e-9, slope(anchors, &state));
    for _ in 0..MAX_ITERATIONS {
        let damped = here.curvature + Matrix3::from_diagonal(&(here.curvature.diagonal() * damping));
        let step = damped.cholesky()?.solve(&-here.gradient);
        let there = slope(anchors, &(state + step));
        if there.cost <= here.cost {
            (state, here) = (state + step, there);
            damping = (damping * 0.1_f64).max(1e-9);
        } else {
            damping = (damping * 10.0).max(1e-4);
        }
        if step.norm() < SETTLED_M {
            return Some(End { state, slope: here, is_settled: true });
        }
    }
    Some(End { state, slope: here, is_settled: false })
}

/// Returns the excess that fits a place best.
fn best_excess_m(anchors: &[Anchor], at: Point) -> f64 {
    anchors.iter().map(|a| a.range_m - (at - a.at).norm()).sum::<f64>() / anchors.len() as f64
}

struct Slope {
    cost: f64,
    gradient: Vector3<f64>,
    curvature: Matrix3<f64>,
}

fn slope(anchors: &[Anchor], state: &Vector3<f64>) -> Slope {
    let mut slope = Slope { cost: 0.0, gradient: Vector3::zeros(), curvature: Matrix3::zeros() };
    for anchor in anchors {
        let view = anchor.view_from(Point::new(state.x, state.y));
        let per_sigma = 1.0 / view.sigma_m;
        let error = (view.residual_m - state.z) * per_sigma;
        // The sigma also grows with the distance.
        let along = view.direction * (per_sigma + error / view.growth_m);
        let by = Vector3::new(along.x, along.y, per_sigma);
        slope.cost += error * error;
        slope.gradient -= by * error;
        slope.curvature += by * by.transpose();
    }
    slope
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Nls, Screened,
        draws::{Draws, ring},
    };
    use proptest::prelude::*;
    use world::StationId;

    const PLACES: [(f64, f64); 6] =
        [(10.0, 0.0), (5.0, 8.66), (-5.0, 8.66), (-10.0, 0.0), (-5.0, -8.66), (5.0, -8.66)];

    fn stations() -> Vec<Station> {
        let station = |(id, (x, y)): (u32, (f64, f64))| Station {
            id: StationId(id),
            name: format!("S{id}"),
            position: Point::new(x, y),
        };
        (1..).zip(PLACES).map(station).collect()
    }

    fn heard(at: Point, excess_m: f64) -> Vec<Ranging> {
        let range = |station: &Station| {
            let range_m = (at - station.position).norm() + excess_m;
            Ranging::single(station.id, range_m, 0.01 * range_m)
        };
        stations().iter().map(range).collect()
    }

    proptest! {
        #[test]
        fn exact_differences_give_the_place_whenever_it_was_emitted(
            x in -6.0..6.0f64, y in -6.0..6.0f64, excess_m in 0.0..200.0f64,
        ) {
            let at = Point::new(x, y);
            let fix = Differences.solve(&heard(at, excess_m), &stations(), None).unwrap();
            prop_assert!((fix.position - at).norm() < 1e-5, "{} for {at}", fix.position);
            prop_assert_eq!((fix.degrees_of_freedom, fix.integrity), (3, Integrity::Ok));
            let found_m = common_excess_m(&fix, &heard(at, excess_m), &stations()).unwrap();
            prop_assert!((found_m - excess_m).abs() < 1e-5);
        }
    }

    /// Stations on a ring with uneven gaps, and ranges with errors of 1 %, some of them with one wrong station.
    #[test]
    fn stations_that_agree_with_the_first_start_agree_with_the_best_one() {
        let mut draws = Draws::new(0.0, 1, 45);
        let (mut first, mut elsewhere) = (0, Vec::new());
        for k in 0..20_000u32 {
            let n = 5 + k % 4;
            let mut stations = ring(n, 10.0);
            for station in &mut stations {
                let turn = nalgebra::Rotation2::new(0.8 * draws.even() / f64::from(n));
                station.position = turn * station.position;
            }
            let at = draws.on_disc() * 0.95;
            let mut ranges: Vec<Ranging> = stations
                .iter()
                .map(|s| (s.id, (at - s.position).norm() + 0.1 * draws.bell() + 180.0))
                .map(|(id, range_m)| Ranging { timing_sigma_m: 0.1, ..Ranging::single(id, range_m, 0.1) })
                .collect();
            if k % 3 == 0 {
                ranges[(k % n) as usize].range_m += draws.even();
            }
            let anchors = anchored(&ranges, &stations).unwrap();
            let (Some(near), Some(best)) = (near(&anchors), best(&anchors, None)) else { continue };
            first += 1;
            if (near.position - best.position).norm() > 1e-4 {
                elsewhere.push((n, at, near.position, best.position));
            }
        }
        assert!(first > 15_000 && elsewhere.is_empty(), "{first}: {elsewhere:?}");
    }

    #[test]
    fn not_knowing_when_costs_accuracy() {
        let at = Point::new(2.0, 3.0);
        let known = Nls.solve(&heard(at, 0.0), &stations(), None).unwrap();
        let unknown = Differences.solve(&heard(at, 0.0), &stations(), None).unwrap();
        assert!(unknown.covariance.trace() > known.covariance.trace());
    }

    #[test]
    fn three_stations_are_too_few_and_a_late_one_is_left_out() {
        let mut ranges = heard(Point::new(2.0, 3.0), 50.0);
        assert_eq!(
            Differences.solve(&ranges[..3], &stations(), None),
            Err(FixError::TooFewStations { have: 3, need: 4 })
        );
        for range in &mut ranges {
            range.sigma_m = 0.001 * range.range_m;
        }
        ranges[2].range_m += 3.0;
        let fix = Screened(Differences).solve(&ranges, &stations(), None).unwrap();
        assert!((fix.position - Point::new(2.0, 3.0)).norm() < 0.01, "{}", fix.position);
        assert_eq!(fix.excluded[0].0, StationId(3));
    }
}
