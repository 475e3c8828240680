//! Pulses that the stations exchange while the robot stands still.

use super::{Clock, Sounder, timed_m};
use rand_distr::{Distribution, Exp1};
use world::{PulseSet, Station};

/// How long the robot has stood still, and whether the stations have exchanged pulses since.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Rest {
    since_s: Option<f64>,
    is_tested: bool,
    /// Whether there has been any exchange.
    has_begun: bool,
}

impl Rest {
    /// Whether an exchange is due at a time, seconds: at the first call, and once whenever the robot has stood still for
    /// long enough; in an outage, it waits.
    fn is_due(&mut self, t_s: f64, is_at_rest: bool, least_s: f64, is_out: bool) -> bool {
        if !is_at_rest {
            *self = Self { has_begun: self.has_begun, ..Self::default() };
            return false;
        }
        let since_s = *self.since_s.get_or_insert(t_s);
        let is_due = !is_out && !self.is_tested && (!self.has_begun || t_s - since_s >= least_s);
        self.is_tested |= is_due;
        self.has_begun |= is_due;
        is_due
    }
}

/// A station, and the length by which its clock is late, metres.
type Late<'a> = (&'a Station, f64);

impl Sounder {
    /// The pulses that end at time `t_s`, seconds: each station sends, and all others hear. Empty if no exchange is due.
    ///
    /// A fault of a station delays its clock: it hears late, and its pulses seem to arrive early. A silent station neither
    /// sends nor hears.
    pub(crate) fn due_pulses(&mut self, t_s: f64, is_at_rest: bool) -> Vec<PulseSet> {
        let Some(least_s) = self.config.pulse_rest_s else { return Vec::new() };
        let is_out = self.config.outages_s.iter().any(|(from, to)| (*from..*to).contains(&t_s));
        if !self.rest.is_due(t_s, is_at_rest, least_s, is_out) {
            return Vec::new();
        }
        let (stations, clocks) = (self.stations.clone(), self.clocks.clone());
        let ends: Vec<Late<'_>> = stations
            .iter()
            .zip(clocks)
            .filter_map(|(station, clock)| Some((station, self.late_m(station, clock, t_s)?)))
            .collect();
        let mut all = Vec::new();
        for sender in &ends {
            for receiver in ends.iter().filter(|receiver| receiver.0.id != sender.0.id) {
                all.extend(self.pulses(*sender, *receiver));
            }
        }
        all
    }

    /// The length by which the clock of a station is late, metres; `None` for a silent station.
    fn late_m(&self, station: &Station, clock: Clock, t_s: f64) -> Option<f64> {
        let faults = self.config.disturbances.faults.iter();
        let mut present =
            faults.filter(|fault| fault.station == station.id && (fault.from_s..fault.to_s).contains(&t_s));
        present.try_fold(clock.late_m(t_s), |late_m, fault| Some(late_m + fault.excess_range_m?))
    }

    /// The pulses from one station to another; `None` if the sound does not get there.
    fn pulses(&mut self, (from, sent_m): Late<'_>, (to, heard_m): Late<'_>) -> Option<PulseSet> {
        let Self { config, propagation, streams, .. } = self;
        let (what, rng) = (&config.disturbances, &mut streams.pulses);
        let path = propagation.path(from.position, to.position, what.behind_columns)?;
        let delay: f64 = if path.is_late { Exp1.sample(rng) } else { 0.0 };
        let scaled_m = path.length_m * (1.0 + what.sound_speed_error_ratio);
        let late_m = what.excess_range_mean_m * delay + heard_m - sent_m;
        let lengths_m = (0..config.repetitions)
            .map(|_| {
                let error_m = scaled_m * config.noise.error_ratio(rng);
                timed_m(config.timing, scaled_m + error_m + late_m, rng)
            })
            .collect();
        Some(PulseSet { sender: from.id, receiver: to.id, lengths_m })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        AeConfig, Clocks, Disturbances, NoiseModel, StationFault,
        config::{BehindColumns, TimingErrors},
    };
    use world::{Boundary, Point, StationId, World};

    fn sounder(pulse_rest_s: Option<f64>, disturbances: Disturbances) -> Sounder {
        let config = AeConfig {
            period_s: 1.0,
            repetitions: 2,
            noise: NoiseModel::None,
            timing: TimingErrors::default(),
            clocks: Clocks { is_emission_unknown: true, offset_sigma_m: 3.0, drift_sigma_m_per_h: 0.0 },
            pulse_rest_s,
            dropout_probability: 0.0,
            outages_s: vec![(100.0, 200.0)],
            disturbances,
        };
        let station = |id: u32| Station {
            id: StationId(id),
            name: format!("S{id}"),
            position: Point::new(f64::from(id), 5.0 - f64::from(id * id)),
        };
        let world = World {
            boundary: Boundary::Circle { radius_m: 10.0 },
            obstacles: vec![],
            stations: (1..=3).map(station).collect(),
            zones: vec![],
        };
        Sounder::new(config, &world, 3)
    }

    #[test]
    fn stations_exchange_pulses_at_the_start_and_once_in_every_rest() {
        let mut sounder = sounder(Some(5.0), Disturbances::default());
        let due: Vec<u32> = (0..60u32)
            .filter(|t_s| {
                let is_at_rest = !(10..20).contains(t_s) && *t_s != 30;
                !sounder.due_pulses(f64::from(*t_s), is_at_rest).is_empty()
            })
            .collect();
        assert_eq!(due, [0, 25, 36]);
        assert!(sounder.due_pulses(105.0, false).is_empty());
        let after: Vec<u32> =
            (106..220u32).filter(|t_s| !sounder.due_pulses(f64::from(*t_s), true).is_empty()).collect();
        assert_eq!(after, [200], "an outage ends at 200 s");
    }

    #[test]
    fn without_the_key_no_station_sends() {
        let mut sounder = sounder(None, Disturbances::default());
        assert!((0..60).all(|t_s| sounder.due_pulses(f64::from(t_s), true).is_empty()));
    }

    #[test]
    fn a_pulse_shows_the_difference_of_two_clocks_and_both_directions_the_distance() {
        let slow = Disturbances { sound_speed_error_ratio: 0.02, ..Disturbances::default() };
        let mut sounder = sounder(Some(5.0), slow);
        let (stations, clocks) = (sounder.stations.clone(), sounder.clocks.clone());
        let sets = sounder.due_pulses(0.0, true);
        assert_eq!(sets.len(), 6);
        for set in sets {
            let index = |id: StationId| id.0 as usize - 1;
            let [from, to] = [set.sender, set.receiver].map(index);
            let way_m = (stations[from].position - stations[to].position).norm();
            let expected_m = 1.02 * way_m + clocks[to].offset_m - clocks[from].offset_m;
            assert!(set.lengths_m.len() == 2, "{set:?}");
            assert!(set.lengths_m.iter().all(|m| (m - expected_m).abs() < 1e-9), "{set:?}: {expected_m}");
        }
    }

    #[test]
    fn a_silent_station_takes_no_part_and_a_late_one_delays_its_clock() {
        let fault = |excess_range_m| {
            let fault = StationFault { station: StationId(2), from_s: 0.0, to_s: 9.0, excess_range_m };
            Disturbances {
                faults: vec![fault],
                behind_columns: BehindColumns::Heard,
                ..Disturbances::default()
            }
        };
        let silent = sounder(Some(5.0), fault(None)).due_pulses(0.0, true);
        assert_eq!(silent.len(), 2);
        assert!(silent.iter().all(|set| set.sender != StationId(2) && set.receiver != StationId(2)));
        let sound = sounder(Some(5.0), Disturbances::default()).due_pulses(0.0, true);
        let late = sounder(Some(5.0), fault(Some(0.5))).due_pulses(0.0, true);
        for (before, after) in sound.iter().zip(&late) {
            let by_m = after.lengths_m[0] - before.lengths_m[0];
            let expected_m = match (after.sender.0, after.receiver.0) {
                (2, _) => -0.5,
                (_, 2) => 0.5,
                _ => 0.0,
            };
            assert!((by_m - expected_m).abs() < 1e-9, "{after:?}: {by_m}");
        }
    }
}
