//! Corrects the estimate with the ranges of a cycle, whether the tracks gripped or spun.

use super::{Ekf, Update};
use crate::{
    anchor::{Anchor, anchored},
    fix::Ranging,
    nonlinear::{Slope, information_at},
    quality::{chi_squared_quantile, inverse_of},
};
use nalgebra::{Matrix2, Vector2};
use world::{Point, Station};

/// Standard normal quantile beyond which the ranges of a cycle are refused. This refuses one correct cycle in 10,000.
const GATE_Z: f64 = 3.719;
/// The largest number of steps in an iterated update; three are usual.
const UPDATE_STEPS: usize = 12;
/// The length of a step, metres, below which the update ends.
const SETTLED_M: f64 = 1e-5;
/// The share of a motion that is lost when tracks spin: mean and standard deviation.
const SLIPPED_THROUGH: (f64, f64) = (0.5, 0.2);

impl Ekf {
    /// Corrects the estimate with all ranges of a cycle together, unless they are implausibly far off.
    ///
    /// Searches for the position that best fits both estimate and ranges (an iterated update), so curved range
    /// circles do no harm. Heading, slip and bias follow from their correlation with the position. If a range names
    /// an unknown station, all ranges are refused.
    pub fn update_ranges(&mut self, ranges: &[Ranging], stations: &[Station]) -> Update {
        let Ok(anchors) = anchored(ranges, stations) else { return Update::REFUSED };
        let degrees = u32::try_from(anchors.len()).unwrap_or(u32::MAX);
        let gate = chi_squared_quantile(GATE_Z, degrees);
        // The comparison also refuses NaN.
        let met = |filter: &Self| filter.meeting(&anchors).filter(|(_, met)| met.cost <= gate);
        let slip_chance =
            if self.last_way.norm() > 0.0 { self.noise.slip_chance.clamp(0.0, 0.5) } else { 0.0 };
        let gripped = met(self);
        let slipped = if slip_chance > 0.0 { met(&self.slipped_through(1.0)) } else { None };
        let (updated, nis, share) = match (gripped, slipped) {
            (None, None) => {
                return Update::refused(self.meeting(&anchors).map_or(f64::MAX, |(_, met)| met.cost));
            }
            (Some((updated, met)), None) => (updated, met.cost, 0.0),
            (None, Some((updated, met))) => (updated, met.cost, 1.0),
            (Some((held, met_held)), Some((lost, met_lost))) => {
                let odds = (met_lost.log_evidence - met_held.log_evidence).clamp(-50.0, 50.0).exp();
                let share = slip_chance * odds / (1.0 - slip_chance + slip_chance * odds);
                (held.mixed_with(&lost, share), met_held.cost.min(met_lost.cost), share)
            }
        };
        let accepted = self.adopt(updated);
        self.last_way = Vector2::zeros();
        Update { nis, accepted, slipped: share }
    }

    /// Returns the estimate for the case that the tracks spun in the last motion, weighted by `share`.
    pub(crate) fn slipped_through(&self, share: f64) -> Self {
        let (mean, sigma) = SLIPPED_THROUGH;
        let mut lost = self.clone();
        let mut position = lost.state.fixed_rows_mut::<2>(0);
        position -= self.last_way * (mean * share);
        let mut covariance = lost.covariance.fixed_view_mut::<2, 2>(0, 0);
        let variance = share * sigma * sigma + share * (1.0 - share) * mean * mean;
        covariance += self.last_way * self.last_way.transpose() * variance;
        lost
    }

    /// Returns the estimate corrected with the ranges, and how well the two agree.
    fn meeting(&self, anchors: &[Anchor]) -> Option<(Self, Meeting)> {
        let prior = self.position_covariance();
        let belief = inverse_of(&prior)?;
        let mut met = best_of_belief_and_ranges(anchors, self.pose().position, &belief)?;
        met.log_evidence = 0.5 * ((met.covariance.determinant() / prior.determinant()).ln() - met.cost);
        Some((self.with_position(met.position, &met.covariance, &belief), met))
    }

    /// Returns one estimate with the mean and covariance of a mixture of two; `share` is the weight of `other`.
    fn mixed_with(&self, other: &Self, share: f64) -> Self {
        let state = self.state * (1.0 - share) + other.state * share;
        let spread = |filter: &Self| {
            let off = filter.state - state;
            filter.covariance + off * off.transpose()
        };
        let covariance = spread(self) * (1.0 - share) + spread(other) * share;
        Self { state, covariance, ..self.clone() }
    }

    /// Returns the estimate after a correction of its position; the other values follow from their correlation with it.
    fn with_position(&self, position: Point, covariance: &Matrix2<f64>, belief: &Matrix2<f64>) -> Self {
        let gain = self.covariance.fixed_view::<5, 2>(0, 0) * belief;
        let lost = self.position_covariance() - covariance;
        Self {
            state: self.state + gain * (position - self.pose().position),
            covariance: self.covariance - gain * lost * gain.transpose(),
            ..self.clone()
        }
    }
}

/// The best compromise between estimate and ranges.
struct Meeting {
    position: Point,
    covariance: Matrix2<f64>,
    cost: f64,
    /// Logarithm of the likelihood of the ranges given the estimate, except for terms that depend only on the ranges.
    log_evidence: f64,
}

/// Minimises the sum of the squared errors of estimate and ranges; `belief` is the inverse of the estimate's
/// covariance.
fn best_of_belief_and_ranges(anchors: &[Anchor], start: Point, belief: &Matrix2<f64>) -> Option<Meeting> {
    let cost_at = |slope: &Slope, at: Point| slope.cost + (at - start).dot(&(belief * (at - start)));
    let (mut position, mut damping) = (start, 0.0);
    let mut slope = Slope::at(anchors, position);
    let mut cost = cost_at(&slope, position);
    for _ in 0..UPDATE_STEPS {
        let curvature = slope.curvature + belief;
        let damped = curvature + Matrix2::identity() * (damping * curvature.trace());
        let step = inverse_of(&damped)? * -(slope.gradient + belief * (position - start));
        let there = Slope::at(anchors, position + step);
        let cost_there = cost_at(&there, position + step);
        if cost_there <= cost {
            (position, slope, cost) = (position + step, there, cost_there);
            damping *= 0.1;
        } else {
            damping = (damping * 10.0).max(1e-2);
        }
        if step.norm() < SETTLED_M {
            break;
        }
    }
    let covariance = inverse_of(&(information_at(anchors, position) + belief))?;
    Some(Meeting { position, covariance, cost, log_evidence: 0.0 })
}
