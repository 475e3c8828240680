//! The ways to end a mission: here, or after a drive back to the anchor.

use crate::fixture::{RICH, Screen};
use crate::screens::{drawn, text};
use mission::{EventKind, HoldReason, Home, Order, Outcome, WayBack};
use tui::model::{Overlay, ui::Ask};
use tui::{Effect, Key, Mouse, Msg, Query, RunMsg, Target};
use world::Point;

fn way() -> WayBack {
    let path = [(-0.78, 7.4), (4.0, 6.0), (9.4, 0.0)].map(|(x, y)| Point::new(x, y)).to_vec();
    WayBack { to: Home::Anchor, path, length_m: 13.1, clearance_m: 0.12, slack_m: None }
}

/// A mission whose end has been asked for, and whose way back is known.
pub(crate) fn ending() -> Screen {
    let mut screen = Screen::tethered();
    assert_eq!(screen.type_text("X"), [Effect::Order(Order::Hold), Effect::Ask(Query::WayBack)]);
    let held = screen.mission.obeyed(Order::Hold);
    screen.hear(RunMsg::Events(held));
    screen.hear(RunMsg::WayBack(Ok(way())));
    screen
}

/// A mission whose robot is driving back.
pub(crate) fn driving_back() -> Screen {
    let mut screen = ending();
    screen.press([Key::Down, Key::Enter]);
    let mut events = screen.mission.obeyed(Order::DriveBack);
    events.push(screen.mission.now(EventKind::ReturnBegan { way: way() }));
    screen.hear(RunMsg::Events(events));
    screen
}

#[test]
fn the_time_left_of_a_drive_back_is_that_of_the_way_and_not_of_the_plan() {
    let mut screen = Screen::tethered();
    let of_plan_s = screen.model.live.run.left_s().expect("the plan has a pace");
    screen = driving_back();
    let run = &screen.model.live.run;
    let (left_m, speed) =
        (run.way_left_m().expect("it drives back"), run.about.as_ref().unwrap().mission.limits.v_max_m_per_s);
    let left_s = run.left_s().expect("the way has a length");
    assert!((left_s - left_m / speed).abs() < 1e-9 && (left_s - of_plan_s).abs() > 60.0, "{left_s}");
    // Held on the way, the mission may resume its plan.
    let held = screen.mission.obeyed(Order::Hold);
    screen.hear(RunMsg::Events(held));
    assert_eq!(screen.model.live.run.left_s(), Some(of_plan_s));
}

#[test]
fn a_drive_back_is_no_progress_along_the_plan_although_it_crosses_its_lanes() {
    let mut screen = driving_back();
    let before = screen.model.live.run.progress.expect("lanes were driven");
    let crossed = EventKind::Progressed {
        done: before.done + 0.3,
        along_m: Some(900.0),
        cross_track_m: Some(4.0),
        target: Point::new(-3.0, 4.0),
        covered_reachable: 0.5,
        covered_whole: 0.4,
        leg: None,
    };
    let events = vec![screen.mission.now(crossed)];
    screen.hear(RunMsg::Events(events));
    let after = screen.model.live.run.progress.expect("it is kept");
    assert_eq!((after.done, after.along_m, after.target), (before.done, before.along_m, before.target));
    assert!((after.covered_reachable - 0.5).abs() < 1e-12, "floor may be scanned on the way");
}

#[test]
fn a_clearance_below_the_required_one_is_named_in_the_list_and_in_the_question() {
    let mut screen = ending();
    let required_m = screen.model.live.run.about.as_ref().expect("a run").mission.clearance_m;
    let said = format!("BELOW the required {required_m:.2} m");
    for (clearance_m, is_below) in
        [(required_m - 0.02, true), (required_m, false), (required_m - 0.001, false)]
    {
        screen.hear(RunMsg::WayBack(Ok(WayBack { clearance_m, ..way() })));
        for size in [(60, 16), (80, 24), (120, 36)] {
            let shown = shown(&screen, size).split_whitespace().collect::<Vec<_>>().join(" ");
            assert_eq!(
                shown.contains(&said) || shown.contains("BELOW the"),
                is_below,
                "{clearance_m} {size:?}\n{shown}"
            );
        }
    }
}

fn shown(screen: &Screen, size: (u16, u16)) -> String {
    text(&drawn(&screen.model, RICH, size))
}

#[test]
fn a_mission_is_ended_here_or_after_a_drive_back() {
    assert_eq!(ending().press([Key::Enter]), [Effect::Order(Order::Abort)]);
    assert_eq!(ending().press([Key::Down, Key::Enter]), [Effect::Order(Order::DriveBack)]);
    for size in [(120, 36), (80, 24), (60, 16), (44, 10)] {
        let mut screen = ending();
        let here = shown(&screen, size);
        assert!(here.contains("End here") && here.contains("To the anchor"), "{here}");
        screen.press([Key::Down]);
        let back = shown(&screen, size);
        assert!(back.contains("13.1 m, clearance 0.12 m") || size.0 < 60, "{back}");
    }
}

#[test]
fn whatever_is_no_answer_closes_the_question_and_a_later_enter_does_nothing() {
    for key in [Key::Esc, Key::Char('q'), Key::Char('b'), Key::Char('7'), Key::Char(' ')] {
        let mut screen = ending();
        screen.press([Key::Down, key]);
        assert_eq!(screen.model.ui.overlay, Overlay::None, "{key}");
        assert_eq!(screen.press([Key::Enter]), [], "{key}");
    }
    for key in [Key::Char('b'), Key::Char('z'), Key::Char('3')] {
        let mut screen = Screen::held();
        screen.press([Key::Char(' '), key]);
        assert_eq!(screen.press([Key::Enter]), [], "{key}");
    }
}

#[test]
fn a_click_neither_answers_nor_leaves_the_screen_under_a_question_or_a_list() {
    use tui::actions::ActionId;
    for open in ["X", "P", ":", "L"] {
        let mut screen = Screen::held();
        screen.model.ui.mouse = true;
        screen.type_text(open);
        let before = screen.model.ui.clone();
        for id in [ActionId::Go(tui::model::Screen::Alarms), ActionId::DriveBack, ActionId::Back] {
            assert_eq!(screen.send(Msg::Mouse(Mouse::Click(Target::Key(id)))), []);
        }
        assert_eq!(screen.model.ui, before, "{open}");
    }
}

#[test]
fn without_a_way_back_only_the_end_here_is_possible() {
    let mut screen = ending();
    screen.hear(RunMsg::WayBack(Err("the hull does not fit through".into())));
    assert_eq!(screen.press([Key::Down, Key::Enter]), []);
    let said = screen.model.notice().map(|notice| notice.text.clone());
    assert_eq!(said.as_deref(), Some("no way back: the hull does not fit through"));
    assert_eq!(screen.press([Key::Up, Key::Enter]), [Effect::Order(Order::Abort)]);
}

#[test]
fn return_asks_with_length_and_clearance() {
    let mut screen = Screen::held();
    screen.type_text(":return");
    assert_eq!(screen.press([Key::Enter]), [Effect::Ask(Query::WayBack)]);
    assert_eq!(screen.model.ui.overlay, Overlay::Confirm(Ask::DriveBack));
    assert!(screen.model.awaits_figures());
    screen.hear(RunMsg::WayBack(Ok(way())));
    assert!(!screen.model.awaits_figures());
    let asked = shown(&screen, (80, 24)).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(asked.contains("To the anchor, 13.1 m, clearance 0.12 m."), "{asked}");
    assert_eq!(screen.press([Key::Enter]), [Effect::Order(Order::DriveBack)]);
    // Without a way, the question is closed.
    let mut screen = Screen::held();
    screen.type_text(":return");
    screen.press([Key::Enter]);
    screen.hear(RunMsg::WayBack(Err("blocked".into())));
    assert_eq!(screen.model.ui.overlay, Overlay::None);
    // While the robot moves, HOLD comes first.
    let why = tui::update::offered(&Screen::running().model, tui::actions::ActionId::DriveBack).unwrap_err();
    assert!(why.contains("HOLD"), "{why}");
}

#[test]
fn a_drive_back_says_how_far_it_is_and_hold_stops_it() {
    let mut screen = driving_back();
    let text = shown(&screen, (120, 36));
    let line = text.lines().find(|line| line.contains("Driving back to the anchor: 13.")).unwrap_or_default();
    assert!(line.contains(" m left. space: HOLD. Clearance 0.12 m."), "{text}");
    assert_eq!(screen.press([Key::Char(' ')]), [Effect::Order(Order::Hold)]);
}

#[test]
fn a_breach_of_a_zone_is_a_critical_alarm_and_says_why_the_robot_is_held() {
    let mut screen = Screen::running();
    let breached = screen.mission.now(EventKind::ZoneBreached { zone: "no-go 1".into(), depth_m: 0.08 });
    let held = screen.mission.held(HoldReason::ZoneBreached { zone: "no-go 1".into() });
    screen.hear(RunMsg::Events(vec![breached, held]));
    let text = shown(&screen, (120, 36));
    assert!(text.contains("HELD: hull in a no-go zone") && text.contains("1 crit 2 watch unack"), "{text}");
    let state = text.lines().find(|line| line.starts_with(" HELD")).unwrap();
    assert!(state.contains(":return: drive back. X: end mission.") && !state.contains("resume"), "{state}");
    screen.type_text("4");
    let alarms = shown(&screen, (120, 36));
    assert!(alarms.contains("hull in zone no-go 1"), "{alarms}");
    // The question says where the hull is, and what is safer.
    screen.type_text("3:resume");
    screen.press([Key::Enter]);
    let asked = shown(&screen, (120, 36));
    assert!(asked.contains("Resume?") && asked.contains("HULL IS IN A NO-GO ZONE"), "{asked}");
    assert!(asked.contains("may get stuck there. Safer: Esc, then :return drives back"), "{asked}");
    screen.press([Key::Esc]);
    // Whatever holds the robot in the zone, the remedy is the same.
    screen.type_text("3");
    let message = "planner apf finds no way out of zone no-go 1".to_owned();
    let held = screen.mission.held(HoldReason::Stuck { message });
    screen.hear(RunMsg::Events(vec![held]));
    let text = shown(&screen, (120, 36));
    assert!(text.contains("HELD: robot stuck; hull in a no-go zone"), "{text}");
    assert!(text.contains(":return: drive back."), "{text}");
    // Outside, the planner can go on.
    let left = screen.mission.now(EventKind::ZoneLeft { zone: "no-go 1".into() });
    let held = screen.mission.held(HoldReason::ZoneBreached { zone: "no-go 1".into() });
    screen.hear(RunMsg::Events(vec![left, held]));
    let text = shown(&screen, (120, 36));
    assert!(text.contains("HELD: hull has left the zone") && text.contains("space: resume."), "{text}");
}

#[test]
fn parameters_of_an_ended_mission_are_refused_with_the_reason() {
    let mut screen = Screen::held();
    screen.type_text("3p");
    assert!(matches!(screen.model.ui.overlay, Overlay::Parameters { .. }), "{:?}", screen.model.ui.overlay);
    screen.press([Key::Esc]);
    let ended = screen.mission.ended(Outcome::Aborted, "ended by operator");
    screen.hear(RunMsg::Events(vec![ended]));
    for number in ["3", "2"] {
        screen.type_text(number);
        screen.type_text("p");
        assert_eq!(screen.model.ui.overlay, Overlay::None);
        let text = shown(&screen, (120, 36));
        assert!(text.contains("he mission has ended") && !text.contains("p parameters"), "{text}");
    }
}
