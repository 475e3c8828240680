//! Stopping has no exception: whatever the mission is doing, HOLD stops the robot in the tick in which it arrives, and
//! only an order lets the robot move again.

use super::{covering::covering, tethered::tethered, *};
use crate::{
    order::{Injection, RangeFault},
    phase::{Resumes, StepTo},
};

/// A mission in some state, together with a function that would let the robot move again if HOLD had not been ordered.
struct Case {
    name: &'static str,
    flight: Flight,
    /// Removes the cause of the hold, or lets the planner answer.
    clear: fn(&mut Flight),
}

fn never(_: &Ask, _: u64) -> u64 {
    u64::MAX / 2
}

fn at_once(flight: &mut Flight) {
    flight.delay = Box::new(|_, _| 0);
    flight.open.iter_mut().for_each(|(due, _)| *due = 0);
}

fn started(config: MissionConfig) -> Flight {
    let mut flight = Flight::new(config);
    flight.tick(&[Order::Start]);
    flight.fly(10);
    flight
}

fn waiting_for(is_unanswered: fn(&Ask) -> bool, config: MissionConfig) -> Flight {
    let mut flight = Flight::new(config);
    flight.delay = Box::new(move |ask, tick| if is_unanswered(ask) { never(ask, tick) } else { 0 });
    flight.tick(&[Order::Start]);
    flight.fly(5);
    flight
}

fn fallback() -> MissionConfig {
    let choice = PlannerChoice { id: "fallback".into(), parameters: Parameters::new() };
    MissionConfig { fallback: Some(choice), ..config() }
}

fn lost() -> Flight {
    let mut flight = started(MissionConfig { odometry_sigma_per_m: 0.5, ..config() });
    flight.silent = true;
    flight.fly(60);
    flight
}

fn alarmed() -> Flight {
    let mut flight = started(config());
    flight.excess_range_m = vec![1.5];
    flight.fly(20);
    flight
}

/// A mission that is held because the hull does not fit through the return path along the cable; the hold ends as soon
/// as the hull fits.
fn without_return_path() -> Flight {
    let mut flight = started(tethered(20.0));
    let hold =
        Hold { by: HoldReason::Tether { message: "no return path".into() }, resumes: Resumes::WhenCleared };
    flight.mission.known.phase = Phase::Held(hold);
    flight
}

fn fallback_under_way() -> Flight {
    let mut flight = started(fallback());
    flight.planner.fail_at_tick = Some(flight.mission.known.tick);
    flight.delay =
        Box::new(|ask, tick| if matches!(ask.what, What::Open { .. }) { never(ask, tick) } else { 0 });
    flight.fly(5);
    flight
}

fn silent_planner() -> Flight {
    let mut flight = started(config());
    flight.delay = Box::new(never);
    flight.fly(25);
    flight
}

fn cases() -> Vec<Case> {
    let is_open = |ask: &Ask| matches!(ask.what, What::Open { .. });
    let is_plan = |ask: &Ask| matches!(ask.what, What::Plan(_));
    let is_step = |ask: &Ask| matches!(ask.what, What::Step(_));
    let case = |name, flight, clear| Case { name, flight, clear };
    vec![
        case("running", started(config()), at_once),
        case("running, planner opening", waiting_for(is_open, config()), at_once),
        case("running, plan in the making", waiting_for(is_plan, config()), at_once),
        case("covering, plan in the making", waiting_for(is_plan, covering()), at_once),
        case("running, step unanswered", waiting_for(is_step, config()), at_once),
        case("position lost", lost(), |flight| flight.silent = false),
        case("ranges contradict", alarmed(), |flight| flight.excess_range_m.clear()),
        case("no return path", without_return_path(), |_| {}),
        case("fallback opening", fallback_under_way(), at_once),
        case("planner silent", silent_planner(), at_once),
    ]
}

/// All ways to stop give the mission one of two orders: keys and signals give HOLD, and leaving the console gives the
/// end of the mission.
#[test]
fn every_hold_stops_the_robot_in_its_tick_and_for_good() {
    for Case { name, mut flight, clear } in cases() {
        assert!(flight.mission.phase().may_move(), "{name}: {:?}", flight.mission.phase());
        let before = flight.pose;
        flight.tick(&[Order::Hold]);
        assert_eq!(flight.pose, before, "{name}: the robot moved in the tick of HOLD");
        assert_eq!(flight.held_by(), Some(&HoldReason::Operator), "{name}");
        clear(&mut flight);
        flight.fly(80);
        assert_eq!(flight.pose, before, "{name}: the robot moved without an order");
        assert!(!flight.mission.phase().may_move(), "{name}: {:?}", flight.mission.phase());
        flight.tick(&[Order::Resume]);
        flight.fly(30);
        assert!(flight.pose != before, "{name}: an order lets the robot move: {:?}", flight.mission.phase());
    }
}

#[test]
fn hold_and_another_order_in_one_tick_are_obeyed_in_turn() {
    for Case { name, mut flight, clear } in cases() {
        let before = flight.pose;
        flight.tick(&[Order::Hold, swap_to("other"), Order::Hold]);
        clear(&mut flight);
        flight.fly(80);
        assert_eq!(flight.pose, before, "{name}");
    }
    let mut flight = Flight::new(config());
    let before = flight.pose;
    flight.tick(&[Order::Start, Order::Hold]);
    flight.fly(20);
    assert_eq!(flight.pose, before, "the start was followed by HOLD in the same tick");
}

#[test]
fn leaving_ends_every_mission_in_its_tick_and_closes_every_worker() {
    for Case { name, mut flight, clear } in cases() {
        let before = flight.pose;
        let events = flight.tick(&[Order::Abort]);
        assert!(matches!(events.last(), Some(EventKind::Ended { outcome: Outcome::Aborted, .. })), "{name}");
        clear(&mut flight);
        flight.fly(20);
        assert_eq!(flight.pose, before, "{name}");
        assert!(flight.open.is_empty() && !flight.closed.is_empty(), "{name}: {:?}", flight.open);
    }
}

#[test]
fn a_hold_that_only_an_order_ends_keeps_its_reason() {
    let task = TaskConfig::Goto { goal: Point::new(3.0, 0.0), tolerance_m: 0.0 };
    let mut flight = started(MissionConfig { task, ..config() });
    flight.fly(400);
    assert!(matches!(flight.held_by(), Some(HoldReason::Stuck { .. })));
    let events = flight.tick(&[Order::Hold]);
    assert!(events.iter().any(|kind| matches!(kind, EventKind::Ordered { order: Order::Hold })));
    assert!(matches!(flight.held_by(), Some(HoldReason::Stuck { .. })));
}

/// A single step is interrupted by a hold: when that hold ends, the robot remains held.
#[test]
fn a_single_step_that_is_interrupted_by_a_hold_does_not_become_a_run() {
    let mut flight = silent_planner();
    flight.tick(&[Order::Hold]);
    let before = flight.pose;
    flight.tick(&[Order::Step]);
    assert!(matches!(flight.held_by(), Some(HoldReason::PlannerSilent { .. })), "{:?}", flight.held_by());
    at_once(&mut flight);
    flight.fly(40);
    assert_eq!(flight.pose, before);
    assert!(!flight.mission.phase().may_move(), "{:?}", flight.mission.phase());
}

/// The operator held the robot and changed planners; if the new planner fails, the operator decides, not the fallback
/// rule.
#[test]
fn a_fault_while_only_an_order_ends_the_hold_does_not_hand_over_to_the_fallback() {
    let mut flight = started(fallback());
    flight.tick(&[Order::Hold]);
    flight.tick(&[swap_to("fallback")]);
    flight.fly(3);
    flight.tick(&[Order::Resume]);
    flight.fly(3);
    flight.planner.fail_at_tick = Some(flight.mission.known.tick);
    flight.tick(&[]);
    flight.tick(&[Order::Hold]);
    let before = flight.pose;
    flight.planner.refuse = vec!["other"];
    flight.tick(&[swap_to("other")]);
    flight.fly(40);
    assert_eq!(flight.pose, before, "{:?}", flight.mission.phase());
    assert!(!flight.mission.phase().may_move(), "{:?}", flight.mission.phase());
}

#[test]
#[allow(clippy::large_stack_arrays, reason = "two missions, for a test")]
fn a_planner_chosen_under_a_hold_that_ends_by_itself_waits_for_an_order() {
    for (name, mut flight) in
        [("fallback opening", fallback_under_way()), ("planner silent", silent_planner())]
    {
        let before = flight.pose;
        flight.tick(&[swap_to("other")]);
        at_once(&mut flight);
        flight.fly(40);
        assert_eq!(flight.pose, before, "{name}: {:?}", flight.mission.phase());
        assert_eq!(flight.mission.planner_id(), "other", "{name}");
        flight.tick(&[Order::Resume]);
        flight.fly(10);
        assert!(flight.pose != before, "{name}: {:?}", flight.mission.phase());
    }
}

#[test]
fn a_planner_chosen_in_the_tick_after_a_fault_is_not_replaced_by_the_fallback() {
    let mut flight = started(fallback());
    flight.planner.fail_at_tick = Some(flight.mission.known.tick);
    flight.tick(&[]);
    flight.tick(&[swap_to("other")]);
    flight.fly(10);
    assert_eq!(flight.mission.planner_id(), "other");
    assert_eq!(flight.held_by(), Some(&HoldReason::PlannerReplaced));
}

#[test]
fn a_candidate_that_the_fallback_displaces_is_reported() {
    let mut flight = started(fallback());
    flight.tick(&[Order::Hold]);
    flight.delay = Box::new(|ask, tick| match &ask.what {
        What::Open { choice, .. } if choice.id == "other" => never(ask, tick),
        _ => 0,
    });
    flight.tick(&[swap_to("other")]);
    flight.tick(&[Order::Resume]);
    flight.planner.fail_at_tick = Some(flight.mission.known.tick);
    flight.fly(5);
    assert_eq!(flight.mission.planner_id(), "fallback");
    let is_reported = |kind: &EventKind| matches!(kind, EventKind::PlannerRejected { planner, why } if planner == "other" && why.contains("fallback"));
    assert_eq!(count(&flight, is_reported), 1);
}

/// A planner that takes long to open does not count as a robot that is stuck.
#[test]
fn a_robot_that_waits_for_a_planner_to_open_is_not_stuck() {
    let is_open = |ask: &Ask| matches!(ask.what, What::Open { .. });
    let mut flight = waiting_for(is_open, config());
    flight.fly(450);
    assert_eq!(flight.mission.phase(), &Phase::Running(Gait::Steady));
}

/// An obstacle makes a new plan necessary. This does not close a working planner in favour of one that may fail to open.
#[test]
fn a_planner_that_is_well_stays_when_the_chosen_one_cannot_be_opened() {
    let mut flight = started(config());
    flight.tick(&[Order::Hold]);
    flight.mission.driving.course.want_plan(Reason::MapChanged);
    flight.planner.refuse = vec!["other"];
    flight.tick(&[swap_to("other")]);
    flight.fly(3);
    assert_eq!(flight.mission.planner_id(), "straight");
    let before = flight.pose;
    flight.tick(&[Order::Resume]);
    flight.fly(5);
    assert!(flight.pose != before, "{:?}", flight.mission.phase());
}

#[test]
fn a_step_ends_after_a_metre_without_lanes_and_goes_on_until_something_happens() {
    let mut flight = started(config());
    flight.tick(&[Order::Hold]);
    let from = flight.mission.known.locator.position();
    flight.tick(&[Order::StepTo(StepTo::LaneEnd)]);
    flight.fly(200);
    assert!(matches!(flight.mission.phase(), Phase::Held(hold) if hold.by == HoldReason::Stepped));
    let way_m = (flight.mission.known.locator.position() - from).norm();
    assert!((0.9..1.6).contains(&way_m), "{way_m} m");
    flight.tick(&[Order::StepTo(StepTo::Event)]);
    flight.fly(3);
    assert!(
        matches!(flight.mission.phase(), Phase::Running(Gait::To(StepTo::Event))),
        "nothing has happened"
    );
    flight.silent = true;
    flight.fly(60);
    assert!(matches!(flight.mission.phase(), Phase::Held(hold) if hold.resumes.is_never()));
}

/// A hold that would have ended automatically: making a station fail, or excluding one, does not release the robot.
#[test]
fn what_changes_the_ranges_of_a_held_robot_leaves_it_to_an_order() {
    let station = StationId(1);
    let fault = Order::Inject(Injection { station, fault: RangeFault::Dead, for_s: 1.0, by: None });
    let held = |case: &Case| matches!(case.flight.mission.phase(), Phase::Held(_));
    for order in [fault, Order::UseStation { station, used: false, by: None }] {
        for Case { name, mut flight, clear } in cases().into_iter().filter(held) {
            let before = flight.pose;
            flight.tick(std::slice::from_ref(&order));
            clear(&mut flight);
            flight.fly(80);
            assert_eq!(flight.pose, before, "{name}: {order:?}");
        }
    }
}

#[test]
fn an_excluded_station_is_not_used_until_it_is_taken_back() {
    let station = StationId(1);
    let mut flight = started(config());
    flight.tick(&[Order::UseStation { station, used: false, by: None }]);
    let used = |flight: &mut Flight| {
        let events: Vec<EventKind> = (0..20).flat_map(|_| flight.tick(&[])).collect();
        let ranged = events.iter().filter_map(|kind| match kind {
            EventKind::Ranged { ranges } => Some(ranges.iter().any(|range| range.station == station)),
            _ => None,
        });
        let ranged: Vec<bool> = ranged.collect();
        (ranged.len() > 1, ranged.iter().any(|used| *used))
    };
    assert_eq!(used(&mut flight), (true, false));
    flight.tick(&[Order::UseStation { station, used: true, by: None }]);
    assert_eq!(used(&mut flight), (true, true));
}
