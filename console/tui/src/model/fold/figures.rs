//! Copies figures from events into alarms whose cause persists.

use crate::model::alarms::Reading;
use crate::model::{Cause, Run};
use mission::{EventKind, event::TetherAlarm};
use positioning::{Exclusion, Fix, FixError};

impl Run {
    /// Updates the figures of the alarms from an event.
    pub(super) fn read_figures(&mut self, kind: &EventKind) {
        match kind {
            EventKind::Estimated { .. } | EventKind::PositionLost { .. } => self.read_error(kind),
            EventKind::Fixed { fix } => self.read_fix(fix),
            EventKind::FixFailed { error, .. } => self.read_failure(error),
            EventKind::RangesInconsistent { chi2, degrees_of_freedom } => {
                self.alarms.read(&Cause::Contradiction, || chi_squared(*chi2, *degrees_of_freedom));
            }
            EventKind::StationRejected { station, reason } => {
                self.alarms.read(&Cause::Station(*station), || residual(reason));
            }
            EventKind::TetherAlarmRaised { alarm, .. } => {
                if let Some(reading) = of_tether(alarm) {
                    self.alarms.read(&Cause::Tether(alarm.word().to_owned()), || reading);
                }
            }
            EventKind::Tethered { .. } => self.read_tether(),
            _ => {}
        }
    }

    fn read_error(&mut self, kind: &EventKind) {
        let limit_m = self.about.as_ref().map(|about| about.mission.position_limit_m);
        let (error_m, limit_m) = match kind {
            EventKind::PositionLost { error_m, limit_m } => (*error_m, Some(*limit_m)),
            _ => (self.position.error_m().unwrap_or(f64::NAN), limit_m),
        };
        let metres = |m: f64| format!("±{m:.2} m");
        self.alarms.read(&Cause::PositionLost, || Reading {
            now: metres(error_m),
            limit: limit_m.map(metres).unwrap_or_default(),
        });
    }

    fn read_fix(&mut self, fix: &Fix) {
        self.alarms.read(&Cause::Contradiction, || chi_squared(fix.chi2, fix.degrees_of_freedom));
        for (station, reason) in &fix.excluded {
            self.alarms.read(&Cause::Station(*station), || residual(reason));
        }
    }

    fn read_failure(&mut self, error: &FixError) {
        if let FixError::Inconsistent { chi2, degrees_of_freedom } = error {
            self.alarms.read(&Cause::Contradiction, || chi_squared(*chi2, *degrees_of_freedom));
        }
        if let FixError::TooFewStations { have, need } = error {
            let ranges = |n: &usize| format!("{n} range{}", if *n == 1 { "" } else { "s" });
            self.alarms.read(&Cause::NoFix, || Reading { now: ranges(have), limit: ranges(need) });
        }
    }

    fn read_tether(&mut self) {
        let Some(tether) = &self.tether else { return };
        let Some(config) = self.about.as_ref().and_then(|about| about.mission.tether.as_ref()) else {
            return;
        };
        let (out_m, total_rad) = (tether.length_m, tether.wrap_total_rad);
        let limits = config.limits;
        let reel = TetherAlarm::Reel { out_m, reel_length_m: limits.reel_length_m };
        let total = TetherAlarm::WrapTotal { sum_rad: total_rad, limit_rad: limits.wrap_total_max_rad };
        for alarm in [reel, total] {
            let cause = Cause::Tether(alarm.word().to_owned());
            self.alarms.read(&cause, || of_tether(&alarm).unwrap_or_default());
        }
    }
}

fn chi_squared(chi2: f64, degrees_of_freedom: u32) -> Reading {
    let limit = match degrees_of_freedom {
        0 => String::new(),
        n => format!("{:.1}", positioning::alarm_limit(n)),
    };
    Reading { now: format!("χ² {chi2:.0}"), limit }
}

fn residual(reason: &Exclusion) -> Reading {
    match reason {
        Exclusion::Silent => Reading { now: "not heard".into(), limit: String::new() },
        Exclusion::ByOrder => Reading { now: "excluded".into(), limit: String::new() },
        Exclusion::Impossible { range_m, most_m } => {
            Reading { now: format!("{range_m:.1} m"), limit: format!("{most_m:.1} m") }
        }
        Exclusion::Residual { residual_m, gate_m } => {
            Reading { now: format!("{residual_m:+.2} m"), limit: format!("{gate_m:.2} m") }
        }
    }
}

fn of_tether(alarm: &TetherAlarm) -> Option<Reading> {
    let metres =
        |now: f64, limit: f64| Reading { now: format!("{now:.1} m"), limit: format!("{limit:.1} m") };
    let degrees = |now: f64, limit: f64| Reading {
        now: format!("{:.0}°", now.to_degrees()),
        limit: format!("{:.0}°", limit.to_degrees()),
    };
    match alarm {
        TetherAlarm::Reel { out_m, reel_length_m } => Some(metres(*out_m, *reel_length_m)),
        TetherAlarm::Wrap { wrap_rad, limit_rad, .. } => Some(degrees(*wrap_rad, *limit_rad)),
        TetherAlarm::WrapTotal { sum_rad, limit_rad } => Some(degrees(*sum_rad, *limit_rad)),
        TetherAlarm::Snag { paid_out_m, explained_m } => Some(metres(*paid_out_m, *explained_m)),
        TetherAlarm::NoReturnPath | TetherAlarm::Strayed => None,
    }
}
