//! What the line of keys and the help offer is what the keys do.

use crate::fixture::{RICH, Screen};
use crate::overviews::found;
use crate::screens::{drawn, text};
use crate::sizes::SIZES;
use mission::EventKind;
use tui::model::home::HomeList;
use tui::{Key, Msg, RunMsg};

fn shown(screen: &Screen, size: (u16, u16)) -> String {
    text(&drawn(&screen.model, RICH, size))
}

fn footer(screen: &Screen, size: (u16, u16)) -> String {
    shown(screen, size).lines().last().unwrap_or_default().to_owned()
}

fn said(screen: &Screen) -> String {
    screen.model.notice().map(|notice| notice.text.clone()).unwrap_or_default()
}

#[test]
fn during_a_mission_nothing_is_offered_that_enter_refuses() {
    for (way, list) in [("1", HomeList::Scenarios), ("1", HomeList::Runs), ("6", HomeList::Scenarios)] {
        let mut waiting = Screen::idle();
        let mut moving = Screen::running();
        for screen in [&mut waiting, &mut moving] {
            screen.send(Msg::Found(Box::new(found())));
            screen.send(Msg::Resize { width: 120, height: 36 });
            screen.type_text(way);
            (screen.model.home.list, screen.model.home.scenario) = (list, 0);
        }
        assert!(footer(&waiting, (120, 36)).contains("Enter"), "{way} {list:?}");
        assert!(!footer(&moving, (120, 36)).contains("Enter"), "{way} {list:?}");
        assert_eq!(moving.press([Key::Enter]), []);
        assert!(said(&moving).contains("a mission is in progress"), "{way} {list:?}: {}", said(&moving));
    }
}

#[test]
fn tab_is_in_the_line_of_keys_where_panes_have_no_keys_of_their_own() {
    let make: [fn() -> Screen; 2] = [Screen::idle, Screen::running];
    for (screen, ways) in make.into_iter().zip([["1", "2", "3"], ["3", "2", "5"]]) {
        for way in ways {
            for size in [(60, 16), (80, 24)] {
                let mut screen = screen();
                screen.send(Msg::Found(Box::new(found())));
                screen.send(Msg::Resize { width: size.0, height: size.1 });
                screen.type_text(way);
                let footer = footer(&screen, size);
                assert!(footer.contains("Tab pane"), "{way} {size:?}: {footer}");
            }
        }
    }
}

#[test]
fn the_scenario_that_is_open_is_marked_and_selected_when_home_is_first_shown() {
    let mut screen = Screen::idle();
    let found = found();
    let open = found.scenarios.iter().position(|entry| entry.name == "cover-unknown-columns").unwrap();
    screen.model.live.source = Some(found.scenarios[open].source.clone());
    screen.send(Msg::Found(Box::new(found.clone())));
    assert_eq!(screen.model.home.scenario, open);
    screen.type_text("1");
    for size in SIZES {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        let text = shown(&screen, size);
        let line = text.lines().find(|line| line.contains(">cover-unknown-columns")).unwrap_or_default();
        assert!(line.contains("open, ready"), "{size:?}\n{text}");
    }
    screen.press([Key::Up]);
    screen.send(Msg::Found(Box::new(found)));
    assert_eq!(screen.model.home.scenario, open - 1, "a later look at the disk leaves the selection");
}

#[test]
fn the_help_lists_the_keys_of_the_screen_and_is_paged() {
    let mut screen = Screen::idle();
    screen.send(Msg::Found(Box::new(found())));
    screen.type_text("1?");
    let text = shown(&screen, (200, 60));
    for words in ["This screen: Home", "Open the selected line: open", "Filter the list", "Ten lines down"] {
        assert!(text.contains(words), "{words}\n{text}");
    }
    let selected = |screen: &Screen| match &screen.model.ui.overlay {
        tui::model::Overlay::Commands(palette) => palette.selected,
        other => panic!("{other:?}"),
    };
    let mut at = Vec::new();
    for key in [Key::PageDown, Key::PageUp, Key::End, Key::Home] {
        screen.press([key]);
        at.push(selected(&screen));
    }
    assert!(at[0] == 10 && at[1] == 0 && at[2] > 20 && at[3] == 0, "{at:?}");
}

#[test]
fn the_text_of_an_event_uses_the_width_and_ends_in_an_ellipsis_where_it_is_cut() {
    let mut screen = Screen::running();
    let message = "alpha, bravo; charlie, delta; echo, foxtrot; golf, hotel; india, juliett; kilo, lima; mike, \
                   november; oscar, papa; quebec, romeo; sierra, tango; uniform, victor; whiskey, x-ray; yankee, zulu";
    let (planner, level) = ("rpf".to_owned(), planner_api::LogLevel::Warn);
    let event = screen.mission.now(EventKind::PlannerLogged { planner, level, message: message.into() });
    screen.hear(RunMsg::Events(vec![event]));
    screen.type_text("5");
    for size in SIZES {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        let text = shown(&screen, size);
        let row = text.lines().find(|line| line.contains("T+") && line.contains("alpha")).unwrap_or_default();
        let row = row.split('│').nth(1).unwrap_or_default().trim_end_matches('█');
        assert!(row.contains("zulu") || row.trim_end().ends_with('…'), "{size:?}: {row}");
        // The row is cut between two words, so the blanks behind it are too few for the next word.
        let blank = row.len() - row.trim_end().len();
        let last = row.trim_end().trim_end_matches('…').rsplit(' ').next().unwrap_or_default();
        let rest = message.split_once(last).map_or("", |(_, rest)| rest);
        let next = rest.trim_start_matches([',', ';', ' ']).split(' ').next().unwrap_or_default();
        assert!(row.contains("zulu") || blank <= next.len() + 1, "the width is used at {size:?}: {row}");
    }
}

#[test]
fn a_long_filter_and_the_reason_of_a_shelved_alarm_are_whole_on_a_small_screen() {
    let mut screen = Screen::running();
    screen.send(Msg::Resize { width: 60, height: 16 });
    screen.type_text("5/");
    screen.type_text("sev>=watch source=ae,tether station=C t>00:05 -lane -column -reel end");
    let words = |screen: &Screen| shown(screen, (60, 16)).replace(['│', '\n', ' '], "");
    assert!(words(&screen).contains("-lane-column-reelend"), "{}", shown(&screen, (60, 16)));
    let mut screen = Screen::running();
    screen.send(Msg::Resize { width: 60, height: 16 });
    let lost = screen.mission.now(EventKind::PositionLost { error_m: 0.2, limit_m: 0.15 });
    screen.hear(RunMsg::Events(vec![lost]));
    let wait = screen.mission.wait(30);
    screen.hear(RunMsg::Events(wait));
    screen.type_text("4");
    let table = screen.model.live.run.alarms.table();
    let cause = table.iter().find(|alarm| alarm.severity == mission::Severity::Watch).unwrap().cause.clone();
    screen.model.ui.alarm = Some(cause.clone());
    let reason = "the tank is being filled and the pump beside station two is loud".to_owned();
    let note =
        mission::Noted::Shelved { alarm: cause.key(), text: "position lost".into(), for_s: 600.0, reason };
    let t_s = screen.model.live.run.clock.t_s;
    screen.model.live.run.alarms.take(&mission::Note { what: note, by: None }, t_s);
    let text = shown(&screen, (60, 16));
    let words: String = text.replace(['│', '\n'], " ").split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("the tank is being filled and the pump beside station two is loud"), "{text}");
}
