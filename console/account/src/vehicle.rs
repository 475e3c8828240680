//! The record of a real vehicle: its link and its stops.

use ::vehicle::port::{LinkSeen, LinkState, Notice, VehicleInfo};
use mission::EventKind;
use serde::{Deserialize, Serialize};

/// Maximum number of other vehicles that are kept.
const MOST_OTHERS: usize = 4;

/// The record of a real vehicle in a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct VehicleRecord {
    /// Name of the vehicle.
    pub name: String,
    /// The address at which the console reached its adapter.
    pub at: String,
    /// Number of readings that arrived.
    pub heard: u64,
    /// Whether the journal ends before the last figures of the link. `heard` then also counts the later ticks with
    /// readings, and all numbers of messages are minima.
    #[serde(default)]
    pub at_least: bool,
    /// Number of readings that are missing according to the sequence numbers.
    pub missed: u64,
    /// Number of faulty messages.
    pub faulty: u64,
    /// Age that 99 % of the readings did not exceed on arrival, seconds.
    pub age_p99_s: Option<f64>,
    /// Number of times that the link was lost or closed.
    pub lost: u64,
    /// Number of stops that the odometry confirmed.
    pub stops: u64,
    /// Longest time from a command to stand still until the odometry confirmed the stop, seconds; absent without stops.
    pub stop_max_s: Option<f64>,
    /// Number of times that the odometry did not confirm a stop in time.
    pub stops_not_confirmed: u64,
    /// Time for which the motion is unknown because odometry was lost, seconds.
    #[serde(default)]
    pub unmeasured_s: f64,
    /// Whether the last commanded stop is confirmed; absent if the vehicle was driven last, or nothing is known.
    #[serde(default)]
    pub stands: Option<bool>,
    /// The first faulty message: its field and its fault; absent without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fault_first: Option<String>,
    /// The last faulty message.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fault_last: Option<String>,
    /// Other vehicles that answered on the same connection, each with the differences in its description, at most 4.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub others: Vec<String>,
    /// The rate of the vehicle's clock, if it differed from the console's by more than 1 %; of several such rates, the last
    /// one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clock_rate: Option<f64>,
    /// Time for which the console itself was stopped, seconds.
    #[serde(default)]
    pub console_stopped_s: f64,
    #[serde(skip)]
    is_heard: bool,
}

impl VehicleRecord {
    pub(crate) fn new(info: &VehicleInfo) -> Self {
        Self { name: info.name.clone(), at: info.at.clone(), is_heard: true, ..Self::default() }
    }

    pub(crate) fn apply(&mut self, event: &EventKind) {
        match event {
            EventKind::Link(LinkSeen {
                state,
                age_p99_s,
                heard,
                missed,
                faulty,
                unmeasured_s,
                console_stopped_s,
                ..
            }) => {
                (self.unmeasured_s, self.console_stopped_s) = (*unmeasured_s, *console_stopped_s);
                (self.heard, self.missed, self.faulty) = (*heard, *missed, *faulty);
                self.at_least = false;
                self.age_p99_s = age_p99_s.or(self.age_p99_s);
                let is_lost = matches!(state, LinkState::Lost | LinkState::Closed);
                self.lost += u64::from(is_lost && self.is_heard);
                self.is_heard = !is_lost;
            }
            EventKind::Noticed(notice) => self.notice(notice),
            EventKind::Sensed { .. } => {
                self.heard += 1;
                self.at_least = true;
            }
            EventKind::Sent { drive: Some(_), .. } => self.stands = None,
            EventKind::Stood { confirmed: true, after_s, .. } => {
                self.stands = Some(true);
                self.stops += 1;
                self.stop_max_s = Some(self.stop_max_s.map_or(*after_s, |most| most.max(*after_s)));
            }
            EventKind::Stood { confirmed: false, .. } => {
                self.stands = Some(false);
                self.stops_not_confirmed += 1;
            }
            _ => {}
        }
    }

    fn notice(&mut self, notice: &Notice) {
        match notice {
            Notice::OtherVehicle { vehicle, differs } => {
                let other = format!("{} ({})", vehicle.name, differs.join(", "));
                if self.others.len() < MOST_OTHERS && !self.others.contains(&other) {
                    self.others.push(other);
                }
            }
            Notice::FaultyMessages { count, first, last } => {
                self.faulty = *count;
                (self.fault_first, self.fault_last) = (Some(first.clone()), Some(last.clone()));
            }
            Notice::ClockRate { rate, is_off, .. } => {
                self.clock_rate = is_off.then_some(*rate).or(self.clock_rate);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_after_the_last_figures_of_the_link_count() {
        let mut record = VehicleRecord::default();
        let sensed = EventKind::Sensed { source_t_s: 1.0, arrival_t_s: 1.0, readings: Box::default() };
        let figures = |heard| EventKind::Link(LinkSeen { heard, ..LinkSeen::default() });
        for event in [&figures(0), &sensed, &sensed] {
            record.apply(event);
        }
        assert_eq!((record.heard, record.at_least), (2, true));
        record.apply(&figures(5));
        assert_eq!((record.heard, record.at_least), (5, false));
    }
}
