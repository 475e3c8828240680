//! Acoustic-emission ranging: when a cycle ends and what it brings.

use crate::{chance::Chance, config::AeConfig};
use rand::RngExt;
use world::{Point, RangeSet, Station};

/// Slack when time is compared with a multiple of the period, as a share of the period.
const SLACK: f64 = 1e-6;

/// The ranging of a run; counts the cycles that ended.
#[derive(Debug, Clone)]
pub(crate) struct Ranging {
    config: AeConfig,
    ended: f64,
}

impl Ranging {
    pub fn new(config: AeConfig) -> Self {
        Self { config, ended: 0.0 }
    }

    /// The ranges of a cycle, if one ends at time `t_s`; empty if no station was heard.
    ///
    /// The first cycle ends after one period. A period shorter than a tick means one cycle in every tick.
    pub fn cycle(
        &mut self,
        t_s: f64,
        truth: Point,
        stations: &[Station],
        chance: &mut Chance,
    ) -> Option<Vec<RangeSet>> {
        let period_s = self.config.period_s.max(1e-9);
        let cycles = (t_s / period_s + SLACK).floor();
        if cycles <= self.ended {
            return None;
        }
        self.ended = cycles;
        // The noise is drawn for every station, heard or not, so that a loss leaves all later ranges as they were.
        let mut sets: Vec<RangeSet> = stations.iter().map(|s| self.measure(s, truth, chance)).collect();
        sets.retain(|_| chance.dropout.random::<f64>() >= self.config.dropout);
        if self.is_out(t_s) {
            sets.clear();
        }
        Some(sets)
    }

    fn measure(&self, station: &Station, truth: Point, chance: &mut Chance) -> RangeSet {
        let distance_m = (truth - station.position).norm();
        let noise = &self.config.noise;
        let ranges_m =
            (0..self.config.repetitions).map(|_| noise.measured_m(distance_m, &mut chance.ranging)).collect();
        RangeSet { station: station.id, ranges_m }
    }

    fn is_out(&self, t_s: f64) -> bool {
        self.config.outages_s.iter().any(|(from, to)| (*from..*to).contains(&t_s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::NoiseModel;
    use world::StationId;

    fn config() -> AeConfig {
        AeConfig {
            period_s: 0.3,
            repetitions: 3,
            noise: NoiseModel::Uniform { ratio: 0.05 },
            dropout: 0.0,
            outages_s: vec![],
        }
    }

    fn stations() -> Vec<Station> {
        (1..=3)
            .map(|id| Station {
                id: StationId(id),
                name: format!("S{id}"),
                position: Point::new(f64::from(id), 5.0),
            })
            .collect()
    }

    fn cycles(config: AeConfig) -> Vec<Option<Vec<RangeSet>>> {
        let (mut ranging, mut chance) = (Ranging::new(config), Chance::new(3));
        (0..31)
            .map(|k| ranging.cycle(f64::from(k) * 0.1, Point::origin(), &stations(), &mut chance))
            .collect()
    }

    #[test]
    fn a_cycle_ends_after_every_period() {
        let ends: Vec<usize> =
            cycles(config()).iter().enumerate().filter(|(_, c)| c.is_some()).map(|(k, _)| k).collect();
        assert_eq!(ends, [3, 6, 9, 12, 15, 18, 21, 24, 27, 30]);
    }

    #[test]
    fn an_outage_silences_all_and_changes_nothing_else() {
        let whole = cycles(config());
        let broken = cycles(AeConfig { outages_s: vec![(0.5, 1.0)], ..config() });
        assert_eq!(broken[6], Some(vec![]));
        assert_eq!(broken[9], Some(vec![]));
        assert_eq!(broken[12..], whole[12..]);
    }

    #[test]
    fn dropouts_leave_the_other_ranges_as_they_were() {
        let (whole, thinned) = (cycles(config()), cycles(AeConfig { dropout: 0.4, ..config() }));
        let count = |cycles: &[Option<Vec<RangeSet>>]| cycles.iter().flatten().flatten().count();
        assert_eq!(count(&whole), 30);
        assert!((8..28).contains(&count(&thinned)), "{}", count(&thinned));
        for (a, b) in thinned.iter().zip(&whole) {
            assert!(a.iter().flatten().all(|set| b.iter().flatten().any(|other| other == set)));
        }
    }

    #[test]
    fn a_period_shorter_than_a_tick_gives_one_cycle_a_tick() {
        let all = cycles(AeConfig { period_s: 0.0, ..config() });
        assert!(all[0].is_none() && all[1..].iter().all(Option::is_some));
    }
}
