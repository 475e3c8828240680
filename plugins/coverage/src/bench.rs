//! Helpers shared by the tests of the coverage planners.

use planner_api::testing::Bench;
use planner_api::{Plan, PlanRequest, Planner, PoseEstimate, Reason, Result, Task, TetherLimits};
use trials::tanks::Tank;
use world::Point;

/// Plans a tank from its anchor.
pub(crate) fn plan<P: Planner>(
    tank: &Tank,
    values: &[(&str, f64)],
    tether: Option<TetherLimits>,
) -> (Result<Plan>, Bench) {
    let bench = Bench::new();
    let obstacles = tank.obstacles();
    let mut planner: P = bench.configure(values, &tank.site(&obstacles)).unwrap();
    let plan = ask(&mut planner, tank, tether, &bench);
    (plan, bench)
}

/// Plans the rest of a tank from a position inside it.
pub(crate) fn plan_from<P: Planner>(tank: &Tank, start: Point) -> Result<Plan> {
    let (bench, obstacles) = (Bench::new(), tank.obstacles());
    let mut planner: P = bench.configure(&[], &tank.site(&obstacles)).unwrap();
    ask_from(&mut planner, tank, start, None, &bench)
}

/// Asserts that the progress a planner reports rises from zero, in more than a few steps.
pub(crate) fn assert_progress_rises(bench: &Bench) {
    let progress = bench.progress();
    let shares: Vec<f64> = progress.iter().map(|(share, _)| *share).collect();
    assert!(shares.windows(2).all(|pair| pair[0] <= pair[1]), "{progress:?}");
    assert!(shares.iter().all(|share| (0.0..=1.0).contains(share)), "{progress:?}");
    let distinct =
        shares.iter().map(|share| (share * 1e3) as u64).collect::<std::collections::BTreeSet<_>>().len();
    assert!(distinct > 10 && shares[0] == 0.0 && shares[shares.len() - 1] > 0.3, "{distinct}: {progress:?}");
    assert!(progress.iter().all(|(_, what)| !what.is_empty() && what.len() <= 80), "{progress:?}");
}

/// A planner, together with its plan for a tank.
pub(crate) fn planned<P: Planner>(tank: &Tank, values: &[(&str, f64)]) -> (P, Plan, Bench) {
    let bench = Bench::new();
    let obstacles = tank.obstacles();
    let mut planner: P = bench.configure(values, &tank.site(&obstacles)).unwrap();
    let plan = ask(&mut planner, tank, None, &bench).unwrap();
    (planner, plan, bench)
}

fn ask<P: Planner>(
    planner: &mut P,
    tank: &Tank,
    tether: Option<TetherLimits>,
    bench: &Bench,
) -> Result<Plan> {
    ask_from(planner, tank, tank.anchor, tether, bench)
}

fn ask_from<P: Planner>(
    planner: &mut P,
    tank: &Tank,
    position: Point,
    tether: Option<TetherLimits>,
    bench: &Bench,
) -> Result<Plan> {
    let obstacles = tank.obstacles();
    let site = tank.site(&obstacles);
    let start = PoseEstimate { position, heading_rad: 0.0, covariance: nalgebra::Matrix3::zeros() };
    let task = Task::Cover { anchor: tank.anchor, regions: &[], tether, tolerance_m: 0.3 };
    let request = PlanRequest::new(&Reason::Start, start, task, &site);
    planner.plan(&request, &bench.ctx())
}
