//! Collects the pulses of stations in a file, test by test.

use crate::{columns::Sent, moments::Moment};
use mission::event::PulsePhase;
use positioning::{Pulse, PulseError, PulseSeries, PulseTest};
use world::Station;

/// A pulse test of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Pulsed {
    /// The part of the run.
    pub phase: PulsePhase,
    /// Time of the last pulse as in the file, seconds.
    pub t_s: f64,
    /// The result.
    pub test: PulseTest,
}

/// The pulses of a file. Pulses without a range of the robot between them belong to one test.
#[derive(Debug, Default)]
pub(crate) struct Pulsing {
    groups: Vec<Group>,
    /// Whether the robot was heard at all, and since the last pulse.
    has_ranged: bool,
    has_ranged_since: bool,
}

#[derive(Debug)]
struct Group {
    is_first: bool,
    t_s: f64,
    pulses: Vec<Sent>,
}

impl Pulsing {
    /// Adds a moment.
    pub(crate) fn take(&mut self, moment: &Moment) {
        if !moment.pulses.is_empty() {
            let is_new = self.groups.is_empty() || self.has_ranged_since;
            if is_new {
                self.groups.push(Group { is_first: !self.has_ranged, t_s: moment.t_s, pulses: Vec::new() });
            }
            if let Some(group) = self.groups.last_mut() {
                group.t_s = moment.t_s;
                group.pulses.extend(&moment.pulses);
            }
            self.has_ranged_since = false;
        }
        if !moment.ranges.is_empty() {
            (self.has_ranged, self.has_ranged_since) = (true, true);
        }
    }

    /// Evaluates all tests. `sigma_m` gives the standard deviation of a single range at a distance, metres.
    ///
    /// # Errors
    /// The phase and the reason of a test that gives no result.
    pub(crate) fn tests(
        &self,
        stations: &[Station],
        sigma_m: impl Fn(f64) -> f64,
    ) -> Result<Vec<Pulsed>, (PulsePhase, PulseError)> {
        let n = self.groups.len();
        let evaluated = |(index, group): (usize, &Group)| {
            let phase = match (group.is_first, index + 1 == n && !self.has_ranged_since) {
                (true, _) => PulsePhase::Before,
                (false, true) => PulsePhase::After,
                (false, false) => PulsePhase::Held,
            };
            let pulse = |sent: &Sent| Pulse {
                sender: sent.sender,
                receiver: sent.heard.station,
                length_m: sent.heard.range_m,
                sigma_m: sigma_m(sent.heard.range_m) / f64::from(sent.heard.repetitions).sqrt(),
            };
            let pulses: Vec<Pulse> = group.pulses.iter().map(pulse).collect();
            let found = PulseTest::new(&pulses, stations);
            found.map(|test| Pulsed { phase, t_s: group.t_s, test }).map_err(|error| (phase, error))
        };
        self.groups.iter().enumerate().map(evaluated).collect()
    }
}

/// The corrections that tests give.
pub(crate) fn series(tests: &[Pulsed]) -> PulseSeries {
    PulseSeries { tests: tests.iter().map(|pulsed| (pulsed.t_s, pulsed.test.clone())).collect() }
}
