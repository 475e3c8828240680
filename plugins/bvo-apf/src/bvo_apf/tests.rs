#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use planner_api::{
    Boundary, Code, Drawing, Drive, Limits, Motion, Obstacle, Outline, Reason, StopReason, Task, Vector2,
    testing::Bench,
};
use std::f64::consts::PI;
use trials::exact_pose;
use world::{Pose, Vector, geometry::wrap_angle_rad};

const TICK_S: f64 = 0.1;

/// A cup of columns in a round tank, open to the west.
fn cup() -> Vec<Obstacle<'static>> {
    let corners = [(-1.5, 2.0), (1.5, 2.0), (1.5, -2.0), (-1.5, -2.0)].map(|(x, y)| Point::new(x, y));
    let centers = world::polyline::resampled(&corners, 0.6);
    let column = |(id, center): (usize, &Point)| Obstacle {
        id: id as u32,
        outline: Outline::Disc { center: *center, radius_m: 0.35 },
        discovered: false,
        velocity_m_per_s: Vector2::zeros(),
    };
    centers.iter().enumerate().map(column).collect()
}

fn site<'a>(obstacles: &'a [Obstacle<'a>], motion: Motion) -> Site<'a> {
    Site {
        revision: 0,
        boundary: Boundary::Circle { radius_m: 8.0 },
        obstacles,
        zones: &[],
        limits: Limits {
            motion,
            v_max_m_per_s: 0.4,
            w_max_rad_per_s: 1.0,
            radius_m: 0.25,
            sensing_range_m: 2.5,
            acceleration_m_per_s2: 0.5,
            tick_s: 0.1,
            amphibious: None,
        },
        swath_m: 0.5,
        clearance_m: 0.05,
        seed: 0,
    }
}

const START: Point = Point::new(-6.0, 0.2);
const GOAL: Point = Point::new(6.0, 0.0);

fn task() -> Task<'static> {
    Task::Goto { goal: GOAL, tolerance_m: 0.2 }
}

fn plan(values: &[(&str, f64)], task: Task<'_>) -> (Result<Plan>, Bench) {
    let (bench, obstacles) = (Bench::new(), cup());
    let site = site(&obstacles, Motion::Point);
    let mut planner: BvoApf = bench.configure(values, &site).unwrap();
    let request = PlanRequest::new(&Reason::Start, exact_pose(START), task, &site);
    let plan = planner.plan(&request, &bench.ctx());
    (plan, bench)
}

#[test]
fn every_mode_plans_a_complete_path_and_the_best_is_shorter() {
    let cost = |mode: f64| {
        let (plan, bench) = plan(&[("mode", mode), ("rho_0_m", 1.0), ("k_rep", 1.0)], task());
        let plan = plan.unwrap();
        assert!(plan.complete, "{mode} {:?}", bench.logs());
        plan.cost
    };
    assert!(cost(3.0) < 0.9 * cost(0.0).min(cost(1.0)).min(cost(2.0)));
}

#[test]
fn a_plan_reports_how_it_left_the_trap_and_draws_its_virtual_circles() {
    let (plan, bench) = plan(&[("mode", 0.0), ("rho_0_m", 1.0), ("k_rep", 1.0)], task());
    assert!(plan.is_ok());
    let said: Vec<String> = bench.logs().into_iter().map(|(_, message)| message).collect();
    assert!(said[0].starts_with("trapped at (") && said[1].starts_with("sealing the trap with"), "{said:?}");
    assert!(bench.scalar("virtual_circles").unwrap() > 0.0);
    assert!(bench.drawings().iter().any(|d| matches!(d, Drawing::Circle { layer: Layer::Virtual, .. })));
}

#[test]
fn what_it_cannot_do_is_refused_with_the_reason() {
    let targets = [START, GOAL];
    let code = |task: Task<'_>| plan(&[], task).0.unwrap_err().code;
    assert_eq!(code(Task::Follow { targets: &targets, tolerance_m: 0.1 }), Code::Unsupported);
    assert_eq!(code(Task::Goto { goal: Point::new(1.5, 0.0), tolerance_m: 0.1 }), Code::GoalOccupied);
    assert_eq!(code(Task::Goto { goal: Point::new(9.0, 0.0), tolerance_m: 0.1 }), Code::GoalOutside);
}

#[test]
fn it_stops_planning_when_the_console_says_so() {
    let (bench, obstacles) = (Bench::new(), cup());
    let site = site(&obstacles, Motion::Point);
    let mut planner: BvoApf = bench.configure(&[("mode", 0.0)], &site).unwrap();
    bench.stop_with(StopReason::Timeout);
    let request = PlanRequest::new(&Reason::Start, exact_pose(START), task(), &site);
    assert_eq!(planner.plan(&request, &bench.ctx()).unwrap_err().code, Code::Timeout);
}

struct Flown {
    arrived: bool,
    clearance_m: f64,
    phases: Vec<f64>,
}

/// Flies without a plan over a floor on which every column must be discovered; a new planner takes over at a tick.
fn fly(values: &[(&str, f64)], motion: Motion, swap_at: Option<u64>) -> Flown {
    let (bench, columns) = (Bench::new(), cup());
    let site = site(&[], motion);
    let mut planner: BvoApf = bench.configure(values, &site).unwrap();
    let mut pose = Pose { position: START, heading_rad: 0.0 };
    let mut flown = Flown { arrived: false, clearance_m: f64::INFINITY, phases: Vec::new() };
    for tick in 0..4000 {
        if swap_at == Some(tick) {
            planner = bench.configure(values, &site).unwrap();
        }
        // The estimated position is off by a few centimetres, and the error changes slowly.
        let off = Vector::new((tick as f64 * 0.01).sin(), (tick as f64 * 0.013).cos()) * 0.03;
        let believed = pose.position + off;
        if (believed - GOAL).norm() < 0.2 {
            flown.arrived = true;
            break;
        }
        let distance_m = |o: &Obstacle<'_>, at: Point| match o.outline {
            Outline::Disc { center, radius_m } => (center - at).norm() - radius_m,
            _ => f64::INFINITY,
        };
        let near: Vec<Obstacle<'_>> = columns
            .iter()
            .copied()
            .filter(|o| distance_m(o, believed) < site.limits.sensing_range_m)
            .collect();
        let estimate = planner_api::PoseEstimate {
            position: believed,
            heading_rad: pose.heading_rad,
            covariance: nalgebra::Matrix3::from_diagonal(&nalgebra::Vector3::new(9e-4, 9e-4, 1e-4)),
        };
        let targets = [GOAL];
        let sensed =
            Sensed { targets_ahead: &targets, obstacles: &near, ..Sensed::new(tick, TICK_S, estimate, GOAL) };
        let command = planner.step(&sensed, &bench.ctx()).unwrap();
        flown.phases.extend(bench.scalar("phase"));
        bench.clear();
        pose = moved(&pose, command.drive, motion);
        let clearance_m = columns.iter().map(|o| distance_m(o, pose.position) - 0.25).fold(9.0, f64::min);
        flown.clearance_m = flown.clearance_m.min(clearance_m);
    }
    flown
}

fn moved(pose: &Pose, drive: Drive, motion: Motion) -> Pose {
    let Drive::Velocity(velocity) = drive else { return *pose };
    if velocity.norm() < 1e-9 {
        return *pose;
    }
    let bearing_rad = velocity.y.atan2(velocity.x);
    if motion == Motion::Point {
        return Pose { position: pose.position + velocity * TICK_S, heading_rad: bearing_rad };
    }
    let off_rad = wrap_angle_rad(bearing_rad - pose.heading_rad);
    let turn_rad = (2.5 * off_rad).clamp(-1.0, 1.0) * TICK_S;
    let ahead_m = if off_rad.abs() > PI / 3.0 { 0.0 } else { velocity.norm() * off_rad.cos() * TICK_S };
    pose.moved(ahead_m, 0.0, turn_rad)
}

#[test]
fn in_flight_it_leaves_a_trap_that_it_had_to_discover() {
    for motion in [Motion::Point, Motion::Unicycle] {
        for mode in 0..4 {
            let values = [("mode", f64::from(mode)), ("rho_0_m", 1.0), ("k_rep", 1.0)];
            let flown = fly(&values, motion, None);
            assert!(flown.arrived, "{motion:?} mode {mode}");
            assert!(flown.clearance_m > 0.0);
            assert!(flown.phases.contains(&1.0) && flown.phases.contains(&2.0));
        }
    }
}

#[test]
fn a_swap_in_the_middle_of_a_trap_is_survived() {
    for swap_at in [150, 250, 400] {
        let flown = fly(&[("mode", 2.0), ("rho_0_m", 1.0), ("k_rep", 1.0)], Motion::Unicycle, Some(swap_at));
        assert!(flown.arrived && flown.clearance_m > 0.0, "{swap_at}");
    }
}

/// A robot without a plan meets a cart that crosses its way to the goal from one side, at the robot's own speed.
fn crossed(from_y_m: f64) -> (bool, f64) {
    let (bench, open) = (Bench::new(), site(&[], Motion::Unicycle));
    let mut planner: BvoApf = bench.configure(&[("rho_0_m", 1.0), ("k_rep", 1.0)], &open).unwrap();
    let mut pose = Pose { position: START, heading_rad: 0.0 };
    let velocity = Vector2::new(0.0, -0.35 * from_y_m.signum());
    let mut clearance_m = f64::INFINITY;
    for tick in 0..1200 {
        if (pose.position - GOAL).norm() < 0.2 {
            return (true, clearance_m);
        }
        let center = Point::new(-2.0, from_y_m) + velocity * (tick as f64 * TICK_S);
        let distance_m = (center - pose.position).norm() - 0.4;
        clearance_m = clearance_m.min(distance_m - open.limits.radius_m);
        let outline = Outline::Disc { center, radius_m: 0.4 };
        // The console knows a velocity only after the second sighting.
        let seen_m = Vector2::zeros();
        let known = if distance_m < open.limits.sensing_range_m - 0.05 { velocity } else { seen_m };
        let cart = [Obstacle { id: 9, outline, discovered: true, velocity_m_per_s: known }];
        let in_sight = distance_m < open.limits.sensing_range_m;
        let estimate =
            planner_api::PoseEstimate { heading_rad: pose.heading_rad, ..exact_pose(pose.position) };
        let sensed = Sensed {
            targets_ahead: &[GOAL],
            obstacles: if in_sight { &cart } else { &[] },
            ..Sensed::new(tick, TICK_S, estimate, GOAL)
        };
        let command = planner.step(&sensed, &bench.ctx()).unwrap();
        bench.clear();
        pose = moved(&pose, command.drive, Motion::Unicycle);
    }
    (false, clearance_m)
}

#[test]
fn what_crosses_its_way_is_met_where_it_will_be() {
    for from_y_m in [-5.0, -4.0, -3.5, -3.0, 3.0, 3.5, 4.0, 5.0] {
        let (arrived, clearance_m) = crossed(from_y_m);
        assert!(arrived && clearance_m > 0.0, "{from_y_m} {arrived} {clearance_m}");
    }
}

#[test]
fn a_map_that_is_too_large_is_refused_before_it_plans_with_what_to_choose_instead() {
    let refusal = check_size(PARTS_MOST + 1).unwrap_err();
    assert_eq!(refusal.code, Code::Unsupported);
    assert!(refusal.message.contains("at most 4000") && refusal.message.contains("this map has 4001"));
    assert!(refusal.message.contains("choose shortest, navfn or apf-dwa"));
    assert!(check_size(PARTS_MOST).is_ok());
}

#[test]
fn a_change_of_live_parameters_acts_like_a_new_planner() {
    let changed = trials::changed::<BvoApf>(&[], &[("slow_m", 3.0)]);
    assert!(changed.after == changed.fresh && changed.after != changed.before, "{changed:?}");
}
