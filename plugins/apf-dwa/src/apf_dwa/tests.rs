#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use geometry::Point;
use planner_api::{Code, Obstacle, Outline, Reason, Task, Vector2, testing::Bench};
use proptest::prelude::*;
use trials::{
    amphibious::{AmphibiousLayout, Group},
    cross, exact_pose,
};

fn with_planner<T>(
    values: &[(&str, f64)],
    seed: u64,
    act: impl FnOnce(&mut ApfDwa, &Site<'_>, &Bench) -> T,
) -> T {
    let (bench, layout) = (Bench::new(), AmphibiousLayout::random(Group::Free, seed));
    let (corners, obstacles, water) =
        (AmphibiousLayout::corners(), layout.obstacles(), AmphibiousLayout::water());
    let zones = AmphibiousLayout::zones(&water);
    let site = AmphibiousLayout::site(&corners, &obstacles, &zones);
    let mut planner = bench.configure(values, &site).unwrap();
    act(&mut planner, &site, &bench)
}

const GOAL: Point = Point::new(4.5, 4.5);

fn request<'a>(site: &'a Site<'a>, task: Task<'a>) -> PlanRequest<'a> {
    let start = planner_api::PoseEstimate { heading_rad: 0.8, ..exact_pose(Point::new(-4.5, -4.5)) };
    PlanRequest::new(&Reason::Start, start, task, site)
}

#[test]
fn a_plan_is_the_run_of_the_loop_and_reports_its_overspeed() {
    with_planner(&[], 3, |planner, site, bench| {
        let task = Task::Goto { goal: GOAL, tolerance_m: 0.15 };
        let plan = planner.plan(&request(site, task), &bench.ctx()).unwrap();
        assert!(plan.complete, "{:?}", bench.logs());
        assert!(plan.path.windows(2).all(|w| (w[1] - w[0]).norm() <= 0.023 + 1e-9));
        assert!(bench.scalar("overspeed").unwrap() < 1e-9);
    });
}

#[test]
fn preset_paths_are_refused_with_the_reason() {
    with_planner(&[], 3, |planner, site, bench| {
        let targets = [GOAL];
        let task = Task::Follow { targets: &targets, tolerance_m: 0.1 };
        assert_eq!(planner.plan(&request(site, task), &bench.ctx()).unwrap_err().code, Code::Unsupported);
    });
}

fn sensed<'a>(pose: Pose, tick: u64, twist: Twist, obstacles: &'a [Obstacle<'a>]) -> Sensed<'a> {
    let estimate = planner_api::PoseEstimate { heading_rad: pose.heading_rad, ..exact_pose(pose.position) };
    Sensed {
        v_m_per_s: twist.v_m_per_s,
        w_rad_per_s: twist.w_rad_per_s,
        targets_ahead: std::slice::from_ref(&GOAL),
        obstacles,
        ..Sensed::new(tick, 0.1, estimate, GOAL)
    }
}

/// Flies with a noisy pose; at the tick `new_at`, a new planner takes over.
fn fly(seed: u64, new_at: Option<u64>) -> (bool, f64) {
    let layout = AmphibiousLayout::random(Group::Block, seed);
    let obstacles = layout.obstacles();
    with_planner(&[], seed, |_, site, bench| {
        let blind = Site { obstacles: &[], ..*site };
        let mut planner: ApfDwa = bench.configure(&[], &blind).unwrap();
        let (mut pose, mut twist) = (Pose::new(-4.5, -4.5, 0.8), Twist::default());
        let mut clearance_m = f64::INFINITY;
        for tick in 0..3000 {
            if new_at == Some(tick) {
                planner = bench.configure(&[], &blind).unwrap();
            }
            if (pose.position - GOAL).norm() < 0.2 {
                return (true, clearance_m);
            }
            let near = |o: &&Obstacle<'_>| match o.outline {
                Outline::Disc { center, radius_m } => (center - pose.position).norm() - radius_m < 2.5,
                _ => true,
            };
            let near: Vec<Obstacle<'_>> = obstacles.iter().filter(near).copied().collect();
            let shake = Vector2::new((tick as f64 * 0.3).sin(), (tick as f64 * 0.2).cos()) * 0.02;
            let believed = Pose { position: pose.position + shake, ..pose };
            let command = planner.step(&sensed(believed, tick, twist, &near), &bench.ctx()).unwrap();
            bench.clear();
            let Drive::Twist { v_m_per_s, w_rad_per_s } = command.drive else { panic!("a twist") };
            twist = Twist { v_m_per_s, w_rad_per_s };
            pose = moved(&pose, twist, 0.1);
            clearance_m = clearance_m.min(layout.hull_clearance_m(pose.position));
        }
        (false, clearance_m)
    })
}

#[test]
fn in_flight_it_arrives_though_it_must_discover_everything_and_is_swapped_on_the_way() {
    for seed in 40..46 {
        for new_at in [None, Some(200), Some(450)] {
            let (arrived, clearance_m) = fly(seed, new_at);
            assert!(arrived && clearance_m > 0.05, "{seed} {new_at:?} {clearance_m}");
        }
    }
}

#[test]
fn a_robot_turns_as_briskly_for_its_turn_rate_as_the_one_of_the_paper() {
    let turning = |w_max_rad_per_s: f64, values: &[(&str, f64)]| {
        with_planner(values, 3, |_, site, bench| {
            let limits = Limits { amphibious: None, w_max_rad_per_s, ..site.limits };
            let planner: ApfDwa = bench.configure(values, &Site { limits, ..*site }).unwrap();
            planner.settings.window.turn_acceleration_rad_per_s2
        })
    };
    let is = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    is(turning(0.12, &[]), 0.4);
    is(turning(1.2, &[]), 4.0);
    is(turning(1.2, &[("turn_acceleration_rad_per_s2", 0.7)]), 0.7);
    let paper = with_planner(&[], 3, |planner, _, _| planner.settings.window.turn_acceleration_rad_per_s2);
    is(paper, 0.4);
}

#[test]
fn what_crosses_its_way_is_met_where_it_will_be() {
    for from_y_m in [-5.0, -4.0, -3.5, -3.0, 3.0, 3.5, 4.0, 5.0] {
        for guide in [0.0, 1.0] {
            let crossing = cross::<ApfDwa>(&[("guide", guide)], from_y_m);
            assert!(crossing.arrived && crossing.clearance_m > 0.0, "{from_y_m} {guide} {crossing:?}");
        }
    }
}

#[test]
fn it_reports_ten_distances_the_mode_and_the_limit() {
    with_planner(&[], 3, |planner, site, bench| {
        let at = Pose::new(-4.5, -4.5, 0.8);
        planner.step(&sensed(at, 0, Twist::default(), site.obstacles), &bench.ctx()).unwrap();
        assert!(DISTANCES.iter().all(|name| bench.scalar(name).is_some()));
        assert_eq!((bench.scalar("mode"), bench.scalar("speed_limit")), (Some(1.0), Some(0.23)));
        assert!(bench.scalar("F_att").is_some() && bench.scalar("safe_distance").is_some());
    });
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn whatever_is_sensed_the_command_is_a_number_within_the_limits(
        at in (-6.0..6.0_f64, -6.0..6.0_f64), heading in -4.0..4.0_f64, v in -1.0..1.0_f64, w in -1.0..1.0_f64,
        on_top in any::<bool>(),
    ) {
        with_planner(&[], 3, |planner, site, bench| {
            let place = if on_top { AmphibiousLayout::random(Group::Free, 3).discs[0].0 } else { Point::new(at.0, at.1) };
            let pose = Pose { position: place, heading_rad: heading };
            let twist = Twist { v_m_per_s: v, w_rad_per_s: w };
            let command = planner.step(&sensed(pose, 0, twist, site.obstacles), &bench.ctx()).unwrap();
            let Drive::Twist { v_m_per_s, w_rad_per_s } = command.drive else { panic!("a twist") };
            assert!(v_m_per_s.is_finite() && w_rad_per_s.is_finite());
            assert!(v_m_per_s >= 0.0 && v_m_per_s <= v.max(0.23) + 0.01);
        });
    }
}

#[test]
fn a_change_of_live_parameters_acts_like_a_new_planner() {
    let changed = trials::changed::<ApfDwa>(&[], &[("guard_m", 0.6)]);
    assert!(changed.after == changed.fresh && changed.after != changed.before, "{changed:?}");
}
