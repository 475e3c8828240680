//! A start order names the plan that the operator saw.

use super::arrivals::replay;
use super::covering::covering;
use super::*;
use crate::{FoldedStanding, PlanId, Readiness, Refusal};
use proptest::prelude::*;
use world::tether::Limits as CableLimits;

fn seen() -> MissionConfig {
    MissionConfig { start_names_plan: true, ..config() }
}

fn ready(flight: &Flight) -> Option<PlanId> {
    match flight.mission.standing().readiness {
        Readiness::Plan(plan) => Some(plan),
        _ => None,
    }
}

fn planned(flight: &mut Flight) -> PlanId {
    flight.tick(&[Order::Plan]);
    for _ in 0..50 {
        if let Some(plan) = ready(flight) {
            return plan;
        }
        flight.tick(&[]);
    }
    panic!("no plan is ready: {:?}", flight.mission.standing().readiness);
}

#[test]
fn a_start_is_refused_until_there_is_a_plan_and_then_names_it() {
    let mut flight = Flight::new(seen());
    flight.delay = Box::new(|_, _| 5);
    let unnamed = flight.tick(&[Order::Start]);
    assert_eq!(refusal(&unnamed), Some("there is no plan to start with; make one first"));
    flight.tick(&[Order::Plan]);
    let early = flight.tick(&[Order::Start]);
    assert_eq!(refusal(&early), Some("the plan is not ready yet; start when it is"));
    while ready(&flight).is_none() {
        flight.tick(&[]);
    }
    let plan = ready(&flight).expect("a plan");
    flight.delay = Box::new(|_, _| 0);
    let unnamed = flight.tick(&[Order::Start]);
    assert!(refusal(&unnamed).is_some_and(|why| why.starts_with("a start must name the plan")));
    assert_eq!(flight.mission.phase(), &Phase::Waiting);
    let asked = flight.planner.plans;
    let started = flight.tick(&[Order::StartPlan(plan)]);
    assert_eq!(refusal(&started), None);
    flight.fly(400);
    assert_eq!((flight.ended(), flight.planner.plans), (Some(Outcome::Complete), asked));
}

#[test]
fn a_start_names_no_plan_that_was_made_before() {
    let mut flight = Flight::new(seen());
    let first = planned(&mut flight);
    // A plan of the same length by another planner is a different plan.
    flight.tick(&[swap_to("other")]);
    let between = flight.tick(&[Order::StartPlan(first)]);
    assert_eq!(refusal(&between), Some("there is no plan to start with; make one first"));
    let second = planned(&mut flight);
    let refused = flight.tick(&[Order::StartPlan(first)]);
    let expected = Refusal::OtherPlan { seen: Some(first), ready: second }.to_string();
    assert_eq!(refusal(&refused), Some(expected.as_str()));
    // If the same plan is made again, it counts as the plan that the operator saw.
    assert_eq!(planned(&mut flight), second);
    assert_eq!(refusal(&flight.tick(&[Order::StartPlan(second)])), None);
}

#[test]
fn a_parameter_that_changes_makes_the_plan_one_of_the_past() {
    for has_stiff_gain in [true, false] {
        let mut flight = Flight::new(seen());
        flight.planner.has_stiff_gain = has_stiff_gain;
        let first = planned(&mut flight);
        let set = Order::SetParameter { key: "gain".into(), value: ParamValue::Float(3.0) };
        flight.tick(&[set, Order::Plan]);
        let second = planned(&mut flight);
        assert_ne!(first, second, "stiff: {has_stiff_gain}");
        assert!(refusal(&flight.tick(&[Order::StartPlan(first)])).is_some());
        assert_eq!(refusal(&flight.tick(&[Order::StartPlan(second)])), None);
    }
}

#[test]
fn a_plan_that_may_not_be_run_and_a_planner_that_fails_say_why() {
    let limits = CableLimits { reel_length_m: 3.0, wrap_max_rad: 1.0, wrap_total_max_rad: 1.0 };
    let tether = crate::TetherConfig {
        anchor: Point::new(-3.0, 0.0),
        limits,
        friction: 0.3,
        reel: None,
        allow_uncertified: false,
    };
    let mut flight = Flight::new(MissionConfig { tether: Some(tether), ..seen() });
    flight.planner.plans_to_goal = true;
    flight.tick(&[Order::Plan]);
    flight.fly(20);
    let refused = flight.tick(&[Order::Start]);
    assert!(refusal(&refused).is_some_and(|why| why.contains("not safe for the tether")), "{refused:?}");

    let mut flight = Flight::new(seen());
    flight.planner.refuse = vec!["straight"];
    flight.tick(&[Order::Plan]);
    flight.fly(3);
    let refused = flight.tick(&[Order::Start]);
    assert!(refusal(&refused).is_some_and(|why| why.contains("there is no planner straight")));
}

#[test]
fn where_nobody_looks_on_a_mission_begins_without_a_plan_that_was_seen() {
    let mut flight = Flight::new(config());
    assert_eq!(refusal(&flight.tick(&[Order::Start])), None);
    // A start order that names a plan is accepted, too: journals of the current console are replayed by the same rule.
    let mut flight = Flight::new(seen());
    let plan = planned(&mut flight);
    let mut other = Flight::new(config());
    assert_eq!(refusal(&other.tick(&[Order::StartPlan(plan)])), None);
}

/// The operator's orders before the start; a start order names the plan that was ready a number of ticks ago.
fn order(n: u8, plans: &[Option<PlanId>]) -> Order {
    let before = |ticks: usize| plans.iter().rev().nth(ticks).copied().flatten();
    match n % 9 {
        0 | 1 => Order::Plan,
        2 => swap_to("other"),
        3 => swap_to("straight"),
        4 => Order::SetParameter { key: "gain".into(), value: ParamValue::Float(f64::from(n % 3)) },
        5 => Order::DrawZone([(1.0, 2.0), (2.0, 2.0), (2.0, 3.0)].map(|(x, y)| Point::new(x, y)).to_vec()),
        6 => Order::Start,
        n => before(3 * (usize::from(n) - 7)).map_or(Order::Start, Order::StartPlan),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Whatever is ordered before the start, however late the answers are and whatever fails: a mission begins only
    /// with the plan that the events show on the screen, and the journal repeats byte for byte.
    #[test]
    fn a_mission_begins_with_the_plan_that_the_events_show(
        covers in any::<bool>(),
        has_stiff_gain in any::<bool>(),
        refuses_other in any::<bool>(),
        delays in prop::collection::vec(prop_oneof![3 => 0_u64..1, 2 => 1_u64..5, 1 => 5_u64..20], 32),
        faults in prop::collection::vec(0_u64..60, 0..3),
        orders in prop::collection::vec((0_u64..60, 0_u8..36), 0..24),
    ) {
        let config = MissionConfig { start_names_plan: true, ..if covers { covering() } else { config() } };
        let mut flight = Flight::new(config.clone());
        flight.planner.has_stiff_gain = has_stiff_gain;
        flight.planner.refuse = if refuses_other { vec!["other"] } else { vec![] };
        flight.planner.fail_at_ticks.clone_from(&faults);
        flight.delay = Box::new(move |ask, tick| delays[(ask.id.n as usize * 31 + tick as usize) % delays.len()]);
        let mut folded = FoldedStanding::default();
        folded.apply(&opened(&config));
        let mut plans = vec![];
        for tick in 0..60 {
            let now: Vec<Order> =
                orders.iter().filter(|(at, _)| *at == tick).map(|(_, n)| order(*n, &plans)).collect();
            let shown = folded.ready_plan();
            for event in flight.tick(&now) {
                if let EventKind::Ordered { order } = &event && order.is_start() {
                    prop_assert_eq!(Some(order.clone()), shown.map(Order::StartPlan));
                    prop_assert_eq!(shown, folded.ready_plan());
                }
                folded.apply(&event);
            }
            if let Some(plan) = ready(&flight).filter(|_| flight.mission.phase() == &Phase::Waiting) {
                prop_assert_eq!(Some(plan), folded.ready_plan());
            }
            plans.push(folded.ready_plan());
        }
        let again = replay(config, &flight);
        prop_assert_eq!(again, flight.events);
    }
}
