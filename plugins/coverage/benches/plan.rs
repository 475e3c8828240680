//! Measures the time that a tether-safe plan takes, and the share of it that the pull of the tether costs: the plan without
//! a reel, the plan with a reel that is strong enough for it, and the certificates of this plan with and without the pull.

use criterion::{Criterion, criterion_group, criterion_main};
use planner_api::{
    Plan, PlanRequest, Planner, PoseEstimate, Reason, Task, TetherLimits, TetherPull, testing::Bench,
};
use planner_coverage::tether_safe::TetherSafe;
use std::hint::black_box;
use trials::tanks::{Known, Tank};
use world::{
    Obstacle, ObstacleId, Shape,
    tether::{Case, Limits, Reel, certify},
};

/// Limits that no plan reaches, so that all variants make the same plan.
const AMPLE: f64 = 1000.0;
const REEL: Reel = Reel {
    mass_kg_per_m: 0.1,
    floor_friction: 0.3,
    pull_n: AMPLE,
    pay_out_n: 0.5,
    robot_pull_n: None,
    pull_ratio_max: 0.8,
};
const FRICTION: f64 = 0.3;

fn plan(tank: &Tank, pull: Option<TetherPull>) -> Plan {
    let (bench, obstacles) = (Bench::new(), tank.obstacles());
    let site = tank.site(&obstacles);
    let mut planner: TetherSafe = bench.configure(&[], &site).expect("the defaults fit");
    let start =
        PoseEstimate { position: tank.anchor, heading_rad: 0.0, covariance: nalgebra::Matrix3::zeros() };
    let tether = TetherLimits { reel_length_m: AMPLE, wrap_max_rad: AMPLE, wrap_total_max_rad: AMPLE, pull };
    let task = Task::Cover { anchor: tank.anchor, regions: &[], tether: Some(tether), tolerance_m: 0.3 };
    let request = PlanRequest::new(&Reason::Start, start, task, &site);
    planner.plan(&request, &bench.ctx()).expect("there is a plan")
}

fn plans(criterion: &mut Criterion) {
    let drag = REEL.drag(FRICTION);
    let pull = TetherPull {
        floor_n_per_m: drag.floor_n_per_m,
        friction: FRICTION,
        reel_n: REEL.pull_n,
        preferred_n: REEL.preferred_n(),
    };
    let mut group = criterion.benchmark_group("tether-safe");
    group.sample_size(10);
    for known in Known::ALL {
        let tank = known.tank(0);
        for (name, pull) in [("", None), (", with pull", Some(pull))] {
            group.bench_function(format!("{}{name}", known.id()), |bencher| {
                bencher.iter(|| plan(&tank, black_box(pull)));
            });
        }
    }
}

fn certificates(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("certificate");
    for known in Known::ALL {
        let tank = known.tank(0);
        let made = plan(&tank, None);
        let obstacle = |(id, (center, radius_m)): (u32, &(_, f64))| {
            let shape = Shape::Disc { center: *center, radius_m: *radius_m };
            Obstacle { id: ObstacleId(id), name: format!("C{id}"), shape, known: true }
        };
        let obstacles: Vec<Obstacle> = (0..).zip(&tank.columns).map(obstacle).collect();
        let limits = Limits { reel_length_m: AMPLE, wrap_max_rad: AMPLE, wrap_total_max_rad: AMPLE };
        for (name, pull) in [("", None), (", with pull", Some(REEL.limits(FRICTION)))] {
            let case = Case {
                path: &made.path,
                anchor: tank.anchor,
                cable: None,
                boundary: &tank.boundary,
                obstacles: &obstacles,
                room_m: trials::tanks::HULL_M,
                limits,
                pull,
                returns: true,
                cuts: &made.cuts,
            };
            group.bench_function(format!("{}{name}", known.id()), |bencher| {
                bencher.iter(|| black_box(certify(black_box(&case))));
            });
        }
    }
}

criterion_group!(benches, plans, certificates);
criterion_main!(benches);
