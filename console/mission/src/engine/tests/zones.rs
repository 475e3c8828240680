//! No-go zones that are drawn during a mission.

use super::covering::covering;
use super::*;

fn zone((west, south): (f64, f64), (east, north): (f64, f64)) -> Order {
    let corners = [(west, south), (east, south), (east, north), (west, north)];
    Order::DrawZone(corners.map(|(x, y)| Point::new(x, y)).to_vec())
}

fn under_way() -> Flight {
    let mut flight = Flight::new(covering());
    flight.tick(&[Order::Start]);
    flight.fly(400);
    flight
}

#[test]
fn a_zone_drawn_under_way_is_no_floor_and_the_planner_goes_on_with_it_on_its_map() {
    let mut flight = under_way();
    let before = flight.mission.known.floor.coverage.counts().reachable;
    let events = flight.tick(&[zone((-1.0, 0.0), (1.0, 2.0))]);
    assert!(
        events.iter().any(|kind| matches!(kind, EventKind::ZoneDrawn { zone } if zone.name == "no-go 1"))
    );
    let lost = (before - flight.mission.known.floor.coverage.counts().reachable) as f64 * 0.01;
    assert!(lost > 3.0 && lost < 12.0, "{lost} m2 of floor");
    assert_eq!(
        flight.planner.chosen,
        ["straight", "straight"],
        "the planner's steering needs to know the zone, too"
    );
    let site = flight.planner.sites.last().unwrap();
    assert_eq!((site.zones.len(), site.revision), (1, 1));
    assert!(flight.planner.kept[1].is_some(), "the planner keeps to its plan");
    assert_eq!(flight.mission.phase(), &Phase::Running(Gait::Steady));
    flight.fly(6000);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
}

#[test]
fn a_plan_from_before_the_start_is_made_again_for_a_zone() {
    let mut flight = Flight::new(covering());
    let no_go = || zone((-1.0, 0.0), (1.0, 2.0));
    flight.tick(&[no_go()]);
    flight.fly(5);
    assert_eq!(flight.planner.plans, 0, "no plan has been requested");
    flight.tick(&[Order::Plan]);
    flight.fly(5);
    assert_eq!(flight.planner.plans, 1);
    flight.tick(&[no_go()]);
    flight.fly(5);
    assert_eq!((flight.planner.plans, flight.mission.phase()), (2, &Phase::Waiting));
    assert_eq!(flight.planner.sites.last().unwrap().zones.len(), 2);
}

#[test]
fn a_zone_drawn_while_the_robot_is_held_is_planned_for_at_once_and_nothing_moves() {
    let mut flight = under_way();
    flight.tick(&[Order::Hold]);
    let before = flight.pose;
    flight.tick(&[swap_to("other"), zone((-1.0, 0.0), (1.0, 2.0))]);
    flight.fly(5);
    assert_eq!((flight.pose, flight.held_by()), (before, Some(&HoldReason::Operator)));
    assert_eq!(flight.mission.planner_id(), "other", "the candidate takes over");
    assert!(flight.planner.sites.iter().rev().take(2).all(|site| site.zones.len() == 1));
}

#[test]
fn a_zone_over_the_place_where_the_robot_starts_and_one_that_is_none_are_refused() {
    let mut flight = under_way();
    let here = flight.pose.position;
    let orders = [
        (around(covering().start.position), "the start is in the zone"),
        (zone((1.0, 1.0), (1.0, 2.0)), "enclose"),
        (zone((1.0, 1.0), (1e308, 1e308)), "within 10000 m"),
        (zone((15.0, 15.0), (16.0, 16.0)), "outside the tank"),
        (zone((-9.0, here.y - 0.8), (9.0, here.y - 0.4)), "would block every path"),
    ];
    for (order, why) in orders {
        let events = flight.tick(std::slice::from_ref(&order));
        assert!(refusal(&events).is_some_and(|text| text.contains(why)), "{why}: {events:?}");
    }
    let good = zone((-1.0, 0.0), (1.0, 2.0));
    assert_eq!(refusal(&flight.tick(std::slice::from_ref(&good))), None);
    assert_eq!(refusal(&flight.tick(&[good])), None, "the second zone gets a different name");
    let names: Vec<&str> =
        flight.mission.known.chart.world().zones.iter().map(|zone| zone.name.as_str()).collect();
    assert_eq!(names, ["no-go 1", "no-go 2"]);
}

fn around(p: Point) -> Order {
    zone((p.x - 0.5, p.y - 0.5), (p.x + 0.5, p.y + 0.5))
}

#[test]
fn a_zone_over_the_robot_holds_it_and_the_robot_drives_out_of_it_on_order() {
    let mut flight = under_way();
    let here = flight.pose.position;
    let corners = crate::outline::boxed(here - Vector::new(0.5, 0.5), here + Vector::new(0.5, 0.5));
    assert!(flight.mission.zone_cost(&corners).is_ok_and(|cost| cost.holds));
    let events = flight.tick(&[Order::DrawZone(corners)]);
    assert!(
        events.iter().any(|kind| matches!(kind, EventKind::ZoneBreached { zone, .. } if zone == "no-go 1"))
    );
    let is_crit = |event: &&Event| {
        event.log_line(&[]).is_some_and(|line| line.severity == crate::event::Severity::Crit)
    };
    let crit = flight.events.iter().filter(is_crit).count();
    assert_eq!(crit, 2, "the breach and the hold");
    assert_eq!(flight.held_by(), Some(&HoldReason::ZoneBreached { zone: "no-go 1".into() }));
    flight.fly(50);
    assert!((flight.pose.position - here).norm() < 0.1, "it stands");
    assert_eq!(refusal(&flight.tick(&[Order::DriveBack])), None);
    while flight.ended().is_none() {
        flight.tick(&[]);
    }
    let left = flight.events.iter().filter(|event| matches!(event.kind, EventKind::ZoneLeft { .. })).count();
    assert_eq!((left, flight.ended()), (1, Some(Outcome::Aborted)));
}

#[test]
fn a_planner_that_finds_no_way_out_of_a_zone_holds_the_robot_soon() {
    let mut flight = under_way();
    flight.tick(&[around(flight.pose.position)]);
    flight.planner.stuck_from_tick = Some(0);
    for attempt in 0..2 {
        let plans = flight.planner.plans;
        flight.tick(&[Order::Resume]);
        let ticks = (0..).take_while(|_| {
            flight.tick(&[]);
            flight.held_by().is_none()
        });
        assert!((5..20).contains(&ticks.count()), "attempt {attempt}");
        let why = "planner straight finds no way out of zone no-go 1";
        assert_eq!(flight.held_by(), Some(&HoldReason::Stuck { message: why.into() }));
        assert!(flight.planner.plans <= plans + 1, "the planner does not plan in circles");
    }
    assert_eq!(refusal(&flight.tick(&[Order::DriveBack])), None);
}

#[test]
fn a_zone_right_in_front_of_the_robot_holds_it_if_it_does_not_stop_in_time() {
    let mut flight = under_way();
    let radius_m = flight.mission.known.config.limits.radius_m;
    let ahead = flight.pose.direction();
    let front = flight.pose.position + ahead * (radius_m + 0.02);
    let corners = crate::outline::round(front + ahead * 0.5, 0.5);
    assert!(flight.mission.zone_cost(&corners).is_ok_and(|cost| !cost.holds));
    assert_eq!(refusal(&flight.tick(&[Order::DrawZone(corners)])), None);
    assert_eq!(flight.held_by(), None, "the hull is outside");
    for _ in 0..5 {
        flight.pose.position += ahead * 0.05;
        flight.tick(&[]);
    }
    assert_eq!(flight.held_by(), Some(&HoldReason::ZoneBreached { zone: "no-go 1".into() }));
}

#[test]
fn a_zone_over_a_robot_that_has_not_started_is_refused() {
    let task = TaskConfig::Goto { goal: Point::new(4.0, 0.0), tolerance_m: 0.1 };
    let mut flight = Flight::new(MissionConfig { task, ..config() });
    let here = flight.pose.position;
    let events = flight.tick(&[around(here)]);
    assert!(refusal(&events).is_some_and(|why| why.contains("the robot is in the zone")), "{events:?}");
}

#[test]
fn a_zone_over_a_part_of_a_preset_path_is_gone_round_and_one_over_all_of_the_rest_is_refused() {
    let path = (0..40).map(|k| Point::new(-4.0 + 0.2 * f64::from(k), 0.0)).collect();
    let task = TaskConfig::Follow { path, tolerance_m: 0.2 };
    let mut flight = Flight::new(MissionConfig { task, ..config() });
    flight.tick(&[Order::Start]);
    flight.fly(20);
    let over = |west: f64, east: f64| zone((west, -0.4), (east, 0.4));
    let events = flight.tick(&[over(0.0, 9.0)]);
    assert!(refusal(&events).is_some_and(|text| text.contains("end of the path")), "{events:?}");
    assert_eq!(refusal(&flight.tick(&[over(-1.0, 1.0)])), None);
    let is_beyond = |flight: &Flight| flight.mission.known.task.target().x > 1.0;
    let targets: Vec<f64> = (0..200)
        .map(|_| {
            flight.tick(&[]);
            flight.mission.known.task.target().x
        })
        .collect();
    let within = targets.iter().filter(|x| (-1.0..=1.0).contains(*x)).count();
    assert!(within == 0 && is_beyond(&flight), "{targets:?}");
}
