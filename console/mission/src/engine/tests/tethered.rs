//! The tether during a mission: plans are certified, limits hold the robot, and the tether passes newly found obstacles
//! on the side on which the robot drove past them.

use super::*;
use crate::{
    config::TetherConfig,
    event::TetherAlarm,
    tether::{Tether, return_path_ends},
};
use planner_api::{Leg, LegTag};
use world::{Obstacle, ObstacleId, Shape, tether::Limits};

pub(super) fn tethered(reel_length_m: f64) -> MissionConfig {
    let limits = Limits { reel_length_m, wrap_max_rad: 1.0, wrap_total_max_rad: 2.0 };
    let tether = TetherConfig {
        anchor: Point::new(-3.0, 0.0),
        limits,
        friction: 0.3,
        reel: None,
        allow_uncertified: true,
    };
    MissionConfig { tether: Some(tether), ..config() }
}

fn lengths(flight: &Flight) -> Vec<f64> {
    let length = |event: &Event| match event.kind {
        EventKind::Tethered { length_m, .. } => Some(length_m),
        _ => None,
    };
    flight.events.iter().filter_map(length).collect()
}

#[test]
fn the_tether_is_reported_every_tick_and_grows_with_the_way() {
    let mut flight = Flight::new(tethered(20.0));
    flight.tick(&[Order::Start]);
    flight.fly(200);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
    let lengths = lengths(&flight);
    assert!(lengths.len() > 100 && lengths[0] < 0.1);
    assert!((lengths.last().unwrap() - 5.9).abs() < 0.3, "{:?}", lengths.last());
}

#[test]
fn the_end_of_the_reel_warns_then_holds_and_the_operator_may_go_on() {
    let mut flight = Flight::new(tethered(3.0));
    flight.tick(&[Order::Start]);
    flight.fly(200);
    let reel = |reached| {
        flight.events.iter().filter(move |event| {
            matches!(&event.kind, EventKind::TetherAlarmRaised { alarm: TetherAlarm::Reel { .. }, reached: r } if *r == reached)
        })
    };
    assert!(reel(false).count() >= 1 && reel(true).count() == 1);
    assert!(matches!(flight.held_by(), Some(HoldReason::Tether { .. })));
    flight.tick(&[Order::Resume]);
    flight.fly(200);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
}

#[test]
fn with_nobody_there_the_end_of_the_reel_ends_the_mission() {
    let mut flight = Flight::new(MissionConfig { attended: false, ..tethered(3.0) });
    flight.tick(&[Order::Start]);
    flight.fly(200);
    assert_eq!(flight.ended(), Some(Outcome::Aborted));
}

#[test]
fn a_plan_that_cannot_be_certified_is_refused_until_the_operator_says_otherwise() {
    let mut config = tethered(20.0);
    config.tether.as_mut().unwrap().allow_uncertified = false;
    config.tether.as_mut().unwrap().limits.reel_length_m = 4.0;
    // The path to the goal is longer than the tether.
    let refused_flight = |config: &MissionConfig| {
        let mut flight = Flight::new(config.clone());
        flight.planner.plans_to_goal = true;
        flight
    };
    let mut flight = refused_flight(&config);
    let events = flight.tick(&[Order::Start]);
    let why = events.iter().find_map(|kind| match kind {
        EventKind::Certified { refused: true, certificate, .. } => Some(certificate.reasons.join("; ")),
        _ => None,
    });
    assert!(why.as_ref().is_some_and(|why| why.contains("the reel holds 4.0 m")), "{why:?}");
    let here = flight.pose;
    flight.fly(20);
    assert_eq!(flight.pose, here);
    assert!(matches!(flight.held_by(), Some(HoldReason::PlanRefused { .. })));
    let events = flight.tick(&[Order::FlyUncertified]);
    assert!(
        events.iter().any(|kind| matches!(kind, EventKind::Certified { refused: false, .. })),
        "{events:?}"
    );
    assert!(refusal(&flight.tick(&[Order::FlyUncertified])).is_some_and(|why| why.contains("no plan")));
    // The refused plan of a planner that was chosen later can be run as well.
    let mut flight = refused_flight(&config);
    flight.tick(&[Order::Start]);
    flight.tick(&[swap_to("other")]);
    flight.fly(3);
    assert_eq!(flight.mission.planner_id(), "other");
    let events = flight.tick(&[Order::FlyUncertified]);
    assert!(events.iter().any(|kind| matches!(kind, EventKind::Certified { refused: false, .. })));
    let mut flight = refused_flight(&MissionConfig { attended: false, ..config });
    flight.tick(&[Order::Start]);
    flight.fly(5);
    assert_eq!(flight.ended(), Some(Outcome::Aborted));
}

#[test]
fn an_obstacle_found_across_the_cable_is_passed_on_the_side_that_was_driven() {
    let column = |y: f64| Obstacle {
        id: ObstacleId(7),
        name: "found".into(),
        shape: Shape::Disc { center: Point::new(0.0, y), radius_m: 0.2 },
        known: false,
    };
    for (side, sign) in [(1.0, -1.0), (-1.0, 1.0)] {
        let config = tethered(20.0).tether.unwrap();
        let mut world = drawing();
        let mut tether = Tether::new(&config, 0.25, &world, Point::new(-3.0, 0.0)).unwrap();
        for way in [(-1.0, 1.0), (0.0, 1.5), (1.0, 1.0), (3.0, 0.0)] {
            tether.drag_to(Point::new(way.0, way.1 * side));
        }
        // The taut line passes right over the obstacle; only the path driven shows on which side it lies.
        world.obstacles.push(column(0.05 * side));
        tether.lay_again(&world);
        let map = world::ObstacleMap::new(&world.boundary, &world.obstacles);
        let events = tether.update(&world, &map, 0.1);
        let EventKind::Tethered { contacts, return_length_m, .. } = &events[0] else { panic!("{events:?}") };
        assert!(contacts.len() == 1 && contacts[0].wrap_rad * sign > 0.0, "{contacts:?}");
        assert!(return_length_m.is_some_and(|way_m| way_m > 6.0));
    }
}

/// Limits of the tether that no plan in these tests reaches.
pub(super) fn loosely_tethered() -> MissionConfig {
    let mut config = MissionConfig { attended: false, ..tethered(99.0) };
    let limits = &mut config.tether.as_mut().unwrap().limits;
    (limits.wrap_max_rad, limits.wrap_total_max_rad) = (99.0, 99.0);
    config
}

/// Runs the mission with a barrier across the tank behind the robot, shifted north by some metres.
fn fly_before_barrier(flight: &mut Flight, ticks: usize, shift_m: impl Fn(usize) -> f64) {
    for tick in 0..ticks {
        let ends = [-6.0, 6.0].map(|y| Point::new(-1.5, y + shift_m(tick)) - flight.pose.position);
        let points = ends.map(Point::from).to_vec();
        let shape_in_robot = Shape::Polyline { points, half_width_m: 0.1 };
        flight.sightings = vec![Sighting { id: ObstacleId(9), shape_in_robot }];
        flight.tick(&[]);
    }
}

/// A robot that has driven past a column on its right, which it has found; its tether lies between the column and the wall.
fn past_a_column() -> Flight {
    let mut flight = Flight::new(MissionConfig { attended: true, ..loosely_tethered() });
    flight.tick(&[Order::Start]);
    while flight.pose.position.x < 1.0 {
        let center = Point::from(Point::new(-1.0, -1.0) - flight.pose.position);
        let shape_in_robot = Shape::Disc { center, radius_m: 0.4 };
        flight.sightings = vec![Sighting { id: ObstacleId(9), shape_in_robot }];
        flight.tick(&[]);
    }
    flight
}

#[test]
fn a_zone_leaves_the_return_path_free_and_its_cost_says_if_the_way_back_is_blocked() {
    let between = |low: f64, high: f64| crate::outline::boxed(Point::new(-1.3, low), Point::new(-0.7, high));
    let mut flight = past_a_column();
    let blocks =
        |flight: &Flight, corners: &[Point]| flight.mission.zone_cost(corners).unwrap().blocks_way_back;
    // Between the column and the wall, the zone leaves the hull room only beyond the column, where the tether is not.
    let closed = between(-0.55, 4.8);
    assert!(!blocks(&flight, &between(1.0, 3.0)) && blocks(&flight, &closed));
    assert_eq!(refusal(&flight.tick(&[Order::DrawZone(closed)])), None);
    flight.tick(&[Order::Hold]);
    let why = flight.mission.way_back().unwrap_err();
    assert!(why.contains("does not fit"), "{why}");
    // The tether can still be reeled in along it: a zone is not an obstacle for the tether.
    let last = flight.events.iter().rev().find_map(|event| match &event.kind {
        EventKind::Tethered { return_length_m, .. } => Some(return_length_m.is_some()),
        _ => None,
    });
    assert_eq!((last, holds(&flight)), (Some(true), 0));
}

#[test]
fn a_plan_refused_while_the_return_path_is_blocked_waits_for_it() {
    let mut config = loosely_tethered();
    (config.attended, config.tether.as_mut().unwrap().allow_uncertified) = (true, false);
    let mut flight = Flight::new(config);
    flight.planner.plans_to_goal = true;
    flight.tick(&[Order::Start]);
    flight.fly(60);
    // The barrier blocks the return path and makes the mission ask for a plan, which cannot be certified. The hold comes
    // before the alarm.
    while flight.held_by().is_none() {
        fly_before_barrier(&mut flight, 1, |_| 0.0);
    }
    let message = TetherAlarm::NoReturnPath.to_string();
    assert_eq!(flight.held_by(), Some(&HoldReason::Tether { message }));
    let here = flight.pose;
    fly_before_barrier(&mut flight, 60, |_| 0.0);
    assert_eq!(flight.pose, here);
    // The barrier leaves slowly. The robot resumes when a plan can be certified, not a moment earlier.
    fly_before_barrier(&mut flight, 800, |tick| 0.01 * tick as f64);
    assert_eq!(flight.held_by(), None, "the robot resumes automatically");
    assert_eq!(holds(&flight), 1);
    let refused =
        |event: &&Event| matches!(event.kind, EventKind::Held { by: HoldReason::PlanRefused { .. }, .. });
    assert_eq!(flight.events.iter().filter(refused).count(), 0);
}

pub(super) fn holds(flight: &Flight) -> usize {
    let is_hold =
        |event: &&Event| matches!(event.kind, EventKind::Held { by: HoldReason::Tether { .. }, .. });
    flight.events.iter().filter(is_hold).count()
}

#[test]
fn a_way_home_that_is_closed_for_a_moment_is_no_alarm() {
    let mut flight = Flight::new(loosely_tethered());
    flight.tick(&[Order::Start]);
    flight.fly(60);
    fly_before_barrier(&mut flight, 40, |tick| if tick < 20 { 0.0 } else { 7.0 + 0.1 * tick as f64 });
    let without_home = flight
        .events
        .iter()
        .filter(|event| matches!(event.kind, EventKind::Tethered { return_length_m: None, .. }));
    assert!(without_home.count() > 10);
    flight.fly(100);
    assert_eq!((holds(&flight), flight.ended()), (0, Some(Outcome::Complete)));
}

#[test]
fn a_robot_without_a_way_home_is_held_until_there_is_one() {
    let mut flight = Flight::new(loosely_tethered());
    flight.tick(&[Order::Start]);
    flight.fly(60);
    fly_before_barrier(&mut flight, 40, |_| 0.0);
    assert_eq!(holds(&flight), 1);
    let here = flight.pose;
    fly_before_barrier(&mut flight, 100, |_| 0.0);
    assert_eq!((flight.pose, flight.ended()), (here, None));
    fly_before_barrier(&mut flight, 100, |tick| 0.1 * tick as f64);
    flight.fly(100);
    assert_eq!((holds(&flight), flight.ended()), (1, Some(Outcome::Complete)));
}

#[test]
fn with_nobody_there_a_robot_that_stays_without_a_way_home_is_entangled() {
    let mut flight = Flight::new(loosely_tethered());
    flight.tick(&[Order::Start]);
    flight.fly(60);
    fly_before_barrier(&mut flight, 400, |_| 0.0);
    assert_eq!((holds(&flight), flight.ended()), (1, Some(Outcome::Entangled)));
}

#[test]
fn a_plan_that_is_refused_under_way_is_asked_for_again_after_a_way_home() {
    let config = covering::covering();
    let limits = Limits { reel_length_m: 50.0, wrap_max_rad: 50.0, wrap_total_max_rad: 50.0 };
    let anchor = config.start.position;
    let tether = TetherConfig { anchor, limits, friction: 0.3, reel: None, allow_uncertified: false };
    let mut flight = Flight::new(MissionConfig { tether: Some(tether), ..config });
    flight.tick(&[Order::Start]);
    flight.fly(900);
    assert!((flight.pose.position - anchor).norm() > 1.0);
    // The cut of the next plan is directly in front of the robot, across its cable.
    flight.planner.cut = Some(vec![Point::new(-1.0, -4.1), Point::new(1.0, -4.1)]);
    let here = flight.pose.position;
    flight.tick(&[Order::Hold]);
    let other = PlannerChoice { id: "other".into(), parameters: Parameters::new() };
    let events = flight.tick(&[Order::ChoosePlanner(other)]);
    let plans: Vec<(Point, Option<LegTag>)> = events
        .iter()
        .filter_map(|kind| match kind {
            EventKind::Planned { path, legs, .. } => Some((path[0], legs.first().map(|leg| leg.tag))),
            _ => None,
        })
        .collect();
    assert_eq!(plans.len(), 2, "{plans:?}");
    assert!((plans[1].0 - here).norm() < 0.1 && plans[1].1 == Some(LegTag::Retract), "{plans:?}");
}

#[test]
fn a_robot_back_at_the_anchor_with_cable_left_out_is_entangled() {
    let config = tethered(30.0);
    let mut world = drawing();
    world.obstacles.push(Obstacle {
        id: ObstacleId(1),
        name: "C1".into(),
        shape: Shape::Disc { center: Point::origin(), radius_m: 0.3 },
        known: true,
    });
    let tether = config.tether.unwrap();
    let mut lie = Tether::new(&tether, 0.25, &world, Point::new(-3.0, 0.0)).unwrap();
    assert_eq!(lie.left_out(&world), None);
    for (x, y) in [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-3.0, 0.0)] {
        lie.drag_to(Point::new(x, y));
    }
    let why = lie.left_out(&world).unwrap();
    assert!(why.contains("of tether still out, hooked around C1"), "{why}");
}

#[test]
fn only_a_way_that_ends_at_the_anchor_is_a_way_home() {
    let path = vec![Point::new(1.0, 0.0), Point::new(0.1, 0.0), Point::new(2.0, 0.0)];
    let tagged = |last| {
        let legs = vec![Leg { tag: LegTag::Retract, first: 0, last }];
        return_path_ends(&Plan { path: path.clone(), legs, ..Plan::default() }, Point::origin())
    };
    assert_eq!([tagged(1), tagged(2), tagged(9)], [1, 0, 0]);
}
