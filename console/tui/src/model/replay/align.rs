//! Matches moments in two runs.

use crate::model::Run;
use serde::{Deserialize, Serialize};
use world::Point;

/// The minimum time between two samples of a track, seconds.
const SAMPLE_S: f64 = 1.0;
/// Positions that are further away than the nearest one by more than this belong to a different pass, metres.
const SAME_PASS_M: f64 = 0.5;

/// How moments in two runs are matched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Align {
    /// By the time since the start.
    #[default]
    Time,
    /// By the share of the path driven.
    Path,
    /// By the robot's position; if there were several passes, by the pass with the nearest share of the path.
    Place,
}

impl Align {
    /// The next way of matching.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Self::Time => Self::Path,
            Self::Path => Self::Place,
            Self::Place => Self::Time,
        }
    }

    /// The quantity that is matched.
    pub fn word(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Path => "path share",
            Self::Place => "place",
        }
    }
}

/// The robot's positions, one per second.
#[derive(Debug, Clone, Default)]
pub struct Track {
    samples: Vec<Sample>,
    started_s: f64,
}

#[derive(Debug, Clone, Copy)]
struct Sample {
    t_s: f64,
    at: Point,
    /// The distance driven so far according to the estimated position, metres.
    way_m: f64,
}

impl Track {
    /// Records the current position of a run.
    pub fn add(&mut self, run: &Run) {
        self.started_s = run.clock.started_s.unwrap_or(0.0);
        let Some(at) = run.position.pose.as_ref().map(|pose| pose.position) else { return };
        let (t_s, last) = (run.clock.t_s, self.samples.last().copied());
        let is_due = last.is_none_or(|last| t_s - last.t_s >= SAMPLE_S);
        if is_due && at.x.is_finite() && at.y.is_finite() {
            let way_m = last.map_or(0.0, |last| last.way_m + (at - last.at).norm());
            self.samples.push(Sample { t_s, at, way_m });
        }
    }

    /// The sample at the given time, or the last one before it.
    fn at(&self, t_s: f64) -> Option<Sample> {
        let index = self.samples.partition_point(|sample| sample.t_s <= t_s);
        self.samples.get(index.saturating_sub(1)).copied()
    }

    fn share(&self, sample: Sample) -> f64 {
        let whole_m = self.samples.last().map_or(0.0, |last| last.way_m);
        if whole_m > 0.0 { sample.way_m / whole_m } else { 0.0 }
    }

    /// The moment in the other run that corresponds to a moment in this one, seconds of mission time.
    pub fn moment_of(&self, other: &Self, align: Align, t_s: f64) -> f64 {
        let by_time = || t_s - self.started_s + other.started_s;
        let Some(sample) = self.at(t_s).filter(|sample| sample.t_s <= t_s) else { return by_time() };
        let share = self.share(sample);
        let found = match align {
            Align::Time => None,
            Align::Path => {
                let index = other.samples.partition_point(|its| other.share(*its) < share);
                other.samples.get(index).or(other.samples.last())
            }
            Align::Place => {
                let far_m = |its: &Sample| (its.at - sample.at).norm();
                let nearest_m = other.samples.iter().map(far_m).fold(f64::INFINITY, f64::min);
                let passes = other.samples.iter().filter(|its| far_m(its) <= nearest_m + SAME_PASS_M);
                let off = |its: &Sample| (other.share(*its) - share).abs();
                passes.min_by(|one, two| off(one).total_cmp(&off(two)))
            }
        };
        found.map_or_else(by_time, |its| its.t_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The track of a robot that waits for some time and then drives there and back at some speed.
    fn track(speed_m_per_s: f64, waits_s: f64) -> Track {
        let mut track = Track { started_s: waits_s, ..Track::default() };
        let turn_s = 100.0 / speed_m_per_s;
        for tick in 0..=(2.0 * turn_s) as u32 {
            let t_s = f64::from(tick);
            let x = if t_s <= turn_s { t_s } else { 2.0 * turn_s - t_s } * speed_m_per_s;
            let way_m = t_s * speed_m_per_s;
            track.samples.push(Sample { t_s: waits_s + t_s, at: Point::new(x, 0.0), way_m });
        }
        track
    }

    #[test]
    fn moments_correspond_by_time_by_share_and_by_place() {
        let (slow, fast) = (track(1.0, 10.0), track(2.0, 0.0));
        let moment = |align, t_s| slow.moment_of(&fast, align, t_s);
        assert!((moment(Align::Time, 40.0) - 30.0).abs() < 1e-9);
        assert!((moment(Align::Path, 40.0) - 15.0).abs() < 1e-9);
        assert!((moment(Align::Place, 40.0) - 15.0).abs() <= 1.0);
        assert!((moment(Align::Place, 180.0) - 85.0).abs() <= 1.0, "on the way back");
    }

    #[test]
    fn a_track_without_samples_corresponds_by_time() {
        let (none, some) = (Track::default(), track(1.0, 0.0));
        for align in [Align::Time, Align::Path, Align::Place] {
            assert!((none.moment_of(&some, align, 7.0) - 7.0).abs() < 1e-9);
            assert!((some.moment_of(&none, align, 7.0) - 7.0).abs() < 1e-9);
        }
    }
}
