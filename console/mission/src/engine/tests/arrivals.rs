//! Answers that arrive at any time: the mission does not wait for them, and the journal reproduces each of them.

use super::{covering::covering, shadow::shadow, *};
use crate::{Awaits, FoldedStanding, event::RecordedAnswers};
use proptest::prelude::*;

fn step_delay(ticks: u64, from: u64, to: u64) -> Delay {
    Box::new(
        move |ask, tick| {
            if matches!(ask.what, What::Step(_)) && (from..to).contains(&tick) { ticks } else { 0 }
        },
    )
}

fn moves(flight: &mut Flight, ticks: usize) -> Vec<bool> {
    (0..ticks)
        .map(|_| {
            let before = flight.pose;
            flight.tick(&[]);
            flight.pose != before
        })
        .collect()
}

#[test]
fn a_late_step_costs_its_tick_and_is_used_while_it_is_fresh() {
    let mut flight = Flight::new(config());
    flight.tick(&[Order::Start]);
    flight.fly(10);
    let tick = flight.mission.known.tick;
    flight.delay = step_delay(1, tick, tick + 1);
    assert_eq!(moves(&mut flight, 4), [false, true, true, true]);
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::PlannerLate { ticks: 1, .. })), 1);
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::PlannerFailed { .. })), 0);
    flight.delay = Box::new(|_, _| 0);
    flight.fly(200);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
}

#[test]
fn a_step_older_than_two_ticks_is_dropped_and_asked_again() {
    let mut flight = Flight::new(config());
    flight.tick(&[Order::Start]);
    flight.fly(10);
    let tick = flight.mission.known.tick;
    flight.delay = step_delay(3, tick, tick + 1);
    assert_eq!(moves(&mut flight, 5), [false, false, false, true, true]);
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::Discarded { .. })), 1);
}

#[test]
fn a_planner_that_is_silent_for_two_seconds_holds_the_robot_until_it_answers() {
    let mut flight = Flight::new(config());
    flight.tick(&[Order::Start]);
    flight.fly(10);
    let tick = flight.mission.known.tick;
    flight.delay = step_delay(50, tick, tick + 1);
    flight.fly(25);
    let Phase::Held(hold) = flight.mission.phase() else { panic!("{:?}", flight.mission.phase()) };
    assert!(matches!(hold.by, HoldReason::PlannerSilent { .. }) && !hold.resumes.is_never());
    flight.fly(200);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::PlannerFailed { .. })), 0);
}

#[test]
fn the_clock_runs_while_a_plan_is_made_and_nobody_is_stuck_meanwhile() {
    for config in [config(), covering()] {
        let mut flight = Flight::new(config);
        flight.delay = Box::new(|ask, _| if matches!(ask.what, What::Plan(_)) { 300 } else { 0 });
        flight.tick(&[Order::Start]);
        assert_eq!(flight.mission.awaits(), Awaits::Work);
        let before = flight.pose;
        flight.fly(299);
        assert_eq!((flight.pose, flight.mission.phase()), (before, &Phase::Running(Gait::Steady)));
        flight.fly(20);
        assert!(flight.pose != before);
    }
}

#[test]
fn two_planners_have_asks_open_at_once_and_the_one_before_drives_on() {
    let mut flight = Flight::new(config());
    flight.tick(&[Order::Start]);
    flight.fly(10);
    flight.tick(&[Order::Hold]);
    flight.delay = Box::new(|ask, _| if matches!(ask.what, What::Plan(_)) { 5 } else { 0 });
    flight.tick(&[swap_to("other")]);
    assert_eq!(flight.mission.awaits(), Awaits::Candidate);
    // While the other planner plans, the robot continues with its current planner and plan.
    flight.delay = step_delay(1, 0, u64::MAX);
    flight.tick(&[Order::Resume]);
    let workers: Vec<_> = flight.open.iter().map(|(_, ask)| ask.id.worker).collect();
    assert!(workers.len() == 2 && workers[0] != workers[1], "{workers:?}");
    flight.delay = Box::new(|_, _| 0);
    flight.fly(250);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
    assert_eq!(flight.planner.chosen, ["straight", "other"]);
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::PlannerPrepared { .. })), 1);
}

#[test]
fn a_planner_whose_plan_comes_after_the_robot_went_on_plans_again_and_the_robot_waits() {
    let mut flight = Flight::new(config());
    flight.tick(&[Order::Start]);
    flight.fly(10);
    flight.tick(&[Order::Hold]);
    flight.delay = Box::new(|ask, _| if matches!(ask.what, What::Plan(_)) { 25 } else { 0 });
    flight.tick(&[swap_to("other")]);
    flight.tick(&[Order::Resume]);
    flight.fly(24);
    let before = flight.pose;
    assert_eq!(moves(&mut flight, 20), [false; 20], "the robot waits for the second plan");
    flight.fly(5);
    assert!(flight.pose != before);
    assert_eq!(flight.planner.chosen, ["straight", "other"]);
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::PlannerChosen { .. })), 2);
}

#[test]
fn a_live_parameter_goes_to_the_planner_before_its_next_step() {
    let mut flight = Flight::new(config());
    flight.tick(&[Order::Start]);
    flight.fly(10);
    flight.mission.driving.worker.info.as_mut().unwrap().parameters = vec![gain(true)];
    let value = ParamValue::Float(2.0);
    let events = flight.tick(&[Order::SetParameter { key: "gain".into(), value: value.clone() }]);
    let at = |is: fn(&EventKind) -> bool| events.iter().position(is);
    let changed = at(|kind| matches!(kind, EventKind::ParametersChanged { .. }));
    assert!(
        changed.is_some() && changed < at(|kind| matches!(kind, EventKind::Commanded { .. })),
        "{events:?}"
    );
    assert_eq!(flight.mission.driving.worker.choice.parameters["gain"], value);
}

#[test]
fn state_is_saved_every_second_and_given_to_the_next_instance() {
    let mut flight = Flight::new(config());
    flight.planner.snapshots = true;
    flight.tick(&[Order::Start]);
    flight.fly(35);
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::Snapshotted { .. })), 3);
    let newest = flight.mission.driving.worker.saved;
    flight.planner.fail_at_tick = Some(flight.mission.known.tick);
    flight.tick(&[]);
    flight.delay = Box::new(|ask, _| u64::from(matches!(ask.what, What::Open { .. })));
    flight.tick(&[Order::Resume]);
    let What::Open { restore, .. } = &flight.open[0].1.what else { panic!("{:?}", flight.open) };
    assert!(newest.is_some() && *restore == newest);
}

#[test]
fn a_plugin_that_fails_three_times_within_a_minute_may_not_drive_again() {
    let mut flight = Flight::new(config());
    flight.tick(&[Order::Start]);
    for _ in 0..3 {
        flight.planner.fail_at_tick = Some(flight.mission.known.tick);
        flight.tick(&[]);
        flight.tick(&[Order::Resume]);
    }
    let barred = |kind: &EventKind| matches!(kind, EventKind::PlannerFailed { fault, .. } if fault.cause == Cause::Quarantined);
    assert_eq!(count(&flight, barred), 1);
    flight.tick(&[swap_to("other")]);
    flight.tick(&[Order::Resume]);
    flight.fly(200);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
}

/// Replays the answers of a journal in another mission, in the ticks in which they arrived.
pub(super) fn replay(config: MissionConfig, recorded: &Flight) -> Vec<Event> {
    replay_asking(config, recorded, |_| {})
}

/// Does the same, and passes each ask to `hear`.
pub(super) fn replay_asking(
    config: MissionConfig,
    recorded: &Flight,
    mut hear: impl FnMut(&Ask),
) -> Vec<Event> {
    let mut again = Flight::new(config);
    let (mut events, mut answers) = (Vec::new(), RecordedAnswers::default());
    for (readings, orders) in &recorded.inputs {
        let tick = again.mission.known.tick;
        answers
            .begin_tick(recorded.events.iter().filter(|event| event.tick == tick).map(|event| &event.kind));
        again.mission.sense(&Input { readings, age_s: 0.0, orders, trouble: None });
        loop {
            while let Some(ask) = again.mission.poll_ask() {
                hear(&ask);
                answers.submit(&ask);
            }
            let Some((answer, _)) = answers.next_answer() else { break };
            again.mission.answer(answer);
        }
        events.extend(again.mission.act().events);
    }
    events
}

fn order(n: u8) -> Order {
    match n % 13 {
        0 => Order::Hold,
        1 => Order::Resume,
        2 => Order::Step,
        3 => swap_to("other"),
        4 => swap_to("straight"),
        5 => Order::SetParameter { key: "gain".into(), value: ParamValue::Float(f64::from(n)) },
        6 => Order::Start,
        7 => shadow("other"),
        8 => shadow("straight"),
        9 => Order::Promote,
        10 => Order::TakePlan,
        11 => Order::DriveBack,
        _ => Order::DropShadow,
    }
}

/// How far the operator's orders allow the robot to move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Leave {
    /// Not at all: the last order was HOLD, or chose another planner.
    None,
    /// For one command.
    OneTick,
    /// Until the robot is held.
    Steady,
}

impl Leave {
    fn after(self, events: &[Event]) -> Self {
        events.iter().fold(self, |leave, event| match &event.kind {
            EventKind::Ordered {
                order: Order::Start | Order::Resume | Order::DriveBack | Order::FlyUncertified,
            } => Self::Steady,
            EventKind::Ordered { order: Order::Step } => Self::OneTick,
            EventKind::Ordered { order: Order::Hold | Order::ChoosePlanner(_) } => Self::None,
            _ => leave,
        })
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Delays, losses, faults and orders at random: the robot moves only while it runs, and only as far as orders
    /// allow; HOLD stops it in the same tick; no worker has two open asks; and the journal repeats byte for byte.
    #[test]
    fn whatever_arrives_when_the_rules_hold_and_the_journal_repeats(
        covers in any::<bool>(),
        has_fallback in any::<bool>(),
        refuses_other in any::<bool>(),
        has_stiff_gain in any::<bool>(),
        silent in prop::option::of(20_u64..300),
        delays in prop::collection::vec(prop_oneof![4 => 0_u64..1, 2 => 1_u64..5, 1 => 20_u64..60], 64),
        faults in prop::collection::vec(0_u64..400, 0..4),
        orders in prop::collection::vec((0_u64..400, 0_u8..26), 0..16),
    ) {
        let config = if covers { covering() } else { config() };
        let fallback = PlannerChoice { id: "fallback".into(), parameters: Parameters::new() };
        // The error of the odometry grows quickly, so the position is lost if ranges are missing.
        let config = MissionConfig { fallback: has_fallback.then_some(fallback), odometry_sigma_per_m: 0.3, ..config };
        let mut flight = Flight::new(config.clone());
        flight.planner.has_stiff_gain = has_stiff_gain;
        flight.planner.refuse = if refuses_other { vec!["other"] } else { vec![] };
        flight.planner.snapshots = true;
        flight.planner.fail_at_ticks.clone_from(&faults);
        flight.planner.says_much = true;
        flight.delay = Box::new(move |ask, tick| delays[(ask.id.n as usize * 31 + tick as usize) % delays.len()]);
        flight.tick(&[Order::Start]);
        let mut folded = FoldedStanding::default();
        flight.events.iter().for_each(|event| folded.apply(&event.kind));
        let mut leave = Leave::Steady;
        for tick in 1..400 {
            let now: Vec<Order> =
                orders.iter().filter(|(at, _)| *at == tick).map(|(_, n)| order(*n)).collect();
            let (before, n_before) = (flight.pose, flight.events.len());
            flight.silent = silent.is_some_and(|from| (from..from + 40).contains(&tick));
            flight.tick(&now);
            leave = leave.after(&flight.events[n_before..]);
            if flight.pose != before {
                prop_assert_ne!(leave, Leave::None, "tick {}: the robot moves without an order", tick);
                leave = if leave == Leave::OneTick { Leave::None } else { leave };
            }
            for event in flight.events.iter().filter(|event| event.tick == flight.mission.known.tick - 1) {
                folded.apply(&event.kind);
            }
            let standing = flight.mission.standing();
            prop_assert_eq!(&folded.phase, standing.phase);
            for n in [0, 1, 2, 3, 5, 6, 7, 9, 10, 11, 12] {
                prop_assert_eq!(folded.standing().allows(&order(n)), standing.allows(&order(n)), "{:?}", order(n));
            }
            let holds = now.last() == Some(&Order::Hold);
            if holds || !matches!(flight.mission.phase(), Phase::Running(_) | Phase::Held(Hold { by: HoldReason::Stepped, .. })) {
                prop_assert_eq!(flight.pose, before, "{:?}", flight.mission.phase());
            }
            let mut open: Vec<_> = flight.open.iter().map(|(_, ask)| ask.id.worker).collect();
            let n_open = open.len();
            open.dedup();
            prop_assert!(n_open <= 3 && open.len() == n_open, "{:?}", flight.open);
        }
        let again = replay(config, &flight);
        for (again, event) in again.iter().zip(&flight.events) {
            prop_assert_eq!(again, event);
        }
        prop_assert_eq!(again.len(), flight.events.len());
    }
}

#[test]
fn with_long_ticks_a_planner_that_always_answers_in_the_next_tick_drives() {
    let limits = Limits { tick_s: 0.5, ..config().limits };
    let mut flight = Flight::new(MissionConfig { tick_s: 0.5, limits, ..config() });
    flight.delay = Box::new(|ask, _| if matches!(ask.what, What::Open { .. }) { 40 } else { 1 });
    flight.tick(&[Order::Start]);
    flight.fly(60);
    assert_eq!(flight.held_by(), None, "a planner may take long to open");
    assert!(flight.pose.position.x > -2.5, "{}", flight.pose.position);
}
