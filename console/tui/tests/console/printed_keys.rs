//! Every key printed on the screen does what the text beside it says, whichever keys the operator has chosen.

use crate::fixture::{RICH, Screen};
use crate::screens::text;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use std::sync::OnceLock;
use tui::actions::ACTIONS;
use tui::actions::keymap::{Binding, Keymap, PRESETS};
use tui::model::{Overlay, Screen as Name};
use tui::{Caps, Key, Model, view};

/// The maps of keys under which pictures are checked: the presets, the example of the guide, and one in which no action but those
/// that nobody can move keeps a key: there a key that is written by hand is bound to nothing.
fn maps() -> &'static [(&'static str, Keymap)] {
    static MADE: OnceLock<Vec<(&'static str, Keymap)>> = OnceLock::new();
    MADE.get_or_init(make_maps)
}

fn make_maps() -> Vec<(&'static str, Keymap)> {
    let example = [Binding { action: "hold".into(), keys: vec![Key::F(12)] }, bound("zoom-in", '=')];
    let mut names: Vec<&str> = ACTIONS.iter().map(|action| action.name).collect();
    names.sort_unstable();
    names.dedup();
    // Letters without small ones, so that what moves the robot may have them, too.
    let moved: Vec<Binding> =
        names.into_iter().zip('\u{1401}'..).map(|(name, key)| bound(name, key)).collect();
    let presets = PRESETS.map(|(name, changes)| (name, Keymap::new(changes, &[])));
    let own = [("example", Keymap::new(&[], &example)), ("moved", Keymap::new(&[], &moved))];
    let maps = presets.into_iter().chain(own);
    maps.map(|(name, (map, objections))| {
        assert_eq!(objections, [], "{name}");
        (name, map)
    })
    .collect()
}

fn bound(action: &str, key: char) -> Binding {
    Binding { action: action.into(), keys: vec![Key::Char(key)] }
}

/// Draws a model under every map and looks for keys that do nothing.
pub(crate) fn check(model: &Model, caps: Caps, size: (u16, u16)) {
    let mut model = model.clone();
    // This text was written with the keys of the model.
    model.console.notice = None;
    for (name, keys) in maps() {
        model.console.keys = keys.clone();
        let shown = drawn(&model, caps, size);
        assert_eq!(misprints(&shown, &model.console.keys), [""; 0], "under {name}:\n{shown}");
    }
}

fn drawn(model: &Model, caps: Caps, size: (u16, u16)) -> String {
    let mut terminal = Terminal::new(TestBackend::new(size.0, size.1)).unwrap();
    terminal.draw(|frame| view(model, &caps, frame)).unwrap();
    text(terminal.backend().buffer())
}

/// The same of a list or a line over a screen: of the rows in which it covers the middle of the screen only its own columns, because
/// it cuts words of the screen at its sides.
fn check_over(model: &Model, caps: Caps, size: (u16, u16)) {
    let (mut model, mut below) = (model.clone(), model.clone());
    below.ui.overlay = Overlay::None;
    for shown in [&mut model, &mut below] {
        shown.console.notice = None;
    }
    for (name, keys) in maps() {
        for shown in [&mut model, &mut below] {
            shown.console.keys = keys.clone();
        }
        let rows = |model: &Model| -> Vec<Vec<char>> {
            drawn(model, caps, size).lines().map(|row| row.chars().collect()).collect()
        };
        let (over, under) = (rows(&model), rows(&below));
        let differs = |row: usize, at: usize| over[row].get(at) != under.get(row).and_then(|row| row.get(at));
        let feet = over.len().saturating_sub(3);
        let columns: Vec<usize> = (1..feet)
            .flat_map(|row| (0..over[row].len()).map(move |at| (row, at)))
            .filter(|(row, at)| differs(*row, *at))
            .map(|(_, at)| at)
            .collect();
        let range = columns.iter().min().zip(columns.iter().max());
        let own = |(row, cells): (usize, &Vec<char>)| -> String {
            let is_cut = (1..feet).contains(&row) && (0..cells.len()).any(|at| differs(row, at));
            match range.filter(|_| is_cut) {
                Some((first, last)) => cells[*first..=(*last).min(cells.len() - 1)].iter().collect(),
                None => cells.iter().collect(),
            }
        };
        let shown: Vec<String> = over.iter().enumerate().map(own).collect();
        let shown = shown.join("\n");
        assert_eq!(misprints(&shown, keys), [""; 0], "under {name}:\n{shown}");
    }
}

/// The words that are printed as keys but are not keys, or are keys without an action.
fn misprints(shown: &str, keys: &Keymap) -> Vec<String> {
    let known =
        |word: &str| ACTIONS.iter().flat_map(|action| keys.of(action)).any(|key| key.to_string() == word);
    let printed = shown.lines().flat_map(|row| clauses(row).into_iter().chain(notes(row)));
    printed.filter(|word| !known(word)).collect()
}

/// Whether a word could be the name of a key.
fn is_key(word: &str) -> bool {
    let named = ["Enter", "Esc", "Tab", "space"].contains(&word) || word.starts_with("Ctrl-");
    named || word.starts_with('<') && word.ends_with('>') || word.chars().count() == 1
}

/// Keys at the beginning of a clause, before what they do: `X: end mission`, `n N: go to one`.
fn clauses(row: &str) -> Vec<String> {
    // A mark in the list of commands.
    let row = row.replace("-: not available", "");
    let clauses =
        ["  ", ". ", ", ", "; ", "? ", "(", "│", "─"].iter().fold(row, |row, end| row.replace(end, "\n"));
    let heads = clauses.lines().filter_map(|clause| {
        let (head, deed) = clause.split_once(": ")?;
        deed.starts_with(|c: char| c.is_ascii_lowercase()).then_some(head)
    });
    let words = heads.map(|head| head.split_whitespace().filter(|word| *word != "or").collect::<Vec<_>>());
    words.filter(|words| words.iter().all(|word| is_key(word))).flatten().map(str::to_owned).collect()
}

/// Keys at the right of a title: `z Z zoom  f follow`.
fn notes(row: &str) -> Vec<String> {
    let titles = row.split('┌').skip(1).filter_map(|title| title.split_once('┐'));
    let parts =
        titles.map(|(title, _)| title.split('─').filter(|part| !part.trim().is_empty()).collect::<Vec<_>>());
    let notes = parts.filter(|parts| parts.len() > 1).filter_map(|parts| parts.last().copied());
    notes.flat_map(keys_of_note).collect()
}

fn keys_of_note(note: &str) -> Vec<String> {
    // A note may count or explain something else.
    let is_legend = [" of ", " min", "% by", "▲", "* changed"].iter().any(|word| note.contains(word));
    let words = note.split_whitespace().map(|word| word.strip_suffix(':').unwrap_or(word));
    let words = words.filter(|word| !is_legend && is_key(word));
    words.map(str::to_owned).collect()
}

fn on_every_screen() -> impl Iterator<Item = (Screen, Name)> {
    let missions: [fn() -> Screen; 3] = [Screen::idle, Screen::running, Screen::held];
    missions.into_iter().flat_map(|mission| Name::ALL.iter().map(move |name| (mission(), *name)))
}

#[test]
fn a_refusal_names_keys_that_are_bound() {
    for (map, keys) in maps() {
        for (base, name) in on_every_screen() {
            for action in ACTIONS.iter() {
                let mut screen = base.clone();
                screen.model.console.keys = keys.clone();
                screen.model.ui.go(name);
                screen.act(action.id);
                let said = screen.model.notice().map(|notice| notice.text.clone()).unwrap_or_default();
                let refusal = tui::update::offered(&screen.model, action.id).err().unwrap_or_default();
                let found = [said, refusal].map(|words| misprints(&words, keys)).concat();
                assert_eq!(found, [""; 0], "{} on {} under {map}", action.name, name.name());
            }
        }
    }
}

#[test]
fn the_lists_and_lines_over_a_screen_print_keys_that_are_bound() {
    for (base, name) in on_every_screen() {
        for action in ACTIONS.iter() {
            let mut screen = base.clone();
            screen.model.ui.go(name);
            screen.act(action.id);
            if screen.model.ui.overlay != Overlay::None {
                check_over(&screen.model, RICH, (120, 36));
            }
        }
    }
}
