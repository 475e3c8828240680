//! The wait for the pulse test after the run.

use super::*;
use crate::{Locating, event::PulsePhase};
use positioning::PulseError;

/// A mission to its goal whose stations exchange pulses after a rest.
fn with_pulses(rest_s: f64, time_limit_s: f64) -> Flight {
    let locating = Locating { pulse_rest_s: Some(rest_s), ..config().locating };
    let mut flight = Flight::new(MissionConfig { time_limit_s, locating, ..config() });
    flight.pulse = true;
    flight.tick(&[Order::Start]);
    flight
}

/// Flies until the last pulses are awaited; returns the time at which the wait ends.
fn fly_to_the_wait(flight: &mut Flight) -> f64 {
    for _ in 0..300 {
        for kind in flight.tick(&[]) {
            if let EventKind::PulsesAwaited { until_s } = kind {
                return until_s;
            }
        }
    }
    panic!("no wait: {:?}", flight.ended());
}

fn phases(flight: &Flight) -> Vec<PulsePhase> {
    let of = |event: &Event| match &event.kind {
        EventKind::PulsesTested { phase, .. } | EventKind::PulsesFailed { phase, .. } => Some(*phase),
        _ => None,
    };
    flight.events.iter().filter_map(of).collect()
}

#[test]
fn a_mission_that_is_done_ends_with_the_pulse_test_after_the_run() {
    let mut flight = with_pulses(5.0, 1000.0);
    fly_to_the_wait(&mut flight);
    let at = flight.pose.position;
    flight.fly(50);
    assert_eq!((flight.ended(), flight.pose.position), (None, at), "the robot stands still");
    flight.pulse = true;
    flight.tick(&[]);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
    assert_eq!(phases(&flight), [PulsePhase::Before, PulsePhase::After]);
}

#[test]
fn without_pulses_the_mission_ends_and_says_so_at_the_latest_at_its_time_limit() {
    for time_limit_s in [1000.0, 20.0] {
        let mut flight = with_pulses(5.0, time_limit_s);
        let until_s = fly_to_the_wait(&mut flight);
        assert!(until_s <= time_limit_s + 0.2, "{until_s}");
        flight.fly(220);
        assert_eq!(flight.ended(), Some(Outcome::Complete), "limit {time_limit_s} s");
        let missing = EventKind::PulsesFailed { phase: PulsePhase::After, why: PulseError::Missing };
        assert_eq!(count(&flight, |kind| *kind == missing), 1);
        let ended = flight.events.iter().find(|event| matches!(event.kind, EventKind::Ended { .. })).unwrap();
        assert!((ended.t_s - until_s).abs() < 0.2, "{} s, {until_s} s", ended.t_s);
    }
}

#[test]
fn a_hold_interrupts_the_wait_and_the_resumption_begins_it_again() {
    let mut flight = with_pulses(5.0, 1000.0);
    fly_to_the_wait(&mut flight);
    flight.tick(&[Order::Hold]);
    flight.fly(400);
    assert_eq!((flight.ended(), flight.held_by()), (None, Some(&HoldReason::Operator)));
    let resumed = flight.tick(&[Order::Resume]);
    assert!(resumed.iter().any(|kind| matches!(kind, EventKind::PulsesAwaited { .. })), "{resumed:?}");
    flight.pulse = true;
    flight.tick(&[]);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
    assert_eq!(phases(&flight), [PulsePhase::Before, PulsePhase::After]);
}

#[test]
fn pulses_that_come_during_a_hold_after_the_task_are_those_after_the_run() {
    let mut flight = with_pulses(5.0, 1000.0);
    fly_to_the_wait(&mut flight);
    flight.tick(&[Order::Hold]);
    flight.pulse = true;
    flight.tick(&[]);
    assert_eq!(flight.ended(), None);
    flight.tick(&[Order::Resume]);
    flight.tick(&[]);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
    assert_eq!(phases(&flight), [PulsePhase::Before, PulsePhase::After]);
}

#[test]
fn a_mission_that_is_ended_in_the_wait_says_that_the_test_is_missing() {
    let mut flight = with_pulses(5.0, 1000.0);
    fly_to_the_wait(&mut flight);
    flight.tick(&[Order::Hold]);
    flight.tick(&[Order::Abort]);
    assert_eq!(phases(&flight), [PulsePhase::Before, PulsePhase::After]);
    assert_eq!(flight.ended(), Some(Outcome::Aborted));
}
