//! The guard by the raw scan of a real vehicle.

use super::{Flight, config};
use crate::{
    MissionConfig,
    event::EventKind,
    order::Order,
    phase::{HoldReason, Outcome, Phase},
};
use geometry::Vector;
use world::Point;

fn guarded(config: MissionConfig) -> Flight {
    let mut flight = Flight::new(MissionConfig { live: true, guard_reaction_s: Some(0.1), ..config });
    flight.scanner = Some((Vec::new(), true));
    flight
}

/// Distance between the hull and an object in the robot's way, metres.
fn gap_m(flight: &Flight) -> f64 {
    let (discs, _) = flight.scanner.as_ref().unwrap();
    let gap_m = |(center, radius_m): &(Point, f64)| (center - flight.pose.position).norm() - radius_m - 0.25;
    discs.iter().map(gap_m).fold(f64::INFINITY, f64::min)
}

/// A moving robot, and an object ahead of it that only the scan shows.
fn before_an_object(config: MissionConfig) -> Flight {
    let mut flight = guarded(config);
    flight.tick(&[Order::Start]);
    let from = flight.pose.position;
    flight.fly(20);
    let way = (flight.pose.position - from).normalize();
    flight.scanner = Some((vec![(flight.pose.position + way * 1.2, 0.1)], true));
    flight
}

#[test]
fn an_object_that_only_the_scan_shows_is_not_hit_and_holds_the_robot() {
    let mut flight = before_an_object(config());
    let mut least_m = f64::INFINITY;
    for _ in 0..3 {
        for _ in 0..200 {
            flight.tick(&[]);
            least_m = least_m.min(gap_m(&flight));
        }
        let Some(HoldReason::Guard { message }) = flight.held_by() else {
            panic!("{:?}", flight.mission.phase())
        };
        assert!(message.contains("from the hull"), "{message}");
        flight.tick(&[Order::Resume]);
    }
    assert!(least_m > 0.0 && least_m < 0.1, "{least_m}");
    let limited = |kind: &EventKind| matches!(kind, EventKind::Guarded { asked_m_per_s, sent_m_per_s, .. } if sent_m_per_s < asked_m_per_s);
    assert!(flight.events.iter().any(|event| limited(&event.kind)));
}

#[test]
fn an_unattended_run_ends_before_the_object() {
    let mut flight = before_an_object(MissionConfig { attended: false, ..config() });
    flight.fly(200);
    assert_eq!(flight.ended(), Some(Outcome::Stuck));
    assert!(gap_m(&flight) > 0.0);
}

/// A robot that drives from a standstill towards an object in plain view until it is held: for each tick, the gap and
/// the way, metres.
fn driven_until_held(reaction_s: f64, age_s: f64, from_m: f64) -> Vec<(f64, f64)> {
    let mut flight = guarded(config());
    flight.mission.known.config.guard_reaction_s = Some(reaction_s);
    flight.age_s = age_s;
    flight.scanner = Some((vec![(flight.pose.position + Vector::x() * from_m, 0.1)], true));
    flight.tick(&[Order::Start]);
    let mut ticks = Vec::new();
    while flight.held_by().is_none() {
        let before = flight.pose.position;
        flight.tick(&[]);
        ticks.push((gap_m(&flight), (flight.pose.position - before).norm()));
        assert!(ticks.len() < 400, "the robot is never held");
    }
    ticks
}

#[test]
fn a_vehicle_that_reacts_sooner_than_it_states_is_slowed_but_not_held_while_it_drives() {
    for from_m in [0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.5] {
        let ticks = driven_until_held(0.7, 0.0, from_m);
        let fastest_m = ticks.iter().map(|(_, way_m)| *way_m).fold(0.0, f64::max);
        assert!(ticks.iter().all(|(gap_m, _)| *gap_m > 0.0));
        let last = &ticks[ticks.len() - 20..];
        assert!(last.iter().all(|(_, way_m)| *way_m < 0.5 * fastest_m), "from {from_m} m: {last:?}");
    }
}

#[test]
fn old_readings_make_the_robot_brake_earlier() {
    let brakes_m = |age_s| {
        let ticks = driven_until_held(0.1, age_s, 2.0);
        let fastest_m = ticks[0].1;
        ticks.iter().find(|(_, way_m)| *way_m < 0.9 * fastest_m).map(|(gap_m, _)| *gap_m).expect("it brakes")
    };
    let (new_m, old_m) = (brakes_m(0.0), brakes_m(0.5));
    assert!(old_m > new_m + 0.1, "gap with new readings {new_m}, with old ones {old_m}");
}

#[test]
fn without_a_guard_the_object_would_be_hit() {
    let mut flight = before_an_object(config());
    flight.mission.known.config.guard_reaction_s = None;
    flight.fly(200);
    assert!(
        flight.held_by().is_none()
            && !flight.events.iter().any(|event| matches!(event.kind, EventKind::Guarded { .. }))
    );
}

#[test]
fn an_open_floor_does_not_slow_the_robot() {
    let mut one = guarded(config());
    let mut other = Flight::new(config());
    one.tick(&[Order::Start]);
    other.tick(&[Order::Start]);
    one.fly(100);
    other.fly(100);
    assert_eq!(one.pose, other.pose);
}

#[test]
fn a_robot_whose_scan_stops_is_held() {
    let mut flight = guarded(config());
    flight.tick(&[Order::Start]);
    flight.fly(20);
    flight.scanner = Some((Vec::new(), false));
    flight.fly(3);
    assert!(matches!(flight.mission.phase(), Phase::Running(_)), "a scan may be late");
    flight.fly(10);
    let blind = |flight: &Flight| match flight.held_by() {
        Some(HoldReason::Guard { message }) => message.contains("the guard is blind"),
        _ => false,
    };
    assert!(blind(&flight), "{:?}", flight.mission.phase());
    let mut never = guarded(config());
    never.scanner = None;
    let start = never.pose;
    never.tick(&[Order::Start]);
    never.fly(30);
    assert_eq!(never.pose, start, "nothing moves before the first scan");
    assert!(blind(&never), "{:?}", never.mission.phase());
}

#[test]
fn an_object_that_only_the_scan_shows_is_put_on_the_map() {
    let mut flight =
        before_an_object(MissionConfig { sensor: Some(perception::Sensor::UNKNOWN), ..config() });
    let (discs, _) = flight.scanner.clone().unwrap();
    flight.fly(15);
    let found: Vec<_> = flight
        .events
        .iter()
        .filter_map(|event| match &event.kind {
            EventKind::ObstacleFound { obstacle } => Some(obstacle.shape.clone()),
            _ => None,
        })
        .collect();
    let [world::Shape::Disc { center, radius_m }] = found[..] else { panic!("{found:?}") };
    assert!((center - discs[0].0).norm() < 0.05 && (radius_m - 0.1).abs() < 0.02, "{found:?}");
    assert_eq!(flight.mission.known.perception.as_ref().and_then(perception::Perception::trouble), None);
}

#[test]
fn a_scan_that_cannot_be_right_holds_the_robot() {
    let sensor = perception::Sensor { rays: Some(180), ..perception::Sensor::UNKNOWN };
    let mut flight = guarded(MissionConfig { sensor: Some(sensor), ..config() });
    flight.tick(&[Order::Start]);
    flight.fly(5);
    let Some(HoldReason::Guard { message }) = flight.held_by() else {
        panic!("{:?}", flight.mission.phase())
    };
    assert!(message.starts_with("the scan has 360 rays instead of 180; "), "{message}");
}

/// A robot under way whose scans show an object that it cannot avoid in some ticks, and no object in others; `None` is a
/// tick without a scan. Returns whether the robot was held.
fn is_held_after(ticks: &[Option<bool>]) -> bool {
    let mut flight = guarded(config());
    flight.tick(&[Order::Start]);
    let from = flight.pose.position;
    flight.fly(20);
    for shows in ticks {
        let at = flight.pose.position + (flight.pose.position - from).normalize() * 0.36;
        let discs = shows.filter(|shows| *shows).map(|_| (at, 0.1));
        flight.scanner = Some((discs.into_iter().collect(), shows.is_some()));
        flight.tick(&[]);
    }
    flight.held_by().is_some()
}

#[test]
fn one_noisy_scan_holds_no_robot_and_two_do() {
    let (noise, clear, none) = (Some(true), Some(false), None);
    assert!(!is_held_after(&[noise, none, none, none, clear, clear, clear]));
    assert!(!is_held_after(&[noise, clear, clear, clear]));
    assert!(is_held_after(&[noise, noise, clear]));
    assert!(is_held_after(&[noise, none, noise, clear]));
}

/// The troubles of the scanner in the events so far.
fn judged(flight: &Flight) -> Vec<Option<&str>> {
    let mut judged = Vec::new();
    for event in &flight.events {
        if let EventKind::ScannerJudged { trouble } = &event.kind {
            judged.push(trouble.as_deref());
        }
    }
    judged
}

#[test]
fn scans_are_judged_before_the_start_and_again_when_they_change() {
    let sensor = perception::Sensor { rays: Some(360), ..perception::Sensor::UNKNOWN };
    let mut flight = guarded(MissionConfig { sensor: Some(sensor), ..config() });
    flight.fly(10);
    assert!(judged(&flight).is_empty(), "{:?}", judged(&flight));
    flight.scanner = Some((Vec::new(), false));
    flight.fly(30);
    let [Some(why)] = judged(&flight)[..] else { panic!("{:?}", judged(&flight)) };
    assert!(why.contains("s old, so the guard is blind; check"), "{why}");
    flight.scanner = Some((Vec::new(), true));
    flight.fly(2);
    assert_eq!(judged(&flight)[1..], [None]);
    assert_eq!(flight.mission.phase(), &Phase::Waiting);
}

#[test]
fn a_scanner_that_never_sends_is_named_before_the_start() {
    let mut flight = guarded(config());
    flight.scanner = Some((Vec::new(), false));
    flight.fly(40);
    let [Some(why)] = judged(&flight)[..] else { panic!("{:?}", judged(&flight)) };
    assert!(why.starts_with("the vehicle has not sent a scan yet"), "{why}");
}
