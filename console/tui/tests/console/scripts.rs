//! Whole missions as scripts of messages: what the operator does, and what follows.

use crate::fixture::{RICH, Screen, choice, listed};
use crate::screens::{drawn, text};
use mission::{
    AskId, Check, CheckOutcome, EventKind, Gait, HoldReason, Order, Outcome, ParamValue, Phase, Resumes,
    Severity, WorkerId,
};
use tui::actions::ActionId;
use tui::model::ui::Purpose;
use tui::model::{Overlay, Pane, home::Found};
use tui::{
    Effect, Job, Key, KeyPress, Model, Msg, Query, Recording, RunId, RunMsg, RunResult, Signal, Source, Speed,
};

const SPACE: Key = Key::Char(' ');

fn order(order: Order) -> Effect {
    Effect::Order(order)
}

fn notice(screen: &Screen) -> &str {
    screen.model.notice().map_or("", |notice| notice.text.as_str())
}

fn shown(screen: &Screen) -> String {
    text(&drawn(&screen.model, RICH, (120, 36)))
}

fn send_event(screen: &mut Screen, kind: EventKind) -> Vec<Effect> {
    let event = screen.mission.now(kind);
    screen.hear(RunMsg::Events(vec![event]))
}

fn obeyed(screen: &mut Screen, order: Order) {
    let events = screen.mission.obeyed(order);
    screen.hear(RunMsg::Events(events));
}

/// The ask of a planner that is being prepared.
fn preparing() -> AskId {
    AskId { worker: WorkerId(2), n: 1 }
}

fn prepare(screen: &mut Screen, ask: AskId) {
    let info = Box::new(crate::fixture::planners().remove(2));
    send_event(screen, EventKind::PlannerPrepared { ask, choice: choice("spiral-tangent"), info });
}

fn send_certified_plan(screen: &mut Screen, ask: Option<AskId>, reasons: &[&str]) {
    let planned = screen.mission.planned(ask);
    send_event(screen, planned);
    let certified = screen.mission.certified(reasons);
    screen.hear(RunMsg::Events(vec![certified]));
}

fn held(by: HoldReason) -> EventKind {
    EventKind::Held { by, resumes: Resumes::Never }
}

#[test]
fn the_mission_starts_only_after_the_operator_agreed() {
    let mut screen = Screen::idle();
    assert_eq!(screen.type_text("S"), []);
    assert_eq!(*screen.model.live.run.phase(), Phase::Waiting);
    assert!(matches!(screen.press([Key::Enter])[..], [Effect::Check { .. }]));
    assert!(screen.model.live.may_move(), "it may be started by what is found");
    let effects = screen.hear(RunMsg::Checked(Vec::new()));
    let [Effect::Order(Order::NoteChecks(checks)), Effect::Order(start @ Order::StartPlan(_))] = &effects[..]
    else {
        panic!("{effects:?}")
    };
    assert!(checks.iter().all(|check| check.outcome < CheckOutcome::Failed), "{checks:?}");
    obeyed(&mut screen, start.clone());
    assert_eq!(*screen.model.live.run.phase(), Phase::Running(Gait::Steady));
    assert_eq!(screen.model.live.asked, None);
}

#[test]
fn what_fails_before_the_start_blocks_it_and_is_checked_again_at_the_moment_of_start() {
    let full = Check { what: "disk".into(), outcome: CheckOutcome::Failed, found: "1 MB free".into() };
    let mut screen = Screen::idle();
    screen.press([Key::Char('S'), Key::Enter]);
    assert_eq!(screen.hear(RunMsg::Checked(vec![full])), []);
    assert_eq!(notice(&screen), "start blocked: disk: 1 MB free");
    assert!(matches!(screen.model.ui.overlay, Overlay::Preflight { .. }), "what failed is shown");
    screen.press([Key::Esc]);
    assert!(matches!(screen.start()[..], [_, Effect::Order(Order::StartPlan(_))]));
}

#[test]
fn the_start_waits_for_every_tick_by_hand_and_the_ticks_are_written_down() {
    let mut screen = Screen::idle();
    screen.model.live.run.about.as_mut().unwrap().checklist = vec!["manway clear".into(), "permit".into()];
    screen.model.console.preferences.operator = Some("lk".into());
    assert_eq!(screen.type_text("S"), []);
    assert_eq!(notice(&screen), "start blocked: manway clear: not ticked; A: pre-flight check");
    screen.press([Key::Char('A'), Key::Down, SPACE, Key::Down, SPACE, SPACE, SPACE, Key::Esc]);
    let effects = screen.start();
    let Some(Effect::Order(Order::NoteChecks(checks))) = effects.first() else { panic!("{effects:?}") };
    let ticked: Vec<(&str, &str)> = checks
        .iter()
        .filter(|check| check.outcome == CheckOutcome::Ticked)
        .map(|check| (check.what.as_str(), check.found.as_str()))
        .collect();
    assert_eq!(ticked, [("manway clear", "by lk"), ("permit", "by lk")]);
}

#[test]
fn a_start_that_is_being_checked_is_cancelled_by_whatever_stops() {
    for stop in [SPACE, Key::Ctrl('c'), Key::Esc] {
        let mut screen = Screen::idle();
        screen.model.ui.screen = tui::model::Screen::Plan;
        screen.press([Key::Char('S'), Key::Enter, stop]);
        assert_eq!(screen.hear(RunMsg::Checked(Vec::new())), [], "{stop}");
        assert!(!screen.model.live.may_move());
    }
}

#[test]
fn a_question_is_dropped_by_esc_and_by_q_and_sends_nothing() {
    for back in [Key::Esc, Key::Char('q')] {
        let mut screen = Screen::idle();
        assert_eq!(screen.press([Key::Char('S'), back, Key::Enter]), []);
        assert_eq!(screen.model.ui.overlay, Overlay::None);
    }
}

#[test]
fn space_holds_at_once_and_then_asks_to_go_on() {
    let mut screen = Screen::running();
    assert_eq!(screen.press([SPACE]), [order(Order::Hold)]);
    assert!(screen.model.live.hold_asked);
    obeyed(&mut screen, Order::Hold);
    assert_eq!(screen.press([SPACE]), []);
    assert_eq!(screen.press([SPACE, Key::Enter]), [], "space never agrees: it takes the question back");
    assert_eq!(screen.press([SPACE, Key::Enter]), [order(Order::Resume)]);
}

#[test]
fn space_holds_in_every_list_and_question() {
    let ways: [&[Key]; 5] =
        [&[Key::Char('p')], &[Key::Char('L')], &[Key::Tab], &[Key::Char('z')], &[Key::Char('m')]];
    for way in ways {
        let mut screen = Screen::running();
        assert_eq!(screen.press(way.iter().copied()), [], "{way:?}");
        assert_eq!(screen.press([SPACE]), [order(Order::Hold)], "space after {way:?}");
        assert_eq!(screen.press([Key::Ctrl('c')]), [order(Order::Hold)], "Ctrl-C after {way:?}");
    }
}

#[test]
fn a_start_that_was_not_answered_yet_can_be_held() {
    let mut screen = Screen::idle();
    screen.start();
    assert_eq!(screen.press([SPACE]), [order(Order::Hold)]);
}

#[test]
fn a_robot_that_waits_for_its_position_can_be_held_for_good() {
    let mut screen = Screen::running();
    send_event(&mut screen, EventKind::PositionLost { error_m: 0.5, limit_m: 0.15 });
    send_event(&mut screen, EventKind::Held { by: HoldReason::PositionLost, resumes: Resumes::WhenCleared });
    assert_eq!(screen.press([SPACE]), [order(Order::Hold)]);
    obeyed(&mut screen, Order::Hold);
    assert_eq!(screen.press([SPACE]), []);
    assert!(notice(&screen).contains("position is lost"), "it says so instead of asking");
    assert_eq!(screen.press([Key::Enter]), []);
    send_event(&mut screen, EventKind::PositionRegained { error_m: 0.1 });
    assert_eq!(screen.press([SPACE, Key::Enter]), [order(Order::Resume)]);
}

#[test]
fn single_steps_ask_once_and_wait_for_each_answer() {
    let mut screen = Screen::running();
    assert_eq!(screen.type_text("."), []);
    assert!(notice(&screen).contains("HOLD first"));
    let mut screen = Screen::held();
    assert_eq!(screen.type_text("."), []);
    assert_eq!(screen.type_text("."), [order(Order::Step)]);
    assert_eq!(screen.type_text("."), [], "the first step was not answered yet");
    obeyed(&mut screen, Order::Step);
    send_event(&mut screen, held(HoldReason::Stepped));
    assert_eq!(screen.press([Key::Enter]), [order(Order::Step)]);
    obeyed(&mut screen, Order::Step);
    send_event(&mut screen, held(HoldReason::Stepped));
    assert_eq!(screen.press([Key::Esc, Key::Enter]), []);
}

#[test]
fn the_pace_goes_in_steps_and_says_where_it_ends() {
    let mut screen = Screen::running();
    assert_eq!(screen.type_text(">>"), [Effect::Speed(Speed::Times(2.0)), Effect::Speed(Speed::Times(4.0))]);
    assert_eq!(screen.type_text(">>>>>").last(), Some(&Effect::Speed(Speed::Max)));
    assert_eq!(screen.type_text(">"), []);
    assert!(notice(&screen).contains("already at maximum speed"));
    assert_eq!(screen.type_text("<<<<<<<<<").last(), Some(&Effect::Speed(Speed::Times(0.25))));
    assert_eq!(screen.type_text("<"), []);
}

#[test]
fn another_planner_drives_only_when_held_and_agreed() {
    let mut screen = Screen::running();
    assert_eq!(screen.type_text("P"), []);
    assert!(notice(&screen).contains("HOLD first"));
    screen.press([SPACE, Key::Char('P')]);
    assert!(matches!(screen.model.ui.overlay, Overlay::Planners { .. }), "HOLD was sent, the list may open");
    let mut screen = Screen::held();
    screen.type_text("P");
    assert_eq!(
        screen.model.ui.overlay,
        Overlay::Planners { purpose: Purpose::Drive, selected: 1, is_unfolded: false },
        "the active one is selected"
    );
    let both = vec![choice("rpf"), choice("spiral-tangent")];
    assert_eq!(screen.press([Key::Down, Key::Enter]), [Effect::Forecast(both)], "its effect is shown");
    let answered = [order(Order::ChoosePlanner(choice("spiral-tangent"))), Effect::StopForecasting];
    assert_eq!(screen.press([Key::Enter]), answered);
}

#[test]
fn a_planner_that_covers_no_floor_is_marked_and_not_asked_to() {
    let mut screen = Screen::held();
    let run = screen.model.live.run.about.as_mut().unwrap();
    run.mission.task =
        mission::TaskConfig::Cover { anchor: world::Point::origin(), regions: Vec::new(), tolerance_m: 0.2 };
    let planners = screen.model.console.planners.clone();
    assert_eq!(screen.model.live.run.cannot_fly(&planners[0]), Some("does not support coverage missions"));
    screen.press([Key::Char('P'), Key::Down]);
    assert!(shown(&screen).contains("+ 2 planners that cannot run this mission"), "{}", shown(&screen));
    assert_eq!(screen.press([Key::Enter]), [], "the list unfolds");
    screen.press([Key::Enter]);
    assert_eq!(notice(&screen), format!("planner {} does not support coverage missions", planners[0].id));
    assert!(matches!(screen.model.ui.overlay, Overlay::Planners { .. }), "no question is asked");
    screen.model.console.planners[0].covers = true;
    screen.press([Key::Up, Key::Enter]);
    assert!(matches!(screen.model.ui.overlay, Overlay::Confirm(_)));
}

#[test]
fn planning_is_shown_with_the_time_it_has_taken_while_ticks_go_on() {
    let mut screen = Screen::idle();
    screen.start();
    let start = screen.model.live.asked.clone().expect("a start");
    obeyed(&mut screen, start);
    screen.hear(RunMsg::Busy(Some(("Planning (rpf)".into(), Some(60.0)))));
    assert!(screen.model.wakes_at_mono_s().is_some(), "the seconds keep counting");
    for _ in 0..7 {
        screen.pass(1.0);
        let events = screen.mission.wait(2);
        screen.hear(RunMsg::Events(events));
    }
    assert_eq!(screen.model.silent_s(), None);
    let expect = |screen: &Screen, text: &str| assert!(shown(screen).contains(text), "{}", shown(screen));
    expect(&screen, "Planning (rpf), 7 s (limit 60 s). space: HOLD. X: end mission.");
    screen.hear(RunMsg::BusyAt { share: 0.419, what: "candidate 2 of 3".into() });
    expect(&screen, "Planning (rpf) 41 %, 7 s (limit 60 s). Candidate 2 of 3.");
    screen.hear(RunMsg::BusyAt { share: 1.0, what: String::new() });
    expect(&screen, "Planning (rpf) 99 %, 7 s");
    screen.hear(RunMsg::Busy(None));
    screen.hear(RunMsg::BusyAt { share: 0.5, what: "late".into() });
    assert!(!shown(&screen).contains("Planning ("), "late progress starts nothing");
}

#[test]
fn work_on_a_planner_that_is_only_prepared_offers_what_can_be_done() {
    let mut screen = Screen::idle();
    screen.hear(RunMsg::Busy(Some(("Loading planner (rpf)".into(), None))));
    let line = "Loading planner (rpf). Start when the plan is ready.";
    assert!(shown(&screen).contains(line), "{}", shown(&screen));
    assert!(!shown(&screen).contains("space: HOLD"), "there is nothing to hold");
}

#[test]
fn a_hold_by_the_operator_says_what_keeps_the_robot_from_resuming() {
    let lost = EventKind::PositionLost { error_m: 0.5, limit_m: 0.15 };
    let alarmed = EventKind::RangesInconsistent { chi2: 90.0, degrees_of_freedom: 2 };
    for (event, why) in [(lost, "position lost"), (alarmed, "ranges contradict each other")] {
        let mut screen = Screen::held();
        send_event(&mut screen, event);
        let shown = shown(&screen);
        assert!(shown.contains(&format!("HELD by operator; {why}")), "{shown}");
        assert!(shown.contains("Cannot resume without a"), "{shown}");
    }
}

#[test]
fn a_planner_that_was_replaced_is_no_hold_by_the_operator() {
    let mut screen = Screen::running();
    send_event(&mut screen, held(HoldReason::PlannerReplaced));
    send_event(&mut screen, EventKind::PositionLost { error_m: 0.5, limit_m: 0.15 });
    let text = shown(&screen);
    assert!(text.contains("HELD: planner replaced; position lost"), "{text}");
    assert!(text.contains("Cannot resume without a"), "{text}");
}

/// The line above the keys of a held mission, on a screen so wide.
fn line_of_hold(by: &HoldReason, resumes: Resumes, position: Option<EventKind>, size: (u16, u16)) -> String {
    let mut screen = Screen::running();
    for kind in position.into_iter().chain([EventKind::Held { by: by.clone(), resumes }]) {
        send_event(&mut screen, kind);
    }
    screen.send(Msg::Resize { width: size.0, height: size.1 });
    let text = text(&drawn(&screen.model, RICH, size));
    text.lines().find(|line| line.contains("HELD")).unwrap_or(&text).to_owned()
}

#[test]
fn a_hold_that_ends_by_itself_says_so_on_every_screen() {
    use HoldReason::{PlanRefused, PlannerFault, PlannerSilent, PositionLost, RangesInconsistent, Tether};
    for by in HoldReason::every(&"details ".repeat(20)) {
        let resumes = match by {
            PositionLost | RangesInconsistent | PlannerSilent { .. } | Tether { .. } => Resumes::WhenCleared,
            PlannerFault { .. } | PlanRefused { .. } => Resumes::ByFallback,
            // Only an order ends these holds.
            _ => continue,
        };
        for size in [(60, 16), (80, 24), (120, 36)] {
            let line = line_of_hold(&by, resumes, None, size);
            assert!(line.contains("Resumes ") && !line.contains('…'), "{by:?} at {size:?}: {line}");
        }
    }
}

#[test]
fn a_hold_that_an_order_ends_promises_nothing_and_offers_what_is_accepted() {
    let lost = EventKind::PositionLost { error_m: 0.5, limit_m: 0.15 };
    let alarmed = EventKind::RangesInconsistent { chi2: 90.0, degrees_of_freedom: 2 };
    for by in HoldReason::every("details") {
        for position in [None, Some(lost.clone()), Some(alarmed.clone())] {
            let line = line_of_hold(&by, Resumes::Never, position.clone(), (120, 36));
            assert!(!line.contains("automatically") && !line.contains("Resumes"), "{line}");
            let is_refused = matches!(by, HoldReason::PlanRefused { .. });
            let offers = line.contains("space: re") || is_refused && line.contains(":run-uncertified");
            assert_eq!(offers, position.is_none(), "{line}");
        }
    }
}

#[test]
fn starting_a_mission_that_is_held_is_refused_without_a_key_that_would_resume() {
    let why = |screen: &Screen| tui::update::offered(&screen.model, ActionId::Start).unwrap_err();
    assert_eq!(why(&Screen::held()), "the mission has already been started");
    assert_eq!(why(&Screen::running()), "the mission has already been started; space: HOLD");
}

#[test]
fn an_order_that_does_not_reach_the_mission_is_an_alarm_and_can_be_given_again() {
    let mut screen = Screen::idle();
    screen.start();
    let order = screen.model.live.asked.clone().expect("a start");
    let failed = RunMsg::OrderFailed { order, why: "cannot create the run folder".into() };
    assert_eq!(screen.hear(failed), [Effect::Bell]);
    assert_eq!((&screen.model.live.asked, screen.model.live.may_move()), (&None, false));
    assert!(notice(&screen).contains("cannot create the run folder"));
    assert!(matches!(screen.start()[..], [_, Effect::Order(Order::StartPlan(_))]));
}

#[test]
fn a_hold_of_the_tick_before_does_not_answer_a_resume() {
    let mut screen = Screen::held();
    assert_eq!(screen.press([SPACE, Key::Enter]), [order(Order::Resume)]);
    send_event(&mut screen, held(HoldReason::Tether { message: "snagged".into() }));
    assert_eq!(screen.press([SPACE]), [order(Order::Hold)], "the robot will move after that event");
    obeyed(&mut screen, Order::Resume);
    obeyed(&mut screen, Order::Hold);
    assert_eq!((screen.model.live.may_move(), screen.model.live.hold_asked), (false, false));
}

#[test]
fn a_robot_that_resumes_by_itself_withdraws_the_question() {
    let mut screen = Screen::running();
    let by = HoldReason::Tether { message: "no return path".into() };
    send_event(&mut screen, EventKind::Held { by, resumes: Resumes::WhenCleared });
    screen.press([Key::Char(':')]);
    screen.type_text("resume");
    screen.press([Key::Enter]);
    assert!(matches!(screen.model.ui.overlay, Overlay::Confirm(_)));
    send_event(&mut screen, EventKind::Resumed);
    assert_eq!(screen.model.ui.overlay, Overlay::None);
    assert_eq!(screen.press([Key::Enter]), []);
}

#[test]
fn a_planner_that_is_rejected_or_late_is_reported() {
    let (mut screen, ask) = (Screen::held(), preparing());
    prepare(&mut screen, ask);
    assert_eq!(screen.model.live.run.planner_id(), Some("rpf"), "it does not drive yet");
    let why = "no plan within 60 s".to_owned();
    send_event(&mut screen, EventKind::PlannerRejected { planner: "spiral-tangent".into(), why });
    assert!(notice(&screen).contains("spiral-tangent will not take over: no plan within 60 s"));
    let mut screen = Screen::running();
    let before = screen.model.clone();
    send_event(&mut screen, EventKind::Discarded { ask, plan: None });
    send_event(&mut screen, EventKind::Snapshotted { ask, bytes: 12 });
    assert_eq!(screen.model, before, "of no interest to the operator");
    for (ticks, text) in [
        (1, "planner rpf was late; the robot waited 1 tick"),
        (4, "planner rpf was late; the robot waited 4 ticks"),
    ] {
        send_event(&mut screen, EventKind::PlannerLate { planner: "rpf".into(), ticks });
        assert_eq!(notice(&screen), text);
    }
    let events = screen.mission.planner_fails();
    screen.hear(RunMsg::Events(events));
    send_event(&mut screen, EventKind::PlannerLate { planner: "rpf".into(), ticks: 4 });
    obeyed(&mut screen, Order::Resume);
    assert_eq!(
        screen.model.live.run.alarms.unacknowledged(Severity::Crit),
        1,
        "the fault waits to be acknowledged"
    );
}

#[test]
fn the_certificate_of_a_planner_that_is_prepared_says_nothing_of_the_plan_that_is_flown() {
    let (mut screen, ask) = (Screen::tethered(), preparing());
    prepare(&mut screen, ask);
    send_certified_plan(&mut screen, Some(ask), &["cable stays out"]);
    let why = "plan is not safe for the tether".to_owned();
    send_event(&mut screen, EventKind::PlannerRejected { planner: "spiral-tangent".into(), why });
    assert_eq!(
        screen.model.live.run.tether.as_ref().unwrap().certified,
        Some(true),
        "the plan that is flown is"
    );
    assert_eq!(screen.model.live.run.alarms.list(), Screen::tethered().model.live.run.alarms.list());
    send_certified_plan(&mut screen, None, &["cable stays out"]);
    assert_eq!(screen.model.live.run.tether.as_ref().unwrap().certified, Some(false));
    assert_eq!(
        screen.model.live.run.alarms.unacknowledged(Severity::Crit),
        0,
        "another plan is being made, and the robot is not held"
    );
    send_event(&mut screen, held(HoldReason::PlanRefused { message: "cable stays out".into() }));
    assert_eq!(screen.model.live.run.alarms.unacknowledged(Severity::Crit), 1);
}

#[test]
fn the_certificate_of_a_planner_that_takes_over_counts() {
    let (mut screen, ask) = (Screen::tethered(), preparing());
    prepare(&mut screen, ask);
    send_certified_plan(&mut screen, Some(ask), &["cable stays out"]);
    let (choice, info) = (choice("spiral-tangent"), Box::new(crate::fixture::planners().remove(2)));
    let from = Some("rpf".to_owned());
    send_event(&mut screen, EventKind::PlannerChosen { ask: None, choice, info, from });
    send_certified_plan(&mut screen, Some(ask), &["cable stays out"]);
    assert_eq!(screen.model.live.run.tether.as_ref().unwrap().certified, Some(false));
}

#[test]
fn a_space_is_typed_in_text_and_control_c_holds_there() {
    let lines: [&[Key]; 3] = [&[Key::Char(':')], &[Key::Char('/')], &[Key::Char('p'), Key::Enter]];
    for line in lines {
        let mut screen = Screen::held();
        screen.press(line.iter().copied());
        send_event(&mut screen, EventKind::Resumed);
        assert_eq!(screen.type_text("a b"), [], "{line:?}");
        let typed = match &screen.model.ui.overlay {
            Overlay::Commands(palette) => palette.line.text(),
            Overlay::Parameters { edit: Some(edit), .. } => edit.line.text(),
            _ => &screen.model.ui.needle,
        };
        assert!(typed.ends_with("a b"), "{typed}");
        assert_eq!(screen.press([Key::Ctrl('c')]), [order(Order::Hold)], "Ctrl-C after {line:?}");
    }
}

#[test]
fn a_value_is_checked_again_when_it_is_sent() {
    let mut screen = Screen::running();
    send_event(&mut screen, EventKind::Held { by: HoldReason::PositionLost, resumes: Resumes::WhenCleared });
    screen.press([Key::Char('p'), Key::Down, Key::Down, Key::Down, Key::Enter]);
    send_event(&mut screen, EventKind::Resumed);
    assert_eq!(screen.press([Key::Enter]), [], "mode is not live");
    let Overlay::Parameters { edit: Some(edit), .. } = &screen.model.ui.overlay else {
        panic!("still typing")
    };
    assert!(edit.refusal.as_ref().is_some_and(|why| why.contains("while the mission is running")));
}

#[test]
fn a_bad_value_is_refused_in_place_and_a_good_one_sent() {
    let mut screen = Screen::held();
    screen.press([Key::Char('p'), Key::Char('e'), Key::Backspace, Key::Backspace, Key::Backspace]);
    screen.type_text("9");
    assert_eq!(screen.press([Key::Enter]), []);
    let Overlay::Parameters { edit: Some(edit), .. } = &screen.model.ui.overlay else {
        panic!("still typing")
    };
    assert!(edit.refusal.as_ref().is_some_and(|why| why.contains("0.2 to 4 m3/s")));
    screen.press([Key::Backspace]);
    screen.type_text("1.8");
    let key = "rpf_gain".to_owned();
    screen.press([Key::Enter]);
    let set = order(Order::SetParameter { key, value: ParamValue::Float(1.8) });
    assert_eq!(screen.press([Key::Enter]), [set, Effect::StopForecasting]);
}

#[test]
fn what_cannot_change_under_way_says_so() {
    let mut screen = Screen::running();
    screen.press([Key::Char('p'), Key::Down, Key::Down, Key::Down, Key::Enter]);
    let why = "parameter `mode` cannot be changed while the mission is running; HOLD first";
    assert!(notice(&screen).contains(why));
    assert!(matches!(screen.model.ui.overlay, Overlay::Parameters { edit: None, .. }));
}

#[test]
fn ending_holds_first_and_asks() {
    let mut screen = Screen::running();
    assert_eq!(screen.type_text("X"), [order(Order::Hold), Effect::Ask(Query::WayBack)]);
    assert_eq!(screen.press([Key::Enter]), [order(Order::Abort)]);
}

#[test]
fn leaving_a_running_mission_holds_first_and_ends_it_only_when_agreed() {
    let mut screen = Screen::running();
    assert_eq!(screen.type_text("1"), [Effect::Look], "home does not hold");
    assert_eq!(screen.type_text("q"), [order(Order::Hold)]);
    obeyed(&mut screen, Order::Hold);
    assert_eq!(screen.press([Key::Esc]), []);
    screen.type_text("q");
    assert_eq!(screen.press([Key::Enter]), [order(Order::Abort), Effect::Quit { signal: None }]);
}

#[test]
fn leaving_is_not_asked_where_nothing_is_at_stake() {
    assert_eq!(Screen::idle().type_text("1q"), [Effect::Look, Effect::Quit { signal: None }]);
    let mut screen = Screen::running();
    let ended = screen.mission.ended(Outcome::Complete, "task complete");
    screen.hear(RunMsg::Events(vec![ended]));
    assert_eq!(screen.type_text("1q"), [Effect::Look, Effect::Quit { signal: None }]);
}

#[test]
fn q_leads_back_screen_by_screen_and_the_mission_goes_on() {
    use tui::model::Screen::{Home, Mission, Plan};
    let mut screen = Screen::running();
    let screens = |screen: &Screen| (screen.model.ui.screen, screen.model.ui.back.clone());
    assert_eq!(screens(&screen), (Mission, vec![Home, Plan]));
    assert_eq!(screen.type_text("q"), []);
    assert_eq!(screen.type_text("q"), [Effect::Look]);
    assert_eq!(screens(&screen), (Home, vec![]));
    screen.type_text("3");
    assert_eq!(screens(&screen), (Mission, vec![Home]));
    assert!(screen.model.live.may_move());
}

#[test]
fn another_mission_is_opened_only_when_none_is_in_progress() {
    let scenarios = vec![listed("one", None), listed("two", Some("two.toml:3:1: unknown key"))];
    let found = Msg::Found(Box::new(Found { scenarios, ..Found::default() }));
    let mut screen = Screen::running();
    screen.send(found.clone());
    screen.type_text("1");
    assert_eq!(screen.press([Key::Enter]), []);
    assert_eq!(notice(&screen), "a mission is in progress; 3: show it, X: end it");
    let mut screen = Screen::idle();
    screen.send(found);
    screen.type_text("1j");
    assert_eq!(screen.press([Key::Enter]), []);
    assert_eq!(notice(&screen), "two cannot be opened: line 3: unknown key");
    screen.type_text("k");
    let source = Source::File("one.toml".into());
    screen.model.live.speed = Speed::Times(4.0);
    // Settings for one mission do not apply to the next one.
    let opens = Effect::Open { id: RunId(2), source, planner: None, speed: Speed::default() };
    assert_eq!(screen.press([Key::Enter]), [opens]);
    assert_eq!(screen.model.ui.screen, tui::model::Screen::Plan);
    assert_eq!(screen.model.live.speed, Speed::default());
    // Messages from the previous run are too late.
    let late = screen.mission.drive(3);
    screen.hear(RunMsg::Events(late));
    assert_eq!(screen.model.live.run, tui::model::Run::default());
    screen.type_text("S");
    assert_eq!(notice(&screen), "the scenario is loading; start when the plan is ready");
}

#[test]
fn a_scenario_that_cannot_be_opened_leaves_the_ready_mission_open() {
    let mut screen = Screen::idle();
    screen.model.live.source = Some(Source::Demo);
    let (ready, id) = (screen.model.live.run.clone(), screen.model.live.id);
    let scenarios = vec![listed("one", None)];
    screen.send(Msg::Found(Box::new(Found { scenarios, ..Found::default() })));
    screen.type_text("1");
    screen.press([Key::Enter]);
    let opening = screen.model.live.id;
    assert!(screen.model.live.is_opening);
    // Messages that arrive meanwhile are not lost.
    let prepared = screen.mission.wait(1);
    screen.send(Msg::Run(id, RunMsg::Events(prepared)));
    screen.send(Msg::Run(opening, RunMsg::OpenFailed("one.toml:3:1: unknown key `tnak`".into())));
    assert_eq!(notice(&screen), "not opened: one.toml:3:1: unknown key `tnak`");
    assert_eq!(screen.model.ui.screen, tui::model::Screen::Home);
    let live = &screen.model.live;
    assert!(live.waits() && live.id == id && live.before.is_none() && live.failure.is_none());
    assert_eq!(live.run.about, ready.about);
    assert!(live.run.clock.t_s > ready.clock.t_s, "{} {}", live.run.clock.t_s, ready.clock.t_s);
}

#[test]
fn a_run_that_ends_shows_its_result_and_what_comes_next() {
    let mut screen = Screen::running();
    let ended = screen.mission.ended(Outcome::Complete, "task complete");
    screen.hear(RunMsg::Events(vec![ended]));
    let result = RunResult {
        summary: Box::default(),
        name: Some("20261122T040049Z-tank-07".into()),
        kept: "run kept in logs".into(),
        is_kept: true,
    };
    assert_eq!(screen.hear(RunMsg::Closed(Box::new(result))), [Effect::Look]);
    assert_eq!(screen.model.ui.screen, tui::model::Screen::Result);
    let run = || "20261122T040049Z-tank-07".to_owned();
    assert_eq!(screen.type_text("v"), [Effect::Do(Job::Verify(run()))]);
    let failed = Err("different from tick 3 on".to_owned());
    screen.send(Msg::Done(Job::Verify(run()), failed));
    assert_eq!(notice(&screen), format!("verifying {} failed: different from tick 3 on", run()));
    assert_eq!(screen.type_text("r"), []);
    assert!(notice(&screen).starts_with("planner rpf does not support coverage missions"));
    screen.model.live.run.planning.info.iter_mut().for_each(|planner| planner.covers = true);
    let again = Effect::Open {
        id: RunId(2),
        source: Source::Rescan(vec![run()]),
        planner: None,
        speed: Speed::default(),
    };
    assert_eq!(screen.type_text("r"), [again]);
}

#[test]
fn a_hold_slows_the_mission_down_to_real_time() {
    let mut screen = Screen::running();
    screen.type_text(">>");
    assert_eq!(screen.type_text(" "), [order(Order::Hold), Effect::Speed(Speed::Times(1.0))]);
    assert_eq!(screen.model.live.speed, Speed::Times(1.0));
}

#[test]
fn control_c_holds_and_only_twice_in_two_seconds_asks_to_leave() {
    let mut screen = Screen::running();
    assert_eq!(screen.press([Key::Ctrl('c')]), [order(Order::Hold)]);
    assert_eq!(notice(&screen), "press Ctrl-C again within 2 s to quit");
    screen.pass(1.9);
    assert_ne!(notice(&screen), "");
    screen.pass(0.2);
    assert_eq!(notice(&screen), "", "the first one no longer counts");
    screen.press([Key::Ctrl('c')]);
    assert_eq!(screen.model.ui.overlay, Overlay::None);
    screen.pass(1.0);
    screen.press([Key::Ctrl('c')]);
    assert_eq!(screen.model.ui.overlay, Overlay::Quit);
}

#[test]
fn control_z_holds_before_the_terminal_is_given_back() {
    let mut screen = Screen::running();
    assert_eq!(screen.press([Key::Ctrl('z')]), [order(Order::Hold), Effect::Suspend]);
    assert_eq!(screen.send(Msg::Signal(Signal::Continue)), [Effect::Redraw]);
}

#[test]
fn a_signal_to_end_holds_and_leaves() {
    for signal in [Signal::Terminate, Signal::Hangup, Signal::End(3)] {
        let effects = Screen::running().send(Msg::Signal(signal));
        assert_eq!(effects, [order(Order::Hold), Effect::Quit { signal: Some(signal) }]);
        assert_eq!(Screen::idle().send(Msg::Signal(signal)), [Effect::Quit { signal: Some(signal) }]);
    }
}

#[test]
fn a_question_is_withdrawn_when_things_change() {
    let mut screen = Screen::held();
    screen.press([SPACE]);
    let events = screen.mission.planner_fails();
    screen.hear(RunMsg::Events(events));
    assert_eq!(screen.model.ui.overlay, Overlay::None);
    assert_eq!(screen.press([Key::Enter]), []);
}

#[test]
fn pasted_text_is_never_a_command() {
    let mut screen = Screen::running();
    assert_eq!(screen.send(Msg::Paste("Xq S\n ".into())), []);
    assert_eq!(screen.model.ui.overlay, Overlay::None);
    screen.type_text(":");
    screen.send(Msg::Paste("zoom\nin".into()));
    let Overlay::Commands(palette) = &screen.model.ui.overlay else { panic!("the list is open") };
    assert_eq!(palette.line.text(), "zoomin");
    screen.press([Key::Enter]);
    assert_eq!(screen.model.ui.map.zoom, 1);
}

#[test]
fn a_key_that_is_held_down_moves_the_map_or_stops_the_robot_and_nothing_else() {
    let mut screen = Screen::running();
    let mut repeat = |letter| screen.send(Msg::Key(KeyPress { repeat: true, ..Key::Char(letter).into() }));
    assert_eq!(repeat('q'), []);
    assert_eq!(repeat(' '), [Effect::Order(Order::Hold)]);
    assert_eq!(repeat(' '), [], "it has been asked for");
    repeat('z');
    assert_eq!((screen.model.ui.map.zoom, &screen.model.ui.overlay), (1, &Overlay::None));
}

#[test]
fn every_command_can_be_run_by_its_name() {
    for action in tui::actions::ACTIONS.iter().filter(|action| action.is_command()) {
        let mut by_name = Screen::held();
        by_name.press([Key::Char(':')]);
        by_name.send(Msg::Paste(action.name.into()));
        let named = by_name.press([Key::Enter]);
        let mut by_id = Screen::held();
        let direct = by_id.act(action.id);
        by_id.model.console.history.clone_from(&by_name.model.console.history);
        // An action that is carried out without a message has no moment at which its question appeared.
        by_id.model.console.appeared = by_name.model.console.appeared;
        assert_eq!((named, by_name.model), (direct, by_id.model), "{}", action.name);
    }
}

#[test]
#[allow(clippy::large_stack_arrays, reason = "three screens, for a test")]
fn what_is_refused_says_why() {
    let mut refused = 0;
    for mut screen in [Screen::idle(), Screen::running(), Screen::held()] {
        for action in tui::actions::ACTIONS.iter().filter(|action| action.is_command()) {
            screen.model.console.notice = None;
            let before = screen.model.clone();
            if let Err(why) = tui::update::offered(&screen.model, action.id) {
                assert_eq!(tui::update::act(&mut screen.model, action.id), [], "{}", action.name);
                assert_eq!(notice(&screen), why);
                screen.model.console.notice = None;
                screen.model.console.messages.clone_from(&before.console.messages);
                assert_eq!(screen.model, before, "{} changes nothing when refused", action.name);
                refused += 1;
            }
        }
    }
    assert!(refused > 10);
}

#[test]
fn the_truth_is_not_known_to_the_screen() {
    let mut screen = Screen::running();
    let before = screen.model.clone();
    let pose = world::Pose::new(1.0, 1.0, 0.0);
    send_event(&mut screen, EventKind::Truth { pose, clearance_m: -0.1, collided: true });
    assert_eq!(screen.model, before);
    let names: Vec<&str> = before
        .live
        .run
        .about
        .as_ref()
        .map(|run| run.world.obstacles.iter().map(|o| o.name.as_str()).collect())
        .unwrap();
    assert_eq!(names.last(), Some(&"debris"), "it was found");
    let idle = Screen::idle();
    assert_eq!(
        idle.model.live.run.about.map(|run| run.world.obstacles.len()),
        Some(5),
        "it was not known before"
    );
}

#[test]
fn a_critical_alarm_rings_and_waits_for_the_operator() {
    let mut screen = Screen::running();
    let effects = send_event(&mut screen, EventKind::PositionLost { error_m: 0.5, limit_m: 0.15 });
    assert_eq!(effects, [], "the next cycle may be a good one");
    let lasts = screen.mission.wait(3);
    assert_eq!(screen.hear(RunMsg::Events(lasts)), [Effect::Bell]);
    send_event(&mut screen, EventKind::PositionRegained { error_m: 0.1 });
    assert_eq!(screen.model.live.run.alarms.count(Severity::Crit), 1);
    screen.type_text("a");
    assert_eq!(screen.model.live.run.alarms.count(Severity::Crit), 0);
}

#[test]
fn an_alarm_whose_cause_is_gone_says_so_until_the_operator_has_seen_it() {
    let mut screen = Screen::running();
    send_event(&mut screen, EventKind::RangesInconsistent { chi2: 90.0, degrees_of_freedom: 2 });
    let lasts = screen.mission.wait(3);
    screen.hear(RunMsg::Events(lasts));
    let open = shown(&screen);
    assert!(open.contains("a: acknowledge.") && !open.contains("(cleared)"), "{open}");
    send_event(&mut screen, EventKind::RangesConsistent);
    let over = shown(&screen);
    assert!(over.contains("(cleared). a: acknowledge."), "{over}");
}

#[test]
fn a_stuck_robot_is_held_with_an_alarm_until_it_goes_on_and_the_operator_knows() {
    let mut screen = Screen::running();
    send_event(&mut screen, held(HoldReason::Stuck { message: "no progress".into() }));
    assert_eq!(screen.model.live.run.alarms.unacknowledged(Severity::Warn), 1);
    screen.type_text("a");
    assert_eq!(screen.model.live.run.alarms.count(Severity::Warn), 1, "seen, and not over");
    assert_eq!(screen.press([SPACE, Key::Enter]), [order(Order::Resume)]);
    obeyed(&mut screen, Order::Resume);
    assert_eq!(screen.model.live.run.alarms.count(Severity::Warn), 0);
}

#[test]
fn a_failed_recording_is_an_alarm_until_it_works_again_and_was_seen() {
    let mut screen = Screen::running();
    let health = |recording| RunMsg::Health(tui::Health { recording, ..tui::Health::default() });
    assert_eq!(screen.hear(health(Recording::Failed("disk full".into()))), [Effect::Bell]);
    assert_eq!(screen.hear(health(Recording::Failed("disk full".into()))), []);
    screen.type_text("a");
    assert_eq!(screen.model.live.run.alarms.count(Severity::Crit), 1, "seen, and not over");
    screen.hear(health(Recording::On));
    assert_eq!(screen.model.live.run.alarms.count(Severity::Crit), 0);
}

#[test]
fn a_thread_that_panics_holds_the_robot() {
    let mut screen = Screen::running();
    let panicked = Msg::ThreadPanicked { thread: "recorder".into(), message: "index out of bounds".into() };
    assert_eq!(screen.send(panicked), [order(Order::Hold), Effect::Bell]);
}

#[test]
fn silence_is_noticed_while_running_and_nowhere_else() {
    let mut screen = Screen::running();
    screen.pass(1.9);
    assert_eq!(screen.model.silent_s(), None);
    assert!(screen.model.wakes_at_mono_s().is_some_and(|at_s| (at_s - 2.0).abs() < 1e-9));
    screen.pass(1.0);
    assert!(screen.model.silent_s().is_some());
    let mut held = Screen::held();
    held.pass(60.0);
    assert_eq!((held.model.silent_s(), held.model.wakes_at_mono_s()), (None, None));
}

#[test]
fn news_go_away_by_themselves_and_stay_in_the_log() {
    let mut screen = Screen::idle();
    screen.send(Msg::Notice { severity: Severity::Warn, text: "the disk is nearly full".into() });
    assert_eq!(notice(&screen), "the disk is nearly full");
    screen.pass(10.0);
    assert_eq!(notice(&screen), "");
    screen.type_text("/disk");
    assert_eq!(screen.model.ui.events.matches.len(), 1);
}

#[test]
fn panes_follow_the_size_of_the_screen() {
    let mut screen = Screen::running();
    screen.send(Msg::Resize { width: 60, height: 16 });
    screen.press([Key::Tab, Key::Tab]);
    assert_eq!(screen.model.ui.pane, Pane::Position);
    screen.send(Msg::Resize { width: 120, height: 36 });
    assert_eq!(screen.model.ui.pane, Pane::Map);
    screen.press([Key::BackTab]);
    assert_eq!(screen.model.ui.pane, Pane::Stations);
    screen.press([Key::BackTab]);
    assert_eq!(screen.model.ui.pane, Pane::Events);
}

#[test]
fn the_events_are_scrolled_and_filtered() {
    let mut screen = Screen::running();
    screen.press([Key::Tab, Key::End]);
    let lines = screen.model.live.run.log.len();
    assert_eq!(screen.model.ui.events.newer(), lines - 1);
    screen.press([Key::Home, Key::Char('/')]);
    screen.type_text("STATION");
    screen.press([Key::Enter]);
    assert_eq!(screen.model.ui.needle, "STATION");
    assert_eq!(screen.model.ui.events.matches.len(), 1);
    screen.type_text("m");
    assert_eq!(
        (screen.model.ui.needle.as_str(), screen.model.ui.events.matches.len()),
        ("sev>=watch STATION", 1)
    );
}

#[test]
fn a_model_can_be_saved_and_opened_again() {
    let screen = Screen::running();
    let saved = serde_json::to_string(&screen.model).unwrap();
    let opened: Model = serde_json::from_str(&saved).unwrap();
    assert_eq!(opened, screen.model);
}

#[test]
fn a_key_that_is_no_answer_cancels_the_question_so_that_enter_cannot_agree_to_it() {
    for question in [" ", ".", "X", "1q"] {
        let mut screen = Screen::held();
        screen.type_text(question);
        assert!(screen.model.ui.overlay != Overlay::None, "{question:?} asks");
        assert_eq!(screen.type_text("P"), [], "{question:?}");
        assert_eq!(notice(&screen), "cancelled: key P is not an answer");
        assert_eq!(screen.press([Key::Enter]), [], "{question:?}: Enter agrees to nothing");
    }
}

#[test]
fn a_filter_shows_where_it_acts_and_escape_clears_it() {
    let mut screen = Screen::held();
    screen.type_text("/station");
    screen.press([Key::Enter]);
    assert!(shown(&screen).contains("filter `station`"), "{}", shown(&screen));
    assert_eq!(screen.press([Key::Esc]), []);
    assert_eq!((screen.model.ui.needle.as_str(), notice(&screen)), ("", "filter cleared"));
    assert!(!shown(&screen).contains("filter `"), "{}", shown(&screen));
}

#[test]
fn the_table_of_stations_is_a_pane_at_120x36() {
    let mut screen = Screen::running();
    screen.send(Msg::Resize { width: 120, height: 36 });
    assert!(!shown(&screen).contains("Stations ─"), "{}", shown(&screen));
    screen.press([Key::Tab, Key::Tab]);
    let text = shown(&screen);
    assert!(text.contains("▸ F4 Stations") && text.contains("unused") && text.contains("100 %"), "{text}");
    screen.press([Key::Tab]);
    assert!(!shown(&screen).contains("Stations ─"), "{}", shown(&screen));
}

#[test]
fn planning_that_is_cancelled_says_so() {
    let mut screen = Screen::idle();
    screen.press([Key::Char('2')]);
    screen.hear(RunMsg::Busy(Some(("Planning".into(), None))));
    screen.press([Key::Esc]);
    assert!(notice(&screen).starts_with("planning cancelled; "), "{}", notice(&screen));
}

#[test]
fn a_run_without_its_console_offers_only_what_can_still_be_done() {
    let mut screen = Screen::held();
    screen.model.live.access = tui::model::Access::LookOnly;
    screen.hear(RunMsg::WriterGone);
    let said: Vec<String> = tui::plain::Said::default().next(&screen.model);
    assert_eq!(said.iter().filter(|line| line.contains("CONSOLE LOST")).count(), 1, "{said:#?}");
    assert_eq!(screen.model.notice(), None, "the state line says it");
    screen.press([Key::Char('4')]);
    let text = shown(&screen);
    assert!(text.contains("Check the robot on site") && !text.contains("HOLD the robot"), "{text}");
}

#[test]
fn help_in_sentences_lists_the_commands_that_can_be_given() {
    let screen = Screen::held();
    let lines = tui::plain::help(&screen.model);
    assert!(lines.iter().any(|line| line.starts_with("resume: ")), "{lines:#?}");
    assert!(!lines.iter().any(|line| line.starts_with("take-plan: ")), "{lines:#?}");
}

#[test]
fn help_in_sentences_leaves_out_what_only_a_picture_has() {
    let lines = tui::plain::help(&Screen::running().model);
    for drawn in ["zoom-in: ", "mouse: ", "layers", "next-pane: ", "pan-west: ", "theme "] {
        assert!(!lines.iter().any(|line| line.starts_with(drawn)), "{drawn}: {lines:#?}");
    }
    assert!(lines.iter().any(|line| line.starts_with("hold: ")), "{lines:#?}");
}

#[test]
fn a_hold_is_said_once_and_in_a_live_run_when_it_is_confirmed() {
    for is_live in [false, true] {
        let mut screen = Screen::running();
        screen.model.live.run.about.as_mut().expect("a run").mission.live = is_live;
        screen.model.console.keys.spells_commands = true;
        let mut said = tui::plain::Said::default();
        said.next(&screen.model);
        obeyed(&mut screen, Order::Hold);
        let lines = said.next(&screen.model);
        let first = if is_live { "STOPPING by operator. " } else { "HELD by operator. " };
        let of_hold: Vec<&String> = lines.iter().filter(|line| line.contains("by operator")).collect();
        assert!(matches!(of_hold[..], [line] if line.starts_with(first)), "{lines:#?}");
        screen.press([SPACE]);
        let asked = said.next(&screen.model);
        assert!(!asked.iter().any(|line| line.contains("HELD")), "the question is enough: {asked:#?}");
        screen.press([Key::Esc]);
        send_event(&mut screen, EventKind::Stood { confirmed: true, after_s: 0.3, moved: false });
        let lines = said.next(&screen.model);
        assert_eq!(
            lines.iter().filter(|line| line.starts_with("HELD")).count(),
            usize::from(is_live),
            "{lines:#?}"
        );
    }
}
