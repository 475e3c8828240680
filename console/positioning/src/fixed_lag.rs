//! Estimates where the robot was a short time ago, given all data up to now.

use crate::{
    ekf::{Covariance, Ekf, State},
    fix::{Ranging, ellipse_95},
};
use nalgebra::Matrix2;
use std::collections::VecDeque;
use world::{Odometry, Point, Pose, Station, geometry::wrap_angle_rad};

/// An [`Ekf`] that remembers its last motions and smooths them backwards in time (Rauch, Tung and Striebel).
///
/// Ranges measured after a motion also constrain where the motion began. Ten motions back, the error is a third smaller
/// than that of the filter; the estimate of the present does not improve. The smoothed poses are useful for maps and
/// reports, but not for driving.
#[derive(Debug, Clone)]
pub struct FixedLag {
    filter: Ekf,
    lag: usize,
    past: VecDeque<Past>,
}

/// The estimate before a motion, and the prediction after it.
#[derive(Debug, Clone)]
struct Past {
    state: State,
    covariance: Covariance,
    by_state: Covariance,
    expected: State,
    expected_covariance: Covariance,
}

/// A smoothed pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Smoothed {
    /// The number of motions since the pose.
    pub lag: usize,
    /// Most likely pose.
    pub pose: Pose,
    /// Covariance of the position, square metres.
    pub covariance: Matrix2<f64>,
}

impl Smoothed {
    /// Longer semi-axis of the 95 % ellipse of the position, metres.
    pub fn error_95_m(&self) -> f64 {
        ellipse_95(&self.covariance).0
    }
}

impl FixedLag {
    /// Creates a smoother that looks back over `lag` motions.
    pub fn new(filter: Ekf, lag: usize) -> Self {
        Self { filter, lag, past: VecDeque::with_capacity(lag + 1) }
    }

    /// The filter for the present.
    pub fn filter(&self) -> &Ekf {
        &self.filter
    }

    /// Corrects the present pose with the ranges of a cycle; returns whether they were accepted.
    ///
    /// A motion in which the tracks spun reveals little about where it began.
    pub fn update_ranges(&mut self, ranges: &[Ranging], stations: &[Station]) -> bool {
        let before = self.filter.clone();
        let update = self.filter.update_ranges(ranges, stations);
        if update.slipped > 0.0 {
            self.expect(&before.slipped_through(update.slipped));
        }
        update.accepted
    }

    /// Makes the position as uncertain as if the tracks had spun during the whole last motion; see
    /// [`Ekf::doubt_motion`].
    pub fn doubt_motion(&mut self, odometry: &Odometry) {
        self.filter.doubt_motion(odometry);
        self.expect(&self.filter.clone());
    }

    /// Sets the present position to that of a fix; see [`Ekf::restart_at`]. The past is dropped, because it contains
    /// no information about the new position.
    pub fn restart_at(&mut self, position: Point, covariance: &Matrix2<f64>, heading_sigma_rad: f64) {
        self.filter.restart_at(position, covariance, 0.0, heading_sigma_rad);
        self.past.clear();
    }

    fn expect(&mut self, filter: &Ekf) {
        if let Some(last) = self.past.back_mut() {
            last.expected = *filter.state();
            last.expected_covariance = *filter.state_covariance();
        }
    }

    /// Moves the present pose according to the odometry.
    pub fn predict(&mut self, odometry: &Odometry) {
        let (state, covariance) = (*self.filter.state(), *self.filter.state_covariance());
        let by_state = self.filter.moved_by(odometry);
        self.past.push_back(Past {
            state,
            covariance,
            by_state,
            expected: *self.filter.state(),
            expected_covariance: *self.filter.state_covariance(),
        });
        if self.past.len() > self.lag {
            self.past.pop_front();
        }
    }

    /// Returns all remembered poses, from the oldest to the present one.
    pub fn smoothed(&self) -> Vec<Smoothed> {
        let (mut state, mut covariance) = (*self.filter.state(), *self.filter.state_covariance());
        let mut found = vec![smoothed_pose(0, &state, &covariance)];
        for (ago, past) in self.past.iter().rev().enumerate() {
            let Some(inverse) = past.expected_covariance.cholesky().map(|c| c.inverse()) else { break };
            let gain = past.covariance * past.by_state.transpose() * inverse;
            let mut surprise = state - past.expected;
            surprise[2] = wrap_angle_rad(surprise[2]);
            state = past.state + gain * surprise;
            covariance = past.covariance + gain * (covariance - past.expected_covariance) * gain.transpose();
            if !state.iter().chain(covariance.iter()).all(|number| number.is_finite()) {
                break;
            }
            found.push(smoothed_pose(ago + 1, &state, &covariance));
        }
        found.reverse();
        found
    }

    /// Returns the oldest remembered pose.
    pub fn oldest(&self) -> Smoothed {
        let smoothed = self.smoothed();
        smoothed
            .first()
            .copied()
            .unwrap_or_else(|| smoothed_pose(0, self.filter.state(), self.filter.state_covariance()))
    }
}

fn smoothed_pose(lag: usize, state: &State, covariance: &Covariance) -> Smoothed {
    let covariance = covariance.fixed_view::<2, 2>(0, 0).into_owned();
    Smoothed { lag, pose: Pose::new(state.x, state.y, state.z), covariance }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Aggregation, MotionNoise,
        draws::{Draws, paper_stations},
    };

    /// Errors of the filter, and of the estimate ten motions back, on a circle with tracks that slip by 3 %.
    fn errors(seed: u64) -> (f64, f64) {
        let (stations, mut draws) = (paper_stations(), Draws::new(0.05, 1, seed));
        let mut truth = Pose::new(6.0, 0.0, std::f64::consts::FRAC_PI_2);
        let mut smoother = FixedLag::new(Ekf::new(truth, 0.05, 0.05, MotionNoise::default()), 10);
        let (mut filtered, mut smoothed, mut before) = (0.0, 0.0, Vec::new());
        for _ in 0..200 {
            before.push(truth);
            truth = truth.moved(0.3, 0.0, 0.05);
            let odometry = Odometry {
                forward_m: 0.3 / 0.97 * (1.0 + 0.02 * draws.bell()),
                sideways_m: 0.0,
                turn_rad: 0.05 + 0.002 * draws.bell(),
            };
            smoother.predict(&odometry);
            smoother.update_ranges(&draws.rangings(&stations, truth.position, Aggregation::Mean), &stations);
            filtered += (smoother.filter().pose().position - truth.position).norm();
            let oldest = smoother.oldest();
            if oldest.lag == 10 {
                smoothed += (oldest.pose.position - before[before.len() - 10].position).norm();
            }
        }
        (filtered / 200.0, smoothed / 191.0)
    }

    #[test]
    fn looking_back_is_better_than_looking_now() {
        let all: Vec<(f64, f64)> = (0..20).map(errors).collect();
        let (filtered, smoothed) = all.iter().fold((0.0, 0.0), |(f, s), (a, b)| (f + a / 20.0, s + b / 20.0));
        assert!(smoothed < 0.8 * filtered, "{smoothed} {filtered}");
    }

    #[test]
    fn without_a_past_the_present_is_all_there_is() {
        let start = Pose::new(1.0, 2.0, 0.3);
        let smoother = FixedLag::new(Ekf::new(start, 0.05, 0.05, MotionNoise::default()), 10);
        assert_eq!(smoother.oldest().pose, start);
        assert_eq!(smoother.smoothed().len(), 1);
    }

    #[test]
    fn nothing_is_remembered_beyond_the_lag_and_garbage_is_survived() {
        let mut smoother =
            FixedLag::new(Ekf::new(Pose::new(0.0, 0.0, 0.0), 0.05, 0.05, MotionNoise::default()), 3);
        for forward_m in [0.1, f64::NAN, 1e300, 0.1, f64::INFINITY, 0.1] {
            smoother.predict(&Odometry { forward_m, sideways_m: 0.0, turn_rad: 0.0 });
        }
        let all = smoother.smoothed();
        assert_eq!(all.len(), 4);
        assert!(
            all.iter().all(|s| s.pose.position.iter().all(|c| c.is_finite()) && s.error_95_m().is_finite())
        );
    }
}
