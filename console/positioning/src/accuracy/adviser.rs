//! Advises where to put stations.

use super::{Forecast, Grid, Seen, is_in_sight};
use crate::fix::ellipse_95;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use world::{Boundary, ObstacleMap, Point, Vector, World};

/// The number of candidate places along the wall.
const CANDIDATES: usize = 72;
/// The number of cells along the longer side of the floor in the grid on which the error is computed.
const CELLS: f64 = 28.0;
/// The largest number of rounds; each round moves every station once.
const ROUNDS: usize = 12;
/// The number of initial layouts: even rings, each rotated by a different fraction of the spacing.
const STARTS: usize = 4;
/// The numbers of stations for which advice is available.
const COUNTS: std::ops::RangeInclusive<usize> = 3..=32;
/// The error assumed for a place without a fix, as a share of the tank's size.
const BLIND_SHARE: f64 = 0.25;

/// The best places for stations, and the expected accuracy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Advice {
    /// Places on the wall, metres.
    pub places: Vec<Point>,
    /// Longer semi-axis of the 95 % ellipse, metres: the mean over all places on the floor where there is a fix.
    pub mean_error_95_m: f64,
    /// Longer semi-axis of the 95 % ellipse, metres: the largest value at any place where there is a fix.
    pub worst_error_95_m: f64,
    /// Share of the floor without a fix.
    pub blind_share: f64,
}

/// Why there is no advice.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AdviceError {
    /// No advice is available for this number of stations.
    #[error("advice is available for {} to {} stations, not for {asked}", COUNTS.start(), COUNTS.end())]
    Count {
        /// The number of stations requested.
        asked: usize,
    },
    /// The tank has no free floor.
    #[error("the tank has no free floor")]
    NoFloor,
}

/// Finds the best places on the wall for a number of stations in a tank as drawn.
///
/// Starts from even rings and moves the stations, one at a time, to their best places until no move helps (an exchange
/// search). The criterion is the mean forecast error over the floor, with a large error for places without a fix. Takes
/// a few tens of milliseconds for eight stations.
///
/// # Errors
/// [`AdviceError`] for fewer than 3 or more than 32 stations, or a tank without floor.
pub fn advise(drawing: &World, count: usize, forecast: &Forecast) -> Result<Advice, AdviceError> {
    if !COUNTS.contains(&count) {
        return Err(AdviceError::Count { asked: count });
    }
    let problem = Problem::new(drawing, forecast);
    if problem.n_cells == 0 {
        return Err(AdviceError::NoFloor);
    }
    let starts = (0..STARTS).map(|turn| even_ring(count, turn));
    let best = starts
        .map(|start| problem.improved(start))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .expect("there is at least one start");
    Ok(problem.advice(&best.0))
}

/// Returns candidates evenly spaced around the wall, rotated by `turn` / [`STARTS`] of the spacing.
fn even_ring(count: usize, turn: usize) -> Vec<usize> {
    let offset = turn * CANDIDATES / (STARTS * count);
    (0..count).map(|k| (k * CANDIDATES / count + offset) % CANDIDATES).collect()
}

/// The information that every candidate provides in every cell.
struct Problem {
    candidates: Vec<Point>,
    /// One entry for each candidate and cell, in this order; empty where an obstacle blocks the line of sight.
    seen: Vec<Vec<Seen>>,
    n_cells: usize,
    blind_m: f64,
}

impl Problem {
    fn new(drawing: &World, forecast: &Forecast) -> Self {
        let (low, high) = drawing.boundary.bounds();
        let size_m = (high - low).amax();
        let grid = Grid::of(drawing, size_m / CELLS);
        let map = ObstacleMap::new(&drawing.boundary, &drawing.obstacles);
        let cells: Vec<Point> = (0..grid.width * grid.height)
            .map(|index| grid.center(index))
            .filter(|at| map.clearance_m(*at) >= 0.0)
            .collect();
        let candidates = along_wall(&drawing.boundary);
        let look = |from: &Point, to: &Point| {
            let is_heard = !forecast.needs_line_of_sight || is_in_sight(&map, *from, *to);
            if is_heard { forecast.seen(*from, *to) } else { Seen::default() }
        };
        let seen = candidates.iter().map(|to| cells.iter().map(|from| look(from, to)).collect()).collect();
        Self { candidates, seen, n_cells: cells.len(), blind_m: BLIND_SHARE * size_m }
    }

    /// Moves stations until no move helps; returns the layout and its cost.
    fn improved(&self, mut chosen: Vec<usize>) -> (Vec<usize>, f64) {
        let mut cost = self.cost(&self.together(&chosen));
        for _ in 0..ROUNDS {
            let before = cost;
            for k in 0..chosen.len() {
                let others: Vec<usize> =
                    chosen.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, c)| *c).collect();
                let base = self.together(&others);
                let free = (0..self.candidates.len()).filter(|c| !others.contains(c));
                let best = free.map(|c| (self.cost_with(&base, c), c)).min_by(|a, b| a.0.total_cmp(&b.0));
                if let Some((better, candidate)) = best.filter(|(better, _)| *better < cost) {
                    (cost, chosen[k]) = (better, candidate);
                }
            }
            if cost >= before {
                break;
            }
        }
        (chosen, cost)
    }

    fn together(&self, chosen: &[usize]) -> Vec<Seen> {
        let mut sum = vec![Seen::default(); self.n_cells];
        for candidate in chosen {
            sum.iter_mut().zip(&self.seen[*candidate]).for_each(|(sum, seen)| sum.add(seen));
        }
        sum
    }

    fn cost(&self, sums: &[Seen]) -> f64 {
        sums.iter().map(|sum| self.cost_of(sum)).sum()
    }

    fn cost_with(&self, base: &[Seen], candidate: usize) -> f64 {
        let with = base.iter().zip(&self.seen[candidate]).map(|(sum, seen)| {
            let mut sum = *sum;
            sum.add(seen);
            sum
        });
        with.map(|sum| self.cost_of(&sum)).sum()
    }

    fn cost_of(&self, sum: &Seen) -> f64 {
        error_95_m(sum).map_or(self.blind_m, |error_m| error_m.min(self.blind_m))
    }

    fn advice(&self, chosen: &[usize]) -> Advice {
        let errors: Vec<f64> = self.together(chosen).iter().filter_map(error_95_m).collect();
        let n = errors.len().max(1) as f64;
        let mut order = chosen.to_vec();
        order.sort_unstable();
        Advice {
            places: order.iter().map(|candidate| self.candidates[*candidate]).collect(),
            mean_error_95_m: errors.iter().sum::<f64>() / n,
            worst_error_95_m: errors.iter().copied().fold(0.0, f64::max),
            blind_share: 1.0 - errors.len() as f64 / self.n_cells as f64,
        }
    }
}

fn error_95_m(sum: &Seen) -> Option<f64> {
    sum.covariance().map(|covariance| ellipse_95(&covariance).0)
}

/// Returns places evenly spaced along the wall.
pub(super) fn along_wall(boundary: &Boundary) -> Vec<Point> {
    let share = |k: usize| k as f64 / CANDIDATES as f64;
    match boundary {
        Boundary::Circle { radius_m } => (0..CANDIDATES)
            .map(|k| TAU * share(k))
            .map(|angle| Point::from(Vector::new(angle.cos(), angle.sin()) * *radius_m))
            .collect(),
        Boundary::Polygon { vertices } => {
            let ends = || vertices.iter().zip(vertices.iter().cycle().skip(1));
            let length_m: f64 = ends().map(|(a, b)| (b - a).norm()).sum();
            let at = |walked_m: f64| {
                let mut left_m = walked_m;
                for (a, b) in ends() {
                    let edge_m = (b - a).norm();
                    if left_m <= edge_m {
                        return a + (b - a) * (left_m / edge_m.max(1e-12));
                    }
                    left_m -= edge_m;
                }
                vertices[0]
            };
            (0..CANDIDATES).map(|k| at(length_m * share(k))).collect()
        }
    }
}
