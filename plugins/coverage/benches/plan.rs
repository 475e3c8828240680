//! Measures the time that a tether-safe plan takes.

use criterion::{Criterion, criterion_group, criterion_main};
use planner_api::{Plan, PlanRequest, Planner, PoseEstimate, Reason, Task, testing::Bench};
use planner_coverage::tether_safe::TetherSafe;
use trials::tanks::{Known, Tank};

fn plan(tank: &Tank) -> Plan {
    let (bench, obstacles) = (Bench::new(), tank.obstacles());
    let site = tank.site(&obstacles);
    let mut planner: TetherSafe = bench.configure(&[], &site).expect("the defaults fit");
    let start =
        PoseEstimate { position: tank.anchor, heading_rad: 0.0, covariance: nalgebra::Matrix3::zeros() };
    let task = Task::Cover { anchor: tank.anchor, regions: &[], tether: None, tolerance_m: 0.3 };
    let request = PlanRequest::new(&Reason::Start, start, task, &site);
    planner.plan(&request, &bench.ctx()).expect("there is a plan")
}

fn plans(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("tether-safe");
    group.sample_size(10);
    for known in Known::ALL {
        let tank = known.tank(0);
        group.bench_function(known.id(), |bencher| bencher.iter(|| plan(&tank)));
    }
}

criterion_group!(benches, plans);
criterion_main!(benches);
