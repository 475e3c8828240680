//! A parameter is changed only after the change and its estimated effect were shown.

use crate::fixture::{RICH, Screen, spiral};
use crate::screens::{drawn, text};
use mission::{EventKind, Order, Outcome, Outlook, ParamValue, PlannerChoice};
use tui::model::{Forecast, GhostPlan, Overlay, ui::Ask};
use tui::{Effect, Key, Msg, RunMsg};

const ENTER: [Key; 1] = [Key::Enter];

fn set(value: f64) -> Order {
    Order::SetParameter { key: "rpf_gain".into(), value: ParamValue::Float(value) }
}

fn order(value: f64) -> Effect {
    Effect::Order(set(value))
}

/// Types a value for the first parameter and confirms the line.
fn type_value(screen: &mut Screen, value: &str) -> Vec<Effect> {
    screen.press([Key::Char('p'), Key::Enter, Key::Backspace, Key::Backspace, Key::Backspace]);
    screen.type_text(value);
    screen.press(ENTER)
}

fn shown(screen: &Screen) -> String {
    let words = text(&drawn(&screen.model, RICH, (120, 36)));
    words.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn hear(screen: &mut Screen, kind: EventKind) {
    let event = screen.mission.now(kind);
    screen.hear(RunMsg::Events(vec![event]));
}

/// The active planner with this value.
fn changed(screen: &Screen, value: f64) -> PlannerChoice {
    let mut choice = screen.model.live.run.planning.choice.clone().expect("a planner");
    choice.parameters.insert("rpf_gain".into(), ParamValue::Float(value));
    choice
}

fn forecast(choice: &PlannerChoice, length_m: f64, after_s: f64) -> RunMsg {
    let outlook = Outlook {
        choice: choice.clone(),
        outcome: Some(Outcome::Complete),
        reason: String::new(),
        after_s,
        length_m,
        reachable: 0.9,
        clearance_min_m: 0.1,
        tether_length_max_m: None,
        wrap_max_rad: None,
    };
    RunMsg::Forecast(choice.clone(), Ok(Box::new(Forecast { outlook, path: Vec::new(), certified: None })))
}

#[test]
fn an_unchanged_value_is_not_sent() {
    for open in [Screen::idle as fn() -> Screen, Screen::held, Screen::running] {
        let mut screen = open();
        assert_eq!(screen.press([Key::Char('p'), Key::Enter, Key::Enter]), []);
        assert!(matches!(screen.model.ui.overlay, Overlay::Parameters { edit: None, .. }), "the list stays");
        let said = &screen.model.notice().expect("it says so").text;
        assert_eq!(said, "nothing was sent: rpf_gain is already 1.2 m3/s");
        assert_eq!(screen.press(ENTER), [], "the line is opened again");
        screen.press([Key::Esc, Key::Esc]);
        screen.type_text(":set rpf_gain=1.2");
        assert_eq!(screen.press(ENTER), []);
        assert_eq!(screen.model.ui.overlay, Overlay::None);
    }
}

#[test]
fn the_value_before_a_change_that_is_under_way_can_be_set_again() {
    let mut screen = Screen::held();
    hear(&mut screen, EventKind::Ordered { order: set(1.5) });
    type_value(&mut screen, "1.2");
    assert_eq!(screen.press(ENTER)[0], order(1.2));
}

#[test]
fn before_the_start_the_plan_with_the_value_is_compared_first() {
    let mut screen = Screen::idle();
    let with = changed(&screen, 1.5);
    assert_eq!(type_value(&mut screen, "1.5"), [Effect::Compare(with.clone())]);
    let words = shown(&screen);
    let asked = "Set rpf_gain 1.2 → 1.5 m3/s (default 1.2)? Enter: set, Esc: cancel.";
    assert!(words.contains(asked) && words.contains("Computing the effect..."), "{words}");
    let run = screen.model.live.run.about.as_ref().expect("a mission");
    let estimate = account::Estimate::new(&run.mission, &run.world, &spiral(), true);
    let made = GhostPlan::new(&run.mission, &spiral(), &[], estimate, None);
    let length = format!("path {:.1} m", made.estimate.length_m);
    screen.hear(RunMsg::Compared(with, Ok(Box::new(made))));
    assert!(
        shown(&screen).contains("The planner makes a new plan: clearance ")
            && shown(&screen).contains("Time 00:"),
        "{}",
        shown(&screen)
    );
    assert!(shown(&screen).contains(&length), "{}", shown(&screen));
    let sent = screen.press(ENTER);
    assert_eq!(sent, [order(1.5), Effect::Order(Order::Plan), Effect::StopComparing]);
    assert!(screen.model.live.plans.ghost.is_none(), "the second plan goes with its question");
    assert!(matches!(screen.model.ui.overlay, Overlay::Parameters { .. }), "back in the list");
}

#[test]
fn under_way_a_forecast_with_the_value_is_shown_first() {
    for state in [Screen::held, Screen::running] {
        let mut screen = state();
        let now = screen.model.live.run.planning.choice.clone().expect("a planner");
        let with = changed(&screen, 1.5);
        let asked = type_value(&mut screen, "1.5");
        assert_eq!(asked, [Effect::Forecast(vec![now.clone(), with.clone()])]);
        screen.hear(RunMsg::ForecastAt(with.clone(), 0.345));
        assert!(shown(&screen).contains("Computing the effect 34 %... Enter does not wait for it."));
        screen.hear(forecast(&now, 80.0, 600.0));
        screen.hear(forecast(&with, 90.0, 500.0));
        let effect = "Time 00:08:20 (now 00:10:00), path 90.0 m (now 80.0 m).";
        assert!(shown(&screen).contains(effect), "{}", shown(&screen));
        assert_eq!(screen.press(ENTER), [order(1.5), Effect::StopForecasting]);
    }
}

/// A forecast of a robot on a tether.
fn tethered(choice: &PlannerChoice, clearance_min_m: f64, tether_m: f64, wrap_rad: f64) -> RunMsg {
    let RunMsg::Forecast(choice, Ok(mut made)) = forecast(choice, 80.0, 600.0) else { unreachable!() };
    made.outlook.clearance_min_m = clearance_min_m;
    made.outlook.tether_length_max_m = Some(tether_m);
    made.outlook.wrap_max_rad = Some(wrap_rad);
    RunMsg::Forecast(choice, Ok(made))
}

#[test]
fn a_clearance_that_gets_worse_is_shown_at_every_size() {
    for (width, height) in [(200, 60), (120, 36), (80, 24), (60, 16)] {
        let mut screen = Screen::held();
        screen.send(Msg::Resize { width, height });
        let now = screen.model.live.run.planning.choice.clone().expect("a planner");
        let with = changed(&screen, 1.5);
        type_value(&mut screen, "1.5");
        screen.hear(tethered(&now, 0.24, 12.0, 0.5));
        screen.hear(tethered(&with, 0.08, 12.0, 1.0));
        let words = text(&drawn(&screen.model, RICH, (width, height)));
        let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
        let clearance = "Forecast from here: clearance 0.08 m (now 0.24 m), BELOW the required 0.10 m.";
        assert!(words.contains(clearance), "{width}x{height}: {words}");
        // A clause is shown whole or left out.
        assert!(!words.contains("Wrap") || words.contains("Wrap 57° (now 29°)."), "{words}");
        assert!(words.contains("Wrap") || width <= 80, "{words}");
        assert!(!words.contains("Tether out"), "the length does not change: {words}");
    }
}

#[test]
fn a_clearance_that_prints_as_the_required_one_is_no_warning() {
    let mut screen = Screen::held();
    let with = changed(&screen, 1.5);
    type_value(&mut screen, "1.5");
    screen.hear(tethered(&with, 0.0996, 12.0, 1.0));
    let words = shown(&screen);
    assert!(words.contains("Forecast from here: clearance 0.10 m. "), "{words}");
    assert!(words.contains("Tether out 12.0 m."), "nothing to compare it with: {words}");
}

#[test]
fn sentences_give_the_result_of_an_estimate_once_and_no_progress() {
    let mut screen = Screen::held();
    let mut said = tui::plain::Said::default();
    said.next(&screen.model);
    let now = screen.model.live.run.planning.choice.clone().expect("a planner");
    let with = changed(&screen, 1.5);
    type_value(&mut screen, "1.5");
    assert!(said.next(&screen.model).concat().contains("Computing the effect..."));
    for share in [0.1, 0.2, 0.9] {
        screen.hear(RunMsg::ForecastAt(with.clone(), share));
        assert_eq!(said.next(&screen.model), Vec::<String>::new());
    }
    screen.hear(forecast(&now, 80.0, 600.0));
    screen.hear(forecast(&with, 90.0, 500.0));
    assert!(said.next(&screen.model).concat().contains("path 90.0 m (now 80.0 m)."));
}

#[test]
fn a_change_that_is_given_up_ends_its_estimate() {
    let mut screen = Screen::held();
    type_value(&mut screen, "1.5");
    assert_eq!(screen.press([Key::Esc]), [Effect::StopForecasting]);
    assert!(screen.model.live.what_if.is_none(), "nothing was finished");
    assert!(matches!(screen.model.ui.overlay, Overlay::Parameters { selected: 0, edit: None }));
    let mut screen = Screen::running();
    type_value(&mut screen, "1.5");
    let held = screen.press([Key::Char(' ')]);
    assert_eq!(held, [Effect::Order(Order::Hold), Effect::StopForecasting], "HOLD withdraws the question");
    let mut screen = Screen::idle();
    type_value(&mut screen, "1.5");
    assert_eq!(screen.press([Key::Esc]), [Effect::StopComparing]);
}

#[test]
fn forecasts_of_a_change_stay_in_the_comparison_of_a_held_mission() {
    let mut screen = Screen::held();
    let now = screen.model.live.run.planning.choice.clone().expect("a planner");
    type_value(&mut screen, "1.5");
    screen.hear(forecast(&now, 80.0, 600.0));
    screen.press([Key::Esc, Key::Esc]);
    screen.press([Key::Char('w')]);
    let what_if = screen.model.live.what_if.as_ref().expect("open");
    assert_eq!(what_if.candidates[0].choice, now);
    assert!(what_if.candidates[0].made.is_some());
}

#[test]
fn a_question_about_a_change_leaves_the_comparison_of_the_operator() {
    let mut screen = Screen::held();
    let compared = |screen: &Screen| -> Vec<PlannerChoice> {
        let what_if = screen.model.live.what_if.as_ref().expect("a comparison");
        what_if.candidates.iter().map(|candidate| candidate.choice.clone()).collect()
    };
    screen.press([Key::Char('w')]);
    screen.hear(forecast(&compared(&screen)[0], 80.0, 600.0));
    type_value(&mut screen, "1.7");
    screen.press([Key::Char('w'), Key::Esc]);
    let before = compared(&screen);
    assert_eq!(before[1..], [changed(&screen, 1.7)]);
    type_value(&mut screen, "1.5");
    assert!(compared(&screen).contains(&changed(&screen, 1.5)));
    let given_up = screen.press([Key::Esc]);
    assert_eq!(given_up, [Effect::Forecast(before[1..].to_vec())], "the others are forecast on");
    assert_eq!(compared(&screen), before);
}

#[test]
fn a_planner_added_after_the_active_one_changed_is_the_one_that_is_chosen() {
    let mut screen = Screen::held();
    screen.press([Key::Char('w'), Key::Char('p')]);
    let mut active = screen.model.live.run.planning.choice.clone().expect("a planner");
    active.parameters.insert("rpf_gain".into(), ParamValue::Float(1.5));
    screen.model.live.run.planning.choice = Some(active.clone());
    screen.press([Key::Enter, Key::Backspace, Key::Backspace, Key::Backspace]);
    screen.type_text("1.7");
    screen.press(ENTER);
    let with = changed(&screen, 1.7);
    assert_eq!(screen.press([Key::Char('w')]), [Effect::Forecast(vec![active, with.clone()])]);
    screen.hear(forecast(&with, 90.0, 500.0));
    screen.press(ENTER);
    assert!(
        matches!(&screen.model.ui.overlay, Overlay::Confirm(Ask::Swap(choice)) if *choice == with),
        "{:?}",
        screen.model.ui.overlay
    );
}

#[test]
fn a_change_by_a_command_is_asked_for_and_leaves_no_list() {
    let mut screen = Screen::running();
    screen.type_text(":set rpf_gain=1.5");
    screen.press(ENTER);
    let words = shown(&screen);
    assert!(words.contains("1.2 → 1.5 m3/s") && words.contains("It takes effect now."), "{words}");
    assert!(matches!(screen.model.ui.overlay, Overlay::Confirm(Ask::Set { list: None, .. })));
    assert_eq!(screen.press(ENTER), [order(1.5), Effect::StopForecasting]);
    assert_eq!(screen.model.ui.overlay, Overlay::None);
}

#[test]
fn the_question_about_another_planner_names_the_floor_that_the_change_loses() {
    let mut screen = Screen::held();
    if let Some(about) = &mut screen.model.live.run.about {
        about.mission.task = mission::TaskConfig::Cover {
            anchor: world::Point::origin(),
            regions: Vec::new(),
            tolerance_m: 0.2,
        };
    }
    screen.model.console.planners.iter_mut().for_each(|planner| planner.covers = true);
    let now = screen.model.live.run.planning.choice.clone().expect("a planner");
    let next = crate::fixture::choice("spiral-tangent");
    screen.type_text(":planner spiral-tangent");
    assert_eq!(screen.press(ENTER), [Effect::Forecast(vec![now.clone(), next.clone()])]);
    assert!(
        shown(&screen).contains("Change to spiral-tangent? Enter: change, Esc: cancel. No motion yet."),
        "{}",
        shown(&screen)
    );
    let with = |choice: &PlannerChoice, reachable: f64| {
        let RunMsg::Forecast(choice, Ok(mut made)) = forecast(choice, 80.0, 600.0) else {
            panic!("a forecast")
        };
        made.outlook.reachable = reachable;
        RunMsg::Forecast(choice, Ok(made))
    };
    screen.hear(with(&now, 0.998));
    screen.hear(with(&next, 0.94));
    let loss = "Forecast from here: scans LESS, 94.0 % of the reachable floor instead of 99.8 %.";
    assert!(shown(&screen).contains(loss), "{}", shown(&screen));
    let effects = screen.press([Key::Esc]);
    assert!(effects.iter().all(|effect| !matches!(effect, Effect::Order(_))), "{effects:?}");
}
