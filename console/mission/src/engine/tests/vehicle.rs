//! A real vehicle that must not be driven.

use super::{Flight, config, refusal};
use crate::{
    MissionConfig,
    event::EventKind,
    order::{Injection, Order, RangeFault},
    phase::{HoldReason, Outcome, Phase},
};
use world::StationId;

const WHY: &str = "the link to the vehicle is lost";

fn lost(config: MissionConfig) -> Flight {
    let mut flight = Flight::new(config);
    flight.tick(&[Order::Start]);
    flight.fly(10);
    flight.trouble = Some(WHY);
    flight
}

fn attended() -> MissionConfig {
    MissionConfig { attended: true, live: true, ..config() }
}

#[test]
fn a_vehicle_that_cannot_be_driven_is_held_until_an_order() {
    let mut flight = lost(attended());
    let events = flight.tick(&[]);
    let held =
        EventKind::Held { by: HoldReason::Vehicle { message: WHY.into() }, resumes: crate::Resumes::Never };
    assert!(events.contains(&held), "{events:?}");
    flight.fly(2);
    let place = flight.pose;
    for order in [Order::Resume, Order::StepTo(crate::StepTo::LaneEnd)] {
        let why = refusal(&flight.tick(&[order])).map(ToOwned::to_owned);
        assert_eq!(why.as_deref(), Some("the vehicle cannot be driven: the link to the vehicle is lost"));
    }
    flight.trouble = None;
    flight.fly(50);
    assert_eq!(flight.pose, place, "nothing moves without an order");
    flight.tick(&[Order::Resume]);
    flight.fly(10);
    assert_ne!(flight.pose, place);
}

#[test]
fn a_lost_link_neither_completes_nor_fails_a_mission() {
    let mut flight = lost(MissionConfig { time_limit_s: 2.0, stuck_s: 0.5, ..attended() });
    flight.fly(200);
    assert!(matches!(flight.mission.phase(), Phase::Held(_)), "{:?}", flight.mission.phase());
}

#[test]
fn an_unattended_run_ends_when_its_vehicle_cannot_be_driven() {
    let mut flight = lost(MissionConfig { attended: false, live: true, ..config() });
    flight.fly(3);
    assert_eq!(flight.ended(), Some(Outcome::Aborted));
}

#[test]
fn an_unattended_run_that_waits_for_its_position_says_so_and_when_it_ends() {
    for attended in [false, true] {
        let mut flight = Flight::new(MissionConfig {
            attended,
            live: true,
            odometry_sigma_per_m: 0.5,
            time_limit_s: 12.0,
            ..config()
        });
        flight.tick(&[Order::Start]);
        flight.fly(10);
        flight.silent = true;
        flight.fly(60);
        assert_eq!(flight.held_by(), Some(&HoldReason::PositionLost));
        let awaited = EventKind::PositionAwaited { limit_m: 0.3, ends_t_s: 12.0 };
        let at = flight.events.iter().position(|event| event.kind == awaited);
        assert_eq!(at.is_some(), !attended, "{:?}", flight.events);
        flight.fly(100);
        let reason = flight.events.iter().find_map(|event| match &event.kind {
            EventKind::Ended { reason, .. } => Some(reason.clone()),
            _ => None,
        });
        let Some(at) = at else {
            assert_eq!(reason, None, "the time of an attended hold does not count");
            continue;
        };
        let held = &flight.events[at - 1];
        assert!(matches!(held.kind, EventKind::Held { .. }), "{held:?}");
        let says = format!("time limit of 12 s reached; since T+{:.1} s held: position lost", held.t_s);
        assert_eq!(reason, Some(says));
    }
}

#[test]
fn a_mission_does_not_start_with_a_vehicle_that_cannot_be_driven() {
    let mut flight = Flight::new(attended());
    flight.trouble = Some(WHY);
    assert!(refusal(&flight.tick(&[Order::Start])).is_some_and(|why| why.ends_with(WHY)));
}

#[test]
fn a_real_vehicle_is_neither_stepped_by_ticks_nor_given_faults() {
    let mut flight = lost(attended());
    flight.trouble = None;
    flight.tick(&[Order::Hold]);
    let fault = Injection { station: StationId(1), fault: RangeFault::Dead, for_s: 1.0, by: None };
    for (order, why) in
        [(Order::Step, "cannot be stepped by ticks"), (Order::Inject(fault), "only into a simulation")]
    {
        assert!(refusal(&flight.tick(&[order])).is_some_and(|refused| refused.contains(why)), "{why}");
    }
}
