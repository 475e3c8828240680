//! Measures the time for one plan of the whole spiral of Wang et al. 2023, on layouts of the paper's first
//! distribution, which has 39 obstacles.

use criterion::{Criterion, criterion_group, criterion_main};
use planner_apf::apf::Apf;
use planner_api::{Motion, PlanRequest, Planner, Reason, Task, testing::Bench};
use std::hint::black_box;
use trials::{Distribution, Layout, Sampling, exact_pose};

/// Number of layouts, which are used in turn.
const LAYOUTS: u64 = 20;
/// Settings of Wang et al. 2023, first distribution, with improved repulsion.
const PAPER: [(&str, f64); 5] =
    [("k_att", 200.0), ("k_rep", 200.0), ("rho_0_m", 1.5), ("wall_gain", 0.0), ("repulsion", 1.0)];

fn layouts() -> Vec<Layout> {
    (0..LAYOUTS).map(|seed| Distribution::D1.layout(Sampling::Disk, seed, 0.0)).collect()
}

fn plans<P: Planner>(criterion: &mut Criterion, values: &[(&str, f64)]) {
    let layouts = layouts();
    let mut next = layouts.iter().cycle();
    criterion.bench_function(&format!("plan/{}", P::ID), |bencher| {
        bencher.iter(|| {
            let layout = next.next().expect("a cycle has no end");
            let bench = Bench::new();
            bench.look_away();
            let obstacles = layout.obstacles();
            let site = layout.site(&obstacles, Motion::Point);
            let mut planner: P =
                bench.configure(values, &site).expect("the parameters are those of the planner");
            let task = Task::Follow { targets: &layout.path, tolerance_m: 0.2 };
            let start = exact_pose(layout.path[0]);
            let request = PlanRequest::new(&Reason::Start, start, task, &site);
            black_box(planner.plan(&request, &bench.ctx())).is_ok()
        });
    });
}

fn all(criterion: &mut Criterion) {
    plans::<Apf>(criterion, &PAPER);
}

criterion_group!(benches, all);
criterion_main!(benches);
