//! Copies figures from events into alarms whose cause persists.

use crate::model::alarms::{Reading, rule::reel_limit_m};
use crate::model::{Cause, Run};
use mission::{
    EventKind, Severity,
    event::{MeasuredPull, SLACK_M, TetherAlarm},
};
use positioning::{Exclusion, Fix, FixError};
use world::beside_limit;

impl Run {
    /// Updates the figures of the alarms from an event.
    pub(super) fn read_figures(&mut self, kind: &EventKind) {
        match kind {
            EventKind::Estimated { .. } | EventKind::PositionLost { .. } => self.read_error(kind),
            EventKind::Fixed { fix } => self.read_fix(fix),
            EventKind::FixFailed { error, .. } => self.read_failure(error),
            EventKind::RangesInconsistent { chi2, degrees_of_freedom } => {
                self.read(&Cause::Contradiction, || chi_squared(*chi2, *degrees_of_freedom));
            }
            EventKind::StationRejected { station, reason } => {
                self.read(&Cause::Station(*station), || residual(reason));
            }
            EventKind::TetherAlarmRaised { alarm, reached } => {
                let promised_m = self.tether.as_ref().and_then(|tether| tether.promised_m);
                if let Some(reading) = of_tether(alarm, *reached, promised_m) {
                    self.read(&Cause::Tether(alarm.word().to_owned()), || reading);
                }
            }
            EventKind::Tethered { .. } => self.read_tether(),
            _ => {}
        }
    }

    fn read(&mut self, cause: &Cause, reading: impl FnOnce() -> Reading) {
        self.alarms.read(cause, self.clock.t_s, reading);
    }

    fn read_error(&mut self, kind: &EventKind) {
        let limit_m = self.about.as_ref().map(|about| about.mission.position_limit_m);
        let (error_m, limit_m) = match kind {
            EventKind::PositionLost { error_m, limit_m } => (*error_m, Some(*limit_m)),
            _ => (self.position.error_m().unwrap_or(f64::NAN), limit_m),
        };
        self.read(&Cause::PositionLost, || {
            let written = beside_limit(error_m, limit_m.unwrap_or(f64::NAN), 2);
            let [now, limit] = written.map(|m| format!("±{m} m"));
            let limit = limit_m.map_or_else(String::new, |_| limit);
            Reading { now, limit, numbers: Some((error_m, limit_m)) }
        });
    }

    fn read_fix(&mut self, fix: &Fix) {
        self.read(&Cause::Contradiction, || chi_squared(fix.chi2, fix.degrees_of_freedom));
        for (station, reason) in &fix.excluded {
            self.read(&Cause::Station(*station), || residual(reason));
        }
        for used in &fix.residuals {
            self.read(&Cause::Station(used.station), || used_residual(used.residual_m));
        }
    }

    fn read_failure(&mut self, error: &FixError) {
        if let FixError::Inconsistent { chi2, degrees_of_freedom } = error {
            self.read(&Cause::Contradiction, || chi_squared(*chi2, *degrees_of_freedom));
        }
        if let FixError::TooFewStations { have, need } = error {
            let ranges = |n: &usize| format!("{n} range{}", if *n == 1 { "" } else { "s" });
            let reading = Reading { now: ranges(have), limit: ranges(need), numbers: None };
            self.read(&Cause::NoFix, || reading);
        }
    }

    fn read_tether(&mut self) {
        let Some(tether) = &self.tether else { return };
        let Some(config) = self.about.as_ref().and_then(|about| about.mission.tether.as_ref()) else {
            return;
        };
        let (out_m, total_rad, promised_m) = (tether.length_m, tether.wrap_total_rad, tether.promised_m);
        let limits = config.limits;
        let pulls: Vec<_> = self.pulls(tether).collect();
        let reel = TetherAlarm::Reel { out_m, reel_length_m: limits.reel_length_m };
        let total = TetherAlarm::WrapTotal { sum_rad: total_rad, limit_rad: limits.wrap_total_max_rad };
        let slack =
            tether.measured.map(|MeasuredPull { pull_n, slack_m }| TetherAlarm::Slack { slack_m, pull_n });
        for alarm in [reel, total].into_iter().chain(slack) {
            let cause = Cause::Tether(alarm.word().to_owned());
            let reached = self.alarms.get(&cause).is_some_and(|alarm| alarm.severity == Severity::Crit);
            self.read(&cause, || of_tether(&alarm, reached, promised_m).unwrap_or_default());
        }
        for pull in pulls {
            let [now, limit] = beside_limit(pull.now_n, pull.most_n, 1).map(|newtons| format!("{newtons} N"));
            let numbers = Some((pull.now_n, Some(pull.most_n)));
            self.read(&Cause::Tether(pull.word.to_owned()), || Reading { now, limit, numbers });
        }
    }
}

fn chi_squared(chi2: f64, degrees_of_freedom: u32) -> Reading {
    let limit = (degrees_of_freedom > 0).then(|| positioning::alarm_limit(degrees_of_freedom));
    Reading {
        now: format!("χ² {chi2:.0}"),
        limit: limit.map_or_else(String::new, |limit| format!("{limit:.1}")),
        numbers: Some((chi2, limit)),
    }
}

fn residual(reason: &Exclusion) -> Reading {
    let words = |now: &str| Reading { now: now.into(), ..Reading::default() };
    match reason {
        Exclusion::Silent => words("not heard"),
        Exclusion::ByOrder => words("excluded"),
        Exclusion::Biased { bias_m } => Reading { now: format!("{bias_m:+.2} m"), ..Reading::default() },
        Exclusion::Impossible { range_m, most_m } => {
            let [now, limit] = beside_limit(*range_m, *most_m, 1).map(|m| format!("{m} m"));
            Reading { now, limit, numbers: None }
        }
        Exclusion::Residual { residual_m, gate_m } => {
            let [size, gate] = beside_limit(residual_m.abs(), *gate_m, 2);
            let sign = if *residual_m < 0.0 { '-' } else { '+' };
            Reading {
                now: format!("{sign}{size} m"),
                limit: format!("{gate} m"),
                numbers: Some((residual_m.abs(), Some(*gate_m))),
            }
        }
    }
}

/// The residual of a station whose range is used.
fn used_residual(residual_m: f64) -> Reading {
    let numbers = Some((residual_m.abs(), None));
    Reading { now: format!("{residual_m:+.2} m"), limit: String::new(), numbers }
}

/// The figure of a tether alarm with the limit at which it was raised: a share of the tether's own limit until that is
/// `reached`, or what the certified plan promises, metres, if that is more.
fn of_tether(alarm: &TetherAlarm, reached: bool, promised_m: Option<f64>) -> Option<Reading> {
    let share = if reached { 1.0 } else { TetherAlarm::NEAR };
    let reading = |value: f64, most: f64, (decimals, unit): (usize, &str)| {
        let [now, limit] = beside_limit(value, most, decimals).map(|written| format!("{written}{unit}"));
        Reading { now, limit, numbers: Some((value, Some(most))) }
    };
    let (metres, degrees) = ((1, " m"), (0, "°"));
    match alarm {
        TetherAlarm::Reel { out_m, reel_length_m } if reached => {
            Some(reading(*out_m, *reel_length_m, metres))
        }
        TetherAlarm::Reel { out_m, reel_length_m } => {
            Some(reading(*out_m, reel_limit_m(*reel_length_m, promised_m), metres))
        }
        TetherAlarm::Wrap { wrap_rad: now_rad, limit_rad, .. }
        | TetherAlarm::WrapTotal { sum_rad: now_rad, limit_rad } => {
            Some(reading(now_rad.to_degrees(), share * limit_rad.to_degrees(), degrees))
        }
        TetherAlarm::Snag { paid_out_m, explained_m, .. } => Some(reading(*paid_out_m, *explained_m, metres)),
        TetherAlarm::Slack { slack_m, .. } => Some(reading(*slack_m, SLACK_M, (2, " m"))),
        // The reel takes the free end up: what was out when the break was noticed is not out now. The message states it.
        TetherAlarm::Broken { .. } | TetherAlarm::NoReturnPath | TetherAlarm::Strayed => None,
    }
}
