//! Measures the cost of one plan for the paper's whole spiral, on layouts of its first distribution with 39 obstacles.
//!
//! The classical field is in a different plugin, which has its own bench: two plugins cannot be linked into one
//! program.

use criterion::{Criterion, criterion_group, criterion_main};
use planner_api::{Motion, PlanRequest, Planner, Reason, Task, testing::Bench};
use planner_spiral::{
    escapes::{Iapf, Vt},
    rpf::Rpf,
    spiral_lattice::SpiralLattice,
    spiral_tangent::SpiralTangent,
};
use std::hint::black_box;
use trials::{Distribution, Layout, Sampling, exact_pose};

/// Number of layouts, which are used in turn.
const LAYOUTS: u64 = 20;
/// Clearance that our own planners keep, metres.
const CLEARANCE_M: f64 = 0.3;
/// Settings of Wang et al. 2023, first distribution, with improved repulsion.
const PAPER: [(&str, f64); 5] =
    [("k_att", 200.0), ("k_rep", 200.0), ("rho_0_m", 1.5), ("wall_gain", 0.0), ("repulsion", 1.0)];

fn layouts(clearance_m: f64) -> Vec<Layout> {
    (0..LAYOUTS).map(|seed| Distribution::D1.layout(Sampling::Disk, seed, clearance_m)).collect()
}

fn plans<P: Planner>(criterion: &mut Criterion, clearance_m: f64, values: &[(&str, f64)]) {
    let layouts = layouts(clearance_m);
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
    plans::<Vt>(criterion, 0.0, &PAPER);
    plans::<Iapf>(criterion, 0.0, &PAPER);
    plans::<Rpf>(criterion, 0.0, &PAPER);
    plans::<SpiralLattice>(criterion, CLEARANCE_M, &[]);
    plans::<SpiralTangent>(criterion, CLEARANCE_M, &[]);
}

criterion_group!(benches, all);
criterion_main!(benches);
