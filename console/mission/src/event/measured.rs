//! The readings behind a located run, which came from another system, and the floor that its tool passed over.

use crate::config::MissionConfig;
use planner_api::PoseEstimate;
use positioning::fix::{ellipse_95, position_covariance};
use serde::{Deserialize, Serialize};
use world::{Pose, Tool};

/// A normally distributed error stays within this number of standard deviations in 95 of 100 cases.
const NORMAL_95: f64 = 1.96;

/// Difference, seconds, below which times count as equal: the same time can be computed in two different ways.
const TIE_S: f64 = 1e-6;

/// The file of readings behind a located run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Name of the file.
    pub file: String,
    /// SHA-256 of the file, hexadecimal.
    pub sha256: String,
    /// The options that were given on the command line and are not in the scenario.
    #[serde(default)]
    pub asked: Asked,
    /// Whether the motion between the readings was measured; without it the heading is unknown.
    #[serde(default)]
    pub has_motion: bool,
    /// Periods of mission time in which the tool was on, seconds, in order; absent if not recorded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tool_on_s: Option<Vec<[f64; 2]>>,
}

/// The options with which the readings were located. Together with the scenario, they reproduce the same result.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Asked {
    /// Speed of sound, metres per second; absent if the readings are distances.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sound_speed_m_per_s: Option<f64>,
    /// Whether the speed of sound was estimated from the readings.
    pub finds_sound_speed: bool,
    /// Whether the offset between the clocks was estimated.
    pub finds_clock_offset: bool,
    /// Whether bad rows were left out.
    pub skips_bad_rows: bool,
}

impl Measured {
    /// Total time for which the tool was on, seconds; `None` if not recorded.
    pub fn on_for_s(&self) -> Option<f64> {
        Some(self.tool_on_s.as_ref()?.iter().map(|[from_s, to_s]| to_s - from_s).sum())
    }

    /// Whether the tool was on throughout the time between two moments, seconds.
    fn is_on(&self, from_s: f64, to_s: f64) -> bool {
        let is_within = |[first_s, last_s]: &[f64; 2]| *first_s <= from_s + TIE_S && to_s <= *last_s + TIE_S;
        self.tool_on_s.iter().flatten().any(is_within)
    }
}

/// Determines, from successive position estimates, where the tool passed over floor that counts as scanned.
///
/// A stretch between two estimates counts if four conditions are met: the tool was on all the time; the position error
/// was within the limit at both ends; if the tool is a bar, the heading is known well enough to place the ends of the
/// bar; and the robot cannot have strayed from the straight line by more than the limit in the meantime. If a stretch
/// does not count, the place of the second estimate alone may count.
#[derive(Debug, Clone)]
pub struct ToolTrack {
    measured: Measured,
    tool: Tool,
    limit_m: f64,
    v_max_m_per_s: f64,
    last: Option<(f64, Pose, bool)>,
}

impl ToolTrack {
    /// Creates a track for the tool of the mission with which the readings were located.
    pub fn new(measured: &Measured, mission: &MissionConfig) -> Self {
        Self {
            measured: measured.clone(),
            tool: mission.tool(),
            limit_m: mission.scan_limit_m(),
            v_max_m_per_s: mission.limits.v_max_m_per_s,
            last: None,
        }
    }

    /// Whether the times when the tool was on were recorded.
    pub fn is_known(&self) -> bool {
        self.measured.tool_on_s.is_some()
    }

    /// Adds the next estimate, at a mission time in seconds. If floor counts as scanned, returns the two poses between
    /// which the tool passed over it; both are the same if only a single place counts.
    pub fn visit(&mut self, t_s: f64, estimate: &PoseEstimate) -> Option<(Pose, Pose)> {
        let here = Pose { position: estimate.position, heading_rad: estimate.heading_rad };
        let is_good = self.is_good(estimate);
        let before = self.last.replace((t_s, here, is_good));
        if !is_good || !self.measured.is_on(t_s, t_s) {
            return None;
        }
        let stretch = before.filter(|(before_s, from, was_good)| {
            let way_m = (here.position - from.position).norm();
            *was_good
                && self.measured.is_on(*before_s, t_s)
                && self.strays_m(way_m, t_s - before_s) <= self.limit_m
        });
        Some((stretch.map_or(here, |(_, from, _)| from), here))
    }

    /// Whether a place counts, that is, whether the positions of all ends of the tool are known to within the limit.
    fn is_good(&self, estimate: &PoseEstimate) -> bool {
        let error_m = ellipse_95(&position_covariance(&estimate.covariance)).0;
        let sideways_m = match self.tool {
            Tool::Bar { .. } if !self.measured.has_motion => f64::INFINITY,
            Tool::Bar { swath_m } => NORMAL_95 * estimate.covariance[(2, 2)].max(0.0).sqrt() * swath_m / 2.0,
            Tool::Disc { .. } => 0.0,
        };
        error_m <= self.limit_m && sideways_m <= self.limit_m
    }

    /// How far a robot can have strayed from a straight line of length `way_m` in a given time at its maximum speed: the
    /// height of the triangle over that line.
    fn strays_m(&self, way_m: f64, time_s: f64) -> f64 {
        let half_m = self.v_max_m_per_s * time_s / 2.0;
        (half_m.powi(2) - (way_m / 2.0).powi(2)).max(0.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::Point;

    /// A track for a bar of 0.6 m on a robot that drives at 0.3 m/s at most. The tool is on from 1 s to 3 s.
    fn track(has_motion: bool) -> ToolTrack {
        let (file, sha256) = ("r.csv".to_owned(), String::new());
        ToolTrack {
            measured: Measured {
                file,
                sha256,
                asked: Asked::default(),
                has_motion,
                tool_on_s: Some(vec![[1.0, 3.0]]),
            },
            tool: Tool::Bar { swath_m: 0.6 },
            limit_m: 0.2,
            v_max_m_per_s: 0.3,
            last: None,
        }
    }

    fn at(x: f64, sigma_m: f64, heading_sigma_rad: f64) -> PoseEstimate {
        let covariance = nalgebra::Matrix3::zeros();
        let mut pose = PoseEstimate { position: Point::new(x, 0.0), heading_rad: 0.0, covariance };
        for (at, sigma) in [(0, sigma_m), (1, sigma_m), (2, heading_sigma_rad)] {
            pose.covariance[(at, at)] = sigma * sigma;
        }
        pose
    }

    /// The stretch that the tool passed over, from its start to its end along the x axis.
    fn passed(track: &mut ToolTrack, t_s: f64, x: f64) -> Option<(f64, f64)> {
        let (from, to) = track.visit(t_s, &at(x, 0.01, 0.05))?;
        Some((from.position.x, to.position.x))
    }

    #[test]
    fn only_what_was_passed_while_the_tool_was_on_counts() {
        let mut track = track(true);
        let xs = [(0.0, 0.0), (0.5, 0.1), (1.0, 0.2), (1.5, 0.3), (3.0, 0.7), (3.5, 0.8)];
        let all = xs.map(|(t_s, x)| passed(&mut track, t_s, x));
        // The stretch up to 1 s was driven with the tool off, so only its end counts.
        assert_eq!(all, [None, None, Some((0.2, 0.2)), Some((0.2, 0.3)), Some((0.3, 0.7)), None]);
        assert_eq!(track.measured.on_for_s(), Some(2.0));
    }

    #[test]
    fn a_stretch_on_which_the_robot_may_have_strayed_counts_only_at_its_end() {
        let mut slow = track(true);
        assert_eq!(passed(&mut slow, 1.0, 0.0), Some((0.0, 0.0)));
        // At its maximum speed, the robot could have been 0.3 m off the line in these 2 s.
        assert_eq!(passed(&mut slow, 3.0, 0.0), Some((0.0, 0.0)));
        let mut sure = track(true);
        passed(&mut sure, 1.0, 0.0);
        assert_eq!(
            passed(&mut sure, 3.0, 0.6),
            Some((0.0, 0.6)),
            "at its maximum speed, the robot must drive straight"
        );
        let mut far = track(true);
        passed(&mut far, 1.0, 0.0);
        assert_eq!(passed(&mut far, 3.0, 0.2), Some((0.2, 0.2)));
    }

    #[test]
    fn a_place_or_heading_that_is_not_known_well_enough_does_not_count() {
        let visit = |track: &mut ToolTrack, pose: &PoseEstimate| track.visit(2.0, pose).is_some();
        assert!(visit(&mut track(true), &at(0.0, 0.05, 0.05)));
        assert!(!visit(&mut track(true), &at(0.0, 0.1, 0.05)), "0.245 m in 95 %");
        assert!(!visit(&mut track(true), &at(0.0, 0.01, 0.4)), "ends of the bar off by 0.235 m");
        assert!(!visit(&mut track(false), &at(0.0, 0.01, 0.05)), "nothing measured the heading");
        let mut disc = ToolTrack { tool: Tool::Disc { swath_m: 0.6 }, ..track(false) };
        assert!(visit(&mut disc, &at(0.0, 0.01, 3.0)), "a disc needs no heading");
    }
}
