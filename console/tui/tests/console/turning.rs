//! Turning between the panes of a screen, and scrolling the details of the selected row.

use crate::fixture::{RICH, Screen};
use crate::overviews::found;
use crate::screens::{drawn, text};
use crate::sizes::{self, SIZES};
use mission::EventKind;
use tui::model::home::HomeList;
use tui::model::{Alarms, Pane, ui::Arrangement};
use tui::{Key, Msg};

/// The screens with a list, each with a selected row.
const LISTS: [&str; 4] = ["4", "5", "6", "8"];

fn with_rows() -> Screen {
    let mut screen = Screen::running();
    screen.send(Msg::Found(Box::new(found())));
    let lost = screen.mission.now(EventKind::PositionLost { error_m: 0.5, limit_m: 0.15 });
    screen.hear(tui::RunMsg::Events(vec![lost]));
    let wait = screen.mission.wait(30);
    screen.hear(tui::RunMsg::Events(wait));
    assert!(screen.model.selected_alarm().is_some());
    screen
}

fn on(screen: &Screen, way: &str, (width, height): (u16, u16)) -> Screen {
    let mut screen = screen.clone();
    screen.send(Msg::Resize { width, height });
    screen.type_text(way);
    screen
}

fn shown(screen: &Screen, size: (u16, u16)) -> String {
    text(&drawn(&screen.model, RICH, size))
}

#[test]
fn tab_and_the_keys_in_the_titles_go_to_the_details_and_back() {
    let rows = with_rows();
    for way in LISTS {
        for size in SIZES {
            let mut screen = on(&rows, way, size);
            assert_eq!(screen.model.ui.focus(), Pane::List, "{way} {size:?}");
            screen.press([Key::Tab]);
            assert_eq!(screen.model.ui.focus(), Pane::Detail, "{way} {size:?}");
            let text = shown(&screen, size);
            assert_eq!(text.matches('▸').count(), 1, "one pane has the mark\n{text}");
            screen.press([Key::Tab]);
            assert_eq!(screen.model.ui.focus(), Pane::List, "{way} {size:?}");
            let is_wide = Arrangement::of(size.0, size.1) == Arrangement::Wide;
            let text = shown(&screen, size);
            assert_eq!(text.contains("F2 ") && text.contains("F3 "), is_wide, "{way} {size:?}\n{text}");
            if is_wide {
                screen.press([Key::F(3)]);
                assert_eq!(screen.model.ui.focus(), Pane::Detail, "{way} {size:?}");
                screen.press([Key::F(2)]);
                assert_eq!(screen.model.ui.focus(), Pane::List, "{way} {size:?}");
            }
        }
    }
}

#[test]
fn the_keys_in_the_titles_of_home_go_to_its_lists() {
    let mut screen = on(&with_rows(), "1", (120, 36));
    let lists =
        [(Key::F(3), HomeList::Runs), (Key::F(4), HomeList::Attention), (Key::F(2), HomeList::Scenarios)];
    for (key, list) in lists {
        screen.press([key]);
        assert_eq!(screen.model.home.list, list);
    }
    let text = shown(&screen, (120, 36));
    for title in ["F2 Scenarios", "F3 Past runs", "F4 Attention"] {
        assert!(text.contains(title), "{title}\n{text}");
    }
}

#[test]
fn the_last_row_of_every_detail_can_be_reached() {
    let mut rows = with_rows();
    for planner in &mut rows.model.console.planners {
        let last = planner.parameters[0].clone();
        planner
            .parameters
            .extend((0..20).map(|n| mission::ParamInfo { key: format!("key_{n}"), ..last.clone() }));
    }
    let last = |way: &str| match way {
        "4" => "Residuals",
        "5" => "journal",
        "6" => "folder",
        _ => "key_19",
    };
    for way in LISTS {
        for size in SIZES {
            let mut screen = on(&rows, way, size);
            screen.press([Key::Tab, Key::End]);
            let text = shown(&screen, size);
            assert!(text.contains(last(way)), "{way} {size:?}\n{text}");
            let scrolled = screen.model.ui.scrolled;
            screen.press([Key::Down]);
            assert_eq!(screen.model.ui.scrolled, scrolled, "the end was reached: {way} {size:?}");
            screen.press([Key::Home]);
            assert_eq!(screen.model.ui.scrolled, 0);
        }
    }
    let mut small = on(&rows, "8", (80, 24));
    assert!(!shown(&small, (80, 24)).contains("key_19"), "it is cut before");
    assert!(shown(&small, (80, 24)).contains("Tab pane"), "the title says how to see the rest");
    small.press([Key::Tab, Key::PageDown]);
    assert!(small.model.ui.scrolled > 0);
}

#[test]
fn without_a_selected_row_only_the_list_responds_and_the_message_says_so() {
    let mut screen = on(&Screen::idle(), "4", (120, 36));
    assert!(screen.model.selected_alarm().is_none());
    screen.press([Key::Tab]);
    assert_eq!(screen.model.ui.focus(), Pane::List);
    let said = screen.model.notice().map(|notice| notice.text.clone()).unwrap_or_default();
    assert!(said.contains("nothing is selected"), "{said}");
}

#[test]
fn a_small_screen_names_itself_in_its_title() {
    let rows = with_rows();
    let names = ["1 Home", "2 Plan", "3 Mission", "4 Alarms", "5 Events", "6 Review", "8 Plugins"];
    for name in names {
        let screen = on(&rows, &name[..1], (60, 16));
        let text = shown(&screen, (60, 16));
        assert!(text.lines().nth(1).unwrap_or_default().contains(name), "{name}\n{text}");
    }
}

#[test]
fn the_line_of_screens_is_shown_from_80x24() {
    let rows = with_rows();
    for way in ["1", "2", "3", "4", "5", "6", "8"] {
        for size in [(80, 24), (100, 30), (120, 30), (120, 36), (200, 60)] {
            let text = shown(&on(&rows, way, size), size);
            let line = text.lines().nth(1).unwrap_or_default();
            let has_all = (1..=8).all(|digit| line.contains(&digit.to_string()));
            assert!(has_all && line.contains(&format!("[{way} ")), "{way} {size:?}\n{text}");
        }
    }
}

#[test]
fn without_an_alarm_the_limits_that_are_watched_are_shown_with_their_values() {
    let mut screen = Screen::tethered();
    screen.send(Msg::Found(Box::new(found())));
    screen.model.live.run.alarms = Alarms::default();
    screen.type_text("4");
    sizes::store("alarms_quiet", &mut screen, sizes::is_log);
    for size in [(80, 24), (120, 36), (200, 60)] {
        let text = shown(&on(&screen, "4", size), size);
        for words in ["Limits that are watched", "AE error", "±0.15 m", "tether", "disk space left", "200 MB"]
        {
            assert!(text.contains(words), "{words} at {size:?}\n{text}");
        }
    }
    let large = shown(&on(&screen, "4", (200, 60)), (200, 60));
    let blank = large.lines().filter(|row| row.replace(['│', ' '], "").is_empty()).count();
    assert!(blank <= 20, "{blank} of 60 rows are blank\n{large}");
}
