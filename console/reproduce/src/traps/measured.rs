//! One method on one trap.

use super::{Map, Method, flight};
use crate::{planners::Planners, study::Problem};
use mission::During;
use nalgebra::Matrix3;
use planner_api::{PlanRequest, PoseEstimate, Reason, Task};
use trials::traps::{HULL_M, Kind, SIDE_M, Trap};
use world::{Boundary, Point, polyline, shortest::GrownFloor};

/// The goal counts as reached at this distance, metres.
pub(super) const TOLERANCE_M: f64 = 0.1;
/// Rounding of clearances, metres.
const ROUNDING_M: f64 = 1e-6;

/// How a method did on a trap.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Measured {
    /// Whether there is such a planner here.
    pub is_there: bool,
    /// Whether the goal is reached without a touch.
    pub arrives: bool,
    /// Whether the hull touches a disc or the wall on the way.
    pub collides: bool,
    /// Length of the way over that of the exact shortest one; only of ways that arrive.
    pub ratio: Option<f64>,
    /// Time of the first plan, milliseconds.
    pub plan_time_ms: Option<f64>,
    /// Times of the plans after it, milliseconds.
    pub replan_times_ms: Vec<f64>,
}

/// Asks a method to leave a trap.
pub(super) fn measure(
    planners: &Planners,
    method: &Method,
    kind: Kind,
    seed: u64,
) -> Result<Measured, Problem> {
    let trap = Trap::random(kind, seed);
    let gone = match method.map {
        Map::Known => planned(planners, method, &trap),
        Map::Sensed { range_m } => flight::fly(planners, method, &trap, range_m),
    };
    match gone {
        Ok(gone) => gone.measured(&trap, kind, seed),
        Err(Problem::Planner { fault, .. }) if fault.during == During::Load => Ok(Measured {
            is_there: false,
            arrives: false,
            collides: false,
            ratio: None,
            plan_time_ms: None,
            replan_times_ms: Vec::new(),
        }),
        Err(Problem::Planner { fault, .. }) => {
            Err(Problem::Planner { case: format!("{} seed {seed}, {}", kind.id(), method.id), fault })
        }
        Err(problem) => Err(problem),
    }
}

/// The way that was planned or flown.
pub(super) struct Gone {
    /// Its points.
    pub path: Vec<Point>,
    /// Times of the plans, milliseconds, the first one first.
    pub plan_times_ms: Vec<f64>,
}

fn planned(planners: &Planners, method: &Method, trap: &Trap) -> Result<Gone, Problem> {
    let (corners, obstacles) = (Trap::corners(), trap.obstacles(false));
    let site = Trap::site(&corners, &obstacles, SIDE_M);
    let start = PoseEstimate { position: trap.start, heading_rad: 0.0, covariance: Matrix3::zeros() };
    let task = Task::Goto { goal: trap.goal, tolerance_m: TOLERANCE_M };
    let request = PlanRequest { reason: &Reason::Start, start, task, site: &site, previous: &[] };
    let planned = planners.plan(method.planner, &method.parameters, &request)?;
    Ok(Gone { plan_times_ms: vec![planned.plan_time_ms], path: planned.plan.path })
}

impl Gone {
    fn measured(self, trap: &Trap, kind: Kind, seed: u64) -> Result<Measured, Problem> {
        let end = self.path.last().copied().unwrap_or(trap.start);
        let missing_m = (trap.goal - end).norm();
        let collides = clearance_m(&self.path, trap) < -ROUNDING_M;
        let arrives = missing_m <= TOLERANCE_M + ROUNDING_M && !collides;
        let shortest_m = shortest_m(trap)
            .ok_or_else(|| Problem::Nothing(format!("{} seed {seed}: the trap has no way out", kind.id())))?;
        let length_m = polyline::length_m(&self.path) + missing_m;
        Ok(Measured {
            is_there: true,
            arrives,
            collides,
            ratio: arrives.then_some(length_m / shortest_m),
            plan_time_ms: self.plan_times_ms.first().copied(),
            replan_times_ms: self.plan_times_ms.into_iter().skip(1).collect(),
        })
    }
}

/// Length of the exact shortest way, metres.
fn shortest_m(trap: &Trap) -> Option<f64> {
    let boundary = Boundary::Polygon { vertices: Trap::corners().to_vec() };
    let shapes = trap.shapes();
    let floor = GrownFloor::new(&boundary, HULL_M, shapes.iter().map(|shape| (shape, HULL_M)));
    floor.shortest(trap.start, trap.goal, &mut || true).ok().map(|way| way.length_m)
}

/// The least distance between the hull and a disc or the wall on the way, metres.
fn clearance_m(path: &[Point], trap: &Trap) -> f64 {
    let wall = path.iter().map(|p| SIDE_M / 2.0 - p.x.abs().max(p.y.abs()));
    let discs = trap.discs.iter().map(|(at, radius_m)| polyline::distance_m(path, *at) - radius_m);
    wall.chain(discs).fold(f64::INFINITY, f64::min) - HULL_M
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gone(path: Vec<Point>) -> Measured {
        let trap = Trap::random(Kind::U, 3);
        Gone { path, plan_times_ms: vec![1.0, 2.0, 3.0] }.measured(&trap, Kind::U, 3).unwrap()
    }

    #[test]
    fn the_straight_way_through_the_wall_is_a_collision_and_no_arrival() {
        let trap = Trap::random(Kind::U, 3);
        let measured = gone(vec![trap.start, trap.goal]);
        assert!(measured.collides && !measured.arrives && measured.ratio.is_none());
        assert_eq!(measured.replan_times_ms, [2.0, 3.0]);
    }

    #[test]
    fn the_shortest_way_has_the_ratio_one() {
        let trap = Trap::random(Kind::U, 3);
        let boundary = Boundary::Polygon { vertices: Trap::corners().to_vec() };
        let shapes = trap.shapes();
        let floor = GrownFloor::new(&boundary, HULL_M, shapes.iter().map(|shape| (shape, HULL_M)));
        let way = floor.shortest(trap.start, trap.goal, &mut || true).unwrap();
        let measured = gone(way.points());
        assert!(measured.arrives && (measured.ratio.unwrap() - 1.0).abs() < 1e-5);
        assert!(!gone(vec![trap.start]).arrives);
    }
}
