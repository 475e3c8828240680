//! A planner in shadow: it takes over without a hold, and moves nothing before that.

use super::{arrivals::replay, covering::covering, tethered::tethered, *};
use crate::ask::WorkerId;
use proptest::prelude::*;

pub(super) fn shadow(id: &str) -> Order {
    Order::Shadow(PlannerChoice { id: id.into(), parameters: Parameters::new() })
}

/// A mission of many rounds through the tank.
fn rounds(n: usize) -> MissionConfig {
    let angle = |k: usize| std::f64::consts::PI + std::f64::consts::TAU * k as f64 / 48.0;
    let path = (0..48 * n).map(|k| Point::new(3.0 * angle(k).cos(), 3.0 * angle(k).sin())).collect();
    let task = TaskConfig::Follow { path, tolerance_m: 0.2 };
    MissionConfig { task, time_limit_s: 1e6, ..config() }
}

fn is_of_shadow(kind: &EventKind) -> bool {
    matches!(
        kind,
        EventKind::ShadowBegan { .. }
            | EventKind::Shadowed { .. }
            | EventKind::ShadowMissed { .. }
            | EventKind::PromotionRefused { .. }
            | EventKind::ShadowEnded { .. }
            | EventKind::Ordered { order: Order::Shadow(_) }
    )
}

fn commanded_by(flight: &Flight) -> Vec<(u64, WorkerId)> {
    let worker = |event: &Event| match &event.kind {
        EventKind::Commanded { ask: Some(ask), .. } => Some((event.tick, ask.worker)),
        _ => None,
    };
    flight.events.iter().filter_map(worker).collect()
}

fn promotions(flight: &Flight) -> usize {
    count(flight, |kind| matches!(kind, EventKind::Promoted { .. }))
}

#[test]
fn a_thousand_planners_take_over_without_a_hold_or_a_lost_tick() {
    let config = rounds(40);
    let mut flight = Flight::new(config.clone());
    flight.tick(&[Order::Start]);
    for n in 0..1000 {
        flight.tick(&[shadow(if n % 2 == 0 { "other" } else { "straight" })]);
        flight.fly(10);
        flight.tick(&[Order::Promote]);
        assert_eq!(promotions(&flight), n + 1, "in the tick of the order");
    }
    flight.fly(5);
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::Held { .. })), 0);
    let ticks: Vec<u64> = commanded_by(&flight).into_iter().map(|(tick, _)| tick).collect();
    assert_eq!(ticks, (0..flight.mission.known.tick).collect::<Vec<_>>(), "one command in every tick");
    let mut drivers: Vec<u16> = commanded_by(&flight).into_iter().map(|(_, worker)| worker.0).collect();
    drivers.dedup();
    assert_eq!(drivers, (1..=1001).collect::<Vec<_>>());
    assert_eq!(
        flight.closed,
        (1..=1000).map(WorkerId).collect::<Vec<_>>(),
        "every previous worker was closed"
    );
    assert_eq!(replay(config, &flight), flight.events);
}

#[test]
fn a_shadow_that_takes_lanes_over_goes_on_where_the_robot_is() {
    for config in [covering(), MissionConfig { tether: tethered(40.0).tether, ..covering() }] {
        let mut flight = Flight::new(config.clone());
        flight.tick(&[Order::Start]);
        flight.fly(300);
        flight.tick(&[shadow("other")]);
        flight.fly(200);
        let before = flight.pose.position;
        flight.tick(&[Order::Promote]);
        flight.fly(1);
        assert_eq!(promotions(&flight), 1);
        assert!((flight.pose.position - before).norm() < 0.1);
        let plan = flight.events.iter().rev().find_map(|event| match &event.kind {
            EventKind::Planned { ask: None, planner, path, .. } => Some((planner.clone(), path[0])),
            _ => None,
        });
        let (planner, begin) = plan.expect("a plan from the current position");
        assert!(planner == "other" && (begin - before).norm() < 0.1);
        flight.fly(4000);
        assert_eq!(flight.ended(), Some(Outcome::Complete));
        assert_eq!(count(&flight, |kind| matches!(kind, EventKind::Held { .. })), 0);
        assert_eq!(replay(config, &flight), flight.events);
    }
}

#[test]
fn an_answer_two_ticks_late_is_a_miss_and_a_row_starts_over() {
    let mut flight = Flight::new(rounds(1));
    flight.tick(&[Order::Start]);
    flight.tick(&[shadow("other")]);
    flight.fly(20);
    flight.delay = Box::new(|ask, _| if ask.id.worker.0 == 2 { 3 } else { 0 });
    flight.fly(4);
    flight.delay = Box::new(|_, _| 0);
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::ShadowMissed { ticks: 2, .. })), 1);
    let why = flight.tick(&[Order::Promote]);
    assert!(refusal(&why).is_some_and(|why| why.contains("in a row")), "{why:?}");
    flight.fly(20);
    flight.tick(&[Order::Promote]);
    assert_eq!(promotions(&flight), 1);
}

#[test]
fn a_planner_that_falls_behind_before_it_takes_over_stays_in_shadow() {
    let mut flight = Flight::new(rounds(1));
    flight.tick(&[Order::Start]);
    flight.tick(&[shadow("other")]);
    flight.fly(20);
    flight.delay = Box::new(|ask, _| if ask.id.worker.0 == 2 { 4 } else { 0 });
    flight.fly(2);
    flight.tick(&[Order::Promote]);
    flight.delay = Box::new(|_, _| 0);
    flight.fly(40);
    assert_eq!(promotions(&flight), 0);
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::PromotionRefused { .. })), 1);
}

#[test]
fn an_answer_on_its_way_when_the_planner_takes_over_is_neither_used_nor_late() {
    let mut flight = Flight::new(rounds(1));
    flight.tick(&[Order::Start]);
    flight.tick(&[shadow("other")]);
    flight.delay = Box::new(|ask, _| u64::from(ask.id.worker.0 == 2));
    flight.fly(30);
    flight.delay = Box::new(|_, _| 0);
    let n_before = commanded_by(&flight).len();
    flight.tick(&[Order::Promote]);
    assert_eq!(
        commanded_by(&flight).len(),
        n_before + 1,
        "one command in this tick, by the planner that took over"
    );
    assert_eq!(commanded_by(&flight).last().map(|(_, worker)| worker.0), Some(2));
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::PlannerLate { .. })), 0);
    assert_eq!(replay(rounds(1), &flight), flight.events);
}

#[test]
fn a_robot_that_has_left_the_plan_gets_another_one_first_and_never_stands() {
    let mut flight = Flight::new(covering());
    flight.tick(&[Order::Start]);
    flight.fly(300);
    // The planner in shadow would begin the floor again from another corner, so its plans lead away from the robot's
    // position.
    flight.tick(&[shadow("other")]);
    flight.delay = Box::new(|ask, _| if matches!(ask.what, What::Plan(_)) { 15 } else { 0 });
    flight.fly(150);
    let n_before = commanded_by(&flight).len();
    flight.tick(&[Order::Promote]);
    flight.fly(60);
    assert_eq!(promotions(&flight), 1);
    assert_eq!(commanded_by(&flight).len() - n_before, 61, "a command in every tick");
}

#[test]
fn a_shadow_may_take_over_from_a_planner_that_has_failed() {
    let mut flight = Flight::new(rounds(1));
    flight.tick(&[Order::Start]);
    flight.tick(&[shadow("other")]);
    flight.fly(20);
    let tick = flight.mission.known.tick;
    flight.delay = Box::new(move |ask, now| if ask.id.worker.0 == 1 && now >= tick { 100 } else { 0 });
    flight.fly(25);
    assert!(matches!(flight.held_by(), Some(HoldReason::PlannerSilent { .. })));
    flight.tick(&[Order::Promote]);
    assert_eq!(
        flight.held_by(),
        Some(&HoldReason::PlannerReplaced),
        "only the operator lets the robot move again"
    );
    flight.tick(&[Order::Resume]);
    let before = flight.pose;
    flight.fly(1);
    assert!(flight.pose != before);
}

#[test]
fn a_shadow_whose_plan_is_not_certified_does_not_take_over_and_holds_nobody() {
    let tether =
        tethered(40.0).tether.map(|tether| crate::TetherConfig { allow_uncertified: false, ..tether });
    let mut flight = Flight::new(MissionConfig { tether, ..config() });
    flight.tick(&[Order::Start]);
    flight.fly(10);
    flight.planner.plans_to_m = Some(9.0);
    flight.tick(&[shadow("other")]);
    flight.fly(20);
    flight.tick(&[Order::Promote]);
    let refused = |kind: &EventKind| matches!(kind, EventKind::PromotionRefused { why, .. } if why.contains("not safe"));
    assert_eq!(count(&flight, refused), 1);
    flight.fly(200);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::Held { .. })), 0);
}

#[test]
fn a_shadow_that_is_dropped_or_replaced_is_closed() {
    let mut flight = Flight::new(rounds(1));
    flight.tick(&[Order::Start]);
    flight.tick(&[shadow("other")]);
    flight.tick(&[shadow("straight")]);
    flight.fly(2);
    flight.tick(&[Order::DropShadow]);
    assert_eq!(flight.closed, [WorkerId(2), WorkerId(3)]);
    assert!(
        refusal(&flight.tick(&[Order::Promote])).is_some_and(|why| why.contains("no planner runs in shadow"))
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// Whether the planner in shadow is late, silent or failing, a run with it is the same as a run without it, apart
    /// from the events of the shadow.
    #[test]
    fn a_shadow_moves_nothing(
        covers in any::<bool>(),
        begins in 1_u64..40,
        fails in prop::option::of(40_u64..200),
        delays in prop::collection::vec(prop_oneof![3 => 0_u64..1, 2 => 1_u64..5, 1 => 20_u64..90], 64),
    ) {
        let config = if covers { covering() } else { rounds(1) };
        let fly = |orders: &[Order]| {
            let mut flight = Flight::new(config.clone());
            let delays = delays.clone();
            flight.planner.second_fails_at_tick = fails;
            flight.delay = Box::new(move |ask, tick| {
                if ask.id.worker.0 == 1 { 0 } else { delays[(ask.id.n as usize * 31 + tick as usize) % delays.len()] }
            });
            flight.tick(&[Order::Start]);
            for tick in 1..250 {
                flight.tick(if tick == begins { orders } else { &[] });
            }
            flight
        };
        let (plain, shadowed) = (fly(&[]), fly(&[shadow("other")]));
        prop_assert_eq!(plain.pose, shadowed.pose);
        let rest: Vec<&Event> = shadowed.events.iter().filter(|event| !is_of_shadow(&event.kind)).collect();
        prop_assert_eq!(rest, plain.events.iter().collect::<Vec<_>>());
        prop_assert_eq!(replay(config.clone(), &shadowed), shadowed.events);
    }
}

#[test]
fn a_shadow_that_began_during_a_hold_takes_over_during_it_and_moves_nothing() {
    for config in [rounds(1), covering()] {
        let mut flight = Flight::new(config.clone());
        flight.tick(&[Order::Start]);
        flight.fly(100);
        flight.tick(&[Order::Hold]);
        let events = flight.tick(&[shadow("other"), Order::Promote]);
        assert!(refusal(&events).is_some_and(|why| why.contains("has not made a plan")), "{events:?}");
        flight.fly(3);
        let before = flight.pose.position;
        flight.tick(&[Order::Promote]);
        assert_eq!((promotions(&flight), flight.mission.driving.id()), (1, "other"));
        flight.fly(30);
        assert_eq!(flight.pose.position, before, "only an order moves the robot");
        flight.tick(&[Order::Resume]);
        flight.fly(30);
        assert!(flight.pose.position != before);
        assert_eq!(replay(config, &flight), flight.events);
    }
}

#[test]
fn a_shadow_that_dies_while_the_robot_is_held_ends_during_the_hold() {
    let mut flight = Flight::new(covering());
    flight.tick(&[Order::Start]);
    flight.tick(&[shadow("other")]);
    flight.fly(20);
    flight.tick(&[Order::Hold]);
    flight.fly(20);
    assert_eq!(flight.mission.idle_workers().count(), 2);
    flight.tick(&[Order::CheckPlanner]);
    assert!(flight.mission.shadow.is_some(), "both processes still run");
    flight.planner.dead_worker = Some(2);
    flight.tick(&[Order::CheckPlanner]);
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::ShadowEnded { .. })), 1);
    assert!(flight.mission.shadow.is_none());
    assert!(flight.mission.driving.worker.is_ready(), "the active planner continues");
    assert_eq!(replay(covering(), &flight), flight.events);
}
