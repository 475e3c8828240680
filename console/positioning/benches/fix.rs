//! Measures the time of fixes from 60 ranges, of fixes from eight stations of which some are wrong, of protection
//! levels and the session calibration (with known and unknown times of emission), and of filter steps.

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::Matrix2;
use positioning::{
    Aggregation, Bounded, Calibration, Consensus, Differences, Ekf, FixedLag, LinearLs, MotionNoise, Near,
    Nls, Particles, ParticlesConfig, PositionSolver, Positioner, PositionerConfig, RangeNoise, Risk,
    Screened, SessionCalibration, SessionConfig, Timing, Unknowns, WeightedLinear, protection::level_m,
};
use rand::{RngExt, SeedableRng};
use std::hint::black_box;
use world::{Odometry, Point, Pose, RangeSet, Station, StationId};

const NOISE: RangeNoise = RangeNoise::Uniform { ratio: 0.05 };
const TRUTH: Point = Point::new(3.0, -4.0);
const NEAR: Near = Near { at: TRUTH, sigma_m: 0.1, heading_sigma_rad: 0.02 };

fn stations() -> Vec<Station> {
    (1..)
        .zip([(7.5, 0.0), (-7.5, 0.0), (0.0, 7.5)])
        .map(|(id, (x, y))| Station { id: StationId(id), name: format!("S{id}"), position: Point::new(x, y) })
        .collect()
}

fn cycle(stations: &[Station]) -> Vec<RangeSet> {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
    let mut range = |distance: f64| distance * (1.0 + 0.05 * rng.random_range(-1.0..1.0));
    let set = |s: &Station| RangeSet {
        station: s.id,
        ranges_m: (0..20).map(|_| range((TRUTH - s.position).norm())).collect(),
    };
    stations.iter().map(set).collect()
}

fn ring(n: u32) -> Vec<Station> {
    let angle = |k: u32| std::f64::consts::TAU * f64::from(k) / f64::from(n);
    (0..n)
        .map(|k| Station {
            id: StationId(k + 1),
            name: format!("S{k}"),
            position: Point::new(7.5 * angle(k).cos(), 7.5 * angle(k).sin()),
        })
        .collect()
}

fn fixes(criterion: &mut Criterion) {
    let stations = stations();
    let sets = cycle(&stations);
    let solve = |how: Aggregation, solver: &dyn PositionSolver| {
        let rangings = how.aggregate(black_box(&sets), &NOISE).expect("usable ranges");
        solver.solve(&rangings, &stations, None).expect("a fix")
    };
    let mut bench = |name: &str, how: Aggregation, solver: &dyn PositionSolver| {
        criterion.bench_function(&format!("fix of 60 ranges, {name}"), |b| b.iter(|| solve(how, solver)));
    };
    bench("linear", Aggregation::Mean, &LinearLs);
    bench("weighted linear", Aggregation::Mean, &WeightedLinear);
    bench("nls", Aggregation::Mean, &Nls);
    bench("nls on trimmed means", Aggregation::TrimmedMean, &Nls);
    bench("nls on posterior means", Aggregation::Posterior, &Nls);
    bench("bounded", Aggregation::Mean, &Bounded { ratio: 0.05 });
    let start = Pose { position: TRUTH, heading_rad: 0.0 };
    let mut positioner = Positioner::new(PositionerConfig::new(stations.clone(), start));
    criterion.bench_function("cycle of 60 ranges, nls and filter", |b| {
        b.iter(|| positioner.cycle(black_box(&sets)));
    });
}

/// Eight stations, of which two hear the robot late.
fn eight_stations(criterion: &mut Criterion) {
    let stations = ring(8);
    let mut sets = cycle(&stations);
    for late in [2, 5] {
        sets[late].ranges_m.iter_mut().for_each(|range_m| *range_m += 1.0);
    }
    let solve = |solver: &dyn PositionSolver| {
        let rangings = Aggregation::Mean.aggregate(black_box(&sets), &NOISE).expect("usable ranges");
        solver.solve(&rangings, &stations, None).expect("a fix")
    };
    criterion.bench_function("8 stations, consensus", |b| b.iter(|| solve(&Consensus::default())));
    criterion.bench_function("8 stations, screened nls", |b| b.iter(|| solve(&Screened(Nls))));
    let mut calibration = Calibration::new(&stations, Unknowns::default());
    let rangings = Aggregation::Mean.aggregate(&cycle(&stations), &NOISE).expect("usable ranges");
    criterion.bench_function("8 stations, cycle into the calibration", |b| {
        b.iter(|| calibration.take(black_box(&rangings), None));
    });
}

fn filter(criterion: &mut Criterion) {
    let odometry = Odometry { forward_m: 0.03, sideways_m: 0.0, turn_rad: 0.01 };
    let covariance = Matrix2::identity() * 0.0025;
    let fresh = || Ekf::new(Pose::new(3.0, -4.0, 0.0), 0.05, 0.05, MotionNoise::default());
    let mut ekf = fresh();
    criterion.bench_function("filter step: predict and update", |b| {
        b.iter(|| {
            ekf.predict(black_box(&odometry));
            ekf.update_position(ekf.pose().position, &covariance)
        });
    });
    let stations = stations();
    let ranges = Aggregation::Mean.aggregate(&cycle(&stations), &NOISE).expect("usable ranges");
    let begun = fresh();
    criterion.bench_function("filter step: predict and update by 3 ranges", |b| {
        b.iter(|| {
            let mut ekf = begun.clone();
            ekf.predict(black_box(&odometry));
            ekf.update_ranges(&ranges, &stations)
        });
    });
    let mut smoother = FixedLag::new(fresh(), 10);
    (0..10).for_each(|_| smoother.predict(&odometry));
    criterion.bench_function("look back over 10 motions", |b| b.iter(|| black_box(&smoother).oldest()));
    let config = ParticlesConfig {
        count: 2000,
        ratio: 0.05,
        odometry: MotionNoise::default(),
        slip_chance: 0.02,
        seed: 1,
    };
    let particles = Particles::new(Pose::new(3.0, -4.0, 0.0), 0.05, 0.05, config);
    criterion.bench_function("2000 particles: predict, update, renew", |b| {
        b.iter(|| {
            let mut particles = particles.clone();
            particles.predict(black_box(&odometry));
            particles.update(&ranges, &stations).expect("bounds hold");
            particles.renew(&ranges, &stations);
            particles
        });
    });
}

/// Ranges of one repetition whose time of emission is unknown: all are 200 m too long, with an error of 10 cm each.
fn emitted_before(stations: &[Station]) -> Vec<RangeSet> {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(2);
    let mut range_m = |distance_m: f64| distance_m + 200.0 + 0.1 * rng.random_range(-1.7..1.7);
    let set = |s: &Station| RangeSet { station: s.id, ranges_m: vec![range_m((TRUTH - s.position).norm())] };
    stations.iter().map(set).collect()
}

/// The design's limits also hold for differences of arrivals.
fn differences(criterion: &mut Criterion) {
    let timing = Timing { jitter_m: 0.1, resolution_m: 0.0 };
    let noise = RangeNoise::Gaussian { sigma_ratio: 1e-4 };
    for n in [6, 8] {
        let (stations, risk) = (ring(n), Risk::default());
        let sets = emitted_before(&stations);
        let mut rangings = Aggregation::Mean.aggregate(&sets, &noise).expect("usable ranges");
        timing.apply(&mut rangings, &noise, 200.0);
        criterion.bench_function(&format!("{n} stations, fix of differences with protection level"), |b| {
            b.iter(|| {
                let fix = Differences.solve(black_box(&rangings), &stations, None).expect("a fix");
                level_m(&fix, &stations, &risk, true)
            });
        });
        let ways = (Aggregation::Mean, noise, timing);
        let mut session =
            SessionCalibration::new(SessionConfig::default(), &stations, ways, MotionNoise::default())
                .with_free_emission();
        let mut t_s = 0.0;
        criterion.bench_function(
            &format!("{n} stations, step of the session calibration, differences"),
            |b| {
                b.iter(|| {
                    t_s += 1.0;
                    session.take(black_box(&sets), NEAR, t_s)
                });
            },
        );
    }
}

/// The design allows 2 us for a fix with its level, and 200 us for a step of the session calibration.
fn integrity(criterion: &mut Criterion) {
    for n in [6, 8] {
        let (stations, risk) = (ring(n), Risk::default());
        let rangings = Aggregation::Mean.aggregate(&cycle(&stations), &NOISE).expect("usable ranges");
        criterion.bench_function(&format!("{n} stations, fix with protection level"), |b| {
            b.iter(|| {
                let fix = Nls.solve(black_box(&rangings), &stations, None).expect("a fix");
                level_m(&fix, &stations, &risk, false)
            });
        });
        let ways = (Aggregation::Mean, NOISE, Timing::default());
        let config = SessionConfig::default();
        let mut session = SessionCalibration::new(config, &stations, ways, MotionNoise::default());
        let sets = cycle(&stations);
        let mut t_s = 0.0;
        criterion.bench_function(&format!("{n} stations, step of the session calibration"), |b| {
            b.iter(|| {
                t_s += 1.0;
                session.take(black_box(&sets), NEAR, t_s)
            });
        });
    }
}

criterion_group!(benches, fixes, eight_stations, integrity, differences, filter);
criterion_main!(benches);
