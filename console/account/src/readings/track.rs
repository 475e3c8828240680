//! The track of a run, on which readings are placed by their time.

use super::{Before, between, covariance};
use crate::Reading;
use nalgebra::Matrix2;
use planner_api::PoseEstimate;
use world::Pose;

/// The estimated poses of a run, in order of time.
#[derive(Debug, Clone, Default)]
pub struct Track {
    steps: Vec<Step>,
}

/// An estimated pose, and the way to it.
#[derive(Debug, Clone)]
struct Step {
    t_s: f64,
    estimate: PoseEstimate,
    counts: bool,
    /// Way from the start on which floor counts as scanned, metres.
    way_m: f64,
}

/// Where the instrument was at a time.
#[derive(Debug, Clone)]
pub struct Whereabouts<'a> {
    here: Before,
    estimate: &'a PoseEstimate,
    /// Speed, metres per second, and direction of the motion.
    motion: world::Vector,
    /// Whether floor that the tool passes here counts as scanned.
    pub counts: bool,
    /// Way from the start on which floor counts as scanned, metres.
    pub way_m: f64,
}

impl Track {
    /// Adds the next pose; `counts` states whether floor on the way to it counts as scanned.
    pub fn push(&mut self, t_s: f64, estimate: &PoseEstimate, counts: bool) {
        let way_m = self.steps.last().map_or(0.0, |last| {
            let way_m = (estimate.position - last.estimate.position).norm();
            last.way_m + if counts { way_m } else { 0.0 }
        });
        self.steps.push(Step { t_s, estimate: *estimate, counts, way_m });
    }

    /// Mission times of the first and the last pose, seconds; `None` without a pose.
    pub fn span_s(&self) -> Option<(f64, f64)> {
        Some((self.steps.first()?.t_s, self.steps.last()?.t_s))
    }

    /// Where the instrument was at a mission time; `None` before the first and after the last pose.
    pub fn at(&self, t_s: f64) -> Option<Whereabouts<'_>> {
        let next = self.steps.partition_point(|step| step.t_s < t_s);
        let to = self.steps.get(next)?;
        let from = if next == 0 { to } else { &self.steps[next - 1] };
        if next == 0 && t_s < to.t_s {
            return None;
        }
        let span_s = (to.t_s - from.t_s).max(f64::MIN_POSITIVE);
        let share = if next == 0 { 1.0 } else { (t_s - from.t_s) / span_s };
        let moved = to.estimate.position - from.estimate.position;
        Some(Whereabouts {
            here: between(&from.pose(), &to.pose(), share),
            estimate: &to.estimate,
            motion: if next == 0 { world::Vector::zeros() } else { moved / span_s },
            counts: to.counts,
            way_m: from.way_m + (to.way_m - from.way_m) * share,
        })
    }
}

impl Step {
    fn pose(&self) -> Before {
        let pose = Pose { position: self.estimate.position, heading_rad: self.estimate.heading_rad };
        Before { t_s: self.t_s, estimated: pose, truth: pose }
    }
}

impl Whereabouts<'_> {
    /// A reading that was taken here at a distance to the left, metres. The uncertainty of its time, a standard
    /// deviation in seconds, adds to the covariance along the motion.
    pub fn reading(&self, channel: u16, left_m: f64, time_sigma_s: f64, thickness_mm: f64) -> Reading {
        let Before { t_s, estimated, .. } = self.here;
        let along = self.motion * time_sigma_s;
        let of_time =
            Matrix2::new(along.x * along.x, along.x * along.y, along.x * along.y, along.y * along.y);
        Reading {
            t_s,
            channel,
            at: super::beside(estimated, left_m),
            covariance: covariance(self.estimate, estimated.heading_rad, left_m) + of_time,
            thickness_mm,
            is_testable: true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;
    use world::Point;

    fn track() -> Track {
        let mut track = Track::default();
        for (k, counts) in [(0.0, false), (1.0, true), (2.0, false), (3.0, true)] {
            let covariance = Matrix3::identity() * 1e-4;
            let position = Point::new(0.4 * k, 0.0);
            track.push(k, &PoseEstimate { position, heading_rad: 0.0, covariance }, counts);
        }
        track
    }

    #[test]
    fn a_reading_is_placed_where_the_instrument_was_at_its_time() {
        let track = track();
        let there = track.at(0.25).unwrap();
        let reading = there.reading(3, 0.2, 0.0, 7.5);
        assert!((reading.at - Point::new(0.1, 0.2)).norm() < 1e-12);
        assert!(there.counts && (there.way_m - 0.1).abs() < 1e-12 && (reading.t_s - 0.25).abs() < 1e-12);
        assert!(!track.at(1.5).unwrap().counts);
        assert!(
            (track.at(3.0).unwrap().way_m - 0.8).abs() < 1e-12,
            "the way that does not count is left out"
        );
        assert!(track.at(-0.1).is_none() && track.at(3.1).is_none() && track.at(0.0).is_some());
        assert_eq!(track.span_s(), Some((0.0, 3.0)));
    }

    #[test]
    fn an_uncertain_time_widens_the_ellipse_along_the_motion_only() {
        let reading = track().at(0.5).unwrap().reading(0, 0.0, 0.5, 8.0);
        let expected = Matrix2::new(1e-4 + 0.04, 0.0, 0.0, 1e-4);
        assert!((reading.covariance - expected).norm() < 1e-12, "{}", reading.covariance);
    }
}
