//! Measures the cost of a call to a planner: from the console through the worker process and back.
#![expect(clippy::print_stdout, reason = "a bench prints its figures")]

use criterion::{Criterion, criterion_group, criterion_main};
use mission::planner::Parameters;
use nalgebra::{Matrix3, Point2};
use planner_api::{Boundary, Limits, Motion, Obstacle, Outline, PoseEstimate, Sensed, Site};
use planner_host::{BlockingHost, HostConfig, PluginDirs, WorkerCommand};
use std::time::{Duration, Instant};

const N_OBSTACLES: u32 = 16;
const N_STARTS: usize = 200;

fn host() -> BlockingHost {
    let worker = env!("CARGO_BIN_EXE_planner-worker");
    let mut config = HostConfig::new(Duration::from_secs(1));
    config.worker_command = WorkerCommand::new(worker);
    BlockingHost::new(&PluginDirs::standard(&[]), config)
}

fn obstacles() -> Vec<Obstacle<'static>> {
    let disc = |id| Outline::Disc { center: Point2::new(f64::from(id), 1.0), radius_m: 0.2 };
    (0..N_OBSTACLES)
        .map(|id| Obstacle {
            id,
            outline: disc(id),
            discovered: false,
            velocity_m_per_s: planner_api::Vector2::zeros(),
        })
        .collect()
}

fn round_trip(criterion: &mut Criterion) {
    let obstacles = obstacles();
    let limits = Limits {
        motion: Motion::Point,
        v_max_m_per_s: 0.3,
        w_max_rad_per_s: 1.0,
        radius_m: 0.2,
        sensing_range_m: 3.0,
        acceleration_m_per_s2: 0.5,
        tick_s: 0.1,
        amphibious: None,
    };
    let boundary = Boundary::Circle { radius_m: 20.0 };
    let site = Site {
        revision: 0,
        boundary,
        obstacles: &obstacles,
        zones: &[],
        limits,
        swath_m: 0.4,
        clearance_m: 0.1,
        seed: 1,
    };
    let pose = PoseEstimate { position: Point2::origin(), heading_rad: 0.0, covariance: Matrix3::identity() };
    let mut sensed = Sensed { obstacles: &obstacles, ..Sensed::new(0, 0.1, pose, Point2::new(10.0, 0.0)) };
    let mut host = host();
    host.choose("faulty", &Parameters::new(), &site).expect("the fault injector is built with the benches");
    criterion.bench_function("step with 16 obstacles", |bench| {
        bench.iter(|| {
            sensed.tick += 1;
            host.step(&sensed).expect("a command")
        });
    });
    let step = host.stats().step;
    println!(
        "{} steps, p50 {:.1} us, p99 {:.1} us",
        step.calls,
        step.p50_us.unwrap_or(0.0),
        step.p99_us.unwrap_or(0.0)
    );
    criterion.bench_function("choose, from nothing to ready", |bench| {
        bench.iter(|| host.choose("faulty", &Parameters::new(), &site).expect("chosen"));
    });
    let mut starts: Vec<Duration> = (0..N_STARTS)
        .map(|_| {
            let began = Instant::now();
            host.choose("faulty", &Parameters::new(), &site).expect("chosen");
            began.elapsed()
        })
        .collect();
    starts.sort_unstable();
    println!("{N_STARTS} starts, fastest {:?}, p10 {:?}, p50 {:?}", starts[0], starts[20], starts[100]);
}

criterion_group!(benches, round_trip);
criterion_main!(benches);
