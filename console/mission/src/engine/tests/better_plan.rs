//! A plan for the rest of the task, made while a repaired plan is in use.

use super::{
    super::role::Role,
    arrivals::replay,
    covering::{covered, covering},
    *,
};
use crate::{
    AskId, FoldedStanding, WorkerId,
    event::{Effort, OfferEnd, OfferStage, PlanDropped, PlanMade},
};
use planner_api::Reason;
use proptest::prelude::*;

/// A coverage mission in which the plans up to the repair are much longer than necessary.
fn wasteful(better_plan: BetterPlan) -> MissionConfig {
    MissionConfig { better_plan, time_limit_s: 5000.0, ..covering() }
}

fn flight(config: MissionConfig) -> Flight {
    let mut flight = Flight::new(config);
    flight.planner.wasteful_plans = 2;
    flight.tick(&[Order::Start]);
    flight
}

/// Continues past columns that are seen from a distance of two metres.
fn fly_past(flight: &mut Flight, columns: &[Point], ticks: usize) {
    for _ in 0..ticks {
        let robot_from_tank = flight.pose.tank_from_robot().inverse();
        let seen = columns.iter().enumerate().map(|(k, at)| (k, robot_from_tank * at));
        flight.sightings = seen
            .filter(|(_, relative)| relative.coords.norm() < 2.0)
            .map(|(k, center)| Sighting {
                id: ObstacleId(7 + k as u32),
                shape_in_robot: Shape::Disc { center, radius_m: 0.3 },
            })
            .collect();
        flight.tick(&[]);
        if flight.ended().is_some() {
            return;
        }
    }
}

const COLUMN: Point = Point::new(0.0, -2.5);

/// A complete mission past one column.
fn flown(config: &MissionConfig) -> Flight {
    let mut flight = flight(config.clone());
    fly_past(&mut flight, &[COLUMN], 40_000);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
    assert!(covered(&flight) > 0.92, "{}", covered(&flight));
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::Held { .. })), 0);
    assert!(folded(&flight).standing().allows(&Order::TakePlan).is_err());
    flight
}

/// A mission up to the offer of a better plan.
fn with_offer() -> Flight {
    let mut flight = flight(wasteful(BetterPlan::Offer));
    for _ in 0..4000 {
        fly_past(&mut flight, &[COLUMN], 1);
        if flight.mission.standing().offer == Some(OfferStage::Offered) {
            return flight;
        }
    }
    panic!("no plan is offered: {:?}", better_events(&flight));
}

fn folded(flight: &Flight) -> FoldedStanding {
    let mut folded = FoldedStanding::default();
    flight.events.iter().for_each(|event| folded.apply(&event.kind));
    folded
}

/// The log lines about better plans, each with its tick.
fn better_events(flight: &Flight) -> Vec<(u64, String)> {
    let of = |event: &Event| match &event.kind {
        EventKind::BetterPlanned(_) | EventKind::BetterPlanTaken(_) | EventKind::BetterPlanDropped(_) => {
            Some((event.tick, event.log_line(&[])?.text))
        }
        _ => None,
    };
    flight.events.iter().filter_map(of).collect()
}

fn texts(flight: &Flight) -> Vec<String> {
    better_events(flight).into_iter().map(|(_, text)| text).collect()
}

fn driven_s(flight: &Flight) -> f64 {
    flight.mission.known.now_s()
}

#[test]
fn a_better_plan_is_taken_where_it_begins_in_one_tick_and_without_a_hold() {
    let config = wasteful(BetterPlan::Take);
    let (taken, off) =
        (flown(&MissionConfig { attended: false, ..config.clone() }), flown(&wasteful(BetterPlan::Off)));
    let [planned, took] = &better_events(&taken)[..] else { panic!("{:?}", better_events(&taken)) };
    assert!(planned.1.starts_with("better plan of straight: "), "{planned:?}");
    assert!(took.1.starts_with("better plan of straight taken: "), "{took:?}");
    assert!(driven_s(&taken) < 0.8 * driven_s(&off), "{} s, {} s", driven_s(&taken), driven_s(&off));
    assert_eq!(taken.planner.kept.iter().map(Option::is_some).collect::<Vec<_>>(), [false, true, false]);
    assert_eq!(taken.closed, [WorkerId(1), WorkerId(2)], "the previous worker, and the last one at the end");
    assert_eq!(off.planner.plans, 2);
    let commands = |tick: u64| {
        taken.events.iter().filter(|event| event.tick == tick).any(|event| {
            matches!(&event.kind, EventKind::Commanded { ask: Some(AskId { worker: WorkerId(2), .. }), .. })
        })
    };
    assert!(
        commands(took.0) && !commands(took.0 - 1),
        "the planner commands in the tick in which it takes over"
    );
}

#[test]
fn the_plan_is_asked_from_a_place_ahead_for_what_will_be_left_there() {
    let mut flight = with_offer();
    let Some(Preparing { role: Role::Better(better), .. }) = &flight.mission.preparing else {
        panic!("no better plan may be made")
    };
    let (kept, asked) = (flight.planner.regions_m2[1], flight.planner.regions_m2[2]);
    assert!(asked < kept - 2.0, "{kept} m² at the repair, {asked} m² for the better plan");
    let at = better.joint().unwrap().at;
    let mut nearest_m = f64::INFINITY;
    let away_m = (at - flight.pose.position).norm();
    for _ in 0..2000 {
        fly_past(&mut flight, &[COLUMN], 1);
        nearest_m = nearest_m.min((at - flight.pose.position).norm());
    }
    assert!(away_m > 0.5 && nearest_m < 0.1, "{away_m} m ahead, passed at {nearest_m} m");
}

#[test]
fn an_offer_that_nobody_takes_ends_where_the_plan_begins() {
    let mut flight = with_offer();
    assert_eq!(folded(&flight).standing().offer, Some(OfferStage::Offered));
    fly_past(&mut flight, &[COLUMN], 4000);
    let [.., last] = &texts(&flight)[..] else { panic!() };
    assert_eq!(last, "offer ended: robot passed the start of the plan");
    assert_eq!((flight.closed.as_slice(), flight.planner.plans), (&[WorkerId(2)][..], 3));
    assert!(refusal(&flight.tick(&[Order::TakePlan])).is_some_and(|why| why == "no better plan is offered"));
}

#[test]
fn an_offer_is_taken_by_order_also_by_one_that_is_given_while_the_robot_is_held() {
    for holds in [false, true] {
        let mut flight = with_offer();
        if holds {
            flight.tick(&[Order::Hold]);
            flight.tick(&[Order::TakePlan]);
            let held_at = flight.pose;
            fly_past(&mut flight, &[COLUMN], 50);
            assert_eq!(flight.pose, held_at);
            flight.tick(&[Order::Resume]);
        } else {
            flight.tick(&[Order::TakePlan]);
        }
        assert!(refusal(&flight.tick(&[Order::TakePlan])).is_some(), "the plan has already been accepted");
        fly_past(&mut flight, &[COLUMN], 40_000);
        assert_eq!(count(&flight, |kind| matches!(kind, EventKind::BetterPlanTaken(_))), 1);
        assert_eq!(flight.ended(), Some(Outcome::Complete));
    }
}

#[test]
fn none_is_made_where_nobody_could_take_it() {
    let config = MissionConfig { attended: false, ..wasteful(BetterPlan::Offer) };
    let flight = flown(&config);
    assert_eq!((flight.planner.plans, flight.closed.as_slice()), (2, &[WorkerId(1)][..]));
}

#[test]
fn a_plan_that_saves_less_than_a_change_costs_is_named_and_not_offered() {
    let mut flight = flight(wasteful(BetterPlan::Take));
    flight.planner.wasteful_plans = 9;
    fly_past(&mut flight, &[COLUMN], 40_000);
    let [said] = &texts(&flight)[..] else { panic!("{:?}", texts(&flight)) };
    assert!(
        said.starts_with("straight replanned: ") && said.ends_with("; the current plan is kept"),
        "{said}"
    );
    assert_eq!(flight.closed, [WorkerId(2), WorkerId(1)]);
}

#[test]
fn a_plan_that_scans_less_is_not_offered() {
    let mut flight = flight(wasteful(BetterPlan::Take));
    flight.planner.scans_less_from_plan = Some(3);
    fly_past(&mut flight, &[COLUMN], 40_000);
    let [said] = &texts(&flight)[..] else { panic!("{:?}", texts(&flight)) };
    assert!(said.contains("m² less"), "{said}");
}

/// A mission up to the third plan, whose answer is delayed.
fn while_it_is_made(config: MissionConfig) -> Flight {
    let mut flight = flight(config);
    flight.delay = Box::new(|ask, _| {
        let is_second = ask.id.worker == WorkerId(2) && matches!(ask.what, What::Plan(_));
        if is_second { 100_000 } else { 0 }
    });
    for _ in 0..4000 {
        fly_past(&mut flight, &[COLUMN], 1);
        if !flight.open.is_empty() {
            return flight;
        }
    }
    panic!("no better plan is made: {:?}", better_events(&flight));
}

#[test]
fn a_plan_that_is_not_there_in_time_is_given_up_and_the_robot_never_waits_for_it() {
    let mut flight = while_it_is_made(wasteful(BetterPlan::Take));
    let mut stood = 0;
    for _ in 0..3000 {
        let before = flight.pose;
        fly_past(&mut flight, &[COLUMN], 1);
        stood += usize::from(flight.pose == before);
    }
    let [said] = &texts(&flight)[..] else { panic!("{:?}", texts(&flight)) };
    let late = "it arrived after the robot had passed its start";
    assert_eq!(*said, format!("better plan of straight dropped: {late}"));
    assert_eq!((stood, flight.closed.as_slice()), (0, &[WorkerId(2)][..]));
}

#[test]
fn another_find_drops_what_is_being_made_and_after_its_repair_one_is_made_anew() {
    let mut flight = while_it_is_made(wasteful(BetterPlan::Take));
    flight.delay = Box::new(|_, _| 0);
    // On a lane that has not been driven yet, with room for the hull on all sides.
    let ahead = Point::new(-1.5, -3.3);
    fly_past(&mut flight, &[COLUMN, ahead], 1000);
    assert_eq!(texts(&flight)[0], "better plan of straight dropped: the map has changed");
    let kept: Vec<bool> = flight.planner.kept.iter().map(Option::is_some).collect();
    assert_eq!(kept[..4], [false, true, true, false], "{:?}", texts(&flight));
    assert_eq!(flight.closed[0], WorkerId(2));
}

#[test]
fn orders_that_change_the_plan_drop_it() {
    let corners = world::shape::rectangle(Point::new(2.0, 2.0), Point::new(3.0, 3.0));
    let gain = Order::SetParameter { key: "gain".into(), value: ParamValue::Float(2.0) };
    for (order, why) in [
        (swap_to("other"), OfferEnd::OtherPlannerChosen),
        (gain, OfferEnd::ParameterChanged),
        (Order::DrawZone(corners), OfferEnd::ZoneDrawn),
        (Order::DriveBack, OfferEnd::DrivingBack),
    ] {
        let mut flight = with_offer();
        flight.tick(&[Order::Hold]);
        assert_eq!(
            flight.mission.standing().offer,
            Some(OfferStage::Offered),
            "a hold does not change the plan"
        );
        flight.tick(&[order]);
        assert_eq!((flight.mission.standing().offer, folded(&flight).standing().offer), (None, None));
        assert_eq!(texts(&flight)[1], format!("offer ended: {why}"));
        let (stage, reason) = (Some(OfferStage::Offered), Some(why));
        assert_eq!(
            count(
                &flight,
                |kind| matches!(kind, EventKind::BetterPlanDropped(PlanDropped { stage: s, reason: r, .. }) if (s, r) == (&stage, &reason))
            ),
            1
        );
        assert_eq!(flight.closed[0], WorkerId(2));
        assert!(flight.mission.preparing.is_none());
    }
}

#[test]
fn a_zone_that_drops_an_accepted_plan_says_so() {
    let mut flight = with_offer();
    flight.tick(&[Order::TakePlan]);
    assert_eq!(folded(&flight).standing().offer, Some(OfferStage::Accepted));
    let why = refusal(&flight.tick(&[Order::TakePlan])).map(ToOwned::to_owned);
    assert!(why.is_some_and(|why| why.contains("has been accepted")));
    let corners = crate::outline::boxed(Point::new(2.0, 2.0), Point::new(3.0, 3.0));
    assert!(flight.mission.zone_cost(&corners).is_ok_and(|cost| cost.drops_offer));
    flight.tick(&[Order::DrawZone(corners)]);
    let [.., last] = &texts(&flight)[..] else { panic!() };
    assert_eq!(last, "accepted better plan dropped: a no-go zone was drawn");
}

#[test]
fn an_offer_says_how_much_floor_both_plans_scan() {
    let flight = with_offer();
    let scans = flight.events.iter().find_map(|event| match &event.kind {
        EventKind::BetterPlanned(PlanMade { scans, .. }) => *scans,
        _ => None,
    });
    let scans = scans.unwrap();
    assert!(scans.better.left_m2 < scans.flown.left_m2 + 0.1, "{scans:?}");
    assert!(scans.better.covered_reachable > 0.92 && scans.flown.covered_reachable > 0.92, "{scans:?}");
}

#[test]
fn a_planner_that_fails_at_it_is_named_and_harms_nobody() {
    let mut flight = flight(wasteful(BetterPlan::Take));
    flight.planner.refuse = vec!["straight"];
    fly_past(&mut flight, &[COLUMN], 40_000);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
    assert_eq!(texts(&flight), ["better plan of straight dropped: there is no planner straight"]);
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::PlannerFailed { .. })), 1);
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::Held { .. })), 0);
}

#[test]
fn a_fault_of_the_planner_that_drives_drops_it() {
    let mut flight = with_offer();
    flight.planner.fail_at_tick = Some(flight.mission.known.tick);
    flight.tick(&[]);
    assert_eq!(texts(&flight)[1], "offer ended: the active planner failed");
    flight.tick(&[Order::Resume]);
    fly_past(&mut flight, &[COLUMN], 40_000);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
}

#[test]
fn a_forecast_makes_none_unless_they_are_taken_without_asking() {
    for (better_plan, in_fork) in [(BetterPlan::Offer, BetterPlan::Off), (BetterPlan::Take, BetterPlan::Take)]
    {
        let flight = flight(wasteful(better_plan));
        assert_eq!(flight.mission.fork().mission.known.config.better_plan, in_fork);
    }
}

#[test]
fn a_turn_at_the_joint_counts_for_both() {
    let mut taken = flight(wasteful(BetterPlan::Take));
    fly_past(&mut taken, &[COLUMN], 4000);
    let said = taken.events.iter().find_map(|event| match &event.kind {
        EventKind::BetterPlanned(PlanMade { flown, better, path, .. }) => {
            Some((*flown, *better, path.clone()))
        }
        _ => None,
    });
    let (flown, better, path) = said.unwrap();
    let alone = Effort::of(&path, &taken.mission.known.config.limits);
    assert!(better.length_m > alone.length_m && flown.length_m > better.length_m);
    let planned = taken.events.iter().rev().find_map(|event| match &event.kind {
        EventKind::Planned { ask: None, reason: Reason::MapChanged, length_m, .. } => Some(*length_m),
        _ => None,
    });
    assert!((planned.unwrap() - alone.length_m).abs() < 0.3, "{planned:?} of {}", alone.length_m);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Delays and orders at random: the journal repeats byte for byte, and all readers know whether a plan is offered.
    #[test]
    fn the_journal_repeats_better_plans(
        takes in any::<bool>(),
        delay in 0_u64..900,
        orders in prop::collection::vec((200_u64..3000, 0_u8..5), 0..6),
    ) {
        let config = wasteful(if takes { BetterPlan::Take } else { BetterPlan::Offer });
        let mut flight = flight(config.clone());
        flight.delay = Box::new(move |ask, tick| match ask.what {
            What::Plan(_) if ask.id.worker.0 > 1 => delay,
            What::Open { .. } => tick % 7,
            _ => 0,
        });
        let mut standing = FoldedStanding::default();
        standing.apply(&opened(&config));
        flight.events.iter().for_each(|event| standing.apply(&event.kind));
        for tick in 1..3000 {
            let due = orders.iter().filter(|(at, _)| *at == tick).map(|(_, n)| match n {
                0 => Order::Hold,
                1 => Order::Resume,
                2 => swap_to("straight"),
                _ => Order::TakePlan,
            });
            let due: Vec<Order> = due.collect();
            if !due.is_empty() {
                let n_before = flight.events.len();
                flight.tick(&due);
                flight.events[n_before..].iter().for_each(|event| standing.apply(&event.kind));
            }
            let n_before = flight.events.len();
            fly_past(&mut flight, &[COLUMN], 1);
            flight.events[n_before..].iter().for_each(|event| standing.apply(&event.kind));
            prop_assert_eq!(standing.standing().offer, flight.mission.standing().offer);
        }
        let again = replay(config, &flight);
        prop_assert_eq!(again.len(), flight.events.len());
        for (again, event) in again.iter().zip(&flight.events) {
            prop_assert_eq!(again, event);
        }
    }
}
