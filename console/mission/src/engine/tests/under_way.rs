//! The plans that planners are asked to keep to: a plan that is in use, or one that they made shortly before.

use super::*;
use super::{
    arrivals::{replay, replay_asking},
    covering::covering,
};
use crate::{event::Severity, standing::Readiness};
use world::polyline;

/// A coverage mission that is held before its end.
fn held_on_the_way() -> Flight {
    let mut flight = Flight::new(covering());
    flight.tick(&[Order::Start]);
    flight.fly(200);
    flight.tick(&[Order::Hold]);
    flight
}

/// The path of the last plan.
fn last_path(flight: &Flight) -> Vec<Point> {
    let path = |event: &Event| match &event.kind {
        EventKind::Planned { path, .. } => Some(path.clone()),
        _ => None,
    };
    flight.events.iter().rev().find_map(path).unwrap()
}

/// Lengths of the plans to keep to, one per request, metres.
fn kept_m(flight: &Flight) -> Vec<Option<f64>> {
    let length_m = |plan: &Option<Plan>| plan.as_ref().map(|plan| polyline::length_m(&plan.path));
    flight.planner.kept.iter().map(length_m).collect()
}

#[test]
fn a_planner_that_starts_again_is_given_what_is_left_of_its_plan() {
    let mut flight = Flight::new(covering());
    flight.planner.fail_at_ticks = vec![200];
    flight.planner.cut = Some(vec![Point::new(0.0, 1.0), Point::new(0.0, 2.0)]);
    flight.tick(&[Order::Start]);
    flight.fly(199);
    let (path, target) = (last_path(&flight), flight.mission.known.task.target());
    flight.fly(2);
    assert!(flight.held_by().is_some());
    flight.tick(&[Order::Resume]);
    flight.fly(2);
    let [None, Some(kept)] = &flight.planner.kept[..] else { panic!("{:?}", kept_m(&flight)) };
    assert!((kept.path[0] - target).norm() < 0.1 && kept.path.last() == path.last());
    let left_m = polyline::length_m(&path) - flight.mission.known.now_s() * 0.4;
    assert!((polyline::length_m(&kept.path) - left_m).abs() < 1.5, "{left_m} m, {:?}", kept_m(&flight));
    assert_eq!(kept.check(), Ok(()));
    assert_eq!((kept.cuts.len(), kept.legs.last().map(|leg| leg.tag)), (1, Some(api::LegTag::Travel)));
}

#[test]
fn another_planner_and_other_values_begin_anew() {
    let mut flight = held_on_the_way();
    flight.tick(&[swap_to("other")]);
    let parameters = Parameters::from([("gain".to_owned(), ParamValue::Float(2.0))]);
    flight.tick(&[Order::ChoosePlanner(PlannerChoice { id: "other".into(), parameters })]);
    assert_eq!(kept_m(&flight), [None; 3]);
}

#[test]
fn the_planner_that_drives_keeps_its_plan_when_it_is_chosen_with_other_live_values() {
    let mut flight = held_on_the_way();
    flight.mission.driving.worker.info.as_mut().unwrap().parameters = vec![gain(true)];
    let chosen = |value| {
        let parameters = Parameters::from([("gain".to_owned(), ParamValue::Float(value))]);
        Order::ChoosePlanner(PlannerChoice { id: "straight".into(), parameters })
    };
    let changed =
        |events: &[EventKind]| events.iter().any(|kind| matches!(kind, EventKind::ParametersChanged { .. }));
    assert!(changed(&flight.tick(&[chosen(2.0)])));
    assert_eq!((flight.planner.plans, flight.planner.chosen.len(), flight.closed.len()), (1, 1, 0));
    assert!(matches!(flight.held_by(), Some(HoldReason::Operator)));
    // Ordering the same choice once more makes a new plan; so does a choice that changes the plan or resets a value.
    flight.tick(&[chosen(2.0)]);
    assert_eq!(flight.planner.plans, 2);
    flight.mission.driving.worker.info.as_mut().unwrap().parameters = vec![gain(false)];
    flight.tick(&[chosen(3.0)]);
    flight.mission.driving.worker.info.as_mut().unwrap().parameters = vec![gain(true)];
    flight.tick(&[swap_to("straight")]);
    assert_eq!((flight.planner.plans, flight.planner.chosen.len()), (4, 4));
}

#[test]
fn a_planner_that_begins_again_with_other_live_values_keeps_to_its_plan() {
    let mut flight = Flight::new(covering());
    flight.planner.has_stiff_gain = true;
    flight.tick(&[Order::Start]);
    flight.fly(200);
    flight.tick(&[Order::Hold]);
    let left_m = flight.mission.known.task.under_way().map(|plan| polyline::length_m(&plan.path));
    flight.tick(&[Order::SetParameter { key: "gain".into(), value: ParamValue::Float(2.0) }]);
    flight.fly(2);
    assert_eq!((flight.planner.chosen.len(), kept_m(&flight)), (2, vec![None, left_m]));
    assert_eq!(flight.mission.driving.worker.choice.parameters["gain"], ParamValue::Float(2.0));
}

#[test]
fn a_planner_that_dies_while_the_robot_is_held_is_reported_at_once_and_starts_again_at_the_next_resume() {
    let mut flight = Flight::new(covering());
    flight.tick(&[Order::Start]);
    flight.fly(100);
    assert!(
        refusal(&flight.tick(&[Order::CheckPlanner])).is_some(),
        "a planner that drives the robot is asked in every tick anyway"
    );
    flight.tick(&[Order::Hold]);
    flight.fly(5);
    assert!(flight.mission.idle_workers().count() == 1);
    flight.planner.has_died = true;
    flight.tick(&[Order::CheckPlanner]);
    assert_eq!((last_fault(&flight).cause, last_fault(&flight).severity()), (Cause::Died, Severity::Crit));
    assert!(flight.mission.idle_workers().count() == 0, "the planner is checked only once");
    flight.fly(20);
    assert_eq!(flight.planner.chosen.len(), 1);
    let before = flight.pose.position;
    flight.tick(&[Order::Resume]);
    flight.fly(20);
    assert_eq!(flight.planner.chosen.len(), 2);
    assert!(flight.pose.position != before);
    assert_eq!(replay(covering(), &flight), flight.events);
}

#[test]
fn a_planner_that_dies_before_the_start_is_reported_and_bars_the_start_until_it_has_planned_again() {
    let config = MissionConfig { start_names_plan: true, ..covering() };
    let mut flight = Flight::new(config.clone());
    flight.tick(&[Order::Plan]);
    let Readiness::Plan(seen) = flight.mission.standing().readiness else { panic!("a plan") };
    assert_eq!(flight.mission.idle_workers().count(), 1);
    flight.planner.has_died = true;
    flight.tick(&[Order::CheckPlanner]);
    assert_eq!(last_fault(&flight).cause, Cause::Died);
    assert!(matches!(flight.mission.standing().readiness, Readiness::Failed(_)));
    assert!(refusal(&flight.tick(&[Order::StartPlan(seen)])).is_some());
    flight.planner.has_died = false;
    flight.tick(&[Order::Plan]);
    let Readiness::Plan(seen) = flight.mission.standing().readiness else {
        panic!("there must be a plan again")
    };
    assert!(refusal(&flight.tick(&[Order::StartPlan(seen)])).is_none());
    assert_eq!(replay(config, &flight), flight.events);
}

fn last_fault(flight: &Flight) -> &Fault {
    let mut faults = flight.events.iter().rev().filter_map(|event| match &event.kind {
        EventKind::PlannerFailed { fault, .. } => Some(fault),
        _ => None,
    });
    faults.next().expect("a fault must be reported")
}

#[test]
fn a_change_that_a_planner_refuses_under_way_is_a_warning_and_its_old_values_stay() {
    let mut flight = Flight::new(covering());
    flight.planner.has_stiff_gain = true;
    flight.tick(&[Order::Start]);
    flight.fly(200);
    flight.tick(&[Order::SetParameter { key: "gain".into(), value: ParamValue::Float(2.0) }]);
    flight.fly(2);
    let fault = last_fault(&flight);
    assert!(fault.refuses_change(), "{fault}");
    assert_eq!(fault.severity(), Severity::Warn);
    assert!(flight.mission.known.is_running() && flight.mission.driving.worker.choice.parameters.is_empty());
}

#[test]
fn a_planner_that_is_called_back_to_where_it_left_goes_on_with_its_plan() {
    let mut flight = held_on_the_way();
    let left_m = flight.mission.known.task.under_way().map(|plan| polyline::length_m(&plan.path));
    flight.tick(&[swap_to("other")]);
    flight.tick(&[swap_to("straight")]);
    assert_eq!(kept_m(&flight), [None, None, left_m]);
    // Once the other planner has driven the robot, the earlier plan is not valid any more.
    flight.tick(&[swap_to("other")]);
    flight.tick(&[Order::Resume]);
    flight.fly(30);
    flight.tick(&[Order::Hold]);
    flight.tick(&[swap_to("straight")]);
    let kept: Vec<bool> = flight.planner.kept[3..].iter().map(Option::is_some).collect();
    assert_eq!(kept, [true, false]);
}

#[test]
fn a_plan_that_came_too_late_is_kept_to_in_the_next_one_unless_the_robot_is_far() {
    for (delay, is_kept) in [(25, true), (90, false)] {
        let mut flight = held_on_the_way();
        flight.delay = Box::new(move |ask, _| if matches!(ask.what, What::Plan(_)) { delay } else { 0 });
        flight.tick(&[swap_to("other")]);
        flight.tick(&[Order::Resume]);
        flight.fly(2 * delay as usize);
        assert_eq!(kept_m(&flight).len(), 3);
        assert_eq!(flight.planner.kept[2].is_some(), is_kept, "after {delay} ticks");
        let mut kept = Vec::new();
        let events = replay_asking(covering(), &flight, |ask| {
            if let What::Plan(request) = &ask.what {
                kept.push(request.under_way.clone());
            }
        });
        assert!(events == flight.events && kept == flight.planner.kept, "the asks and events repeat");
    }
}
