//! A tether that catches on an unseen object that is not on the drawing: the reel reveals it, and the robot goes back
//! and frees the tether. A slack tether: the robot goes back until it is taut.

use super::{
    covering::{covered, covering},
    tethered::{holds, loosely_tethered, tethered},
    *,
};
use crate::{config::TetherConfig, event::TetherAlarm};
use planner_api::LegTag;
use world::{Shape, tether};

/// A small column between two lanes.
const UNSEEN: Shape = Shape::Disc { center: Point::new(0.0, 2.05), radius_m: 0.05 };

pub(super) fn snags(flight: &Flight) -> Vec<String> {
    let snag = |event: &Event| match &event.kind {
        EventKind::TetherAlarmRaised { alarm: alarm @ TetherAlarm::Snag { .. }, reached: true } => {
            Some(alarm.to_string())
        }
        _ => None,
    };
    flight.events.iter().filter_map(snag).collect()
}

fn eased(flight: &Flight) -> usize {
    let is_eased = |event: &&Event| {
        matches!(&event.kind, EventKind::TetherAlarmCleared { alarm: TetherAlarm::Snag { .. } })
    };
    flight.events.iter().filter(is_eased).count()
}

fn cable(anchor: Point, unseen: &[Shape]) -> Option<Cable> {
    Cable::new(anchor, &drawing().boundary, unseen).ok()
}

/// A mission in which, for some ticks, the reel pays out more than the map explains, by `more_m` metres.
fn caught(config: MissionConfig, more_m: f64, ticks: usize) -> Flight {
    let mut flight = Flight::new(config);
    flight.reel = cable(Point::new(-3.0, 0.0), &[]);
    flight.tick(&[Order::Start]);
    flight.fly(30);
    flight.caught_m = more_m;
    flight.fly(ticks);
    flight.caught_m = 0.0;
    flight
}

#[test]
fn cable_that_the_map_does_not_explain_holds_until_the_operator_goes_on() {
    let mut flight = caught(tethered(20.0), 1.5, 40);
    let snags = snags(&flight);
    assert_eq!(snags.len(), 1, "{snags:?}");
    assert!(snags[0].starts_with("tether snagged on an unmapped object: "), "{snags:?}");
    flight.fly(100);
    assert!(matches!(flight.held_by(), Some(HoldReason::Tether { .. })));
    flight.tick(&[Order::Resume]);
    flight.fly(200);
    assert_eq!((holds(&flight), flight.ended()), (1, Some(Outcome::Complete)));
}

#[test]
fn little_cable_too_much_or_for_a_moment_is_no_snag() {
    for (more_m, ticks) in [(0.15, 40), (1.5, 25)] {
        let mut flight = caught(tethered(20.0), more_m, ticks);
        flight.fly(200);
        assert_eq!((snags(&flight).len(), flight.ended()), (0, Some(Outcome::Complete)), "{more_m} m");
    }
}

#[test]
fn with_nobody_there_a_robot_that_cannot_go_back_by_itself_is_entangled() {
    let mut flight = caught(loosely_tethered(), 1.5, 40);
    flight.fly(200);
    assert_eq!((snags(&flight).len(), flight.ended()), (1, Some(Outcome::Entangled)));
}

#[test]
fn the_reel_ends_by_what_it_has_paid_out() {
    let flight = caught(MissionConfig { attended: false, ..tethered(7.0) }, 9.0, 5);
    assert_eq!(flight.ended(), Some(Outcome::Aborted));
    let free_m = flight.events.iter().filter_map(|event| match event.kind {
        EventKind::Tethered { free_m, .. } => Some(free_m),
        _ => None,
    });
    assert!(free_m.fold(f64::INFINITY, f64::min) < 0.0);
}

/// Scans a floor with a column that is seen from `seen_m` metres once the cable has caught on it.
fn scan_round_unseen_column(seen_m: f64) -> Flight {
    let anchor = covering().start.position;
    let limits = tether::Limits { reel_length_m: 50.0, wrap_max_rad: 50.0, wrap_total_max_rad: 50.0 };
    let config = TetherConfig { anchor, limits, friction: 0.3, reel: None, allow_uncertified: false };
    let mut flight = Flight::new(MissionConfig { tether: Some(config), attended: false, ..covering() });
    flight.reel = cable(anchor, &[UNSEEN]);
    flight.tick(&[Order::Start]);
    for _ in 0..10_000 {
        let is_seen = !snags(&flight).is_empty() && UNSEEN.distance_m(flight.pose.position) < seen_m;
        let shape_in_robot = UNSEEN.transformed(&flight.pose.tank_from_robot().inverse());
        flight.sightings =
            if is_seen { vec![Sighting { id: ObstacleId(7), shape_in_robot }] } else { vec![] };
        flight.tick(&[]);
        if flight.ended().is_some() {
            break;
        }
    }
    flight
}

#[test]
fn a_caught_cable_is_freed_on_the_way_back() {
    let flight = scan_round_unseen_column(0.0);
    let legs = flight.events.iter().filter_map(|event| match &event.kind {
        EventKind::Planned { reason: Reason::Blocked, legs, .. } => legs.first().map(|leg| leg.tag),
        _ => None,
    });
    assert_eq!(legs.collect::<Vec<_>>(), [LegTag::Retract; 2]);
    // The cable caught for the third time at one place, and no operator is present.
    assert_eq!((snags(&flight).len(), eased(&flight), flight.ended()), (3, 2, Some(Outcome::Entangled)));
}

#[test]
fn what_the_cable_has_caught_on_is_planned_for_once_it_is_seen() {
    let flight = scan_round_unseen_column(1.5);
    assert_eq!((snags(&flight).len(), eased(&flight)), (1, 1));
    let is_again = |event: &Event| {
        matches!(event.kind, EventKind::Planned { reason: Reason::MapChanged, .. }) && event.t_s > 300.0
    };
    assert!(flight.events.iter().any(is_again));
}

/// The reasons for the plans that are made after a column has been found across the cable, far from the remaining
/// lanes.
fn plans_for_column_across_cable(wrap_max_rad: f64) -> Vec<Reason> {
    let anchor = covering().start.position;
    let limits = tether::Limits { reel_length_m: 50.0, wrap_max_rad, wrap_total_max_rad: 50.0 };
    let config = TetherConfig { anchor, limits, friction: 0.3, reel: None, allow_uncertified: false };
    let mut flight = Flight::new(MissionConfig { tether: Some(config), attended: false, ..covering() });
    flight.tick(&[Order::Start]);
    while flight.pose.position.y < 0.5 {
        flight.tick(&[]);
    }
    let column: Shape = Shape::Disc { center: Point::new(0.0, -2.45), radius_m: 0.05 };
    let shape_in_robot = column.transformed(&flight.pose.tank_from_robot().inverse());
    flight.sightings = vec![Sighting { id: ObstacleId(7), shape_in_robot }];
    flight.events.clear();
    flight.fly(3);
    assert!(flight.events.iter().any(|event| matches!(event.kind, EventKind::ObstacleFound { .. })));
    let reason = |event: &Event| match &event.kind {
        EventKind::Planned { reason, .. } => Some(reason.clone()),
        _ => None,
    };
    flight.events.iter().filter_map(reason).collect()
}

#[test]
fn a_column_found_beside_the_lanes_is_planned_for_if_the_cable_will_not_bear_it() {
    let first = |wrap_max_rad| plans_for_column_across_cable(wrap_max_rad).first().cloned();
    // The remaining lanes wind the cable round the column by about 55 degrees.
    assert_eq!((first(0.5), first(1.5)), (Some(Reason::MapChanged), None));
}

/// Scans a floor with a reel that stops taking the cable up at each of these scanned shares of the floor, and runs again
/// once the robot has gone back.
fn scan_with_a_reel_that_stops(at_shares: &[f64]) -> Flight {
    let anchor = covering().start.position;
    let limits = tether::Limits { reel_length_m: 50.0, wrap_max_rad: 50.0, wrap_total_max_rad: 50.0 };
    let config = TetherConfig { anchor, limits, friction: 0.3, reel: None, allow_uncertified: false };
    let mut flight = Flight::new(MissionConfig { tether: Some(config), attended: false, ..covering() });
    flight.reel = cable(anchor, &[]);
    flight.tick(&[Order::Start]);
    let mut stops = at_shares.iter().peekable();
    let mut out_m: Option<f64> = None;
    let mut went_back = false;
    while flight.ended().is_none() && flight.events.len() < 200_000 {
        flight.tick(&[]);
        let taut_m = flight.reel.as_ref().unwrap().length_m();
        if out_m.is_none() && stops.next_if(|share| covered(&flight) >= **share).is_some() {
            (out_m, went_back) = (Some(taut_m), false);
        }
        out_m = out_m.map(|out_m| out_m.max(taut_m));
        flight.caught_m = out_m.map_or(0.0, |out_m| out_m - taut_m);
        flight.pull_n = Some(if flight.caught_m > 0.01 { 0.0 } else { 3.0 });
        went_back |= flight.held_by().is_some();
        if went_back && flight.caught_m <= 0.01 {
            out_m = None;
        }
    }
    flight
}

/// The first leg of each plan that was made because the robot was held, and its length in points.
fn ways_back(flight: &Flight) -> Vec<(LegTag, usize)> {
    let first = |event: &Event| match &event.kind {
        EventKind::Planned { reason: Reason::Blocked, legs, return_path, .. } => {
            legs.first().map(|leg| (leg.tag, *return_path))
        }
        _ => None,
    };
    flight.events.iter().filter_map(first).collect()
}

#[test]
fn a_slack_cable_is_made_taut_on_the_way_back_and_the_mission_goes_on() {
    let flight = scan_with_a_reel_that_stops(&[0.3]);
    let ways = ways_back(&flight);
    assert!(matches!(ways[..], [(LegTag::Retract, 3..)]), "{ways:?}");
    assert_eq!((holds(&flight), flight.ended()), (1, Some(Outcome::Complete)));
}

#[test]
fn a_cable_that_is_slack_for_the_third_time_at_one_place_ends_a_mission_without_an_operator() {
    let flight = scan_with_a_reel_that_stops(&[0.3; 3]);
    assert_eq!((ways_back(&flight).len(), flight.ended()), (2, Some(Outcome::Aborted)));
}

/// The breaks of the cable that were reported.
fn breaks(flight: &Flight) -> usize {
    let is_break = |event: &&Event| {
        let EventKind::TetherAlarmRaised { alarm, reached: true } = &event.kind else { return false };
        matches!(alarm, TetherAlarm::Broken { .. })
    };
    flight.events.iter().filter(is_break).count()
}

/// A mission in which the cable tears, and the reel takes the loose end up.
fn torn(config: MissionConfig) -> Flight {
    let mut flight = Flight::new(config);
    flight.reel = cable(Point::new(-3.0, 0.0), &[]);
    flight.pull_n = Some(3.0);
    flight.tick(&[Order::Start]);
    flight.fly(60);
    flight.pull_n = Some(0.0);
    flight
}

/// Goes on with a torn cable that the reel has taken up.
fn go_on(flight: &mut Flight, ticks: usize) {
    for _ in 0..ticks {
        flight.caught_m = -flight.reel.as_ref().unwrap().length_m();
        flight.tick(&[]);
    }
}

#[test]
fn a_torn_cable_holds_the_robot_once_and_an_operator_may_go_on() {
    let mut flight = torn(tethered(20.0));
    go_on(&mut flight, 300);
    assert_eq!((breaks(&flight), holds(&flight)), (1, 1));
    assert!(matches!(flight.held_by(), Some(HoldReason::Tether { message }) if message.contains("broken")));
    flight.tick(&[Order::Resume]);
    go_on(&mut flight, 300);
    assert_eq!((breaks(&flight), holds(&flight), flight.ended()), (1, 1, Some(Outcome::Complete)));
}

#[test]
fn a_cable_that_tears_while_the_robot_is_held_becomes_the_reason_and_one_resume_suffices() {
    let mut flight = torn(tethered(20.0));
    flight.tick(&[Order::Hold]);
    go_on(&mut flight, 50);
    assert!(matches!(flight.held_by(), Some(HoldReason::Tether { message }) if message.contains("broken")));
    assert_eq!(breaks(&flight), 1);
    flight.tick(&[Order::Resume]);
    go_on(&mut flight, 300);
    assert_eq!((breaks(&flight), flight.ended()), (1, Some(Outcome::Complete)));
}

/// A vehicle without a sensor of the pull.
fn vehicle(caught_m: impl Fn(f64) -> f64) -> Flight {
    let mut flight = Flight::new(MissionConfig { live: true, ..tethered(20.0) });
    flight.reel = cable(Point::new(-3.0, 0.0), &[]);
    flight.tick(&[Order::Start]);
    flight.fly(60);
    for _ in 0..80 {
        flight.caught_m = caught_m(flight.reel.as_ref().unwrap().length_m());
        flight.tick(&[]);
    }
    flight
}

#[test]
fn the_encoder_alone_shows_that_the_cable_of_a_vehicle_is_torn_or_caught_or_slack() {
    let is_held = |flight: &Flight, word: &str| matches!(flight.held_by(), Some(HoldReason::Tether { message }) if message.contains(word));
    let torn = vehicle(|taut_m| -taut_m);
    assert!(breaks(&torn) == 1 && is_held(&torn, "or the encoder of the reel is wrong"));
    let more = vehicle(|_| 1.5);
    assert!(is_held(&more, "tether snagged or slack: "), "{:?}", more.mission.phase());
}

#[test]
fn a_torn_cable_ends_a_mission_without_an_operator() {
    let mut flight = torn(MissionConfig { attended: false, ..tethered(20.0) });
    go_on(&mut flight, 300);
    assert_eq!((breaks(&flight), flight.ended()), (1, Some(Outcome::Aborted)));
    let is_reason = |event: &Event| matches!(&event.kind, EventKind::Ended { reason, .. } if reason.contains("tether broken: 0.0 m"));
    assert!(flight.events.iter().any(is_reason));
}

/// A mission whose reel stops taking the cable up after 30 % of the floor, until the slack rule holds the robot; with the
/// length off the reel, and the place where the cable last pulled.
pub(super) fn slack() -> (Flight, f64, Point) {
    let anchor = covering().start.position;
    let limits = tether::Limits { reel_length_m: 50.0, wrap_max_rad: 50.0, wrap_total_max_rad: 50.0 };
    let config = TetherConfig { anchor, limits, friction: 0.3, reel: None, allow_uncertified: false };
    let mut flight = Flight::new(MissionConfig { tether: Some(config), attended: true, ..covering() });
    flight.reel = cable(anchor, &[]);
    flight.tick(&[Order::Start]);
    let mut stopped: Option<(f64, Point)> = None;
    while flight.held_by().is_none() {
        flight.tick(&[]);
        let taut_m = flight.reel.as_ref().unwrap().length_m();
        if stopped.is_none() && covered(&flight) >= 0.3 {
            stopped = Some((taut_m, flight.pose.position));
        }
        if let Some((out_m, at)) = &mut stopped {
            // The cable pulls as long as the robot draws more of it out.
            if taut_m >= *out_m {
                (*out_m, *at) = (taut_m, flight.pose.position);
            }
            flight.caught_m = *out_m - taut_m;
        }
        flight.pull_n = Some(if flight.caught_m > 0.01 { 0.0 } else { 3.0 });
    }
    assert!(matches!(flight.held_by(), Some(HoldReason::Tether { message }) if message.contains("slack")));
    let (out_m, last_pulled_at) = stopped.unwrap();
    (flight, out_m, last_pulled_at)
}

/// Goes on with a reel that takes nothing up, until the robot stops; `drawn_m` more metres come off the reel.
pub(super) fn go_on_with_a_dead_reel(flight: &mut Flight, out_m: f64, drawn_m: f64) {
    for _ in 0..4000 {
        let taut_m = flight.reel.as_ref().unwrap().length_m();
        flight.caught_m = (out_m + drawn_m - taut_m).max(0.0);
        flight.pull_n = Some(if flight.caught_m > 0.01 { 0.0 } else { 3.0 });
        flight.tick(&[]);
        if flight.held_by().is_some() || flight.ended().is_some() {
            return;
        }
    }
}

pub(super) fn way_back(flight: &Flight) -> Vec<Point> {
    let way = flight.events.iter().rev().find_map(|event| match &event.kind {
        EventKind::ReturnBegan { way } => Some(way.path.clone()),
        _ => None,
    });
    way.unwrap()
}

#[test]
fn a_robot_with_a_dead_reel_drives_back_beside_its_cable_by_one_order() {
    let (mut flight, out_m, last_pulled_at) = slack();
    let (anchor, hull_m) = (covering().start.position, covering().limits.radius_m);
    let says = flight.mission.way_back().unwrap().to_string();
    assert!(says.contains("slowly beside the tether on the floor"), "{says}");
    flight.tick(&[Order::DriveBack]);
    let way = way_back(&flight);
    let passes_m = way.iter().map(|at| (at - last_pulled_at).norm()).fold(f64::INFINITY, f64::min);
    assert!(passes_m < 0.15, "{passes_m} m from the place where the cable last pulled");
    let from_anchor_m = (way.last().unwrap() - anchor).norm();
    assert!((hull_m + 0.1..1.8).contains(&from_anchor_m), "{way:?}");
    // The cable lies along the straight line to the place where it last pulled.
    let lies = [anchor, last_pulled_at + (anchor - last_pulled_at).normalize() * 0.8];
    let beside = way.iter().skip_while(|at| (*at - last_pulled_at).norm() > 0.15).skip(1);
    let beside: Vec<Point> = world::polyline::resampled(&beside.copied().collect::<Vec<_>>(), 0.05);
    assert!(beside.iter().all(|at| world::polyline::distance_m(&lies, *at) > hull_m + 0.1), "{way:?}");
    let before = flight.pose.position;
    flight.tick(&[]);
    assert!((flight.pose.position - before).norm() < 0.1 * 0.1 + 0.01, "slowly");
    go_on_with_a_dead_reel(&mut flight, out_m, 0.0);
    let reason = flight.events.iter().rev().find_map(|event| match &event.kind {
        EventKind::Ended { reason, .. } => Some(reason.as_str()),
        _ => None,
    });
    assert_eq!((flight.ended(), holds(&flight)), (Some(Outcome::Aborted), 1), "{reason:?}");
    let reason = reason.unwrap();
    assert!(reason.contains("robot is back beside the anchor") && reason.contains("by hand"), "{reason}");
}

#[test]
fn a_robot_that_is_held_beside_its_cable_drives_on_beside_it_and_not_back_over_it() {
    let (mut flight, out_m, last_pulled_at) = slack();
    flight.tick(&[Order::DriveBack]);
    for _ in 0..400 {
        flight.caught_m = (out_m - flight.reel.as_ref().unwrap().length_m()).max(0.0);
        flight.pull_n = Some(0.0);
        flight.tick(&[]);
    }
    flight.tick(&[Order::Hold]);
    let here = flight.pose.position;
    flight.tick(&[Order::DriveBack]);
    let way = way_back(&flight);
    let back_m = way.iter().map(|at| (at - last_pulled_at).norm()).fold(f64::INFINITY, f64::min);
    assert!(back_m > (here - last_pulled_at).norm() - 1.0, "{way:?}");
    go_on_with_a_dead_reel(&mut flight, out_m, 0.0);
    assert_eq!(flight.ended(), Some(Outcome::Aborted), "{:?}", flight.mission.phase());
}

#[test]
fn cable_that_comes_off_the_reel_on_the_way_beside_it_holds_the_robot() {
    let (mut flight, out_m, _) = slack();
    flight.tick(&[Order::DriveBack]);
    flight.fly(50);
    go_on_with_a_dead_reel(&mut flight, out_m, 0.5);
    assert!(
        matches!(flight.held_by(), Some(HoldReason::Tether { message }) if message.contains("more tether comes off the reel")),
        "{:?}",
        flight.mission.phase()
    );
}

#[test]
fn without_room_beside_a_slack_cable_the_order_is_refused_with_the_remedies() {
    let (mut flight, ..) = slack();
    let (here, anchor) = (flight.pose.position, covering().start.position);
    let along = (anchor - here).normalize();
    // A fence on each side of the cable, with a gap in which the hull would stand on it.
    let fence = |id: u32, side: f64| {
        let aside = Vector::new(-along.y, along.x) * side * 0.5;
        let ends = [here - along * 0.6 + aside, here + along * 1.5 + aside];
        let points = ends.iter().map(|end| flight.pose.tank_from_robot().inverse() * end).collect();
        Sighting { id: ObstacleId(id), shape_in_robot: Shape::Polyline { points, half_width_m: 0.05 } }
    };
    let end = |id: u32| {
        let across = Vector::new(-along.y, along.x) * 0.5;
        let ends = [here - along * 0.6 + across, here - along * 0.6 - across];
        let points = ends.iter().map(|end| flight.pose.tank_from_robot().inverse() * end).collect();
        Sighting { id: ObstacleId(id), shape_in_robot: Shape::Polyline { points, half_width_m: 0.05 } }
    };
    flight.sightings = vec![fence(7, 1.0), fence(8, -1.0), end(9)];
    flight.tick(&[]);
    let events = flight.tick(&[Order::DriveBack]);
    let why = refusal(&events).unwrap_or_default();
    assert!(why.contains("does not take the tether up") && why.contains("fetch the robot by hand"), "{why}");
    assert!(flight.held_by().is_some());
}
