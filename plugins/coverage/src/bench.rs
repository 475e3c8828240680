//! What the tests of the coverage planners share.

use planner_api::{
    Plan, PlanRequest, Planner, PoseEstimate, Reason, Result, Task, TetherLimits, testing::Bench,
};
use trials::tanks::Tank;

/// Plans a tank from its anchor.
pub fn plan<P: Planner>(
    tank: &Tank,
    values: &[(&str, f64)],
    tether: Option<TetherLimits>,
) -> (Result<Plan>, Bench) {
    let bench = Bench::new();
    let obstacles = tank.obstacles();
    let site = tank.site(&obstacles);
    let mut planner: P = bench.configure(values, &site).unwrap();
    let start =
        PoseEstimate { position: tank.anchor, heading_rad: 0.0, covariance: nalgebra::Matrix3::zeros() };
    let task = Task::Cover { anchor: tank.anchor, regions: &[], tether, tolerance_m: 0.3 };
    let request = PlanRequest { reason: &Reason::Start, start, task, site: &site, previous: &[] };
    let plan = planner.plan(&request, &bench.ctx());
    (plan, bench)
}
