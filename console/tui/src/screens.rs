//! The screens, a row each: its digit and name, what it shows, and what Enter, the arrow keys and a filter do on it.
//!
//! A new screen is a variant and a row here, and a folder for what its row names.

use crate::actions::context::Context::{self, Cursor, Map, On, Pan, Replay, Rows};
use crate::actions::{Action, ActionId, action};
use crate::keys::Key;
use crate::model::{Model, Pane, ui::Arrangement};
use crate::update::{Effect, act, alarms, events, go, offer, review};
use crate::view::{self, look::Look};
use ratatui::{Frame, layout::Rect};
use serde::{Deserialize, Serialize};

/// A screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
pub enum Screen {
    /// What there is to open.
    #[default]
    Home,
    /// A mission before it moves.
    Plan,
    /// A mission under way.
    Mission,
    /// What is wrong.
    Alarms,
    /// What happened.
    Events,
    /// Past runs.
    Review,
    /// What a mission has achieved.
    Result,
    /// Which plugins there are.
    Plugins,
}

/// What a screen is.
#[derive(Clone, Copy)]
pub(crate) struct Row {
    name: &'static str,
    /// What shows it: its digit, its command, its line in the help, and whether there is anything to show.
    go: Action,
    /// Draws it between the line on top and the lines at the foot.
    pub draw: Draw,
    /// The contexts that can be active on it; on a screen with a map the last ones are those of its cursor.
    contexts: &'static [&'static [Context]],
    /// Which of them are active.
    active: fn(&Model) -> usize,
    /// The word beside Enter in the footer; `None` while there is nothing to open.
    pub opens: fn(&Model) -> Option<&'static str>,
    /// What Enter does, if it opens anything.
    pub enter: fn(&mut Model) -> Vec<Effect>,
    /// Selects another line, so many further down.
    pub select: fn(&mut Model, isize),
    /// The text by which its list is filtered; `None` where it is the filter of the events.
    pub filter: Option<Filter>,
    /// The run that a command is about.
    pub run: fn(&Model) -> Option<String>,
    /// Whether it lists what is on the disk: that is looked at whenever the screen is shown.
    pub lists_runs: bool,
}

/// The text of a filter, to read and to write.
type Filter = (fn(&Model) -> &str, fn(&mut Model) -> &mut String);
type Draw = fn(&Look, &mut Frame, Rect, Arrangement);

/// A screen on which Enter opens nothing and no line is selected.
const fn row(go: Action, name: &'static str, contexts: &'static [&'static [Context]], draw: Draw) -> Row {
    Row {
        name,
        go,
        draw,
        contexts,
        active: |model| usize::from(model.ui.cursor.is_some()),
        opens: |_| None,
        enter: |_| Vec::new(),
        select: |_, _| {},
        filter: None,
        run: go::open_run,
        lists_runs: false,
    }
}

/// What shows a screen.
const fn shows(screen: Screen, name: &'static str, about: &'static str, keys: &'static [Key]) -> Action {
    action(ActionId::Go(screen), name, about, keys, &[Context::Screen])
}

/// Every screen, in the order of the digits.
#[rustfmt::skip]
const ROWS: &[Row] = &[
    Row { lists_runs: true, opens: |_| Some("open"), enter: go::open_selected, select: |m, by| m.home.select(by),
        filter: Some((|m| &m.home.filter, |m| &mut m.home.filter)), run: go::run_at_home,
        ..row(shows(Screen::Home, "home", "Screen 1: scenarios and past runs", &[Key::Char('1')]), "Home",
            &[&[On(Screen::Home), Rows]], view::home::draw) },
    // Esc ends the cursor here, and nothing else.
    row(shows(Screen::Plan, "plan", "Screen 2: the plan before it moves", &[Key::Char('2')]).when(offer::is_open), "Plan",
        &[&[On(Screen::Plan), Map, Pan], &[Map, Pan, Cursor]], view::plan::draw),
    Row { active: of_mission, opens: |m| (m.ui.pane == Pane::Events).then_some("open"), enter: events::enter,
        select: |m, by| m.ui.events.select(by),
        ..row(shows(Screen::Mission, "mission", "Screen 3: the mission", &[Key::Char('3')]).when(offer::is_open), "Mission",
            &[&[On(Screen::Mission), Map, Pan], &[On(Screen::Mission), Map, Rows], &[On(Screen::Mission), Map],
              &[On(Screen::Mission), Map, Pan, Cursor],
              &[Replay, Map, Pan], &[Replay, Map, Rows], &[Replay, Map], &[Replay, Map, Pan, Cursor]], view::mission) },
    Row { opens: |_| Some("actions"), enter: alarms::open_actions, select: alarms::select,
        ..row(shows(Screen::Alarms, "alarms", "Screen 4: what is wrong, what to do", &[Key::Char('4')]), "Alarms",
            &[&[On(Screen::Alarms), Rows]], view::alarm_screen::draw) },
    Row { opens: |m| Some(if m.ui.events.is_open { "close detail" } else { "detail" }), enter: events::enter,
        select: |m, by| m.ui.events.select(by),
        ..row(shows(Screen::Events, "events", "Screen 5: what happened", &[Key::Char('5')]), "Events",
            &[&[On(Screen::Events), Rows]], view::events::screen) },
    Row { lists_runs: true, opens: |_| Some("replay"), enter: review::enter, select: |m, by| m.review.select(&m.home, by),
        filter: Some((|m| &m.review.filter, |m| &mut m.review.filter)),
        run: |m| m.review.run(&m.home).map(|run| run.name.clone()),
        ..row(shows(Screen::Review, "review", "Screen 6: past runs: replay, compare", &[Key::Char('6')]), "Review",
            &[&[On(Screen::Review), Rows]], view::review::draw) },
    Row { select: go::select_missed,
        ..row(shows(Screen::Result, "result", "Screen 7: what was achieved", &[Key::Char('7')])
                .when(|m| offer::demand(m.live.result.is_some(), "no run has ended yet")), "Result",
            &[&[On(Screen::Result), Map, Rows], &[On(Screen::Result), Map, Pan, Cursor]], view::result::draw) },
    Row { select: act::select_plugin,
        ..row(shows(Screen::Plugins, "plugins", "Screen 8: plugins and their planners", &[Key::Char('8')]), "Plugins",
            &[&[On(Screen::Plugins), Rows]], view::plugins::draw) },
];

/// Which contexts the mission screen has: by its pane or its cursor, then the same for a replay.
fn of_mission(model: &Model) -> usize {
    let here = match model.ui.pane {
        _ if model.ui.cursor.is_some() => 3,
        Pane::Map => 0,
        Pane::Events => 1,
        _ => 2,
    };
    here + if model.live.is_replay() { 4 } else { 0 }
}

/// The contexts of their own that the screens have.
#[rustfmt::skip]
pub(crate) const EACH: &[Context; ROWS.len()] = &[
    On(Screen::Home), On(Screen::Plan), On(Screen::Mission), On(Screen::Alarms),
    On(Screen::Events), On(Screen::Review), On(Screen::Result), On(Screen::Plugins),
];

impl Screen {
    /// Every screen, in the order of their keys.
    #[rustfmt::skip]
    pub const ALL: [Self; ROWS.len()] = [
        Self::Home, Self::Plan, Self::Mission, Self::Alarms, Self::Events, Self::Review, Self::Result, Self::Plugins,
    ];

    pub(crate) fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }

    /// Its name, as the top line shows it.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The digit that selects it.
    pub fn digit(self) -> u8 {
        self as u8 + 1
    }

    /// Whether it has a map.
    pub(crate) fn has_map(self) -> bool {
        self.row().contexts.iter().any(|contexts| contexts.contains(&Map))
    }
}

/// What shows each screen, as rows of the table of actions.
pub(crate) fn actions() -> Vec<Action> {
    ROWS.iter().map(|row| row.go).collect()
}

/// The contexts of the screen that is shown, with nothing over it.
pub(crate) fn contexts(model: &Model) -> &'static [Context] {
    let row = model.ui.screen.row();
    let last = row.contexts.len() - 1;
    row.contexts[(row.active)(model).min(last)]
}

/// Every set of contexts that can be active on a screen with nothing over it.
pub(crate) fn together() -> impl Iterator<Item = &'static [Context]> {
    ROWS.iter().flat_map(|row| row.contexts).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_screen_has_the_row_of_its_place_and_the_key_of_its_digit() {
        for (screen, context) in Screen::ALL.into_iter().zip(EACH) {
            let row = screen.row();
            assert_eq!((row.go.id, *context), (ActionId::Go(screen), On(screen)));
            assert_eq!(row.go.keys, [Key::Char(char::from(b'0' + screen.digit()))], "{}", row.name);
            assert_eq!(row.go.name, row.name.to_lowercase());
            assert!(row.go.about.starts_with(&format!("Screen {}: ", screen.digit())), "{}", row.go.about);
        }
    }
}
