//! The line of keys on every screen, at every size, in every state: whole keys only, the most important first.

use crate::ending;
use crate::fixture::{RICH, Screen};
use crate::overviews;
use crate::replay::replaying;
use crate::screens::{drawn_as_is, text};
use crate::sizes::SIZES;
use mission::{Outcome, Severity};
use tui::{Key, Msg};

/// The states that the keys depend on, each with a name.
fn states() -> Vec<(&'static str, Screen)> {
    let mut ended = Screen::running();
    let end = ended.mission.ended(Outcome::Complete, "task complete");
    ended.hear(tui::RunMsg::Events(vec![end]));
    let mut failed = Screen::running();
    let events = failed.mission.planner_fails();
    failed.hear(tui::RunMsg::Events(events));
    let mut home = Screen::idle();
    home.send(Msg::Found(Box::new(overviews::found())));
    vec![
        ("with past runs", home),
        ("opened", Screen::opened()),
        ("before the start", Screen::idle()),
        ("moving", Screen::running()),
        ("on a tether", Screen::tethered()),
        ("held", Screen::held()),
        ("failed", failed),
        ("ended", ended),
        ("result", overviews::ended().0),
        ("driving back", ending::driving_back()),
        ("replay", replaying(false)),
        ("comparison", replaying(true)),
    ]
}

/// Keys that open each screen, and the overlays on it.
const WAYS: [&str; 21] = [
    "1", "2", "3", "4", "5", "6", "7", "8", "4d", "5/x", "5", "3S", "3X", "3P", "3p", "3L", "3i", "?", ":z",
    "2A", "q",
];

/// The entries of the line of keys: key and label.
fn entries(screen: &Screen, size: (u16, u16)) -> (String, Vec<String>) {
    let shown = text(&drawn_as_is(&screen.model, RICH, size));
    let line = shown.lines().last().unwrap_or_default().to_owned();
    let entries = line.split("  ").map(str::trim).filter(|entry| !entry.is_empty()).map(str::to_owned);
    let entries = entries.collect();
    (line, entries)
}

fn each(mut check: impl FnMut(&str, &mut Screen, (u16, u16))) {
    for (name, state) in states() {
        for way in WAYS {
            for size in SIZES {
                let mut screen = state.clone();
                screen.send(Msg::Resize { width: size.0, height: size.1 });
                screen.type_text(way);
                if way == "4" || way == "5" {
                    screen.press([Key::Enter]);
                }
                screen.pass(60.0);
                check(&format!("{name}, {way}, {size:?}"), &mut screen, size);
            }
        }
    }
}

#[test]
fn no_key_is_cut_and_the_most_important_ones_are_shown() {
    let mut n_lines = 0;
    each(|name, screen, size| {
        let (line, shown) = entries(screen, size);
        // A wider terminal of the same height has the same panes and room for every key.
        screen.send(Msg::Resize { width: if size.0 < 120 { 119 } else { 400 }, height: size.1 });
        let (_, all) = entries(screen, (300, size.1));
        let is_whole = |entry: &String| all.contains(entry) || entry.ends_with(" pane");
        let cut: Vec<&String> = shown.iter().filter(|entry| !is_whole(entry)).collect();
        assert!(cut.is_empty() && line.ends_with(' '), "{name}: {cut:?} in\n{line}\n{all:?}");
        for important in all.iter().filter(|entry| entry.ends_with(" HOLD") || entry.as_str() == "? keys") {
            assert!(shown.contains(important), "{name}: {important} is missing in\n{line}");
        }
        n_lines += 1;
    });
    assert!(n_lines > 900, "{n_lines}");
}

#[test]
fn a_message_beside_the_keys_cuts_none() {
    each(|name, screen, size| {
        screen.send(Msg::Notice { severity: Severity::Info, text: "Report written".into() });
        let (line, shown) = entries(screen, size);
        screen.send(Msg::Resize { width: if size.0 < 120 { 119 } else { 400 }, height: size.1 });
        let (_, all) = entries(screen, (300, size.1));
        let is_whole = |entry: &String| all.contains(entry) || entry.ends_with(" pane");
        assert!(shown.iter().all(is_whole), "{name}:\n{line}\n{all:?}");
    });
}
