//! Statistics of fixes and track.

use crate::fixes::{self, word};
use mission::{Event, EventKind};
use positioning::{Integrity, fix::ellipse_95};
use serde::Serialize;
use std::collections::BTreeMap;
use world::Point;

/// The number of fixes, and the quality of fixes and track.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Tally {
    /// Emissions: times with ranges.
    pub emissions: u64,
    /// Positions from ranges, by integrity.
    pub fixes: BTreeMap<&'static str, u64>,
    /// Emissions without a fix, by reason.
    pub failed: BTreeMap<String, u64>,
    /// Position of the first fix, tank frame, metres.
    pub first_fix_m: Option<Point>,
    /// Mission time of the first fix, seconds.
    pub first_fix_t_s: Option<f64>,
    /// Longer semi-axis of the 95 % ellipse of the first fix, metres.
    pub first_fix_error_95_m: Option<f64>,
    /// How often each station was rejected for its residual, by station number.
    pub left_out: BTreeMap<u32, u64>,
    /// 95 % error of the track from its covariance, metres: mean and largest.
    pub error_95_m: Option<[f64; 2]>,
    /// Distance of the fixes from the truth, metres: mean and largest; absent if the truth is unknown.
    pub fix_error_m: Option<[f64; 2]>,
    /// Distance of the track from the truth, metres: mean and largest; absent if the truth is unknown.
    pub track_error_m: Option<[f64; 2]>,
    #[serde(skip)]
    claimed: Mean,
    #[serde(skip)]
    of_fixes: Mean,
    #[serde(skip)]
    of_track: Mean,
}

#[derive(Debug, Clone, Copy, Default)]
struct Mean {
    sum: f64,
    most: f64,
    count: u64,
}

impl Mean {
    fn take(&mut self, value: f64) {
        self.sum += value;
        self.most = self.most.max(value);
        self.count += 1;
    }

    fn figures(&self) -> Option<[f64; 2]> {
        (self.count > 0).then(|| [self.sum / self.count as f64, self.most])
    }
}

impl Tally {
    /// Whether any emission gave a position that the ranges of that emission do not contradict.
    pub fn has_fix(&self) -> bool {
        self.fixes.keys().any(|word| *word != fixes::word(Integrity::Alarm))
    }

    /// Adds the events of a moment.
    pub fn take(&mut self, events: &[Event]) {
        let mut truth: Option<Point> = None;
        for event in events {
            match &event.kind {
                EventKind::Truth { pose, .. } => truth = Some(pose.position),
                EventKind::Ranged { .. } => self.emissions += 1,
                EventKind::Fixed { fix } => {
                    *self.fixes.entry(word(fix.integrity)).or_default() += 1;
                    self.first_fix_m.get_or_insert(fix.position);
                    self.first_fix_t_s.get_or_insert(event.t_s);
                    self.first_fix_error_95_m.get_or_insert_with(|| fix.ellipse_95().0);
                    for (station, reason) in &fix.excluded {
                        if matches!(reason, positioning::Exclusion::Residual { .. }) {
                            *self.left_out.entry(station.0).or_default() += 1;
                        }
                    }
                    if let Some(truth) = truth.filter(|_| fix.integrity != Integrity::Alarm) {
                        self.of_fixes.take((fix.position - truth).norm());
                    }
                }
                EventKind::FixFailed { error, .. } => *self.failed.entry(error.to_string()).or_default() += 1,
                EventKind::Estimated { pose } => {
                    let covariance = pose.covariance.fixed_view::<2, 2>(0, 0).into_owned();
                    self.claimed.take(ellipse_95(&covariance).0);
                    if let Some(truth) = truth {
                        self.of_track.take((pose.position - truth).norm());
                    }
                }
                _ => {}
            }
        }
        self.error_95_m = self.claimed.figures();
        self.fix_error_m = self.of_fixes.figures();
        self.track_error_m = self.of_track.figures();
    }
}
