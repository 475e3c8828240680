//! A start belongs to the plan that is shown.

use crate::fixture::{PLAIN, Screen, choice, tether};
use crate::maps::beside_map;
use crate::screens::{drawn, text};
use crate::sizes::SIZES;
use mission::{CheckOutcome, EventKind, Order, ParamValue, TaskConfig};
use tui::{
    Effect, Key, Model, Msg, RunId, RunMsg, Source, Speed, actions::ActionId, model::Overlay, update::offered,
};
use world::{Point, Vector};

fn hear(screen: &mut Screen, kind: EventKind) {
    let event = screen.mission.now(kind);
    screen.hear(RunMsg::Events(vec![event]));
}

fn why(screen: &Screen) -> String {
    offered(&screen.model, ActionId::Start).expect_err("it is refused")
}

/// The outcome of a check and what was found.
fn check(screen: &Screen, what: &str) -> (CheckOutcome, String) {
    let check = screen.model.checks().into_iter().find(|check| check.what == what).expect("a check");
    (check.outcome, check.found)
}

/// A mission on a tether with a plan that is certified, before its start.
fn certified() -> Screen {
    let mut screen = Screen::idle();
    if let Some(run) = &mut screen.model.live.run.about {
        run.mission.tether = Some(tether());
    }
    let events = vec![screen.mission.certified(&[])];
    screen.hear(RunMsg::Events(events));
    screen
}

#[test]
fn while_a_plan_is_made_a_start_is_refused_and_says_what_to_wait_for() {
    let mut screen = Screen::opened();
    assert_eq!(why(&screen), "the plan follows; start when it is ready");
    let set = Order::SetParameter { key: "gain".into(), value: ParamValue::Float(2.0) };
    hear(&mut screen, EventKind::Ordered { order: Order::Plan });
    hear(&mut screen, EventKind::Ordered { order: set });
    assert!(why(&screen).contains("there is no plan to start with; make one first"), "{}", why(&screen));
    hear(&mut screen, EventKind::Ordered { order: Order::Plan });
    assert!(why(&screen).contains("the plan is not ready yet"), "{}", why(&screen));
    screen.hear(RunMsg::Busy(Some(("Planning (rpf)".into(), Some(60.0)))));
    screen.hear(RunMsg::BusyAt { share: 0.234, what: String::new() });
    assert_eq!(why(&screen), "Planning (rpf) 23 %: not started; start again when the plan is ready");
    assert_eq!(screen.press([Key::Char('S'), Key::Enter]), []);
    assert_eq!(screen.model.ui.overlay, Overlay::None);
    assert_eq!(
        check(&screen, "plan"),
        (CheckOutcome::Failed, "Planning (rpf) 23 %: not started; start again when the plan is ready".into())
    );
    screen.hear(RunMsg::Busy(None));
    let events = screen.mission.planned_ahead();
    screen.hear(RunMsg::Events(events[1..].to_vec()));
    assert_eq!(offered(&screen.model, ActionId::Start), Ok(()));
    assert_eq!(check(&screen, "plan").0, CheckOutcome::Passed);
}

#[test]
fn while_a_scenario_loads_the_screen_says_so_and_blames_nothing() {
    let mut loading = Screen::opened();
    loading.model = Model::opened(RunId(1), Source::Demo, Speed::default());
    assert_eq!(why(&loading), "the scenario is loading; start when the plan is ready");
    let mut opened = Screen::opened();
    opened.send(Msg::Planners { found: Vec::new(), refused: Vec::new() });
    opened.model.console.planners.clear();
    opened.model.live.run.planning.info = None;
    for (screen, says) in [(&mut loading, "Loading; the plan follows."), (&mut opened, "The plan follows.")] {
        screen.model.ui.go(tui::model::Screen::Plan);
        for size in SIZES {
            screen.send(Msg::Resize { width: size.0, height: size.1 });
            let shown = text(&drawn(&screen.model, PLAIN, size));
            for wrong in ["no planner found", "planning has not begun", "Start blocked", "odometry alone"] {
                assert!(!shown.contains(wrong), "{size:?} {wrong}\n{shown}");
            }
            assert!(size.0 < 120 || shown.contains(says), "{size:?}\n{shown}");
        }
        let said = tui::plain::Said::default().next(&screen.model).join(" ");
        assert!(!said.contains("blocked"), "{said}");
    }
}

#[test]
fn nothing_is_shown_of_a_plan_that_is_being_made_again() {
    let set = Order::SetParameter { key: "gain".into(), value: ParamValue::Float(2.0) };
    for order in [Order::Plan, set, Order::ChoosePlanner(choice("apf"))] {
        let mut screen = certified();
        assert_eq!(check(&screen, "tether").0, CheckOutcome::Passed);
        assert!(screen.model.live.run.planning.plan.is_some());
        hear(&mut screen, EventKind::Ordered { order: order.clone() });
        assert_eq!(check(&screen, "tether"), (CheckOutcome::Failed, "no certified plan yet".into()));
        assert_eq!(check(&screen, "plan").0, CheckOutcome::Failed, "{order:?}");
        assert_eq!(screen.model.live.run.planning.plan, None);
        assert_eq!(screen.model.live.estimate(), None);
        assert!(offered(&screen.model, ActionId::Start).is_err());
        for screen_ in [tui::model::Screen::Plan, tui::model::Screen::Mission] {
            screen.model.ui.go(screen_);
            let shown = text(&drawn(&screen.model, PLAIN, (120, 36)));
            assert!(
                !shown.contains(" certified for the tether\n") && !shown.contains("plan certified"),
                "{shown}"
            );
        }
    }
}

#[test]
fn the_start_names_the_plan_that_was_on_the_screen_when_it_was_asked_for() {
    let mut screen = Screen::idle();
    let plan = screen.model.live.run.standing.ready_plan().expect("a plan");
    let effects = screen.start();
    assert!(
        matches!(effects[..], [_, Effect::Order(Order::StartPlan(named))] if named == plan),
        "{effects:?}"
    );
}

#[test]
fn a_plan_that_is_made_again_takes_the_question_back_and_the_start_that_was_agreed_to() {
    let again = |screen: &mut Screen| hear(screen, EventKind::Ordered { order: Order::Plan });
    let mut screen = Screen::idle();
    screen.press([Key::Char('S')]);
    again(&mut screen);
    assert_eq!(screen.model.ui.overlay, Overlay::None);
    assert_eq!(screen.press([Key::Enter]), []);

    let mut screen = Screen::idle();
    screen.press([Key::Char('S'), Key::Enter]);
    assert!(screen.model.live.preflight.is_starting);
    again(&mut screen);
    assert_eq!(screen.hear(RunMsg::Checked(Vec::new())), []);
    assert!(!screen.model.live.may_move());
}

#[test]
fn the_question_names_length_time_and_certificate_at_every_size() {
    let mut screen = certified();
    for (width, height) in [(200, 60), (120, 36), (80, 24), (60, 16), (40, 12)] {
        screen.send(Msg::Resize { width, height });
        screen.press([Key::Char('S')]);
        let shown = text(&drawn(&screen.model, PLAIN, (width, height)));
        let flat = shown.split_whitespace().collect::<Vec<_>>().join(" ");
        for said in
            ["Start (×1)? Enter: start, Esc: cancel.", "The robot will move: 4", " (planner rpf), certified."]
        {
            assert!(flat.contains(said) || width < 60, "{said}\n{shown}");
        }
        screen.press([Key::Esc]);
    }
}

#[test]
fn a_start_that_is_blocked_is_neither_offered_nor_asked_for() {
    let mut screen = Screen::idle();
    screen.model.live.run.about.as_mut().expect("a run").checklist = vec!["permit".into()];
    assert_eq!(why(&screen), "start blocked: permit: not ticked; A: pre-flight check");
    let shown = text(&drawn(&screen.model, PLAIN, (120, 36)));
    assert!(!shown.contains("S start"), "{shown}");
    assert_eq!(screen.press([Key::Char('S'), Key::Enter]), []);
    assert_eq!(screen.model.ui.overlay, Overlay::None);
}

#[test]
fn every_check_that_needs_attention_is_named_on_the_plan_screen() {
    let mut screen = certified();
    let about = screen.model.live.run.about.as_mut().expect("a run");
    about.checklist = vec!["Hatch guarded".into(), "Gas test done".into()];
    about.mission.position_limit_m = 0.001;
    // The run before left the robot somewhere else.
    let regions = Vec::new();
    about.mission.task = TaskConfig::Cover { anchor: Point::origin(), regions, tolerance_m: 0.2 };
    screen.model.live.left_at = Some(about.mission.start.position + Vector::new(9.0, 0.0));
    for (width, height) in [(80, 24), (120, 36), (200, 60)] {
        screen.send(Msg::Resize { width, height });
        screen.press([Key::Char('2')]);
        let shown = text(&drawn(&screen.model, PLAIN, (width, height)));
        let flat = beside_map(&screen, (width, height));
        assert!(flat.contains("TICK Hatch guarded, Gas test done: not"), "{width}x{height}\n{shown}");
        assert!(shown.contains("2 to tick"), "{width}x{height}\n{shown}");
        assert!(shown.contains("WARN") && shown.contains("robot"), "{width}x{height}\n{shown}");
        assert!(!shown.contains("more: not ticked"), "{width}x{height}\n{shown}");
    }
    screen.send(Msg::Resize { width: 60, height: 16 });
    let shown = text(&drawn(&screen.model, PLAIN, (60, 16)));
    assert!(shown.contains("2 to tick, ") && shown.contains("WARN: A"), "{shown}");
}

#[test]
fn a_planner_that_died_before_the_start_is_named_with_the_cause_and_what_to_do() {
    for (width, height) in [(200, 60), (120, 36), (80, 24), (60, 16)] {
        let mut screen = Screen::opened();
        let failed = screen.mission.planner_fails().remove(0);
        screen.hear(RunMsg::Events(vec![failed]));
        screen.send(Msg::Resize { width, height });
        let shown = text(&drawn(&screen.model, PLAIN, (width, height)));
        let cause = screen.model.live.run.planning.fault.as_ref().expect("a fault").cause.to_string();
        assert!(shown.contains(&format!("Start blocked: planner rpf failed ({cause}).")), "{shown}");
        assert!(shown.contains(":plan-again: replan.") || width < 80, "{shown}");
        assert!(shown.contains("P: change planner.") || width < 100, "{shown}");
        let (outcome, found) = check(&screen, "planner");
        assert_eq!(outcome, CheckOutcome::Failed);
        assert!(found.ends_with("; `:plan-again` replans, `:planner` changes it"), "{found}");
    }
}
