//! A tether that its reel leaves on the floor: told from a caught one, and the way home beside it.

use super::{
    caught::{go_on_with_a_dead_reel, slack, snags, way_back},
    covering::{covered, covering},
    tethered::tethered,
    *,
};
use crate::config::TetherConfig;
use world::tether;

const REEL: tether::Reel = tether::Reel {
    mass_kg_per_m: 0.1,
    floor_friction: 0.3,
    pull_n: 10.0,
    pay_out_n: 0.5,
    robot_pull_n: None,
    pull_ratio_max: 0.8,
};

fn end_reason(flight: &Flight) -> String {
    let reason = flight.events.iter().rev().find_map(|event| match &event.kind {
        EventKind::Ended { reason, .. } => Some(reason.clone()),
        _ => None,
    });
    reason.unwrap_or_default()
}

fn is_held_with(flight: &Flight, words: &str) -> bool {
    matches!(flight.held_by(), Some(HoldReason::Tether { message }) if message.contains(words))
}

/// Whether the way back leads beside the tether on the floor.
fn leads_beside(flight: &Flight) -> bool {
    flight.mission.way_back().is_ok_and(|way| way.to_string().contains("slowly beside the tether"))
}

/// A mission whose robot drags ever more cable off a reel with these pulls at the reel and at the robot, newtons, after 30 %
/// of the floor, until it is held.
fn dragged(reel_n: Option<f64>, robot_n: Option<f64>) -> Flight {
    let anchor = covering().start.position;
    let limits = tether::Limits { reel_length_m: 50.0, wrap_max_rad: 50.0, wrap_total_max_rad: 50.0 };
    let config = TetherConfig { anchor, limits, friction: 0.3, reel: Some(REEL), allow_uncertified: true };
    let mut flight = Flight::new(MissionConfig { tether: Some(config), attended: true, ..covering() });
    flight.reel = Cable::new(anchor, &drawing().boundary, &[]).ok();
    (flight.reel_pull_n, flight.pull_n) = (reel_n.map(|_| 10.0), robot_n.map(|_| 12.0));
    flight.tick(&[Order::Start]);
    while covered(&flight) < 0.3 {
        flight.tick(&[]);
    }
    (flight.reel_pull_n, flight.pull_n) = (reel_n, robot_n);
    let mut out_m = 0.0_f64;
    for _ in 0..200 {
        let taut_m = flight.reel.as_ref().unwrap().length_m();
        out_m = out_m.max(taut_m) + 0.02;
        flight.caught_m = out_m - taut_m;
        flight.tick(&[]);
        if flight.held_by().is_some() {
            break;
        }
    }
    flight
}

#[test]
fn a_cable_that_is_dragged_off_a_stopped_reel_is_slack_and_one_that_pulls_at_its_reel_is_caught() {
    for (reel_n, robot_n) in [(Some(0.5), Some(2.6)), (None, Some(2.6)), (Some(0.5), None)] {
        let mut flight = dragged(reel_n, robot_n);
        flight.fly(10);
        assert!(snags(&flight).is_empty(), "{reel_n:?} {robot_n:?}: {:?}", snags(&flight));
        assert!(is_held_with(&flight, "does not take the tether up"), "{reel_n:?} {robot_n:?}");
        assert!(leads_beside(&flight), "{:?}", flight.mission.way_back());
        assert!(flight.mission.has_reel_stopped());
    }
    for (reel_n, robot_n) in [(Some(10.0), Some(13.0)), (None, Some(13.0)), (Some(10.0), None)] {
        let flight = dragged(reel_n, robot_n);
        assert!(is_held_with(&flight, "tether snagged"), "{reel_n:?} {robot_n:?}");
        assert!(!leads_beside(&flight) && !flight.mission.has_reel_stopped());
    }
}

#[test]
fn a_stopped_reel_stays_stopped_when_the_task_is_taken_up_again_until_it_pulls() {
    let mut flight = dragged(Some(0.5), Some(2.6));
    flight.tick(&[Order::Resume]);
    let mut out_m = 0.0_f64;
    for _ in 0..100 {
        let taut_m = flight.reel.as_ref().unwrap().length_m();
        out_m = out_m.max(taut_m + flight.caught_m);
        flight.caught_m = out_m - taut_m;
        flight.tick(&[]);
    }
    assert!(snags(&flight).is_empty() && flight.mission.has_reel_stopped());
    flight.reel_pull_n = Some(10.0);
    flight.fly(15);
    assert!(!flight.mission.has_reel_stopped());
}

/// Goes on for some ticks with a reel that takes nothing up, or with one that works, until the robot is held or the mission
/// ended.
fn go_on_with_a_reel(flight: &mut Flight, works: bool, ticks: usize) {
    let mut out_m = 0.0_f64;
    for _ in 0..ticks {
        let taut_m = flight.reel.as_ref().unwrap().length_m();
        out_m = out_m.max(taut_m + flight.caught_m);
        flight.caught_m = if works { 0.0 } else { out_m - taut_m };
        flight.tick(&[]);
        if flight.held_by().is_some() || flight.ended().is_some() {
            break;
        }
    }
}

#[test]
fn a_task_that_is_taken_up_again_with_a_stopped_reel_is_held_before_the_hull_reaches_the_cable() {
    const OWN: &str = "hull about to reach its own tether";
    let resumed = |works: bool| {
        let mut flight = dragged(Some(0.5), Some(2.6));
        if works {
            (flight.reel_pull_n, flight.pull_n) = (Some(10.0), Some(12.0));
        }
        for _ in 0..20 {
            flight.tick(&[Order::Resume]);
            go_on_with_a_reel(&mut flight, works, 600);
            if is_held_with(&flight, OWN) || flight.ended().is_some() {
                break;
            }
        }
        flight
    };
    let mut stopped = resumed(false);
    assert!(is_held_with(&stopped, OWN), "{:?}", stopped.mission.phase());
    let at = stopped.pose.position;
    stopped.fly(30);
    assert_eq!(stopped.pose.position, at, "the robot stands where it was held");
    let works = resumed(true);
    assert!(works.events.iter().all(|event| !format!("{:?}", event.kind).contains(OWN)));
}

#[test]
fn the_question_and_the_order_take_the_same_way_although_the_readings_move_a_little() {
    let (mut flight, ..) = slack();
    flight.fly(10);
    let offered = flight.mission.way_back().unwrap();
    flight.caught_m -= 0.04;
    flight.fly(5);
    flight.tick(&[Order::DriveBack]);
    assert_eq!(way_back(&flight), offered.path);
}

#[test]
fn a_robot_that_is_stopped_on_its_way_beside_the_cable_goes_on_with_the_rest_of_this_way() {
    let (mut flight, out_m, _) = slack();
    flight.tick(&[Order::DriveBack]);
    let whole = way_back(&flight);
    for _ in 0..400 {
        flight.caught_m = (out_m - flight.reel.as_ref().unwrap().length_m()).max(0.0);
        flight.pull_n = Some(0.0);
        flight.tick(&[]);
    }
    flight.tick(&[Order::Hold]);
    flight.fly(10);
    flight.tick(&[Order::DriveBack]);
    let rest = way_back(&flight);
    let off_m = rest[1..].iter().map(|at| world::polyline::distance_m(&whole, *at)).fold(0.0, f64::max);
    assert!(rest.len() >= 2 && off_m < 1e-6 && rest.last() == whole.last(), "{off_m} {rest:?}");
    go_on_with_a_dead_reel(&mut flight, out_m, 0.0);
    assert_eq!(flight.ended(), Some(Outcome::Aborted), "{:?}", flight.mission.phase());
}

#[test]
fn a_reel_that_takes_cable_up_again_on_the_way_beside_it_holds_the_robot() {
    let (mut flight, out_m, _) = slack();
    flight.tick(&[Order::DriveBack]);
    for k in 0..450 {
        let left_m = if k < 400 { 0.0 } else { 0.02 * f64::from(k - 400) };
        flight.caught_m = (out_m - left_m - flight.reel.as_ref().unwrap().length_m()).max(0.0);
        flight.tick(&[]);
        if flight.held_by().is_some() {
            break;
        }
    }
    assert!(is_held_with(&flight, "the reel takes the tether up again"), "{:?}", flight.mission.phase());
}

#[test]
fn once_the_reel_has_taken_up_what_lay_on_the_floor_the_way_back_is_the_return_path_again() {
    let mut flight = dragged(Some(0.5), Some(2.6));
    flight.tick(&[Order::DriveBack]);
    flight.tick(&[Order::Hold]);
    assert!(leads_beside(&flight), "{:?}", flight.mission.way_back());
    (flight.reel_pull_n, flight.pull_n, flight.caught_m) = (Some(10.0), Some(9.0), 0.0);
    flight.fly(20);
    let way = flight.mission.way_back().map(|way| way.to_string()).unwrap_or_default();
    assert!(way.starts_with("driving back") && !way.contains("beside"), "{way}");
}

#[test]
fn without_a_sensor_of_the_pull_the_robot_keeps_beside_a_cable_that_may_be_slack_and_ends_entangled() {
    let mut flight = Flight::new(MissionConfig { live: true, ..tethered(20.0) });
    flight.reel = Cable::new(Point::new(-3.0, 0.0), &drawing().boundary, &[]).ok();
    flight.tick(&[Order::Start]);
    flight.fly(60);
    let out_m = flight.reel.as_ref().unwrap().length_m() + 1.5;
    let go_on = |flight: &mut Flight| {
        flight.caught_m = (out_m - flight.reel.as_ref().unwrap().length_m()).max(0.0);
        flight.tick(&[]);
    };
    (0..80).for_each(|_| go_on(&mut flight));
    assert!(is_held_with(&flight, "tether snagged or slack"));
    assert!(leads_beside(&flight), "{:?}", flight.mission.way_back());
    flight.tick(&[Order::DriveBack]);
    for _ in 0..3000 {
        go_on(&mut flight);
        if flight.ended().is_some() || flight.held_by().is_some() {
            break;
        }
    }
    let reason = end_reason(&flight);
    assert_eq!(flight.ended(), Some(Outcome::Entangled), "{reason} {:?}", flight.mission.phase());
    assert!(reason.contains("take them up by hand"), "{reason}");
}
