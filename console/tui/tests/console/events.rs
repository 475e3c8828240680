//! The events screen: finding and reading events.

use crate::fixture::{RICH, Screen};
use crate::screens::{drawn, text};
use crate::sizes;
use mission::{EventKind, HoldReason, Order, Severity};
use positioning::Exclusion;
use tui::model::Overlay;
use tui::{Effect, Key, Msg, RunMsg};
use world::StationId;

fn notice(screen: &Screen) -> &str {
    screen.model.notice().map_or("", |notice| notice.text.as_str())
}

fn shown(screen: &Screen, size: (u16, u16)) -> String {
    text(&drawn(&screen.model, RICH, size))
}

fn station(screen: &mut Screen, id: u32, is_back: bool) {
    let station = StationId(id);
    let ranged = screen.mission.drive(2);
    screen.hear(RunMsg::Events(ranged));
    let reason = Exclusion::Residual { residual_m: -0.22, gate_m: 0.18 };
    let kind = if is_back {
        EventKind::StationRestored { station }
    } else {
        EventKind::StationRejected { station, reason }
    };
    let event = screen.mission.now(kind);
    screen.hear(RunMsg::Events(vec![event]));
}

/// A held mission with a few events of stations, on the events screen.
fn with_events() -> Screen {
    let mut screen = Screen::running();
    for (id, is_back) in [(4, true), (2, false), (2, true), (3, false)] {
        station(&mut screen, id, is_back);
    }
    let held = screen.mission.obeyed(Order::Hold);
    screen.hear(RunMsg::Events(held));
    screen.type_text("5");
    screen
}

#[test]
fn events() {
    let mut screen = with_events();
    screen.type_text("/source=ae \"station\"");
    screen.press([Key::Enter, Key::Down, Key::Down, Key::Enter]);
    sizes::store("events", &mut screen, sizes::is_log);
}

#[test]
fn a_filter_without_hits_says_so_in_the_pane_and_on_the_screen() {
    for page in ["3", "5"] {
        let mut screen = with_events();
        screen.type_text(page);
        screen.type_text("/nowhere");
        screen.press([Key::Enter]);
        for size in [(120, 36), (200, 60)] {
            let shown = shown(&screen, size);
            assert!(shown.contains("No event matches `nowhere`. Esc: show all events."), "{page}\n{shown}");
        }
    }
}

#[test]
fn planner_messages_are_hidden_until_they_are_asked_for_and_then_listed_as_one() {
    let mut screen = with_events();
    let said = |screen: &mut Screen, n: u32| {
        let (planner, level) = ("rpf".to_owned(), planner_api::LogLevel::Debug);
        let message = format!("candidate {n} is longer");
        let event = screen.mission.now(EventKind::PlannerLogged { planner, level, message });
        screen.hear(RunMsg::Events(vec![event]));
    };
    (0..4).for_each(|n| said(&mut screen, n));
    let size = (80, 24);
    screen.send(Msg::Resize { width: size.0, height: size.1 });
    let before = shown(&screen, size);
    assert!(!before.contains("candidate") && before.contains("planner messages hidden"), "{before}");
    screen.type_text("d");
    let after = shown(&screen, size);
    assert!(after.contains("rpf: candidate 3 is longer (+3 more)"), "{after}");
    screen.press([Key::Enter]);
    let detail = shown(&screen, size);
    assert!(detail.contains("Rpf: candidate 0 is longer"), "{detail}");
    screen.type_text("d");
    assert!(!shown(&screen, size).contains("candidate 3"));
}

#[test]
fn what_a_planner_says_again_after_a_replan_is_shown_once() {
    let mut screen = Screen::running();
    for message in ["a rim cannot be reached", "0.09 m² cannot be reached", "a rim cannot be reached"] {
        let (planner, level) = ("rpf".to_owned(), planner_api::LogLevel::Warn);
        let event = screen.mission.now(EventKind::PlannerLogged { planner, level, message: message.into() });
        screen.hear(RunMsg::Events(vec![event]));
    }
    let log = &screen.model.live.run.log;
    let entries = (log.oldest()..log.end()).filter_map(|number| log.get(number));
    let said: Vec<_> =
        entries.filter(|entry| entry.text.contains("a rim")).map(|entry| entry.severity).collect();
    assert_eq!(said, [Severity::Watch, Severity::Debug]);
}

#[test]
fn a_field_that_is_not_understood_is_marked_and_explained_while_it_is_typed() {
    let mut screen = with_events();
    screen.send(Msg::Resize { width: 80, height: 24 });
    screen.type_text("/station sevv>=warn");
    let text = shown(&screen, (80, 24));
    assert!(
        text.contains("filter  station sevv>=warn ") && text.contains("^ unknown field `sevv`"),
        "{text}"
    );
    assert!(text.contains("5 of "), "the rest filters\n{text}");
    let underlined =
        |cell: &&ratatui::buffer::Cell| cell.modifier.contains(ratatui::style::Modifier::UNDERLINED);
    let cells = drawn(&screen.model, RICH, (80, 24));
    assert_eq!(cells.content.iter().filter(underlined).count(), "sevv>=warn".len());
    screen.press([Key::Esc]);
    assert_eq!((screen.model.ui.needle.as_str(), &screen.model.ui.overlay), ("", &Overlay::None));
}

#[test]
fn what_is_typed_next_is_a_term_of_its_own() {
    let mut screen = with_events();
    screen.type_text("/sev>=watch");
    screen.press([Key::Enter]);
    screen.type_text("/S3");
    screen.press([Key::Enter]);
    assert_eq!(screen.model.ui.needle, "sev>=watch S3");
    assert_eq!(screen.model.ui.events.matches.len(), 1);
}

#[test]
fn an_event_that_is_read_stays_selected_while_others_come() {
    let mut screen = with_events();
    screen.press([Key::Enter]);
    let selected = screen.model.ui.events.selected();
    station(&mut screen, 2, false);
    assert_eq!((screen.model.ui.events.selected(), screen.model.ui.events.newer()), (selected, 1));
    screen.press([Key::Enter, Key::Up]);
    station(&mut screen, 2, true);
    assert_eq!(screen.model.ui.events.newer(), 0, "the newest one is followed");
}

#[test]
fn the_next_and_previous_event_of_the_same_kind_are_found() {
    let mut screen = with_events();
    screen.type_text("/S2 rejected");
    screen.press([Key::Enter]);
    let text = |screen: &Screen| {
        let number = screen.model.ui.events.selected().unwrap();
        screen.model.live.run.log.get(number).unwrap().text.clone()
    };
    screen.type_text("/");
    screen.press([Key::Esc, Key::Down, Key::Down]);
    let first = text(&screen);
    assert!(first.starts_with("station S3 rejected"), "{first}");
    screen.type_text("n");
    assert_eq!(notice(&screen), "no later event of this kind");
    screen.type_text("N");
    assert!(text(&screen).starts_with("station S2 rejected"), "{}", text(&screen));
    screen.type_text("n");
    assert_eq!(text(&screen), first);
}

#[test]
fn a_line_is_copied_and_its_place_shown() {
    let mut screen = with_events();
    screen.press([Key::Down, Key::Down]);
    let [Effect::Copy(line)] = &screen.type_text("y")[..] else { panic!("a line is copied") };
    assert!(line.starts_with("T+00:") && line.contains(" WATCH ae station S3 rejected"), "{line}");
    screen.type_text("m");
    assert_eq!(screen.model.ui.screen, tui::model::Screen::Mission);
    let place = crate::fixture::world().stations[2].position;
    assert!((screen.model.ui.map_center(world::Point::origin(), None) - place).norm() < 1e-9);
}

#[test]
fn the_events_pane_of_the_mission_opens_the_whole_event() {
    let mut screen = Screen::running();
    screen.press([Key::Tab, Key::Down, Key::Enter]);
    assert_eq!(screen.model.ui.screen, tui::model::Screen::Events);
    assert!(screen.model.ui.focus() == tui::model::Pane::Detail && screen.model.ui.events.newer() == 1);
}

#[test]
fn every_event_with_a_line_is_described_field_by_field() {
    let mut screen = Screen::tethered();
    let mission = &mut screen.mission;
    let mut events = mission.caught();
    events.extend(mission.plan_refused());
    events.extend(mission.planner_fails());
    let kinds = [
        EventKind::PositionLost { error_m: 0.49, limit_m: 0.15 },
        EventKind::PositionRegained { error_m: 0.1 },
        EventKind::RangesInconsistent { chi2: 250.0, degrees_of_freedom: 3 },
        EventKind::PlannerRejected { planner: "apf".into(), why: "no plan within 60 s".into() },
        EventKind::PlannerLate { planner: "rpf".into(), ticks: 3 },
        EventKind::OrderRefused { order: Order::Resume, why: "the position is lost".into() },
        EventKind::FixFailed {
            error: positioning::FixError::TooFewStations { have: 1, need: 2 },
            repeated: false,
        },
    ];
    events.extend(kinds.map(|kind| mission.now(kind)));
    events.push(mission.held(HoldReason::Stuck { message: "no progress".into() }));
    screen.hear(RunMsg::Events(events));
    screen.type_text("5");
    screen.press([Key::End]);
    let total = screen.model.live.run.log.len();
    assert!(total > 14);
    for _ in 0..total {
        let text = shown(&screen, (120, 36));
        let number = screen.model.ui.events.selected().unwrap();
        let entry = screen.model.live.run.log.get(number).unwrap();
        assert!(!text.contains("─  event ") && text.contains("journal"), "{}\n{text}", entry.text);
        assert!(entry.severity < Severity::Warn || text.contains("robot "), "{}\n{text}", entry.text);
        screen.press([Key::Up]);
    }
}

#[test]
fn sentences_leave_planner_messages_out_until_they_are_asked_for() {
    let mut screen = Screen::running();
    let mut said = tui::plain::Said::default();
    said.next(&screen.model);
    let log = |screen: &mut Screen, message: &str| {
        let (planner, level) = ("rpf".to_owned(), planner_api::LogLevel::Debug);
        let event = screen.mission.now(EventKind::PlannerLogged { planner, level, message: message.into() });
        screen.hear(RunMsg::Events(vec![event]));
    };
    log(&mut screen, "lane 3 of 9");
    assert!(!said.next(&screen.model).concat().contains("lane 3"));
    assert!(tui::plain::help(&screen.model).iter().any(|line| line.starts_with("planner-messages: ")));
    screen.act(tui::actions::ActionId::PlannerMessages);
    said.next(&screen.model);
    log(&mut screen, "lane 4 of 9");
    assert!(said.next(&screen.model).concat().contains("lane 4 of 9"));
}
