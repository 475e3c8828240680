//! The position that most stations agree on.

use crate::{
    anchor::{Anchor, anchored, on_near_circle},
    fix::{CUT_SIGMAS, Exclusion, Fix, FixError, Integrity, PositionSolver, Prior, Ranging},
    linear::solve_linear,
    nonlinear::{Slope, solve_anchors},
};
use world::{Point, Station};

/// The number of Newton steps on a subset of three; the linear start is already close.
const SUBSET_STEPS: usize = 2;
/// The largest number of subsets that are tried before some are skipped: enough for all subsets of ten stations.
const MOST_SUBSETS: usize = 120;
/// The number of groups of agreeing stations that are refined, best first.
const REFINED: usize = 8;
/// The largest number of times that the agreeing stations are selected again.
const ROUNDS: usize = 6;
/// The difference in cost below which a second answer is as good as the first.
const MARGIN: f64 = 16.0;
/// The least number of agreeing stations that prove a position.
const NEEDED: usize = 4;

/// The sign of the error of wrong ranges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WrongRanges {
    /// Always too long, as when sound takes a detour; a range that is too short is accepted.
    #[default]
    Late,
    /// Too long or too short.
    Any,
}

/// Fits all subsets of three stations, keeps the position with which the fewest stations disagree, and fits again to
/// those that agree.
///
/// With fewer than four stations, the solver behaves like [`crate::Nls`]. With six to eight stations, it tolerates one
/// station in five being hidden behind an obstacle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Consensus {
    /// The kind of errors to expect.
    pub wrong: WrongRanges,
}

impl PositionSolver for Consensus {
    fn solve(&self, ranges: &[Ranging], stations: &[Station], prior: Option<Prior>) -> Result<Fix, FixError> {
        let anchors = anchored(ranges, stations)?;
        if anchors.len() < NEEDED {
            return solve_anchors(&anchors, prior);
        }
        let answers = self.answers(&anchors, prior);
        let Some(best) = answers.first() else { return solve_anchors(&anchors, prior) };
        let fix = best.fix.clone();
        let rival = answers.iter().skip(1).find(|other| best.is_contested_by(other));
        Ok(with_exclusions(fix, &anchors, rival))
    }
}

/// A position with the stations that agree on it.
#[derive(Debug, Clone)]
struct Answer {
    fix: Fix,
    cost: f64,
}

impl Answer {
    /// Whether a different answer is nearly as good, but farther away than the 95 % error of this one.
    fn is_contested_by(&self, other: &Self) -> bool {
        let apart_m = (self.fix.position - other.fix.position).norm();
        other.cost < self.cost + MARGIN && apart_m > self.fix.ellipse_95().0
    }
}

impl Consensus {
    /// Returns the best answers, best first.
    fn answers(self, anchors: &[Anchor], prior: Option<Prior>) -> Vec<Answer> {
        let mut tries: Vec<(f64, Point)> = subsets(anchors.len())
            .filter_map(|[i, j, k]| fit_three(&[anchors[i], anchors[j], anchors[k]]))
            .chain(on_near_circle(anchors))
            .map(|position| (self.cost_at(anchors, position), position))
            .collect();
        tries.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut answers: Vec<Answer> = Vec::new();
        let mut seen: Vec<Vec<bool>> = Vec::new();
        for (_, position) in tries {
            let agreeing = self.agreeing(anchors, position);
            if seen.len() < REFINED && !seen.contains(&agreeing) {
                seen.push(agreeing);
                answers.extend(self.refined(anchors, position, prior));
            }
        }
        answers.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        answers
    }

    /// Repeats the fit to the agreeing stations until the selection no longer changes.
    fn refined(self, anchors: &[Anchor], start: Point, prior: Option<Prior>) -> Option<Answer> {
        let mut agreeing = self.agreeing(anchors, start);
        let mut answer = None;
        for _ in 0..ROUNDS {
            let chosen: Vec<Anchor> =
                anchors.iter().zip(&agreeing).filter(|(_, agrees)| **agrees).map(|(a, _)| *a).collect();
            if chosen.len() < 3 {
                return answer;
            }
            let fix = solve_anchors(&chosen, prior).ok()?;
            let now = self.agreeing(anchors, fix.position);
            answer = Some(Answer { cost: self.cost_at(anchors, fix.position), fix });
            if now == agreeing {
                break;
            }
            agreeing = now;
        }
        answer
    }

    fn agreeing(self, anchors: &[Anchor], position: Point) -> Vec<bool> {
        anchors.iter().map(|a| !self.is_wrong(a.view_from(position).sigmas())).collect()
    }

    fn is_wrong(self, sigmas: f64) -> bool {
        sigmas > CUT_SIGMAS || (self.wrong == WrongRanges::Any && sigmas < -CUT_SIGMAS)
    }

    /// Returns the sum of the squared residuals, capped for ranges that may be wrong.
    fn cost_at(self, anchors: &[Anchor], position: Point) -> f64 {
        let cost = |sigmas: f64| if self.is_wrong(sigmas) { CUT_SIGMAS.powi(2) } else { sigmas * sigmas };
        anchors.iter().map(|a| cost(a.view_from(position).sigmas())).sum()
    }
}

/// Adds the excluded stations to the fix, and lowers its integrity if the other stations do not confirm it.
fn with_exclusions(mut fix: Fix, anchors: &[Anchor], rival: Option<&Answer>) -> Fix {
    for anchor in anchors.iter().filter(|a| !fix.used.contains(&a.station)) {
        let view = anchor.view_from(fix.position);
        let gate_m = CUT_SIGMAS * view.sigma_m;
        fix.excluded.push((anchor.station, Exclusion::Residual { residual_m: view.residual_m, gate_m }));
    }
    let too_few = fix.used.len() < NEEDED || 2 * fix.excluded.len() >= anchors.len();
    if rival.is_some() || (too_few && !fix.excluded.is_empty()) {
        fix.integrity = fix.integrity.min_trust(Integrity::Suspect);
    }
    if let Some(rival) = rival {
        fix.mirror = fix.mirror.or(Some(rival.fix.position));
    }
    fix
}

/// Iterates over subsets of three out of `n`, at most about [`MOST_SUBSETS`] of them, evenly spread.
fn subsets(n: usize) -> impl Iterator<Item = [usize; 3]> {
    let all = n * n.saturating_sub(1) * n.saturating_sub(2) / 6;
    let every = (all / MOST_SUBSETS).max(1);
    (0..n).flat_map(move |i| (i + 1..n).flat_map(move |j| (j + 1..n).map(move |k| [i, j, k]))).step_by(every)
}

/// Returns the position from three stations that are not on a line.
fn fit_three(three: &[Anchor; 3]) -> Option<Point> {
    let mut position = solve_linear(three).ok()?.position;
    for _ in 0..SUBSET_STEPS {
        position += Slope::at(three, position).step(1e-6)?;
    }
    position.iter().all(|c| c.is_finite()).then_some(position)
}

#[cfg(test)]
mod tests;
