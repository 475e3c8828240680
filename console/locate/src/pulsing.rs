//! Collects the pulses of stations in a file, test by test.

use crate::{
    columns::{Heard, Sent},
    moments::Moment,
    repeats::{Scatter, lengths},
};
use mission::event::PulsePhase;
use positioning::{Pulse, PulseError, PulseSeries, PulseTest, Repetitions, repetitions::mean_m};
use std::collections::BTreeMap;
use world::{Station, StationId};

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

    /// Evaluates all tests. `sigma_m` gives the standard deviation of a single range at a distance, metres, and `scatter`
    /// the part of it that repetitions show.
    ///
    /// # Errors
    /// The phase and the reason of a test that gives no result.
    pub(crate) fn tests(
        &self,
        stations: &[Station],
        (sigma_m, scatter): (impl Fn(f64) -> f64, &Scatter),
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
            let pulses: Vec<Pulse> = group.counted(scatter).iter().map(pulse).collect();
            let found = PulseTest::new(&pulses, stations);
            found.map(|test| Pulsed { phase, t_s: group.t_s, test }).map_err(|error| (phase, error))
        };
        self.groups.iter().enumerate().map(evaluated).collect()
    }
}

impl Group {
    /// The pulses that count. Repetitions of a pulse that scatter too little to be independent count as one.
    fn counted(&self, scatter: &Scatter) -> Vec<Sent> {
        let mut by_pair: BTreeMap<(StationId, StationId), Vec<Heard>> = BTreeMap::new();
        for sent in &self.pulses {
            by_pair.entry((sent.sender, sent.heard.station)).or_default().push(sent.heard);
        }
        let mut pooled = Repetitions::default();
        for heard in by_pair.values().map(|heard| lengths(heard)) {
            let variance_m2 = mean_m(&heard).map_or(0.0, |mean_m| scatter.variance_m2(mean_m));
            pooled.take(&heard, variance_m2);
        }
        if !pooled.are_narrow() {
            return self.pulses.clone();
        }
        let one = |((sender, station), heard): (&(StationId, StationId), &Vec<Heard>)| {
            let repetitions = heard.iter().map(|one| one.repetitions).max()?;
            let heard = Heard { station: *station, range_m: mean_m(&lengths(heard))?, repetitions };
            Some(Sent { sender: *sender, heard })
        };
        by_pair.iter().filter_map(one).collect()
    }
}

/// The corrections that tests give; a test that contradicts the survey gives none.
pub(crate) fn series(tests: &[Pulsed]) -> PulseSeries {
    let usable = tests.iter().filter(|pulsed| pulsed.test.is_usable());
    PulseSeries { tests: usable.map(|pulsed| (pulsed.t_s, pulsed.test.clone())).collect() }
}
