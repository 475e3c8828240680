//! How the ranges of a cycle correct the belief, with tracks that gripped or slipped through.

use super::{Ekf, Update};
use crate::{
    anchor::{Anchor, anchored},
    fix::Ranging,
    nonlinear::{Slope, information_at},
    quality::{chi_squared_quantile, inverse_of},
};
use nalgebra::{Matrix2, Vector2};
use world::{Point, Station};

/// Normal quantile beyond which ranges are refused: one honest cycle in 10 000.
const GATE_Z: f64 = 3.719;
/// Steps of an iterated update; three are usual.
const UPDATE_STEPS: usize = 12;
/// It ends when a step is shorter than this, metres.
const SETTLED_M: f64 = 1e-5;
/// Part of a motion that is lost when tracks slip through, on average, and its standard deviation.
const SLIPPED_THROUGH: (f64, f64) = (0.5, 0.2);

impl Ekf {
    /// Corrects by all ranges of a cycle at once, unless they are too far off to be true.
    ///
    /// The position that fits belief and ranges best is searched for (an iterated update), so bent range circles are
    /// no matter; heading, slip and bias follow by their correlation with the position. Ranges of unknown stations
    /// are left out.
    pub fn update_ranges(&mut self, ranges: &[Ranging], stations: &[Station]) -> Update {
        let Ok(anchors) = anchored(ranges, stations) else { return Update::REFUSED };
        let degrees = u32::try_from(anchors.len()).unwrap_or(u32::MAX);
        let gate = chi_squared_quantile(GATE_Z, degrees);
        // The comparison also refuses what is not a number.
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

    /// The belief if the tracks slipped through in the last motion, as far as `share` says.
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

    /// The belief after it met the ranges, and how well they met.
    fn meeting(&self, anchors: &[Anchor]) -> Option<(Self, Meeting)> {
        let prior = self.position_covariance();
        let belief = inverse_of(&prior)?;
        let mut met = best_of_belief_and_ranges(anchors, self.pose().position, &belief)?;
        met.log_evidence = 0.5 * ((met.covariance.determinant() / prior.determinant()).ln() - met.cost);
        Some((self.with_position(met.position, &met.covariance, &belief), met))
    }

    /// One belief with the mean and covariance of two, of which the other has the given share.
    fn mixed_with(&self, other: &Self, share: f64) -> Self {
        let state = self.state * (1.0 - share) + other.state * share;
        let spread = |filter: &Self| {
            let off = filter.state - state;
            filter.covariance + off * off.transpose()
        };
        let covariance = spread(self) * (1.0 - share) + spread(other) * share;
        Self { state, covariance, ..self.clone() }
    }

    /// The belief after its position has become known better; the rest follows by correlation.
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

/// Where belief and ranges meet.
struct Meeting {
    position: Point,
    covariance: Matrix2<f64>,
    cost: f64,
    /// Logarithm of the likelihood of the ranges under the belief, up to what only depends on the ranges.
    log_evidence: f64,
}

/// Goes down the sum of the squared errors of belief and ranges; `belief` is the inverse of its covariance.
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
