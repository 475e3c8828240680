//! The robot's estimated position and its error.

use super::History;
use planner_api::PoseEstimate;
use positioning::{Exclusion, Fix, Ranging, fix};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, VecDeque};
use world::{Point, StationId};

/// The time span over which the speed is measured, seconds.
const SPEED_SPAN_S: f64 = 2.0;
/// The assumed time between ranging cycles until the second one is received, seconds.
const FIRST_PERIOD_S: f64 = 1.0;

/// The robot's estimated position and its error.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Position {
    /// The latest estimated pose.
    pub pose: Option<PoseEstimate>,
    /// Mission time of the pose, seconds.
    pub pose_t_s: f64,
    /// The protection level of the pose, metres: `None` if the mission computes none, `Some(None)` if the pose is not
    /// protected.
    #[serde(default)]
    pub protection: Option<Option<f64>>,
    /// The share by which all ranges are too long; `None` if the mission does not estimate it.
    #[serde(default)]
    pub scale: Option<positioning::Estimated>,
    /// Whether the fixes cannot tell this share from the slip of the robot.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_slip_possible: bool,
    /// The clocks of the stations; empty if they share one clock.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub clocks: Vec<mission::ClockOffset>,
    /// The last pulse test of the stations, or why it gave no result; `None` if there was none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pulses: Option<Result<(mission::event::PulsePhase, positioning::PulseTest), String>>,
    /// Mission time until which the robot stands still for the pulse test after the run, seconds; `None` if it does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pulses_until_s: Option<f64>,
    /// The last fix.
    pub fix: Option<Fix>,
    /// Mission time of the fix, seconds.
    pub fix_t_s: f64,
    /// Stations heard in the last ranging cycle.
    pub heard: usize,
    /// The ranges of the last ranging cycle.
    #[serde(default)]
    pub ranges: Vec<Ranging>,
    /// Mission time of the last ranging cycle, seconds.
    pub ranged_t_s: Option<f64>,
    /// Time between the last two ranging cycles, seconds.
    pub period_s: Option<f64>,
    /// Why the last ranging cycle gave no fix; `None` if it gave one.
    pub failure: Option<String>,
    /// How often each station was rejected.
    #[serde(default)]
    pub rejections: BTreeMap<StationId, u32>,
    /// The number of fixes.
    #[serde(default)]
    pub fixes: u32,
    /// The number of fixes in which each station was not used.
    #[serde(default)]
    pub unused: BTreeMap<StationId, u32>,
    /// Whether the position is lost.
    pub lost: bool,
    /// The history of the 95 % error, metres.
    pub history_m: History,
    /// The history of the root mean square of the residuals, millimetres.
    #[serde(default)]
    pub residual_history_mm: History,
    /// The history of each station's residual without its sign, millimetres.
    #[serde(default)]
    pub station_history_mm: BTreeMap<StationId, History>,
    recent: VecDeque<(f64, Point)>,
}

impl Position {
    /// Records a new pose.
    pub fn estimated(&mut self, t_s: f64, pose: PoseEstimate) {
        (self.pose, self.pose_t_s) = (Some(pose), t_s);
        self.recent.push_back((t_s, pose.position));
        while self.recent.len() > 1 && (self.recent[0].0 < t_s - SPEED_SPAN_S || self.recent.len() > 1000) {
            self.recent.pop_front();
        }
        self.history_m.add(t_s, error_95_m(&pose));
    }

    /// Records the end of a ranging cycle.
    pub fn ranged(&mut self, t_s: f64, ranges: &[Ranging]) {
        if let Some(before) = self.ranged_t_s.filter(|before| *before < t_s) {
            self.period_s = Some(t_s - before);
        }
        (self.heard, self.ranged_t_s) = (ranges.len(), Some(t_s));
        ranges.clone_into(&mut self.ranges);
    }

    /// Records a fix.
    pub fn fixed(&mut self, t_s: f64, fix: &Fix) {
        (self.fix, self.fix_t_s, self.failure) = (Some(fix.clone()), t_s, None);
        self.fixes += 1;
        for (station, _) in &fix.excluded {
            *self.unused.entry(*station).or_default() += 1;
        }
        if let Some(rms_m) = self.residual_rms_m() {
            self.residual_history_mm.add(t_s, 1000.0 * rms_m);
        }
        let rejected = fix.excluded.iter().filter_map(|(station, why)| match why {
            Exclusion::Residual { residual_m, .. } => Some((*station, *residual_m)),
            _ => None,
        });
        let used = fix.residuals.iter().map(|residual| (residual.station, residual.residual_m));
        for (station, residual_m) in used.chain(rejected) {
            self.station_history_mm.entry(station).or_default().add(t_s, 1000.0 * residual_m.abs());
        }
    }

    /// Why the last fix did not use a station; `None` if it did, and before the first fix.
    pub fn exclusion(&self, station: StationId) -> Option<&Exclusion> {
        let excluded = self.fix.as_ref()?.excluded.iter();
        excluded.filter(|(id, _)| *id == station).map(|(_, why)| why).next()
    }

    /// The share of the fixes in which a station was not used, 0 to 1; `None` before the first fix.
    pub fn unused_share(&self, station: StationId) -> Option<f64> {
        let unused = self.unused.get(&station).copied().unwrap_or(0);
        (self.fixes > 0).then(|| f64::from(unused) / f64::from(self.fixes))
    }

    /// The 95 % error of the pose, metres.
    pub fn error_m(&self) -> Option<f64> {
        self.pose.as_ref().map(error_95_m)
    }

    /// Root mean square of the residuals of the last fix, metres.
    pub fn residual_rms_m(&self) -> Option<f64> {
        let fix = self.fix.as_ref().filter(|fix| !fix.residuals.is_empty())?;
        let mean =
            fix.residuals.iter().map(|r| r.residual_m.powi(2)).sum::<f64>() / fix.residuals.len() as f64;
        Some(mean.sqrt())
    }

    /// The estimated speed over ground, metres per second.
    pub fn speed_m_per_s(&self) -> Option<f64> {
        let (from, to) = (self.recent.front()?, self.recent.back()?);
        let span_s = to.0 - from.0;
        (span_s > 0.0).then(|| (to.1 - from.1).norm() / span_s)
    }

    /// The age of the last fix, seconds.
    pub fn fix_age_s(&self, t_s: f64) -> Option<f64> {
        self.fix.as_ref().map(|_| (t_s - self.fix_t_s).max(0.0))
    }

    /// Whether the last fix is older than two ranging periods.
    pub fn is_fix_stale(&self, t_s: f64) -> bool {
        self.fix_age_s(t_s).is_some_and(|age_s| age_s > 2.0 * self.period())
    }

    /// Whether the last ranging cycle is older than two periods.
    pub fn is_ranging_stale(&self, t_s: f64) -> bool {
        self.ranged_t_s.is_some_and(|ranged_t_s| t_s - ranged_t_s > 2.0 * self.period())
    }

    fn period(&self) -> f64 {
        self.period_s.unwrap_or(FIRST_PERIOD_S)
    }
}

/// The 95 % error of a pose, metres: the longer semi-axis of the ellipse.
fn error_95_m(pose: &PoseEstimate) -> f64 {
    ellipse_95(pose).0
}

/// The semi-axes of a pose's 95 % ellipse, metres, and the direction of the longer one, radians.
pub fn ellipse_95(pose: &PoseEstimate) -> (f64, f64, f64) {
    fix::ellipse_95(&fix::position_covariance(&pose.covariance))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix2, Matrix3};
    use positioning::Residual;

    fn pose(x: f64, sigma_m: f64) -> PoseEstimate {
        let covariance = Matrix3::from_diagonal_element(sigma_m * sigma_m);
        PoseEstimate { position: Point::new(x, 0.0), heading_rad: 0.0, covariance }
    }

    #[test]
    fn the_speed_is_taken_over_two_seconds() {
        let mut position = Position::default();
        for tick in 0..100 {
            let t_s = f64::from(tick) * 0.1;
            position.estimated(t_s, pose(t_s * 0.2, 0.01));
        }
        assert!((position.speed_m_per_s().unwrap_or_default() - 0.2).abs() < 1e-9);
    }

    #[test]
    fn a_fix_is_stale_after_two_periods() {
        let mut position = Position { fix_t_s: 10.0, ..Position::default() };
        position.ranged(9.0, &[]);
        position.ranged(10.0, &[]);
        assert_eq!(position.period_s, Some(1.0));
        assert!(!position.is_fix_stale(20.0), "no fix at all is not a stale one");
        position.fix = Some(fix());
        assert!(!position.is_fix_stale(11.9));
        assert!(position.is_fix_stale(12.1));
    }

    #[test]
    fn every_station_has_its_history_of_residuals() {
        let mut position = Position::default();
        let residual = |id, residual_m| Residual { station: StationId(id), residual_m, sigma_m: 0.05 };
        let rejected = (StationId(3), Exclusion::Residual { residual_m: 0.4, gate_m: 0.1 });
        let residuals = vec![residual(1, -0.03), residual(2, 0.04)];
        position.fixed(8.0, &Fix { residuals, excluded: vec![rejected], ..fix() });
        let newest = |id| position.station_history_mm.get(&StationId(id)).and_then(|all| all.last(4).next());
        let near = |found: Option<f64>, mm: f64| found.is_some_and(|found| (found - mm).abs() < 0.01);
        assert!(near(newest(1), 30.0) && near(newest(2), 40.0) && near(newest(3), 400.0));
        assert!(
            near(position.residual_history_mm.last(4).next(), 35.355),
            "the rejected one is not part of the fix"
        );
    }

    fn fix() -> Fix {
        Fix {
            position: Point::origin(),
            covariance: Matrix2::identity(),
            residuals: Vec::new(),
            used: Vec::new(),
            excluded: Vec::new(),
            chi2: 0.0,
            degrees_of_freedom: 0,
            gdop: 1.0,
            conditioning: 1.0,
            mirror: None,
            protection_level_m: None,
            integrity: positioning::Integrity::Ok,
        }
    }
}
