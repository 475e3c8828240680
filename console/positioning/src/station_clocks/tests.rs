#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::{
    Guard, Positioner, PositionerConfig, Pulse, RangeNoise, Risk, SolverKind, Timing,
    draws::{Draws, ring},
};
use proptest::prelude::*;
use world::{Boundary, Odometry, Pose, RangeSet};

const SIGMA_M: f64 = 0.05;
const RADIUS_M: f64 = 10.0;
const TICKS_PER_CYCLE: u32 = 10;
/// The robot drives a wide circle in the tank.
const STEP: Odometry = Odometry { forward_m: 0.04, sideways_m: 0.0, turn_rad: 0.007 };

/// A robot with stations whose clocks are not common.
struct Run {
    config: PositionerConfig,
    whole: Positioner,
    guard: Guard,
    at: Pose,
    offsets_m: Vec<f64>,
    drifts_m: Vec<f64>,
    ticks: u32,
    draws: Draws,
}

impl Run {
    fn new(n: u32, seed: u64) -> Self {
        let at = Pose::new(5.5, -1.0, std::f64::consts::FRAC_PI_2);
        let mut draws = Draws::new(0.0, 1, seed);
        let clocks = ClockConfig { offset_sigma_m: 3.0, drift_sigma_m_per_tick: 1e-4 };
        let config = PositionerConfig {
            solver: SolverKind::Differences,
            noise: RangeNoise::Gaussian { sigma_ratio: 1e-6 },
            timing: Timing { jitter_m: SIGMA_M, resolution_m: 0.0 },
            clocks: Some(clocks),
            ..PositionerConfig::new(ring(n, RADIUS_M), at)
        };
        let off = Vector::new(draws.bell(), draws.bell()) * config.start_sigma_m;
        let mut draw = |sigma: f64| (0..n).map(|_| sigma * draws.bell()).collect::<Vec<f64>>();
        Self {
            whole: Positioner::new(config.clone()),
            guard: Guard::new(&config, Risk::default()),
            at: Pose { position: at.position + off, ..at },
            offsets_m: draw(clocks.offset_sigma_m),
            drifts_m: draw(clocks.drift_sigma_m_per_tick),
            ticks: 0,
            config,
            draws,
        }
    }

    fn drive(&mut self) {
        for _ in 0..TICKS_PER_CYCLE {
            let (sin, cos) = (self.at.heading_rad + STEP.turn_rad / 2.0).sin_cos();
            self.at.position += Vector::new(cos, sin) * STEP.forward_m;
            self.at.heading_rad += STEP.turn_rad;
            let measured = Odometry { forward_m: STEP.forward_m * (1.02 + 0.02 * self.draws.bell()), ..STEP };
            self.whole.predict(&measured);
            self.guard.predict(&measured);
            self.ticks += 1;
        }
    }

    /// The offsets at present, relative to their mean, metres.
    fn offsets_m(&self) -> Vec<f64> {
        let ticks = f64::from(self.ticks);
        let all: Vec<f64> = self.offsets_m.iter().zip(&self.drifts_m).map(|(o, d)| o + d * ticks).collect();
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        all.iter().map(|offset_m| offset_m - mean).collect()
    }

    fn sets(&mut self, biases_m: &[f64]) -> Vec<RangeSet> {
        let emitted_m = 100.0 + 40.0 * self.draws.even();
        let offsets_m = self.offsets_m();
        let draws = &mut self.draws;
        let set = |(index, station): (usize, &Station)| {
            let distance_m = (self.at.position - station.position).norm();
            let bias_m = biases_m.get(index).copied().unwrap_or(0.0);
            let range_m = distance_m + emitted_m + offsets_m[index] + bias_m + SIGMA_M * draws.bell();
            RangeSet { station: station.id, ranges_m: vec![range_m] }
        };
        self.config.stations.iter().enumerate().map(set).collect()
    }

    fn hear(&mut self, sets: &[RangeSet]) {
        let result = self.whole.cycle(sets);
        self.guard.cycle(sets, &result.fix, None);
    }

    fn cycle(&mut self, biases_m: &[f64]) {
        self.drive();
        let sets = self.sets(biases_m);
        self.hear(&sets);
    }

    fn error_m(&self) -> f64 {
        (self.whole.estimate().pose.position - self.at.position).norm()
    }
}

/// Not won by a wide covariance: the errors and the stated standard deviations have limits, too.
#[test]
fn offsets_and_drifts_are_found_and_the_pose_is_as_accurate_as_stated() {
    for n in [5, 6, 8] {
        let (mut inside, mut all, mut errors_m) = (0, 0, Vec::new());
        for seed in 0..6 {
            let mut run = Run::new(n, 70 + seed);
            for cycle in 0..400 {
                run.cycle(&[]);
                inside += u32::from(run.error_m() <= run.whole.error_95_m());
                all += 1;
                if cycle >= 200 {
                    errors_m.push(run.error_m());
                }
            }
            let found: Vec<Estimated> = run.whole.clocks().unwrap().offsets_m().map(|(_, o)| o).collect();
            for (found, true_m) in found.iter().zip(run.offsets_m()) {
                let off_m = (found.value - true_m).abs();
                assert!(off_m < 4.5 * found.sigma && found.sigma < 0.05, "{n}, {seed}: {found:?}, {true_m}");
            }
        }
        errors_m.sort_by(f64::total_cmp);
        let p95_m = errors_m[errors_m.len() * 95 / 100];
        assert!(f64::from(inside) / f64::from(all) > 0.9, "{n} stations: {inside} of {all} inside");
        assert!(p95_m < 0.1, "{n} stations: {p95_m} m");
    }
}

#[test]
fn the_level_contains_the_error_while_the_clock_of_one_station_jumps_and_runs_away() {
    for n in [5, 6, 8] {
        let mut levels_m = Vec::new();
        for seed in 0..4 {
            let mut run = Run::new(n, 900 + seed);
            for cycle in 0..300_u32 {
                let after = f64::from(cycle.saturating_sub(100));
                let late_m = if after > 0.0 { 0.3 + 0.01 * after } else { 0.0 };
                run.cycle(&[0.0, late_m]);
                let Ok(level_m) = run.guard.level_m(&run.whole) else { continue };
                assert!(
                    run.error_m() < level_m,
                    "{n}, {seed}, cycle {cycle}: {} m, {level_m} m",
                    run.error_m()
                );
                if cycle < 100 {
                    levels_m.push(level_m);
                }
            }
        }
        levels_m.sort_by(f64::total_cmp);
        assert!(levels_m.len() > 390, "{n} stations: {} of 400 protected", levels_m.len());
        assert!(levels_m[200] < 1.5, "{n} stations: {} m", levels_m[200]);
    }
}

#[test]
fn four_stations_without_a_time_of_emission_protect_nothing() {
    let mut run = Run::new(4, 5);
    for _ in 0..5 {
        run.cycle(&[]);
    }
    assert_eq!(run.guard.level_m(&run.whole), Err(crate::Unprotected::TooFewStations));
}

/// The ranges that a run receives.
type Input<'a> = &'a dyn Fn(&Run) -> Vec<RangeSet>;

#[test]
fn absurd_input_stays_finite_and_sound_ranges_recover() {
    let absurd: [Input<'_>; 4] = [
        &|_| Vec::new(),
        &|run| run.config.stations.iter().map(|s| RangeSet { station: s.id, ranges_m: vec![1e6] }).collect(),
        &|run| vec![RangeSet { station: run.config.stations[0].id, ranges_m: vec![3.0; 1_000] }],
        &|run| {
            let far = |s: &Station| RangeSet { station: s.id, ranges_m: vec![1.0 + 1e5 * f64::from(s.id.0)] };
            run.config.stations.iter().map(far).collect()
        },
    ];
    for (index, input) in absurd.iter().enumerate() {
        let mut run = Run::new(6, 8);
        for _ in 0..60 {
            run.cycle(&[]);
        }
        for _ in 0..60 {
            run.drive();
            let sets = input(&run);
            run.hear(&sets);
            let clocks = run.whole.clocks().unwrap();
            assert!(clocks.offsets_m().all(|(_, o)| o.value.is_finite() && o.sigma.is_finite()), "{index}");
            assert!(run.whole.error_95_m().is_finite(), "{index}");
        }
        for _ in 0..60 {
            run.cycle(&[]);
        }
        let level_m = run.guard.level_m(&run.whole).unwrap();
        assert!(run.error_m() < level_m && run.error_m() < 0.4, "{index}: {} m, {level_m} m", run.error_m());
    }
}

/// Pulses between all stations of a run, with errors of one standard deviation.
fn exchange(run: &mut Run, scale: f64) -> PulseTest {
    let (stations, offsets_m) = (run.config.stations.clone(), run.offsets_m());
    let mut pulses = Vec::new();
    for (from, sender) in stations.iter().enumerate() {
        for (to, receiver) in stations.iter().enumerate().filter(|(to, _)| *to != from) {
            let way_m = (1.0 + scale) * (sender.position - receiver.position).norm();
            let length_m = way_m + offsets_m[to] - offsets_m[from] + SIGMA_M * run.draws.bell();
            pulses.push(Pulse { sender: sender.id, receiver: receiver.id, length_m, sigma_m: SIGMA_M });
        }
    }
    PulseTest::new(&pulses, &stations).unwrap()
}

#[test]
fn a_pulse_test_sets_the_clocks_before_the_first_range_and_after_all_of_them_have_jumped() {
    let mut run = Run::new(6, 12);
    for jumps in [false, true] {
        if jumps {
            (0..50).for_each(|_| run.cycle(&[]));
            let jumped: Vec<f64> = run.offsets_m.iter().map(|offset_m| offset_m + run.draws.bell()).collect();
            run.offsets_m = jumped;
        }
        let test = exchange(&mut run, 0.0);
        run.whole.take_pulses(&test);
        let found: Vec<Estimated> = run.whole.clocks().unwrap().offsets_m().map(|(_, o)| o).collect();
        for (found, true_m) in found.iter().zip(run.offsets_m()) {
            let off_m = (found.value - true_m).abs();
            assert!(off_m < 4.5 * found.sigma && found.sigma < 0.04, "{jumps}: {found:?}, {true_m}");
        }
    }
    // The next ranges fit.
    run.cycle(&[]);
    assert!(run.error_m() < 0.3, "{} m", run.error_m());
}

proptest! {
    #[test]
    fn a_length_that_all_ranges_share_changes_nothing(common_m in 0.0..500.0f64, seed in 0..50u64) {
        let mut run = Run::new(5, seed);
        run.drive();
        let sets = run.sets(&[]);
        let heard = |common_m: f64| -> Vec<Ranging> {
            let one = |set: &RangeSet| Ranging {
                timing_sigma_m: SIGMA_M,
                ..Ranging::single(set.station, set.ranges_m[0] + common_m, SIGMA_M)
            };
            sets.iter().map(one).collect()
        };
        let mut both = [0.0, common_m].map(|common_m| {
            let mut clocks = run.whole.clocks().unwrap().clone();
            clocks.take(&heard(common_m));
            clocks
        });
        let [a, b] = &mut both;
        for ((_, a), (_, b)) in a.offsets_m().zip(b.offsets_m()) {
            prop_assert!((a.value - b.value).abs() < 1e-6 && (a.sigma - b.sigma).abs() < 1e-9);
        }
    }
}

/// Differences between clocks that are larger than the tank do not make ranges impossible.
#[test]
fn clocks_that_are_20_m_apart_cost_no_station_inside_a_wall() {
    for seed in 0..10 {
        let mut run = Run::new(6, 9_100 + seed);
        run.offsets_m.iter_mut().for_each(|offset_m| *offset_m *= 20.0 / 3.0);
        run.config.clocks = Some(ClockConfig { offset_sigma_m: 20.0, drift_sigma_m_per_tick: 1e-4 });
        run.config.boundary = Some(Boundary::Circle { radius_m: RADIUS_M });
        (run.whole, run.guard) =
            (Positioner::new(run.config.clone()), Guard::new(&run.config, Risk::default()));
        for _ in 0..100 {
            run.drive();
            let sets = run.sets(&[]);
            let result = run.whole.cycle(&sets);
            assert!(result.impossible.is_empty() && result.fix.is_ok(), "{seed}: {result:?}");
        }
        assert!(run.error_m() < 0.3, "{seed}: {}", run.error_m());
    }
}
