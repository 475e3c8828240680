//! The facts about a vehicle that are reported when they change.

use vehicle::{
    link::is_off,
    port::{Notice, VehicleInfo},
};

/// Interval at which further faulty messages are reported, seconds.
const FAULTS_EVERY_S: f64 = 10.0;
/// Steps per unit to which a rate is rounded.
const RATE_STEPS: f64 = 1e4;

/// What is known about the vehicle, and what has been reported.
#[derive(Debug, Default)]
pub(super) struct Notices {
    /// Number of faulty messages, the fault of the first one and that of the last one.
    faults: (u64, String, String),
    /// Number of faulty messages in the last report, and its time, seconds.
    told: (u64, f64),
    other: Option<Notice>,
    /// The field of the clock that was last reported because its rate is off.
    off: Option<&'static str>,
}

impl Notices {
    pub(super) fn faulty(&mut self, fault: &str) {
        let (count, first, last) = &mut self.faults;
        *count += 1;
        if first.is_empty() {
            fault.clone_into(first);
        }
        fault.clone_into(last);
    }

    /// The number of faulty messages.
    pub(super) fn faults(&self) -> u64 {
        self.faults.0
    }

    /// The last faulty message; empty without one.
    pub(super) fn last_fault(&self) -> &str {
        &self.faults.2
    }

    pub(super) fn other_vehicle(&mut self, vehicle: VehicleInfo, differs: Vec<String>) {
        self.other = Some(Notice::OtherVehicle { vehicle: Box::new(vehicle), differs });
    }

    /// The reports that are due. `is_last`: nothing is reported later.
    pub(super) fn due(
        &mut self,
        rate: Option<(&'static str, f64)>,
        now_s: f64,
        is_last: bool,
    ) -> Vec<Notice> {
        let other = self.other.take();
        other
            .into_iter()
            .chain(self.due_faults(now_s, is_last))
            .chain(rate.and_then(|rate| self.due_rate(rate)))
            .collect()
    }

    fn due_faults(&mut self, now_s: f64, is_last: bool) -> Option<Notice> {
        let (count, first, last) = &self.faults;
        let (told, told_s) = self.told;
        let is_due = is_last || told == 0 || now_s - told_s >= FAULTS_EVERY_S;
        if *count == told || !is_due {
            return None;
        }
        self.told = (*count, now_s);
        Some(Notice::FaultyMessages { count: *count, first: first.clone(), last: last.clone() })
    }

    fn due_rate(&mut self, (field, rate): (&'static str, f64)) -> Option<Notice> {
        let off = is_off(rate).then_some(field);
        let before = std::mem::replace(&mut self.off, off);
        let rate = (rate * RATE_STEPS).round() / RATE_STEPS;
        (off != before).then(|| Notice::ClockRate {
            field: off.or(before).unwrap_or(field).into(),
            rate,
            is_off: off.is_some(),
        })
    }
}
