use super::*;
use crate::message::{Commander, Motion};

fn pilot() -> Pilot {
    let vehicle = Vehicle {
        name: "crawler".to_owned(),
        motion: Motion::Unicycle,
        speed_m_per_s: 0.4,
        turn_rad_per_s: 1.0,
        acceleration_m_per_s2: 0.5,
        radius_m: 0.2,
        period_s: 0.05,
        stop_time_s: 0.9,
        lease_max_s: 0.5,
    };
    Pilot::new(&vehicle, Has::default(), 0.05, 0.0)
}

fn act(pilot: &mut Pilot, mode: Mode, now_s: f64) -> Vec<Order> {
    let mut orders = Vec::new();
    let state = State { stamp_s: now_s, mode, text: None, battery: None, commander: Commander::You };
    pilot.act(state, now_s, &mut orders);
    orders
}

/// The orders after a line, in a state that is ready.
fn hear(pilot: &mut Pilot, line: Option<&str>, now_s: f64) -> Vec<Order> {
    let mut orders = Vec::new();
    pilot.hear(line, now_s, &mut orders);
    orders.extend(act(pilot, Mode::Ready, now_s));
    orders
}

const DRIVE: &str = r#"{"type": "drive", "seq": 1, "stamp_s": 0, "lease_s": 0.25, "forward_m_per_s": 0.3, "turn_rad_per_s": 0}"#;

fn moves(orders: &[Order]) -> Vec<f64> {
    let forward = |order: &Order| match order {
        Order::Move(velocity) => Some(velocity.forward_m_per_s),
        _ => None,
    };
    orders.iter().filter_map(forward).collect()
}

fn is_hello(order: &Order) -> bool {
    matches!(order, Order::Say(FromVehicle::Hello(_)))
}

#[test]
fn the_introduction_waits_for_a_robot_that_can_be_driven() {
    let mut pilot = pilot();
    assert_eq!(act(&mut pilot, Mode::Fault, 0.0), [Order::Move(Velocity::ZERO)]);
    assert!(is_hello(&act(&mut pilot, Mode::Ready, 0.2)[0]));
    assert!(!act(&mut pilot, Mode::Ready, 0.4).iter().any(is_hello), "once");
}

#[test]
fn the_introduction_does_not_wait_forever() {
    let mut pilot = pilot();
    assert!(!act(&mut pilot, Mode::Fault, 4.9).iter().any(is_hello));
    let orders = act(&mut pilot, Mode::Fault, 5.0);
    assert!(is_hello(&orders[0]));
    let says_why =
        |order: &Order| matches!(order, Order::Say(FromVehicle::State(state)) if state.mode == Mode::Fault);
    assert!(orders.iter().any(says_why), "{orders:?}");
}

#[test]
fn a_drive_is_commanded_at_once_and_again_until_its_lease_lapses_then_zero_again_and_again() {
    let mut pilot = pilot();
    act(&mut pilot, Mode::Ready, 0.0);
    assert_eq!(moves(&hear(&mut pilot, Some(DRIVE), 0.01)), [0.3]);
    assert!(moves(&act(&mut pilot, Mode::Ready, 0.03)).is_empty());
    assert_eq!(moves(&act(&mut pilot, Mode::Ready, 0.07)), [0.3]);
    assert_eq!(moves(&act(&mut pilot, Mode::Ready, 0.23)), [0.3]);
    assert_eq!(pilot.wakes_s(), 0.26, "the lease ends before the next period");
    let orders = act(&mut pilot, Mode::Ready, 0.26);
    assert_eq!(moves(&orders), [0.0]);
    assert!(orders.contains(&Order::Halt));
    let orders = act(&mut pilot, Mode::Ready, 0.32);
    assert_eq!(moves(&orders), [0.0]);
    assert!(!orders.contains(&Order::Halt), "once");
    assert_eq!(moves(&act(&mut pilot, Mode::Ready, 0.40)), [0.0]);
}

#[test]
fn a_stop_a_bad_line_a_bye_and_the_end_stop_at_once() {
    let lines = [Some(r#"{"type": "stop", "seq": 2}"#), Some("{"), Some(r#"{"type": "bye"}"#), None];
    for line in lines {
        let mut pilot = pilot();
        hear(&mut pilot, Some(DRIVE), 0.01);
        let orders = hear(&mut pilot, line, 0.02);
        assert_eq!(moves(&orders), [0.0], "{line:?}");
        assert!(orders.contains(&Order::Halt), "{line:?}");
    }
}

#[test]
fn after_the_end_zero_is_commanded_for_a_while() {
    let mut pilot = pilot();
    hear(&mut pilot, None, 0.1);
    let orders = act(&mut pilot, Mode::Ready, 0.3);
    assert!(moves(&orders) == [0.0] && !orders.contains(&Order::End));
    assert!(act(&mut pilot, Mode::Ready, 0.6).contains(&Order::End));
}

#[test]
fn a_robot_that_is_not_ready_stands_still() {
    let mut pilot = pilot();
    hear(&mut pilot, Some(DRIVE), 0.01);
    let orders = act(&mut pilot, Mode::Manual, 0.02);
    assert!(moves(&orders) == [0.0] && orders.contains(&Order::Halt));
}

#[test]
fn pings_are_answered_on_the_adapters_clock() {
    let orders = hear(&mut pilot(), Some(r#"{"type": "ping", "stamp_s": 7.5}"#), 0.25);
    assert_eq!(orders[0], Order::Say(FromVehicle::Pong { echo_s: 7.5, stamp_s: 0.25 }));
}
