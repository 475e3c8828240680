//! Folds tether events into a run.

use crate::model::alarms::rule;
use crate::model::{Cause, Run, Tether};
use mission::{Event, EventKind, Severity, event::TetherAlarm};
use world::beside_limit;

/// A pull beyond its limit has returned when it is below this share of the limit.
const RETURNED: f64 = 0.95;

/// A pull of the tether beside its limit.
pub(super) struct PullBesideLimit {
    /// The word that tells the alarm of the pull from others.
    pub word: &'static str,
    /// The pull, newtons.
    pub now_n: f64,
    /// The largest permitted pull, newtons.
    pub most_n: f64,
}

impl Run {
    /// Forgets the last certificate, because its plan no longer runs.
    pub(super) fn forget_certificate(&mut self) {
        if let Some(tether) = &mut self.tether {
            (tether.certified, tether.promised_m, tether.promised_pull) = (None, None, None);
            tether.warnings.clear();
        }
    }

    /// Folds in a tether event.
    pub(super) fn tethered(&mut self, event: &Event) {
        match &event.kind {
            EventKind::TetherAlarmRaised { alarm, reached } => {
                if matches!(alarm, TetherAlarm::Snag { .. }) {
                    self.tether.get_or_insert_default().is_snagged = true;
                }
                if let TetherAlarm::Broken { paid_out_m, .. } = alarm {
                    let tether = self.tether.get_or_insert_default();
                    (tether.is_broken, tether.broke_out_m) = (true, Some(*paid_out_m));
                }
                if let (TetherAlarm::Reel { out_m, .. }, false) = (alarm, reached) {
                    self.tether.get_or_insert_default().is_near_end = true;
                    if *out_m <= self.reel_limit_m().unwrap_or(0.0) {
                        return;
                    }
                }
                self.raise_as_logged(event, Cause::Tether(alarm.word().to_owned()));
            }
            EventKind::TetherAlarmCleared { alarm } => {
                if matches!(alarm, TetherAlarm::Snag { .. }) {
                    self.tether.get_or_insert_default().is_snagged = false;
                }
                if matches!(alarm, TetherAlarm::Reel { .. }) {
                    self.tether.get_or_insert_default().is_near_end = false;
                }
                self.clear(&Cause::Tether(alarm.word().to_owned()));
            }
            // The planner is a candidate; the reason why it does not take over is reported when the planner is
            // rejected.
            EventKind::Certified { .. } if self.planning.proposed => {}
            EventKind::Certified { planner, refused, certificate } => {
                let tether = self.tether.get_or_insert_default();
                tether.certified = Some(certificate.certified);
                tether.promised_m = certificate.certified.then_some(certificate.tether_length_max_m);
                tether.promised_pull = certificate.pull;
                tether.warnings.clone_from(&certificate.warnings);
                if certificate.certified {
                    self.clear(&Cause::Certificate);
                } else {
                    let severity = if *refused { Severity::Crit } else { Severity::Warn };
                    let reasons = certificate.reasons.join("; ");
                    let text = format!("plan of {planner} not certified: {reasons}");
                    self.raise(event, Cause::Certificate, severity, text);
                }
            }
            other => {
                let anchor = self.about.as_ref().and_then(|about| about.mission.tether.as_ref());
                let ends =
                    anchor.map(|tether| tether.anchor).zip(self.position.pose.map(|pose| pose.position));
                self.tether.get_or_insert_default().lie(event.t_s, other, ends);
                self.watch_reel(event);
                self.watch_pulls(event);
            }
        }
    }

    /// The length of tether out at which its reel counts as nearly out, metres: 80 % of it, or more if a certified plan
    /// promises more. `None` if it is that share, which the mission itself reports.
    pub(super) fn reel_limit_m(&self) -> Option<f64> {
        let reel_length_m = self.about.as_ref()?.mission.tether.as_ref()?.limits.reel_length_m;
        let promised_m = self.tether.as_ref()?.promised_m?;
        Some(rule::reel_limit_m(reel_length_m, Some(promised_m)))
    }

    /// Raises the alarm about the reel when the tether out exceeds what the plan promises, and clears it when a plan
    /// promises more.
    fn watch_reel(&mut self, event: &Event) {
        let Some(out_m) =
            self.tether.as_ref().filter(|tether| tether.is_near_end).map(|tether| tether.length_m)
        else {
            return;
        };
        let Some(config) = self.about.as_ref().and_then(|about| about.mission.tether.as_ref()) else {
            return;
        };
        let alarm = TetherAlarm::Reel { out_m, reel_length_m: config.limits.reel_length_m };
        let cause = Cause::Tether(alarm.word().to_owned());
        let active = self.alarms.get(&cause).filter(|alarm| alarm.is_active());
        // A reel that is empty stays an alarm until the mission reports that it is not.
        if active.is_some_and(|alarm| alarm.severity == Severity::Crit) {
            return;
        }
        // An acknowledgement applies to the text that the operator saw.
        let text = active.map_or_else(|| alarm.to_string(), |alarm| alarm.text.clone());
        if self.reel_limit_m().is_none_or(|limit_m| out_m > limit_m) {
            self.raise(event, cause, Severity::Warn, text);
        } else if active.is_some() {
            self.clear(&cause);
        }
    }

    /// The pulls whose limits the scenario gives: the pull that taking up the tether needs, beside the pull of the reel,
    /// and in a simulation the pull at the robot, beside what the robot can bear. The sensor of a vehicle is at the reel,
    /// where the pull says nothing about the pull at the robot.
    pub(super) fn pulls(&self, tether: &Tether) -> impl Iterator<Item = PullBesideLimit> + use<> {
        let needed = tether.pull_n.zip(self.reel().map(|reel| reel.pull_n));
        let felt = tether.measured.filter(|_| !self.is_live()).map(|measured| measured.pull_n);
        let felt = felt.zip(self.robot_pull_most_n());
        [("reel pull", needed), ("robot pull", felt)]
            .into_iter()
            .filter_map(|(word, pull)| pull.map(|(now_n, most_n)| PullBesideLimit { word, now_n, most_n }))
    }

    /// Raises the alarm of each pull that exceeds its limit, and clears it when the pull has returned.
    fn watch_pulls(&mut self, event: &Event) {
        let Some(tether) = &self.tether else { return };
        for PullBesideLimit { word, now_n, most_n } in self.pulls(tether) {
            let cause = Cause::Tether(word.to_owned());
            if now_n > most_n {
                let active = self.alarms.get(&cause).filter(|alarm| alarm.is_active());
                // An acknowledgement applies to the text that the operator saw.
                let text = active.map_or_else(|| beyond(word, now_n, most_n), |alarm| alarm.text.clone());
                self.raise(event, cause, Severity::Warn, text);
            } else if now_n < RETURNED * most_n {
                self.clear(&cause);
            }
        }
    }
}

fn beyond(word: &str, now_n: f64, most_n: f64) -> String {
    let [now, most] = beside_limit(now_n, most_n, 1);
    match word {
        "reel pull" => format!("taking up the tether needs {now} N, the reel pulls {most} N"),
        _ => format!("the tether pulls the robot with {now} N, limit {most} N"),
    }
}
