//! Whole links, with the messages of a vehicle over bad networks.

use super::*;
use crate::wire::{
    Misfit,
    message::{Has, Limits, MotionKind, Odometry, Pong},
};
use proptest::prelude::*;

const PERIOD_S: f64 = 0.05;

fn hello() -> Heard<FromVehicle> {
    let limits =
        Limits { speed_m_per_s: 0.4, turn_rad_per_s: 1.0, acceleration_m_per_s2: 0.5, radius_m: 0.2 };
    Heard::Message(FromVehicle::Hello(Box::new(Hello {
        protocol: 1,
        name: "robot".into(),
        motion: MotionKind::Unicycle,
        limits,
        has: Has { odometry: true, ..Has::default() },
        period_s: PERIOD_S,
        stop_time_s: 0.5,
        lease_max_s: 0.5,
        session: None,
    })))
}

fn readings(seq: u64, m_per_s: f64) -> Heard<FromVehicle> {
    let odometry =
        Odometry { over_s: PERIOD_S, forward_m: m_per_s * PERIOD_S, sideways_m: 0.0, turn_rad: 0.0 };
    let stamp_s = 500.0 + seq as f64 * PERIOD_S;
    let readings = Readings { seq, stamp_s, odometry: Some(odometry), ..Readings::default() };
    Heard::Message(FromVehicle::Readings(Box::new(readings)))
}

fn connected() -> Link {
    let mut link = Link::default();
    assert_eq!(link.state(0.0), State::Connecting);
    link.heard(&hello(), 0.0);
    assert_eq!(link.state(0.0), State::Connecting);
    link.heard(&readings(0, 0.0), 0.0);
    assert_eq!(link.state(0.0), State::Alive);
    link
}

#[test]
fn a_silent_link_is_late_then_lost_within_a_second_and_alive_again_with_readings() {
    let mut link = connected();
    assert_eq!(link.state(0.39), State::Alive);
    assert_eq!(link.state(0.41), State::Late);
    assert_eq!(link.state(0.81), State::Lost);
    assert_eq!(link.age_s(5.0), Some(5.0));
    link.heard(&readings(100, 0.0), 5.0);
    assert_eq!((link.state(5.0), link.counts().lost), (State::Alive, 99));
    link.closed();
    assert_eq!(link.state(5.0), State::Lost);
}

#[test]
fn a_vehicle_that_sends_readings_but_takes_no_commands_is_lost() {
    let mut link = connected();
    for seq in 1..80_u64 {
        let now_s = seq as f64 * PERIOD_S;
        link.heard(&readings(seq, 0.0), now_s);
        link.pinged();
        if seq <= 20 {
            link.heard(
                &Heard::Message(FromVehicle::Pong(Pong { echo_s: now_s, stamp_s: 500.0 + now_s })),
                now_s,
            );
        }
        let expected = if seq <= 60 { State::Alive } else { State::Lost };
        assert_eq!(link.state(now_s), expected, "{seq}");
    }
    link.heard(&Heard::Message(FromVehicle::Pong(Pong { echo_s: 3.95, stamp_s: 503.95 })), 3.95);
    assert_eq!(link.state(3.95), State::Alive);
}

#[test]
fn old_readings_that_arrive_steadily_are_late_too() {
    let mut link = connected();
    link.heard(&Heard::Message(FromVehicle::Pong(Pong { echo_s: 0.0, stamp_s: 500.01 })), 0.02);
    // The queue on the way grows: each reading arrives twice its period after the one before it.
    for seq in 1..40_u64 {
        link.heard(&readings(seq, 0.0), 2.0 * PERIOD_S * seq as f64);
    }
    let now_s = 2.0 * PERIOD_S * 39.0;
    assert!(link.age_s(now_s).is_some_and(|age_s| age_s > 1.9));
    assert_eq!(link.state(now_s), State::Lost);
}

#[test]
fn three_malformed_lines_in_a_row_are_a_fault_until_the_vehicle_connects_again() {
    let mut link = connected();
    let bad = Heard::Malformed(Misfit { field: "pong.stamp_s".into(), what: "NaN".into() });
    for _ in 0..3 {
        link.heard(&bad, 0.1);
        link.heard(&bad, 0.1);
        link.heard(&readings(1, 0.0), 0.1);
    }
    assert_eq!(link.state(0.1), State::Alive);
    (0..3).for_each(|_| link.heard(&bad, 0.1));
    link.heard(&readings(2, 0.0), 0.1);
    link.heard(&hello(), 0.1);
    assert_eq!(link.state(0.1), State::Fault);
    assert_eq!(link.fault(), Some("3 malformed lines without good readings in between; pong.stamp_s: NaN"));
}

#[test]
fn readings_that_cannot_be_used_are_a_fault_although_pings_are_answered() {
    let mut link = connected();
    for _ in 0..3 {
        link.heard(&Heard::Malformed(Misfit { field: "readings.seq".into(), what: "NaN".into() }), 0.1);
        link.heard(&Heard::Message(FromVehicle::Pong(Pong { echo_s: 0.1, stamp_s: 0.1 })), 0.1);
    }
    assert_eq!(link.fault(), Some("3 malformed lines without good readings in between; readings.seq: NaN"));
}

#[test]
fn a_flood_of_messages_is_a_fault() {
    let mut link = connected();
    for seq in 1..10_000_u64 {
        link.heard(&readings(seq, 0.0), seq as f64 * 1e-4);
    }
    assert_eq!(link.state(1.0), State::Fault);
    assert_eq!(link.fault(), Some("more than 300 messages in a second"));
}

#[test]
fn what_collects_while_the_console_is_stopped_is_no_flood() {
    let mut link = connected();
    // A minute of readings at 20 a second is read at once.
    for seq in 1..1200_u64 {
        link.heard(&readings(seq, 0.05 * seq as f64), 60.0 + 1e-5 * seq as f64);
    }
    assert_eq!(link.fault(), None);
    for seq in 1200..11_200_u64 {
        link.heard(&readings(seq, 60.0 + 1e-4 * seq as f64), 62.0 + seq as f64 * 1e-4);
    }
    assert_eq!(link.fault(), Some("more than 300 messages in a second"));
}

#[test]
fn a_stop_is_held_by_odometry_and_a_lost_link_leaves_it_not_confirmed() {
    let drive = Drive {
        seq: 1,
        stamp_s: 0.1,
        lease_s: 0.25,
        forward_m_per_s: 0.3,
        sideways_m_per_s: 0.0,
        turn_rad_per_s: 0.0,
    };
    let mut link = connected();
    link.drove(&drive);
    assert_eq!((link.may_move_until_s(0.1), link.hold(0.1)), (Some(0.35), Hold::NotAsked));
    link.stopped(&Stop { seq: 2, stamp_s: 0.2 });
    let mut lost = link.clone();
    for (seq, m_per_s) in [(5, 0.3), (6, 0.1), (7, 0.0), (8, 0.0), (9, 0.0)] {
        link.heard(&readings(seq, m_per_s), seq as f64 * PERIOD_S);
        lost.heard(&readings(seq, 0.3), seq as f64 * PERIOD_S);
    }
    assert!(matches!(link.hold(0.5), Hold::Held { after_s } if (after_s - 0.15).abs() < 1e-9));
    assert_eq!((lost.hold(1.1), lost.hold(1.3)), (Hold::Stopping, Hold::NotConfirmed));
    link.drove(&Drive { seq: 3, ..drive });
    assert_eq!(link.hold(0.6), Hold::NotAsked);
}

#[test]
fn readings_from_before_a_stop_do_not_confirm_it() {
    let mut link = connected();
    // A round trip of 0.1 s: the offset is 500, give or take 0.05 s.
    link.heard(&Heard::Message(FromVehicle::Pong(Pong { echo_s: 0.0, stamp_s: 500.05 })), 0.1);
    link.stopped(&Stop { seq: 1, stamp_s: 0.2 });
    for seq in 1..=8_u64 {
        // All arrive after the stop; the last three were certainly taken after it.
        assert_eq!(link.hold(0.55), Hold::Stopping, "{seq}");
        link.heard(&readings(seq, 0.0), 0.5);
    }
    assert!(matches!(link.hold(0.55), Hold::Held { .. }));
}

#[test]
fn readings_that_do_not_follow_the_commands_are_found() {
    let mut link = connected();
    for seq in 1..80_u64 {
        let now_s = seq as f64 * PERIOD_S;
        link.drove(&Drive {
            seq,
            stamp_s: now_s,
            lease_s: 0.25,
            forward_m_per_s: 0.3,
            sideways_m_per_s: 0.0,
            turn_rad_per_s: 0.0,
        });
        link.heard(&readings(seq, 0.0), now_s);
    }
    assert_eq!(link.finding(), Some(Finding::Frozen(Axis::Forward)));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// A tenth of the messages lost, a delay of 50 to 250 ms, a tenth doubled: two minutes.
    #[test]
    fn a_bad_network_is_not_a_lost_link(fates in prop::collection::vec((0..20_u8, 0.0..0.2_f64), 2400)) {
        let mut arrivals: Vec<(f64, u64)> = vec![(0.05, 0)];
        for (n, (fate, jitter_s)) in fates.iter().enumerate() {
            let (seq, at_s) = (n as u64 + 1, (n + 1) as f64 * PERIOD_S + 0.05 + jitter_s);
            match fate {
                0 | 1 => {}
                2 | 3 => arrivals.extend([(at_s, seq), (at_s + 0.03, seq)]),
                _ => arrivals.push((at_s, seq)),
            }
        }
        arrivals.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut link = Link::default();
        link.heard(&hello(), 0.0);
        link.heard(&Heard::Message(FromVehicle::Pong(Pong { echo_s: -0.1, stamp_s: 499.95 })), 0.0);
        for (at_s, seq) in &arrivals {
            if *seq > 0 {
                prop_assert!(link.state(*at_s) != State::Lost, "{} at {}", seq, at_s);
            }
            link.heard(&readings(*seq, 0.0), *at_s);
        }
        prop_assert!(link.fault().is_none());
        let lost = fates.iter().filter(|(fate, _)| *fate < 2).count() as u64;
        prop_assert!(link.counts().lost <= lost);
    }
}
