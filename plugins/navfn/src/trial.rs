//! Test helpers that run the planners on random traps.

use planner_api::{Obstacle, Plan, PlanRequest, Planner, Point2, Reason, Result, Site, Task, testing::Bench};
use trials::{
    exact_pose,
    traps::{HULL_M, Trap},
};
use world::polyline;

/// Creates a planner with these parameters for a site.
pub(crate) fn planner<P: Planner>(values: &[(&str, f64)], site: &Site<'_>) -> P {
    Bench::new().configure(values, site).expect("the planner accepts its own parameters")
}

/// Returns the plan of a planner for a site.
pub(crate) fn plan<P: Planner>(
    planner: &mut P,
    from: Point2<f64>,
    to: Point2<f64>,
    site: &Site<'_>,
) -> Result<Plan> {
    let task = Task::Goto { goal: to, tolerance_m: 0.1 };
    let request = PlanRequest::new(&Reason::Start, exact_pose(from), task, site);
    planner.plan(&request, &Bench::new().ctx())
}

/// The plan of a new planner that has the whole trap on its map.
pub(crate) fn plan_trap<P: Planner>(trap: &Trap) -> Result<Plan> {
    let (corners, obstacles) = (Trap::corners(), trap.obstacles(false));
    let site = Trap::site(&corners, &obstacles, 6.0);
    plan(&mut planner::<P>(&[], &site), trap.start, trap.goal, &site)
}

/// The smallest distance between the hull and a disc along the path, metres.
pub(crate) fn clearance_m(path: &[Point2<f64>], trap: &Trap) -> f64 {
    let to_disc = |(at, radius_m): &(Point2<f64>, f64)| polyline::distance_m(path, *at) - radius_m;
    trap.discs.iter().map(to_disc).fold(f64::INFINITY, f64::min) - HULL_M
}

/// The discs that come partly within a range and have not been seen before.
pub(crate) fn newly_seen(trap: &Trap, seen: &mut [bool], from: Point2<f64>, range_m: f64) -> bool {
    let before = seen.iter().filter(|seen| **seen).count();
    for (seen, (at, radius_m)) in seen.iter_mut().zip(&trap.discs) {
        *seen |= (at - from).norm() - radius_m <= range_m;
    }
    seen.iter().filter(|seen| **seen).count() > before
}

/// The obstacles seen so far.
pub(crate) fn known<'a>(all: &[Obstacle<'a>], seen: &[bool]) -> Vec<Obstacle<'a>> {
    all.iter().zip(seen).filter(|(_, seen)| **seen).map(|(obstacle, _)| *obstacle).collect()
}
