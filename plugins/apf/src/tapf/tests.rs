#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use planner_api::{Code, Motion, Reason, Task, testing::Bench};
use trials::{Robot, cross, exact_pose, fly, spiral::Layout};
use world::Point;

/// A robot without extent on a floor of radius 90 m.
fn floor(columns: &[(f64, f64, f64)], start: (f64, f64)) -> Layout {
    Layout {
        radius_m: 90.0,
        columns: columns.iter().map(|(x, y, r)| (Point::new(*x, *y), *r)).collect(),
        path: vec![Point::new(start.0, start.1)],
        hull_m: 0.0,
        clearance_m: 0.0,
    }
}

fn plan(layout: &Layout, values: &[(&str, f64)], goal: Point) -> (Result<Plan>, Bench) {
    let (bench, obstacles) = (Bench::new(), layout.obstacles());
    let site = layout.site(&obstacles, Motion::Point);
    let mut planner: Tapf = bench.configure(values, &site).unwrap();
    let (start, task) = (exact_pose(layout.path[0]), Task::Goto { goal, tolerance_m: 0.02 });
    let request = PlanRequest::new(&Reason::Start, start, task, &site);
    let plan = planner.plan(&request, &bench.ctx());
    (plan, bench)
}

#[test]
fn the_always_on_force_stops_where_the_paper_prints_it() {
    // Xu et al. 2022, Table 1: an obstacle at (42, 52) before the goal at (44, 55).
    let layout = floor(&[(42.0, 52.0, 1.0)], (0.0, 0.0));
    let table_1 = [
        ("k_rep", 39.5),
        ("rho_0_m", 5.0),
        ("wall_gain", 0.0),
        ("goto_step_m", 0.01),
        ("tangent", 1.0),
        ("tangent_weight", 0.02),
    ];
    let plan = plan(&layout, &table_1, Point::new(44.0, 55.0)).0.unwrap();
    let stop = plan.path[plan.path.len() - 1];
    assert!(!plan.complete && (stop - Point::new(44.3, 55.3)).amax() < 0.05, "{stop}");
}

#[test]
fn an_obstacle_dead_ahead_stops_the_classical_field_and_not_the_tangent_force() {
    let layout = floor(&[(20.0, 20.0, 1.5)], (1.0, 1.0));
    let goal = Point::new(40.0, 40.0);
    let (classical, bench) = plan(&layout, &[("tangent", 0.0)], goal);
    assert!(!classical.unwrap().complete && bench.logs()[0].1.contains("trapped at (18."));
    assert!(plan(&layout, &[], goal).0.unwrap().complete);
}

#[test]
fn preset_paths_are_refused_with_the_reason() {
    let (bench, layout) = (Bench::new(), floor(&[], (0.0, 0.0)));
    let site = layout.site(&[], Motion::Point);
    let mut planner: Tapf = bench.configure(&[], &site).unwrap();
    let targets = [Point::new(1.0, 0.0)];
    let task = Task::Follow { targets: &targets, tolerance_m: 0.1 };
    let start = exact_pose(Point::origin());
    let request = PlanRequest::new(&Reason::Start, start, task, &site);
    assert_eq!(planner.plan(&request, &bench.ctx()).unwrap_err().code, Code::Unsupported);
}

#[test]
fn in_flight_it_passes_a_column_in_the_way_without_touching_it() {
    let layout = Layout {
        radius_m: 8.0,
        columns: vec![(Point::new(0.0, 0.1), 0.3), (Point::new(2.5, -0.4), 0.3)],
        path: vec![Point::new(-5.0, 0.0), Point::new(5.0, 0.0)],
        hull_m: 0.25,
        clearance_m: 0.05,
    };
    for motion in [Motion::Point, Motion::Unicycle] {
        let robot = Robot { motion, sigma_m: 0.03 };
        let values = [("k_rep", 0.5), ("rho_0_m", 0.8)];
        let outcome = fly::<Tapf>(&values, &layout, robot, 3).unwrap();
        assert!(outcome.completed && outcome.clearance_m > 0.0, "{outcome:?}");
    }
}

#[test]
fn a_goal_near_the_wall_is_reached() {
    let layout = Layout { radius_m: 5.0, hull_m: 0.25, ..floor(&[(0.5, 0.2, 0.3)], (-4.2, 0.0)) };
    let reaches = |values: &[(&str, f64)]| plan(&layout, values, Point::new(4.2, 0.0)).0.unwrap().complete;
    assert!(reaches(&[]) && !reaches(&[("wall_gain", 0.1)]));
}

#[test]
fn what_crosses_its_way_is_met_where_it_will_be_unless_it_counts_as_standing() {
    let from_m = [-5.0, -4.0, -3.5, -3.0, 3.0, 3.5, 4.0, 5.0];
    for from_y_m in from_m {
        let crossing = cross::<Tapf>(&[], from_y_m);
        assert!(crossing.arrived && crossing.clearance_m > 0.0, "{from_y_m} {crossing:?}");
    }
    let taken_as_standing = from_m.map(|from_y_m| cross::<Tapf>(&[("evade", 0.0)], from_y_m));
    assert!(taken_as_standing.iter().any(|crossing| crossing.clearance_m < 0.0), "{taken_as_standing:?}");
}

#[test]
fn a_change_of_live_parameters_acts_like_a_new_planner() {
    let changed = trials::changed::<Tapf>(&[("k_rep", 0.1)], &[("slow_m", 3.0)]);
    assert!(changed.after == changed.fresh && changed.after != changed.before, "{changed:?}");
}
