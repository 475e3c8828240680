#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use planner_api::{Motion, Reason, Task, testing::Bench};
use trials::{Robot, cross, exact_pose, fly, spiral::Layout};

/// Point obstacles on a wide floor, as the paper draws them.
fn floor(points: &[(f64, f64)]) -> Layout {
    Layout {
        radius_m: 30.0,
        columns: points.iter().map(|(x, y)| (Point::new(*x, *y), 0.0)).collect(),
        path: vec![Point::origin()],
        hull_m: 0.0,
        clearance_m: 0.0,
    }
}

fn plan(layout: &Layout, values: &[(&str, f64)], goal: Point) -> (Plan, Bench) {
    let (bench, obstacles) = (Bench::new(), layout.obstacles());
    let site = layout.site(&obstacles, Motion::Point);
    let values: Vec<(&str, f64)> =
        values.iter().copied().chain([("steps_max", 200.0), ("wall_gain", 0.0)]).collect();
    let mut planner: ApfVirtualGoals = bench.configure(&values, &site).unwrap();
    let (start, task) = (exact_pose(Point::origin()), Task::Goto { goal, tolerance_m: 0.0 });
    let request = PlanRequest::new(&Reason::Start, start, task, &site);
    let plan = planner.plan(&request, &bench.ctx()).unwrap();
    (plan, bench)
}

#[test]
fn a_free_way_is_the_straight_one_to_the_millimetre() {
    let layout = floor(&[(3.0, 5.0), (6.0, 3.0), (8.0, 6.0)]);
    for improved in [0.0, 1.0] {
        let rule = [("improved", improved), ("step_rule", improved)];
        let (plan, _) = plan(&layout, &rule, Point::new(10.0, 10.0));
        assert!(plan.complete && (plan.cost - 14.1421).abs() < 1e-4, "{}", plan.cost);
    }
}

#[test]
fn an_obstacle_behind_the_goal_keeps_only_the_traditional_field_away() {
    let layout = floor(&[(7.3, 7.3), (3.0, 4.5)]);
    let goal = Point::new(6.904, 6.904);
    let (improved, _) = plan(&layout, &[], goal);
    assert!(improved.complete && (improved.cost / 9.7637 - 1.0).abs() < 1e-3, "{}", improved.cost);
    assert!(!plan(&layout, &[("improved", 0.0)], goal).0.complete);
}

#[test]
fn before_an_obstacle_dead_ahead_it_goes_for_a_virtual_goal_and_passes() {
    let layout = floor(&[(0.9, 0.0)]);
    let goal = Point::new(3.55, 0.0);
    let (improved, bench) = plan(&layout, &[], goal);
    assert!(improved.complete, "{:?}", improved.path.last());
    assert!(bench.scalar("virtual_goals").unwrap() >= 1.0);
    let (traditional, _) = plan(&layout, &[("improved", 0.0)], goal);
    assert!(!traditional.complete && traditional.path[traditional.path.len() - 1].x < 0.6);
}

#[test]
fn in_flight_it_passes_columns_without_touching_them() {
    let layout = Layout {
        radius_m: 8.0,
        columns: vec![(Point::new(-1.0, 0.05), 0.3), (Point::new(3.5, -0.5), 0.3)],
        path: vec![Point::new(-5.0, 0.0), Point::new(5.0, 0.0)],
        hull_m: 0.25,
        clearance_m: 0.05,
    };
    for motion in [Motion::Point, Motion::Unicycle] {
        let robot = Robot { motion, sigma_m: 0.02 };
        let outcome = fly::<ApfVirtualGoals>(&[("rho_0_m", 0.8)], &layout, robot, 5).unwrap();
        assert!(outcome.completed && outcome.clearance_m > 0.0, "{outcome:?}");
    }
}

#[test]
fn what_crosses_its_way_is_met_where_it_will_be_unless_it_counts_as_standing() {
    let from_m = [-5.0, -4.0, -3.5, -3.0, 3.0, 3.5, 4.0, 5.0];
    for from_y_m in from_m {
        let crossing = cross::<ApfVirtualGoals>(&[], from_y_m);
        assert!(crossing.arrived && crossing.clearance_m > 0.0, "{from_y_m} {crossing:?}");
    }
    let taken_as_standing = from_m.map(|from_y_m| cross::<ApfVirtualGoals>(&[("evade", 0.0)], from_y_m));
    // An obstacle that is evaded is given 0.15 m of clearance.
    assert!(taken_as_standing.iter().any(|crossing| crossing.clearance_m < 0.05), "{taken_as_standing:?}");
}

#[test]
fn a_change_of_live_parameters_acts_like_a_new_planner() {
    let changed = trials::changed::<ApfVirtualGoals>(&[], &[("slow_m", 3.0)]);
    assert!(changed.after == changed.fresh && changed.after != changed.before, "{changed:?}");
}
