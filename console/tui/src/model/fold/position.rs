//! Folds position events into a run.

use crate::model::{Cause, Change, Run, Withdrawn, position};
use mission::{Channels, Event, EventKind, Passage, Severity, event::pulse_error_text};
use planner_api::PoseEstimate;
use positioning::{Exclusion, Integrity};
use world::Pose;

impl Run {
    /// Folds in a position event.
    pub(super) fn locate(&mut self, event: &Event, change: &mut Change) {
        match &event.kind {
            EventKind::Ranged { ranges } => self.position.ranged(event.t_s, ranges),
            EventKind::Fixed { fix } => {
                self.position.fixed(event.t_s, fix);
                self.clear(&Cause::NoFix);
            }
            EventKind::FixFailed { error, .. } => {
                self.position.failure = Some(error.to_string());
                self.raise(event, Cause::NoFix, Severity::Watch, format!("no fix: {error}"));
            }
            EventKind::StationRejected { station, reason } => {
                *self.position.rejections.entry(*station).or_default() += 1;
                // The alarm about the bias says so already.
                if !matches!(reason, Exclusion::Biased { .. }) {
                    self.raise_as_logged(event, Cause::Station(*station));
                }
            }
            EventKind::StationRestored { station } => self.clear(&Cause::Station(*station)),
            EventKind::Estimated { pose } => {
                self.scan(pose);
                self.position.estimated(event.t_s, *pose);
                self.trail.add(pose.position);
            }
            EventKind::Protected { level_m } => self.position.protection = Some(*level_m),
            EventKind::ProtectionLost { .. } => self.raise_as_logged(event, Cause::NotProtected),
            EventKind::ProtectionRegained { .. } => self.clear(&Cause::NotProtected),
            EventKind::SessionCalibrated { scale, slip_correlation } => {
                (self.position.scale, self.position.is_slip_possible) =
                    (Some(*scale), slip_correlation.is_some());
            }
            EventKind::ClocksEstimated { offsets } => self.position.clocks.clone_from(offsets),
            EventKind::PulsesAwaited { until_s } => self.position.pulses_until_s = Some(*until_s),
            EventKind::PulsesTested { phase, test } => {
                self.position.pulses_until_s = None;
                self.position.pulses = Some(Ok((*phase, test.clone())));
                if test.integrity == Integrity::Alarm {
                    self.raise_as_logged(event, Cause::Pulses);
                } else {
                    self.clear(&Cause::Pulses);
                }
            }
            EventKind::PulsesFailed { why, .. } => {
                self.position.pulses_until_s = None;
                self.position.pulses = Some(Err(pulse_error_text(*why, self.stations())));
                self.raise_as_logged(event, Cause::Pulses);
            }
            EventKind::ClocksChanged { .. } => self.raise_as_logged(event, Cause::Pulses),
            EventKind::StationBiased { station, .. } => {
                self.clear(&Cause::Station(*station));
                self.raise_as_logged(event, Cause::Bias(*station));
            }
            EventKind::StationUnbiased { station } => self.clear(&Cause::Bias(*station)),
            EventKind::NotSeparable { .. } => self.raise_as_logged(event, Cause::NotSeparable),
            EventKind::Separable => self.clear(&Cause::NotSeparable),
            EventKind::PositionLost { .. } => {
                self.position.lost = true;
                self.raise_as_logged(event, Cause::PositionLost);
                change.withdraw(Withdrawn::All);
            }
            EventKind::PositionRegained { .. } => {
                self.position.lost = false;
                self.clear(&Cause::PositionLost);
            }
            EventKind::RangesInconsistent { .. } => {
                self.raise(
                    event,
                    Cause::Contradiction,
                    Severity::Crit,
                    "ranges contradict each other".into(),
                );
                change.withdraw(Withdrawn::All);
            }
            EventKind::RangesConsistent => self.clear(&Cause::Contradiction),
            _ => {}
        }
    }

    /// Marks the floor between the last estimate and this one as scanned, as the mission does.
    fn scan(&mut self, here: &PoseEstimate) {
        let Some(mission) = self.about.as_ref().map(|about| &about.mission) else { return };
        let passage = Passage::of(self.phase(), position::ellipse_95(here).0, mission.scan_limit_m());
        if let Some(coverage) = self.coverage.as_mut().filter(|_| passage == Passage::Counts) {
            let at = |pose: &PoseEstimate| Pose { position: pose.position, heading_rad: pose.heading_rad };
            let before = self.position.pose.as_ref().map_or(mission.start, at);
            let mut channels = Channels::new(mission);
            channels.judge(Some(&self.dead_channels));
            let live = channels.live(coverage.floor().rim_m());
            coverage.pass(mission.swath_m, &live, before, at(here));
        }
    }
}
