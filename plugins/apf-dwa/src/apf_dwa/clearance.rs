//! Tests that plan and flight keep the required clearance, or that the plan reports a lack of clearance.
#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use planner_api::{Boundary, Obstacle, Point2, Reason, Task, testing::Bench};
use trials::{discs, exact_pose};

const START: Point2<f64> = Point2::new(0.0, 0.0);
const GOAL: Point2<f64> = Point2::new(12.0, 0.0);
const TOLERANCE_M: f64 = 0.2;
const TICK_S: f64 = 0.1;
/// Tolerance of the comparisons, metres.
const EXACT_M: f64 = 1e-6;

fn site<'a>(obstacles: &'a [Obstacle<'a>], radius_m: f64, clearance_m: f64) -> Site<'a> {
    Site {
        revision: 0,
        boundary: Boundary::Circle { radius_m: 20.0 },
        obstacles,
        zones: &[],
        limits: Limits {
            motion: Motion::Unicycle,
            v_max_m_per_s: 0.4,
            w_max_rad_per_s: 1.0,
            radius_m,
            sensing_range_m: 8.0,
            acceleration_m_per_s2: 0.5,
            tick_s: TICK_S,
            amphibious: None,
        },
        swath_m: 0.5,
        clearance_m,
        seed: 0,
    }
}

/// The outcome of a plan and a flight for one set of requirements, and the clearances that they keep.
#[derive(Debug)]
struct Kept {
    is_complete: bool,
    is_warned: bool,
    arrived: bool,
    plan_m: f64,
    flight_m: f64,
}

fn fly(columns: &[(Point2<f64>, f64)], radius_m: f64, clearance_m: f64, guide: f64) -> Kept {
    let (bench, obstacles) = (Bench::new(), discs::obstacles(columns));
    let site = site(&obstacles, radius_m, clearance_m);
    let mut planner: ApfDwa = bench.configure(&[("guide", guide)], &site).unwrap();
    let task = Task::Goto { goal: GOAL, tolerance_m: TOLERANCE_M };
    let plan = planner.plan(&PlanRequest::new(&Reason::Start, exact_pose(START), task, &site), &bench.ctx());
    let is_warned = bench.logs().iter().any(|(level, _)| *level == LogLevel::Warn);
    let plan = plan.unwrap();
    let mut kept = Kept {
        is_complete: plan.complete,
        is_warned,
        arrived: false,
        plan_m: discs::path_distance_m(columns, &plan.path) - radius_m,
        flight_m: f64::INFINITY,
    };
    let (mut pose, mut twist) = (Pose { position: START, heading_rad: 0.0 }, Twist::default());
    for tick in 0..1200 {
        kept.flight_m = kept.flight_m.min(discs::distance_m(columns, pose.position) - radius_m);
        kept.arrived = (pose.position - GOAL).norm() < TOLERANCE_M;
        if kept.arrived {
            break;
        }
        let estimate =
            planner_api::PoseEstimate { heading_rad: pose.heading_rad, ..exact_pose(pose.position) };
        let sensed = Sensed {
            v_m_per_s: twist.v_m_per_s,
            w_rad_per_s: twist.w_rad_per_s,
            targets_ahead: &[GOAL],
            obstacles: &obstacles,
            ..Sensed::new(tick, TICK_S, estimate, GOAL)
        };
        let command = planner.step(&sensed, &bench.ctx()).unwrap();
        bench.clear();
        let Drive::Twist { v_m_per_s, w_rad_per_s } = command.drive else { panic!("a twist") };
        twist = Twist { v_m_per_s, w_rad_per_s };
        pose = moved(&pose, twist, TICK_S);
    }
    kept
}

#[test]
fn whatever_the_hull_and_the_clearance_plan_and_flight_keep_them_past_a_column() {
    let column = [(Point2::new(6.0, 0.3), 0.05)];
    for radius_m in [0.2, 0.5, 0.9, 1.0, 1.4, 2.0] {
        for clearance_m in [0.0, 0.1, 0.7, 1.5] {
            for guide in [0.0, 1.0] {
                let kept = fly(&column, radius_m, clearance_m, guide);
                let what = format!("radius {radius_m}, clearance {clearance_m}, guide {guide}: {kept:?}");
                assert!(kept.flight_m >= clearance_m - EXACT_M, "{what}");
                assert!(kept.plan_m >= clearance_m - EXACT_M || kept.is_warned, "{what}");
                assert_eq!(kept.is_complete, !kept.is_warned, "{what}");
                // The robot passes by way of the corners of the shortest path; the paper's square may lead nowhere.
                assert!(guide < 0.5 || (kept.arrived && kept.is_complete), "{what}");
            }
        }
    }
}

#[test]
fn a_clearance_that_cannot_be_kept_at_the_goal_is_named_and_the_robot_stops_before_it() {
    let column = [(Point2::new(12.0, 1.0), 0.05)];
    for guide in [0.0, 1.0] {
        let kept = fly(&column, 0.5, 0.9, guide);
        assert!(!kept.is_complete && kept.is_warned && kept.flight_m >= 0.9 - EXACT_M, "{guide}: {kept:?}");
    }
}
