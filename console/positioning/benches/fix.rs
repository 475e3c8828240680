//! Time of one fix from 60 ranges and of one step of the filter.

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::Matrix2;
use positioning::{
    Aggregation, Ekf, LinearLs, MotionNoise, Nls, PositionSolver, Positioner, PositionerConfig, RangeNoise,
};
use rand::{RngExt, SeedableRng};
use std::hint::black_box;
use world::{Odometry, Point, Pose, RangeSet, Station, StationId};

const NOISE: RangeNoise = RangeNoise::Uniform { ratio: 0.05 };
const TRUTH: Point = Point::new(3.0, -4.0);

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

fn fixes(criterion: &mut Criterion) {
    let stations = stations();
    let sets = cycle(&stations);
    let solve = |solver: &dyn PositionSolver| {
        let rangings = Aggregation::Mean.aggregate(black_box(&sets), &NOISE).expect("usable ranges");
        solver.solve(&rangings, &stations, None).expect("a fix")
    };
    criterion.bench_function("fix of 60 ranges, linear", |b| b.iter(|| solve(&LinearLs)));
    criterion.bench_function("fix of 60 ranges, nls", |b| b.iter(|| solve(&Nls)));
    let start = Pose { position: TRUTH, heading_rad: 0.0 };
    let mut positioner = Positioner::new(PositionerConfig::new(stations.clone(), start));
    criterion.bench_function("cycle of 60 ranges, nls and filter", |b| {
        b.iter(|| positioner.cycle(black_box(&sets)));
    });
}

fn filter(criterion: &mut Criterion) {
    let odometry = Odometry { forward_m: 0.03, sideways_m: 0.0, turn_rad: 0.01 };
    let covariance = Matrix2::identity() * 0.0025;
    let mut ekf = Ekf::new(Pose::new(0.0, 0.0, 0.0), 0.05, 0.05, MotionNoise::default());
    criterion.bench_function("filter step: predict and update", |b| {
        b.iter(|| {
            ekf.predict(black_box(&odometry));
            ekf.update_position(ekf.pose().position, &covariance)
        });
    });
}

criterion_group!(benches, fixes, filter);
criterion_main!(benches);
