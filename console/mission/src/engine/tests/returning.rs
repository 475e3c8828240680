//! The robot drives back by order, without a planner, and is held if its hull is in a no-go zone.

use super::{arrivals::replay, covering::covering, tethered::tethered, *};
use crate::{Home, event::TetherAlarm};
use world::{Zone, ZoneKind};

/// A robot that is held during its mission.
fn held(config: MissionConfig, ticks: usize) -> Flight {
    let mut flight = Flight::new(config);
    flight.tick(&[Order::Start]);
    flight.fly(ticks);
    flight.tick(&[Order::Hold]);
    flight
}

fn reason(flight: &Flight) -> &str {
    let mut reasons = flight.events.iter().filter_map(|event| match &event.kind {
        EventKind::Ended { reason, .. } => Some(reason.as_str()),
        _ => None,
    });
    reasons.next_back().unwrap_or_default()
}

fn has(events: &[EventKind], is_kind: impl Fn(&EventKind) -> bool) -> bool {
    events.iter().any(is_kind)
}

/// Draws a zone around a place without any check.
fn draw_around(flight: &mut Flight, at: Point, half_m: f64) {
    let half = Vector::new(half_m, half_m);
    let shape = Shape::Polygon { vertices: world::shape::rectangle(at - half, at + half) };
    flight.mission.known.chart.draw(Zone { name: "wet".into(), kind: ZoneKind::NoGo, shape });
}

#[test]
fn a_held_robot_drives_back_to_its_anchor_and_the_mission_ends() {
    let mut flight = held(tethered(20.0), 80);
    let out_m = (flight.pose.position - Point::new(-3.0, 0.0)).norm();
    let way = flight.mission.way_back().unwrap();
    assert!(out_m > 2.0 && (way.length_m - out_m).abs() < 0.1 && way.to == Home::Anchor, "{way:?}");
    assert!((way.clearance_m - 1.75).abs() < 0.1, "from the wall behind the anchor: {way:?}");
    let n_plans = flight.planner.plans;
    let events = flight.tick(&[Order::DriveBack]);
    assert!(has(&events, |kind| matches!(kind, EventKind::ReturnBegan { way: began } if *began == way)));
    assert!(flight.mission.phase().is_return());
    flight.fly(120);
    assert_eq!(
        (flight.ended(), reason(&flight)),
        (Some(Outcome::Aborted), "ended by operator: robot is back at the anchor")
    );
    assert!((flight.pose.position - Point::new(-3.0, 0.0)).norm() < 0.2, "{}", flight.pose.position);
    assert_eq!(flight.planner.plans, n_plans, "no planner is asked");
    let again = replay(tethered(20.0), &flight);
    assert_eq!(again, flight.events);
}

#[test]
fn a_robot_without_a_tether_drives_back_to_its_start_even_if_its_planner_has_failed() {
    let mut flight = Flight::new(config());
    flight.tick(&[Order::Start]);
    flight.planner.fail_at_tick = Some(60);
    flight.fly(70);
    assert!(matches!(flight.held_by(), Some(HoldReason::PlannerFault { .. })));
    assert_eq!(flight.mission.way_back().map(|way| way.to), Ok(Home::Start));
    flight.tick(&[Order::DriveBack]);
    flight.fly(120);
    assert_eq!(
        (flight.ended(), reason(&flight)),
        (Some(Outcome::Aborted), "ended by operator: robot is back at the start")
    );
}

#[test]
fn hold_stops_a_robot_that_drives_back_and_it_may_drive_on_or_take_up_its_task_again() {
    let mut flight = held(tethered(20.0), 80);
    flight.tick(&[Order::DriveBack]);
    flight.fly(20);
    let here = flight.pose.position;
    flight.tick(&[Order::Hold]);
    assert_eq!(flight.pose.position, here);
    flight.fly(20);
    assert_eq!((flight.pose.position, flight.held_by()), (here, Some(&HoldReason::Operator)));
    flight.tick(&[Order::DriveBack]);
    flight.fly(10);
    assert!(flight.pose.position.x < here.x - 0.1);
    flight.tick(&[Order::Hold]);
    let n_plans = flight.planner.plans;
    flight.tick(&[Order::Resume]);
    assert_eq!(flight.planner.plans, n_plans + 1, "one more plan, from the current position");
    flight.fly(300);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
}

#[test]
fn a_lost_position_holds_a_robot_that_drives_back_until_it_is_ordered_again() {
    let mut flight = held(MissionConfig { odometry_sigma_per_m: 0.5, ..tethered(20.0) }, 80);
    flight.tick(&[Order::DriveBack]);
    flight.silent = true;
    for _ in 0..200 {
        flight.tick(&[]);
        if flight.held_by().is_some() {
            break;
        }
    }
    assert_eq!(flight.held_by(), Some(&HoldReason::PositionLost));
    assert!(refusal(&flight.tick(&[Order::DriveBack])).is_some_and(|why| why.contains("position is lost")));
    flight.silent = false;
    flight.fly(30);
    assert_eq!(flight.held_by(), Some(&HoldReason::PositionLost), "the robot does not move without an order");
    flight.tick(&[Order::DriveBack]);
    flight.fly(200);
    assert_eq!(flight.ended(), Some(Outcome::Aborted));
}

#[test]
fn a_robot_drives_back_only_while_it_is_held_and_then_takes_no_order_for_planners() {
    let mut flight = Flight::new(config());
    assert!(refusal(&flight.tick(&[Order::DriveBack])).is_some_and(|why| why.contains("not been started")));
    flight.tick(&[Order::Start]);
    assert!(refusal(&flight.tick(&[Order::DriveBack])).is_some_and(|why| why.contains("requires HOLD")));
    flight.fly(30);
    flight.tick(&[Order::Hold, Order::DriveBack]);
    let shadow = Order::Shadow(PlannerChoice { id: "other".into(), parameters: Parameters::new() });
    for order in [Order::DriveBack, shadow] {
        assert!(refusal(&flight.tick(&[order])).is_some_and(|why| why.contains("driving back")));
    }
}

#[test]
fn a_drive_back_makes_no_progress_along_the_task_and_its_time_does_not_count() {
    let config = MissionConfig { time_limit_s: 62.0, ..covering() };
    let mut flight = held(config, 600);
    let done = flight.mission.known.task.done();
    flight.tick(&[Order::DriveBack]);
    while flight.ended().is_none() {
        flight.tick(&[]);
    }
    assert_eq!(flight.ended(), Some(Outcome::Aborted), "{}", reason(&flight));
    assert!((flight.mission.known.task.done() - done).abs() < 1e-12);
}

#[test]
fn a_hull_in_a_zone_is_held_once_and_drives_out_of_it() {
    for config in [config(), tethered(20.0)] {
        let mut flight = Flight::new(config);
        flight.tick(&[Order::Start]);
        flight.fly(80);
        let here = flight.pose.position;
        // The robot is near the western side of the zone, which lies ahead of it.
        draw_around(&mut flight, here + Vector::new(0.8, 0.3), 1.0);
        let events = flight.tick(&[]);
        assert!(has(&events, |kind| matches!(kind, EventKind::ZoneBreached { zone, .. } if zone == "wet")));
        assert_eq!(flight.held_by(), Some(&HoldReason::ZoneBreached { zone: "wet".into() }));
        flight.fly(10);
        let way = flight.mission.way_back().unwrap();
        assert!(way.length_m > 1.0, "{way:?}");
        assert_eq!(refusal(&flight.tick(&[Order::DriveBack])), None);
        flight.fly(200);
        assert_eq!(flight.ended(), Some(Outcome::Aborted), "{:?}", flight.mission.phase());
        let of_zone = |event: &&Event| {
            matches!(event.kind, EventKind::ZoneBreached { .. } | EventKind::ZoneLeft { .. })
        };
        assert_eq!(
            flight.events.iter().filter(of_zone).count(),
            2,
            "the hull entered the zone and left it again"
        );
    }
}

/// The nearest place outside the zone is beyond it, and the zone reaches from wall to wall.
#[test]
fn a_hull_in_a_zone_that_closes_the_way_round_leaves_it_along_the_tether() {
    let mut flight = Flight::new(tethered(20.0));
    flight.tick(&[Order::Start]);
    flight.fly(80);
    let here = flight.pose.position;
    let vertices = world::shape::rectangle(Point::new(here.x - 0.9, -20.0), Point::new(here.x + 0.4, 20.0));
    let shape = Shape::Polygon { vertices };
    flight.mission.known.chart.draw(Zone { name: "wet".into(), kind: ZoneKind::NoGo, shape });
    flight.tick(&[]);
    assert_eq!(flight.held_by(), Some(&HoldReason::ZoneBreached { zone: "wet".into() }));
    let way = flight.mission.way_back().unwrap();
    let straight_m = (flight.pose.position - Point::new(-3.0, 0.0)).norm();
    assert!((way.length_m - straight_m).abs() < 0.1, "{way:?}");
    assert_eq!(refusal(&flight.tick(&[Order::DriveBack])), None);
    flight.fly(300);
    assert_eq!(flight.ended(), Some(Outcome::Aborted), "{:?}", flight.mission.phase());
}

/// Every way out of the zone first leads deeper into it. The robot brakes at walls meanwhile, and at other zones.
#[test]
fn a_hull_at_the_far_side_of_a_zone_may_go_deeper_on_its_way_out() {
    let mut flight = Flight::new(tethered(20.0));
    flight.tick(&[Order::Start]);
    flight.fly(80);
    let here = flight.pose.position;
    let vertices = world::shape::rectangle(Point::new(here.x - 2.0, -20.0), Point::new(here.x + 0.1, 20.0));
    let shape = Shape::Polygon { vertices };
    flight.mission.known.chart.draw(Zone { name: "wet".into(), kind: ZoneKind::NoGo, shape });
    flight.tick(&[]);
    assert_eq!(flight.held_by(), Some(&HoldReason::ZoneBreached { zone: "wet".into() }));
    flight.fly(10);
    assert_eq!(refusal(&flight.tick(&[Order::DriveBack])), None);
    flight.fly(300);
    assert_eq!(flight.ended(), Some(Outcome::Aborted), "{:?}", flight.mission.phase());
}

#[test]
fn an_obstacle_found_on_the_way_back_is_gone_round() {
    let mut flight = held(config(), 100);
    flight.tick(&[Order::DriveBack]);
    for _ in 0..300 {
        let relative = Point::from(Point::new(-1.5, 0.1) - flight.pose.position);
        if relative.coords.norm() < 2.0 {
            let shape_in_robot = Shape::Disc { center: relative, radius_m: 0.2 };
            flight.sightings = vec![Sighting { id: ObstacleId(9), shape_in_robot }];
        }
        flight.tick(&[]);
        let apart_m = (flight.pose.position - Point::new(-1.5, 0.1)).norm();
        assert!(apart_m > 0.45, "{apart_m} m from the middle of a column of 0.2 m");
    }
    assert_eq!(flight.ended(), Some(Outcome::Aborted), "{:?}", flight.mission.phase());
    let began = flight.events.iter().filter(|event| matches!(event.kind, EventKind::ReturnBegan { .. }));
    assert!(began.count() >= 2);
}

#[test]
fn a_robot_that_cannot_go_back_says_why() {
    let mut flight = held(config(), 80);
    let at = flight.pose.position;
    let wall = [Point::new(at.x - 0.6, -6.0), Point::new(at.x - 0.6, 6.0)];
    let points = wall.iter().map(|p| Point::from(p - at)).collect();
    flight.sightings =
        vec![Sighting { id: ObstacleId(9), shape_in_robot: Shape::Polyline { points, half_width_m: 0.1 } }];
    flight.tick(&[]);
    assert_eq!(flight.mission.way_back(), Err("no path leads back to the start".into()));
    let why = flight.tick(&[Order::DriveBack]);
    assert_eq!(refusal(&why), Some("no path leads back to the start"));
    assert_eq!(flight.held_by(), Some(&HoldReason::Operator));
}

#[test]
fn a_mover_on_top_of_robot_and_tether_is_no_panic() {
    let mut flight = held(tethered(20.0), 80);
    for k in 0..60 {
        let along = -3.2 + 0.08 * f64::from(k);
        let center = Point::from(Point::new(along, 0.0) - flight.pose.position);
        flight.sightings =
            vec![Sighting { id: ObstacleId(9), shape_in_robot: Shape::Disc { center, radius_m: 0.4 } }];
        flight.tick(&[]);
        let (way, events) = (flight.mission.way_back(), flight.tick(&[Order::DriveBack]));
        assert_eq!(way.is_ok() || flight.mission.phase().is_return(), refusal(&events).is_none());
        flight.tick(&[Order::Hold]);
    }
    assert!(flight.ended().is_none());
}

#[test]
fn a_tether_alarm_holds_a_robot_that_drives_back() {
    let mut flight = held(tethered(20.0), 80);
    flight.tick(&[Order::DriveBack]);
    flight.reel = Some(flight.mission.known.tether.as_ref().unwrap().cable().clone());
    flight.caught_m = 1.5;
    flight.fly(40);
    let is_snag = |alarm: &TetherAlarm| matches!(alarm, TetherAlarm::Snag { .. });
    assert!(
        flight
            .events
            .iter()
            .any(|event| matches!(&event.kind, EventKind::TetherAlarmRaised { alarm, .. } if is_snag(alarm)))
    );
    assert!(matches!(flight.held_by(), Some(HoldReason::Tether { .. })), "{:?}", flight.mission.phase());
    let here = flight.pose.position;
    assert_eq!(refusal(&flight.tick(&[Order::DriveBack])), None, "the drive back frees the tether first");
    flight.fly(20);
    assert!((flight.pose.position - here).norm() > 0.1);
}

#[test]
fn the_cost_of_a_zone_is_known_before_it_is_drawn() {
    let mut flight = held(covering(), 400);
    let corners = crate::outline::boxed(Point::new(1.0, 2.0), Point::new(-1.0, 0.0));
    let before = flight.mission.known.floor.coverage.counts().reachable;
    let cost = flight.mission.zone_cost(&corners).unwrap();
    assert!(cost.path_m > 3.0 && cost.path_m < 20.0, "{cost:?}");
    assert!(
        !cost.drops_offer && (cost.lost_m2 - cost.closed_m2).abs() < 1e-9,
        "nothing of it is scanned yet: {cost:?}"
    );
    flight.tick(&[Order::DrawZone(corners)]);
    let closed = before - flight.mission.known.floor.coverage.counts().reachable;
    assert!((cost.closed_m2 - closed as f64 * 0.01).abs() < 1e-9, "{cost:?} {closed}");
    let start = covering().start.position;
    let why = flight.mission.zone_cost(&crate::outline::round(start, 0.5)).unwrap_err();
    assert!(why.contains("the start is in the zone"), "{why}");
}

#[test]
fn a_round_zone_is_accepted_and_one_that_is_dented_or_crosses_itself_is_refused() {
    let mut flight = held(covering(), 300);
    let ring =
        |corners: &[(f64, f64)]| Order::DrawZone(corners.iter().map(|(x, y)| Point::new(*x, *y)).collect());
    let dented = ring(&[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 0.5)]);
    assert!(refusal(&flight.tick(&[dented])).is_some_and(|why| why.contains("not convex at 1.00, 0.50 m")));
    let star = |k: u32| 2.0 * std::f64::consts::TAU * f64::from(k) / 5.0;
    let star = (0..5).map(|k| Point::new(star(k).cos(), star(k).sin())).collect();
    assert!(refusal(&flight.tick(&[Order::DrawZone(star)])).is_some_and(|why| why.contains("not convex")));
    let many = crate::outline::round(Point::origin(), 1.0).repeat(3);
    assert!(refusal(&flight.tick(&[Order::DrawZone(many)])).is_some());
    let mut clockwise = crate::outline::round(Point::new(0.0, 1.0), 0.5);
    clockwise.reverse();
    let events = flight.tick(&[Order::DrawZone(clockwise)]);
    let area_m2 = events.iter().find_map(|kind| match kind {
        EventKind::ZoneDrawn { zone: Zone { shape: Shape::Polygon { vertices }, .. } } => {
            Some(world::shape::ring_area_m2(vertices))
        }
        _ => None,
    });
    assert!(area_m2.is_some_and(|area_m2| (0.78..0.80).contains(&area_m2)), "{area_m2:?} {events:?}");
}
