//! Acoustic-emission ranging: the timing of the cycles, and the ranges that they give.

mod path;
mod pulses;

use crate::{
    config::{AeConfig, StationFault, TimingErrors},
    random::{RandomStreams, normal, reported_m},
};
use path::Propagation;
use pulses::Rest;
use rand::RngExt;
use rand_distr::{Distribution, Exp1};
use rand_pcg::Pcg64;
use world::{Point, RangeSet, Station, StationId, Vector, World};

/// Tolerance for deciding whether the time is a multiple of the period, as a share of the period.
const SLACK: f64 = 1e-6;

/// The shortest and the longest delay of an emission whose time is unknown, as a length that sound travels, metres. The
/// delay exceeds any offset of a clock, so that every range is positive.
const EMISSION_DELAY_M: [f64; 2] = [150.0, 250.0];

/// The stations of a tank at their true positions, and the random errors of their ranges.
///
/// The same configuration, tank, seed and positions produce the same ranges on every machine.
#[derive(Clone)]
pub struct Sounder {
    config: AeConfig,
    /// The stations at their true positions.
    stations: Vec<Station>,
    /// The clock of each station.
    clocks: Vec<Clock>,
    propagation: Propagation,
    streams: RandomStreams,
    ended: f64,
    rest: Rest,
}

/// The error of a station's clock, as a length that sound travels.
#[derive(Debug, Clone, Copy)]
struct Clock {
    offset_m: f64,
    drift_m_per_h: f64,
}

impl Clock {
    fn late_m(self, t_s: f64) -> f64 {
        self.offset_m + self.drift_m_per_h * t_s / 3600.0
    }
}

impl Sounder {
    /// Creates the stations of `world`, moved to their true positions by the survey error in `config`.
    pub fn new(config: AeConfig, world: &World, seed: u64) -> Self {
        let mut streams = RandomStreams::new(seed);
        let mut stations = world.stations.clone();
        for station in &mut stations {
            let error = Vector::new(normal(&mut streams.survey), normal(&mut streams.survey));
            station.position += error * config.disturbances.survey_sigma_m;
        }
        let clock = |_: &Station| Clock {
            offset_m: config.clocks.offset_sigma_m * normal(&mut streams.clocks),
            drift_m_per_h: config.clocks.drift_sigma_m_per_h * normal(&mut streams.clocks),
        };
        let clocks = stations.iter().map(clock).collect();
        let propagation = Propagation::new(world);
        Self { config, stations, clocks, propagation, streams, ended: 0.0, rest: Rest::default() }
    }

    /// Sets the clocks of stations: the offset of each and its change in an hour, metres.
    pub(crate) fn set_clocks(&mut self, clocks_m: &[(StationId, f64, f64)]) {
        for (station, clock) in self.stations.iter().zip(&mut self.clocks) {
            if let Some((_, offset_m, drift_m_per_h)) = clocks_m.iter().find(|(id, ..)| *id == station.id) {
                *clock = Clock { offset_m: *offset_m, drift_m_per_h: *drift_m_per_h };
            }
        }
    }

    /// Adds a fault of a station to the faults in the configuration.
    pub(crate) fn inject(&mut self, fault: StationFault) {
        self.config.disturbances.faults.push(fault);
    }

    /// The ranges of a cycle if one ends at time `t_s`; `None` if no cycle ends then, and an empty list if no station was
    /// heard.
    ///
    /// The first cycle ends after one period. If the period is shorter than a tick, there is one cycle in every tick.
    pub(crate) fn due_cycle(&mut self, t_s: f64, truth: Point) -> Option<Vec<RangeSet>> {
        let period_s = self.config.period_s.max(1e-9);
        let cycles = (t_s / period_s + SLACK).floor();
        if cycles <= self.ended {
            return None;
        }
        self.ended = cycles;
        Some(self.cycle(t_s, truth))
    }

    /// The ranges of one cycle that ends at time `t_s`.
    pub fn cycle(&mut self, t_s: f64, truth: Point) -> Vec<RangeSet> {
        let Self { config, stations, clocks, propagation, streams, .. } = self;
        let [least_m, most_m] = EMISSION_DELAY_M;
        let delay_m = if config.clocks.is_emission_unknown {
            streams.clocks.random_range(least_m..most_m)
        } else {
            0.0
        };
        // Random numbers are drawn for every station, whether it is heard or not, so a loss does not change later ranges.
        let mut sets: Vec<RangeSet> = stations
            .iter()
            .zip(clocks)
            .map(|(station, clock)| {
                let late_m = delay_m + clock.late_m(t_s);
                measure(config, propagation, (station, late_m), truth, streams)
            })
            .collect();
        sets.retain(|_| streams.dropout.random::<f64>() >= config.dropout_probability);
        for fault in config.disturbances.faults.iter().filter(|f| (f.from_s..f.to_s).contains(&t_s)) {
            sets.iter_mut()
                .filter(|set| set.station == fault.station)
                .for_each(|set| apply_fault(set, fault));
        }
        sets.retain(|set| !set.ranges_m.is_empty());
        if config.outages_s.iter().any(|(from, to)| (*from..*to).contains(&t_s)) {
            sets.clear();
        }
        sets
    }
}

fn apply_fault(set: &mut RangeSet, fault: &StationFault) {
    match fault.excess_range_m {
        Some(excess_range_m) => {
            set.ranges_m.iter_mut().for_each(|range_m| *range_m = reported_m(*range_m + excess_range_m));
        }
        None => set.ranges_m.clear(),
    }
}

/// The ranges of a station in a cycle, all of which are late by the given length, metres.
fn measure(
    config: &AeConfig,
    propagation: &Propagation,
    (station, late_m): (&Station, f64),
    truth: Point,
    streams: &mut RandomStreams,
) -> RangeSet {
    let what = &config.disturbances;
    let path = propagation.path(truth, station.position, what.behind_columns);
    let is_late =
        streams.disturbance.random::<f64>() < what.nlos_probability || path.is_some_and(|path| path.is_late);
    let excess_range_m = if is_late { what.excess_range_mean_m * exponential(streams) } else { 0.0 };
    let mut ranges_m = Vec::with_capacity(config.repetitions as usize);
    for _ in 0..config.repetitions {
        let mut error = config.noise.error_ratio(&mut streams.ranging);
        if streams.disturbance.random::<f64>() < what.outlier_probability {
            error *= what.outlier_factor;
        }
        let is_ping_late = streams.disturbance.random::<f64>() < what.late_ping_probability;
        let ping_late_m = if is_ping_late { what.excess_range_mean_m * exponential(streams) } else { 0.0 };
        let is_heard = streams.disturbance.random::<f64>() >= what.ping_dropout_probability;
        if let Some(path) = path.filter(|_| is_heard) {
            let scale = 1.0 + what.sound_speed_error_ratio;
            let range_m = path.length_m * (1.0 + error) * scale + excess_range_m + ping_late_m + late_m;
            ranges_m.push(reported_m(timed_m(config.timing, range_m, &mut streams.timing)));
        }
    }
    RangeSet { station: station.id, ranges_m }
}

/// Adds the timing errors to a range, metres.
fn timed_m(timing: TimingErrors, range_m: f64, rng: &mut Pcg64) -> f64 {
    let TimingErrors { jitter_m, resolution_m } = timing;
    let jittered_m = if jitter_m > 0.0 { range_m + jitter_m * normal(rng) } else { range_m };
    if resolution_m > 0.0 { (jittered_m / resolution_m).round() * resolution_m } else { jittered_m }
}

/// An exponentially distributed random number with mean 1.
fn exponential(streams: &mut RandomStreams) -> f64 {
    Exp1.sample(&mut streams.disturbance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BehindColumns, Clocks, Disturbances, NoiseModel};
    use world::{Boundary, Obstacle, ObstacleId, Shape};

    fn config() -> AeConfig {
        AeConfig {
            period_s: 0.3,
            repetitions: 3,
            noise: NoiseModel::Uniform { ratio: 0.05 },
            timing: TimingErrors::default(),
            clocks: Clocks::default(),
            pulse_rest_s: None,
            dropout_probability: 0.0,
            outages_s: vec![],
            disturbances: Disturbances::default(),
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

    fn tank(columns: &[(f64, f64, f64)]) -> World {
        let column = |(id, (x, y, radius_m)): (u32, &(f64, f64, f64))| Obstacle {
            id: ObstacleId(id),
            name: format!("C{id}"),
            shape: Shape::Disc { center: Point::new(*x, *y), radius_m: *radius_m },
            known: true,
        };
        World {
            boundary: Boundary::Circle { radius_m: 10.0 },
            obstacles: (1..).zip(columns).map(column).collect(),
            stations: stations(),
            zones: vec![],
        }
    }

    fn cycles(config: AeConfig) -> Vec<Option<Vec<RangeSet>>> {
        let mut sounder = Sounder::new(config, &tank(&[]), 3);
        (0..31).map(|k| sounder.due_cycle(f64::from(k) * 0.1, Point::origin())).collect()
    }

    /// Ranges that are exact apart from the disturbances, between the origin and stations at (1, 5), (2, 5) and (3, 5).
    fn disturbed(disturbances: Disturbances, columns: &[(f64, f64, f64)]) -> Vec<RangeSet> {
        let config = AeConfig { noise: NoiseModel::None, repetitions: 400, disturbances, ..config() };
        Sounder::new(config, &tank(columns), 5).cycle(1.0, Point::origin())
    }

    fn excess(sets: &[RangeSet], station: u32) -> Vec<f64> {
        let distance = Point::new(f64::from(station), 5.0).coords.norm();
        let of_station = sets.iter().filter(|set| set.station == StationId(station));
        of_station.flat_map(|set| set.ranges_m.iter().map(|r| r - distance)).collect()
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
        let (whole, thinned) = (cycles(config()), cycles(AeConfig { dropout_probability: 0.4, ..config() }));
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

    #[test]
    fn without_disturbances_exact_ranges_are_exact() {
        let sets = disturbed(Disturbances::default(), &[(0.5, 2.5, 0.2)]);
        assert!(excess(&sets, 1).iter().all(|e| e.abs() < 1e-12), "by default, columns do not affect ranges");
    }

    #[test]
    fn a_column_only_ever_makes_ranges_longer() {
        let column = [(0.5, 2.5, 0.2)];
        let with = |behind_columns| {
            let sets = disturbed(
                Disturbances { behind_columns, excess_range_mean_m: 1.0, ..Disturbances::default() },
                &column,
            );
            assert!(excess(&sets, 3).iter().all(|e| e.abs() < 1e-12), "station 3 is in sight");
            excess(&sets, 1)
        };
        let creeping = with(BehindColumns::Creeping);
        assert!(creeping[0] > 1e-4 && creeping[0] < 0.1, "{}", creeping[0]);
        let late = with(BehindColumns::Late);
        assert!(late[0] > 0.0 && late.iter().all(|e| (e - late[0]).abs() < 1e-12), "the whole cycle is late");
        // From the origin, the only echoes travel along the same line, which the column blocks.
        assert!(with(BehindColumns::WallEcho).is_empty());
        assert!(with(BehindColumns::Silent).is_empty());
    }

    #[test]
    fn pings_get_lost_late_and_wild_as_often_as_said() {
        let base = Disturbances { excess_range_mean_m: 1.0, outlier_factor: 10.0, ..Disturbances::default() };
        let lost = disturbed(Disturbances { ping_dropout_probability: 0.3, ..base.clone() }, &[]);
        assert!((250..310).contains(&lost[0].ranges_m.len()), "{}", lost[0].ranges_m.len());
        let late = excess(&disturbed(Disturbances { late_ping_probability: 0.25, ..base.clone() }, &[]), 1);
        let n_late = late.iter().filter(|e| **e > 1e-9).count();
        assert!((70..130).contains(&n_late), "{n_late}");
        assert!((late.iter().sum::<f64>() / n_late as f64 - 1.0).abs() < 0.3);
        let config = AeConfig {
            repetitions: 400,
            disturbances: Disturbances { outlier_probability: 0.1, ..base },
            ..config()
        };
        let wild = excess(&Sounder::new(config, &tank(&[]), 5).cycle(1.0, Point::origin()), 1);
        let n_wild = wild.iter().filter(|e| e.abs() > 0.06 * 5.1).count();
        assert!((20..55).contains(&n_wild), "{n_wild}");
    }

    #[test]
    fn a_hidden_station_is_late_by_the_same_in_all_its_pings() {
        let sets = disturbed(
            Disturbances { nlos_probability: 1.0, excess_range_mean_m: 1.0, ..Disturbances::default() },
            &[],
        );
        let (first, second) = (excess(&sets, 1), excess(&sets, 2));
        assert!(first.iter().all(|e| *e > 0.0 && (e - first[0]).abs() < 1e-12));
        assert!((first[0] - second[0]).abs() > 1e-6, "each station has its own delay");
    }

    #[test]
    fn slow_sound_makes_all_ranges_longer_and_a_bad_survey_moves_the_stations() {
        let slow = disturbed(Disturbances { sound_speed_error_ratio: 0.02, ..Disturbances::default() }, &[]);
        assert!((excess(&slow, 1)[0] - 0.02 * 26.0_f64.sqrt()).abs() < 1e-12);
        let moved = disturbed(Disturbances { survey_sigma_m: 0.1, ..Disturbances::default() }, &[]);
        let errors = [1, 2, 3].map(|station| excess(&moved, station)[0]);
        assert!(errors.iter().all(|e| e.abs() > 1e-6 && e.abs() < 0.5), "{errors:?}");
    }

    #[test]
    fn a_forecast_continues_given_clocks_and_draws_the_others() {
        let clocks = Clocks { offset_sigma_m: 2.0, drift_sigma_m_per_h: 0.5, ..Clocks::default() };
        let config = AeConfig { noise: NoiseModel::None, clocks, repetitions: 1, ..config() };
        let mut sounder = Sounder::new(config, &tank(&[]), 5);
        let before = sounder.cycle(0.0, Point::origin());
        sounder.set_clocks(&[(StationId(2), 0.7, -0.36)]);
        let (now, later) = (sounder.cycle(0.0, Point::origin()), sounder.cycle(100.0, Point::origin()));
        assert!((excess(&now, 2)[0] - 0.7).abs() < 1e-9, "{now:?}");
        assert!((excess(&later, 2)[0] - 0.69).abs() < 1e-9, "{later:?}");
        assert_eq!((excess(&now, 1), excess(&now, 3)), (excess(&before, 1), excess(&before, 3)));
    }

    #[test]
    fn an_unknown_emission_delays_all_ranges_of_a_cycle_by_the_same_and_clocks_drift_apart() {
        let late = |clocks: Clocks, t_s: f64| -> Vec<f64> {
            let config = AeConfig { noise: NoiseModel::None, clocks, repetitions: 1, ..config() };
            let mut sounder = Sounder::new(config, &tank(&[]), 5);
            let sets = sounder.cycle(t_s, Point::origin());
            (1..=3).map(|station| excess(&sets, station)[0]).collect()
        };
        let unknown = Clocks { is_emission_unknown: true, ..Clocks::default() };
        let [first, second] = [1.0, 3_601.0].map(|t_s| late(unknown, t_s));
        assert!(first.iter().all(|m| (150.0..250.0).contains(m) && (m - first[0]).abs() < 1e-9), "{first:?}");
        assert!((first[0] - second[0]).abs() < 1e-9, "the delay depends on the cycle, not on the time");
        let own = Clocks { offset_sigma_m: 2.0, drift_sigma_m_per_h: 0.5, ..unknown };
        let apart = |ranges: &[f64]| ranges[1] - ranges[0];
        let (begin_m, later_m) = (apart(&late(own, 0.0)), apart(&late(own, 3_600.0)));
        assert!(begin_m.abs() > 0.01 && (later_m - begin_m).abs() > 0.01, "{begin_m}, {later_m}");
        let without_drift = Clocks { drift_sigma_m_per_h: 0.0, ..own };
        assert!((apart(&late(without_drift, 3_600.0)) - begin_m).abs() < 1e-9);
    }

    #[test]
    fn a_fault_spoils_one_station_for_its_time() {
        let fault =
            |excess_range_m| StationFault { station: StationId(2), from_s: 0.5, to_s: 1.0, excess_range_m };
        let with = |excess_range_m| {
            let disturbances =
                Disturbances { faults: vec![fault(excess_range_m)], ..Disturbances::default() };
            cycles(AeConfig { disturbances, ..config() })
        };
        let whole = cycles(config());
        let heard = |cycles: &[Option<Vec<RangeSet>>], k: usize| cycles[k].as_ref().map(Vec::len);
        let silent = with(None);
        assert_eq!((heard(&silent, 3), heard(&silent, 6), heard(&silent, 12)), (Some(3), Some(2), Some(3)));
        let late = with(Some(1.5));
        let range = |cycles: &[Option<Vec<RangeSet>>]| cycles[6].as_ref().expect("a cycle")[1].ranges_m[0];
        assert!((range(&late) - range(&whole) - 1.5).abs() < 1e-12);
        assert_eq!(late[12..], whole[12..]);
    }
}
