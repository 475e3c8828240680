//! Measures the cost of a plan, and of a discovery, on 160 random traps of 50 m by 50 m.

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::Matrix3;
use planner_api::{
    Obstacle, Plan, PlanRequest, Planner, Point2, PoseEstimate, Reason, Result, Site, Task, testing::Bench,
};
use planner_navfn::{navfn::Navfn, shortest::Shortest};
use std::hint::black_box;
use trials::traps::{Kind, Trap};

/// The number of layouts of each kind.
const LAYOUTS: u64 = 40;
/// Sensing range of the discoveries, metres.
const RANGE_M: f64 = 6.0;

fn traps() -> Vec<Trap> {
    (0..LAYOUTS).flat_map(|seed| Kind::ALL.map(|kind| Trap::random(kind, seed))).collect()
}

fn asked<P: Planner>(planner: &mut P, from: Point2<f64>, goal: Point2<f64>, site: &Site<'_>) -> Result<Plan> {
    let bench = Bench::new();
    bench.look_away();
    let start = PoseEstimate { position: from, heading_rad: 0.0, covariance: Matrix3::zeros() };
    let task = Task::Goto { goal, tolerance_m: 0.1 };
    planner.plan(&PlanRequest::new(&Reason::Start, start, task, site), &bench.ctx())
}

fn planner<P: Planner>(values: &[(&str, f64)], site: &Site<'_>) -> P {
    Bench::new().configure(values, site).expect("the parameters are those of the planner")
}

fn from_scratch<P: Planner>(c: &mut Criterion, name: &str, values: &[(&str, f64)]) {
    let (traps, corners) = (traps(), Trap::corners());
    let mut next = traps.iter().cycle();
    c.bench_function(name, |bencher| {
        bencher.iter(|| {
            let trap = next.next().expect("a cycle has no end");
            let obstacles = trap.obstacles(false);
            let site = Trap::site(&corners, &obstacles, RANGE_M);
            black_box(asked(&mut planner::<P>(values, &site), trap.start, trap.goal, &site))
        });
    });
}

/// Measures the plans on the whole way to the goal. Discs within range are discovered step by step; one iteration is
/// one new plan.
fn replans(c: &mut Criterion) {
    let (traps, corners) = (traps(), Trap::corners());
    let all: Vec<Vec<Obstacle<'static>>> = traps.iter().map(|trap| trap.obstacles(true)).collect();
    let mut journey = None;
    let mut next = (0..traps.len()).cycle();
    c.bench_function("navfn-replan-200", |bencher| {
        bencher.iter(|| {
            let (index, mut navfn, mut at, n_seen): (usize, Navfn, Point2<f64>, usize) =
                journey.take().unwrap_or_else(|| {
                    let index = next.next().expect("a cycle has no end");
                    let site = Trap::site(&corners, &[], RANGE_M);
                    (index, planner(&[("cells", 200.0)], &site), traps[index].start, 0)
                });
            let trap = &traps[index];
            let seen = &all[index][..n_seen];
            let site = Trap::site(&corners, seen, RANGE_M);
            let plan = black_box(asked(&mut navfn, at, trap.goal, &site));
            let path = plan.map(|plan| plan.path).unwrap_or_default();
            // Drives on to the point where the next disc is seen.
            let unseen = all[index].get(n_seen).map(|_| trap.discs[n_seen]);
            if let Some((center, radius_m)) = unseen {
                let sees = |p: &&Point2<f64>| (**p - center).norm() - radius_m < RANGE_M;
                at = path.iter().find(sees).copied().unwrap_or(at);
                journey = Some((index, navfn, at, n_seen + 1));
            }
        });
    });
}

fn plans(c: &mut Criterion) {
    from_scratch::<Shortest>(c, "shortest", &[]);
    from_scratch::<Navfn>(c, "navfn-240", &[("cells", 240.0)]);
    replans(c);
}

criterion_group!(benches, plans);
criterion_main!(benches);
