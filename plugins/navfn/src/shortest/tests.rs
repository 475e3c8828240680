use super::*;
use crate::trial::{clearance_m, plan, plan_trap, planner};
use planner_api::{
    Boundary, Code, Limits, Motion, Obstacle, Outline, Point2, Reason, Task, Vector2, Zone, ZoneKind,
    testing::Bench,
};
use trials::{
    exact_pose,
    traps::{Kind, Trap},
};
use world::polyline;

fn site<'a>(obstacles: &'a [Obstacle<'a>], zones: &'a [Zone<'a>]) -> Site<'a> {
    Site {
        revision: 0,
        boundary: Boundary::Circle { radius_m: 10.0 },
        obstacles,
        zones,
        limits: Limits {
            motion: Motion::Unicycle,
            v_max_m_per_s: 0.4,
            w_max_rad_per_s: 1.0,
            radius_m: 0.25,
            sensing_range_m: 3.0,
            acceleration_m_per_s2: 0.5,
            tick_s: 0.1,
            amphibious: None,
        },
        swath_m: 0.5,
        clearance_m: 0.1,
        seed: 0,
    }
}

fn disc(x: f64, y: f64, radius_m: f64) -> Obstacle<'static> {
    let outline = Outline::Disc { center: Point2::new(x, y), radius_m };
    Obstacle { id: 7, outline, discovered: false, velocity_m_per_s: Vector2::zeros() }
}

fn asked(from: (f64, f64), to: (f64, f64), site: &Site<'_>) -> Result<Plan> {
    plan(&mut planner::<Shortest>(&[], site), Point2::new(from.0, from.1), Point2::new(to.0, to.1), site)
}

#[test]
fn it_leaves_every_trap_by_a_way_that_is_clear_and_as_long_as_it_says() {
    for trap in (0..12).flat_map(|seed| Kind::ALL.map(|kind| Trap::random(kind, seed))) {
        let plan = plan_trap::<Shortest>(&trap).unwrap();
        assert!(plan.complete && clearance_m(&plan.path, &trap) >= 0.0);
        let drawn = polyline::length_m(&plan.path) / plan.cost;
        assert!((1.0 - 1e-9..1.0 + 1e-5).contains(&drawn), "{drawn}");
    }
}

#[test]
fn points_of_the_plan_are_near_enough_to_be_followed() {
    let obstacles = [disc(0.0, 0.0, 1.0)];
    let plan = asked((-5.0, 0.0), (5.0, 0.0), &site(&obstacles, &[])).unwrap();
    assert!(plan.path.windows(2).all(|w| (w[1] - w[0]).norm() <= 0.2 + 1e-9));
}

#[test]
fn a_no_go_zone_is_gone_round() {
    let outline = Outline::Disc { center: Point2::origin(), radius_m: 2.0 };
    let zones = [Zone { kind: ZoneKind::NoGo, outline }, Zone { kind: ZoneKind::Land, outline }];
    let plan = asked((-5.0, 0.0), (5.0, 0.0), &site(&[], &zones)).unwrap();
    let near_m = plan.path.iter().map(|p| p.coords.norm()).fold(f64::INFINITY, f64::min);
    assert!((2.35..2.351).contains(&near_m), "{near_m}");
}

#[test]
fn a_refusal_says_what_is_wrong() {
    let obstacles = [disc(0.0, 0.0, 1.0)];
    let site = site(&obstacles, &[]);
    let code = |from, to| asked(from, to, &site).unwrap_err().code;
    assert_eq!(code((-1.1, 0.0), (5.0, 0.0)), Code::StartOccupied);
    assert_eq!(code((-5.0, 0.0), (0.5, 0.0)), Code::GoalOccupied);
    assert_eq!(code((-11.0, 0.0), (5.0, 0.0)), Code::StartOutside);
    assert_eq!(code((-5.0, 0.0), (12.0, 0.0)), Code::GoalOutside);
    assert_eq!(code((-5.0, 0.0), (f64::NAN, 0.0)), Code::Invalid);
    let error = asked((-1.1, 0.0), (5.0, 0.0), &site).unwrap_err();
    assert_eq!(
        error.message,
        "the start touches obstacle 7: (-1.10, 0.00) is only 0.10 m from it; the hull needs 0.25 m"
    );
}

#[test]
fn a_start_within_the_clearance_is_left_and_a_goal_within_it_is_reached() {
    let obstacles = [disc(0.0, 0.0, 1.0)];
    let plan = asked((-1.27, 0.0), (0.0, 1.27), &site(&obstacles, &[])).unwrap();
    assert!(plan.complete && plan.path.iter().all(|p| p.coords.norm() >= 1.25));
}

#[test]
fn a_closed_ring_is_proved_to_be_closed() {
    let obstacles: Vec<Obstacle<'_>> = (0..12)
        .map(|k| f64::from(k) * std::f64::consts::TAU / 12.0)
        .map(|bearing| disc(3.0 * bearing.cos(), 3.0 * bearing.sin(), 0.5))
        .collect();
    let error = asked((-6.0, 0.0), (0.0, 0.0), &site(&obstacles, &[])).unwrap_err();
    assert_eq!(error.code, Code::NoPath);
    assert!(error.message.starts_with("proved: there is no path"), "{}", error.message);
}

#[test]
fn what_is_discovered_on_the_goal_under_way_is_no_reason_to_stop() {
    let obstacles = [Obstacle { discovered: true, ..disc(5.0, 0.2, 0.4) }];
    let site = site(&obstacles, &[]);
    let mut planner = planner::<Shortest>(&[], &site);
    let bench = Bench::new();
    let task = Task::Goto { goal: Point2::new(5.0, 0.0), tolerance_m: 0.1 };
    let start = exact_pose(Point2::new(-5.0, 0.0));
    let mut ask = |reason| {
        let request = PlanRequest::new(&reason, start, task, &site);
        planner.plan(&request, &bench.ctx())
    };
    let plan = ask(Reason::MapChanged).unwrap();
    assert!(!plan.complete && plan.path[plan.path.len() - 1] == Point2::new(5.0, 0.0));
    assert_eq!(ask(Reason::Start).unwrap_err().code, Code::GoalOccupied);
    assert_eq!(
        bench.logs()[0].1,
        "obstacle 7 is on the goal; the robot will continue to the goal if the obstacle moves away"
    );
}

#[test]
fn a_long_obstacle_discovered_on_the_goal_is_not_planned_through() {
    let points =
        [Point2::new(3.0, -4.0), Point2::new(3.0, 4.0), Point2::new(5.0, 4.0), Point2::new(5.0, 0.0)];
    let outline = Outline::Polyline { points: &points, half_width_m: 0.1 };
    let obstacles = [Obstacle { id: 8, outline, discovered: true, velocity_m_per_s: Vector2::zeros() }];
    let site = site(&obstacles, &[]);
    let task = Task::Goto { goal: Point2::new(5.0, 0.0), tolerance_m: 0.1 };
    for from_m in [-5.0, 2.8] {
        let start = exact_pose(Point2::new(from_m, 0.0));
        let request = PlanRequest::new(&Reason::MapChanged, start, task, &site);
        let plan = planner::<Shortest>(&[], &site).plan(&request, &Bench::new().ctx()).unwrap();
        assert!(!plan.complete && plan.path.iter().all(|at| at.x < 2.9), "{:?}", plan.path);
    }
}
