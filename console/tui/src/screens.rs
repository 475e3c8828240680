//! The screens, one row each: digit and name, contents, and the effect of Enter, of the arrow keys and of a filter.
//!
//! A new screen needs a variant, a row and its entries in `EACH` and [`Screen::ALL`] here, and one module for the functions that
//! its row names.

use crate::actions::context::Context::{self, Cursor, Map, On, Pan, Replay, Rows};
use crate::actions::{Action, ActionId, action};
use crate::keys::Key;
use crate::model::{Model, Pane, ui::Arrangement};
use crate::update::{Effect, act, alarms, events, go, offer, place, review, stations};
use crate::view::{self, look::Look, scroll::Extent};
use ratatui::{Frame, layout::Rect};
use serde::{Deserialize, Serialize};

/// A screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
pub enum Screen {
    /// Scenarios and past runs to open.
    #[default]
    Home,
    /// A mission before the start.
    Plan,
    /// A mission under way.
    Mission,
    /// Alarms.
    Alarms,
    /// Events.
    Events,
    /// Past runs.
    Review,
    /// The result of a mission.
    Result,
    /// Plugins.
    Plugins,
}

/// The definition of a screen.
#[derive(Clone, Copy)]
pub(crate) struct Row {
    name: &'static str,
    /// The action that shows the screen: its digit, command and help text, and whether there is anything to show.
    go: Action,
    /// Draws the screen between the top line and the bottom lines.
    pub draw: Draw,
    /// The sets of contexts that can be active on the screen; on a screen with a map, the last sets apply while the
    /// map cursor is open.
    contexts: &'static [&'static [Context]],
    /// The index of the active set of contexts.
    active: fn(&Model) -> usize,
    /// The main action on the screen; the footer shows its key first.
    pub first: ActionId,
    /// The label of Enter in the footer; `None` while there is nothing to open.
    pub opens: fn(&Model) -> Option<&'static str>,
    /// The effect of Enter, if there is anything to open.
    pub enter: fn(&mut Model) -> Vec<Effect>,
    /// Moves the selection down by the given number of lines.
    pub select: fn(&mut Model, isize),
    /// Whether a row of the screen's list is selected, so that its details can be shown.
    pub has_selection: fn(&Model) -> bool,
    /// How much of the details of the selected row is visible in the area of the screen; `None` if the screen shows no
    /// such pane.
    pub detail: fn(&Look, Rect) -> Option<Extent>,
    /// The filter of the screen's list; `None` if it uses the event filter.
    pub filter: Option<Filter>,
    /// The run to which a command on this screen applies.
    pub run: fn(&Model) -> Option<String>,
    /// Whether the screen lists files; the disk is then rescanned whenever the screen is shown.
    pub lists_runs: bool,
}

/// Read and write access to the text of a filter.
type Filter = (fn(&Model) -> &str, fn(&mut Model) -> &mut String);
type Draw = fn(&Look, &mut Frame, Rect, Arrangement);

/// Creates a screen on which Enter opens nothing and no line can be selected.
const fn row(go: Action, name: &'static str, contexts: &'static [&'static [Context]], draw: Draw) -> Row {
    Row {
        name,
        go,
        draw,
        contexts,
        active: |model| usize::from(model.ui.cursor.is_some()),
        first: ActionId::Accept,
        opens: |_| None,
        enter: |_| Vec::new(),
        select: |_, _| {},
        has_selection: |_| false,
        detail: |_, _| None,
        filter: None,
        run: go::open_run,
        lists_runs: false,
    }
}

/// Creates the action that shows a screen.
const fn shows(screen: Screen, name: &'static str, about: &'static str, keys: &'static [Key]) -> Action {
    action(ActionId::Go(screen), name, about, keys, &[Context::Screen])
}

/// All screens, in the order of their digits.
#[rustfmt::skip]
const ROWS: &[Row] = &[
    Row { lists_runs: true, opens: go::opens_at_home, enter: go::open_selected, select: |m, by| m.home.select(by),
        filter: Some((|m| &m.home.filter, |m| &mut m.home.filter)), run: go::run_at_home,
        ..row(shows(Screen::Home, "home", "Screen 1: scenarios and past runs", &[Key::Char('1')]), "Home",
            &[&[On(Screen::Home), Rows]], view::home::draw) },
    // Esc closes the cursor here and does nothing else.
    Row { first: ActionId::Start, active: of_plan, opens: |m| m.left_out_at().map(|_| "on the map"), enter: place::left_out, select: place::select_left_out,
        ..row(shows(Screen::Plan, "plan", "Screen 2: the plan before the start", &[Key::Char('2')]).when(offer::is_open), "Plan",
            &[&[On(Screen::Plan), Map, Pan], &[On(Screen::Plan), Map, Rows], &[On(Screen::Plan), Map], &[Map, Pan, Cursor]],
            view::plan::draw) },
    Row { first: ActionId::Hold, active: of_mission, opens: opens_on_mission, enter: enter_on_mission, select: select_on_mission,
        ..row(shows(Screen::Mission, "mission", "Screen 3: the mission", &[Key::Char('3')]).when(offer::is_open), "Mission",
            &[&[On(Screen::Mission), Map, Pan], &[On(Screen::Mission), Map, Rows], &[On(Screen::Mission), Map],
              &[On(Screen::Mission), Map, Pan, Cursor],
              &[Replay, Map, Pan], &[Replay, Map, Rows], &[Replay, Map], &[Replay, Map, Pan, Cursor]], view::mission) },
    Row { first: ActionId::Acknowledge, opens: |m| m.selected_alarm().map(|_| "actions"), enter: alarms::open_actions, select: alarms::select,
        has_selection: |m| m.selected_alarm().is_some(), detail: view::alarm_screen::extent,
        ..row(shows(Screen::Alarms, "alarms", "Screen 4: what is wrong, what to do", &[Key::Char('4')]), "Alarms",
            &[&[On(Screen::Alarms), Rows]], view::alarm_screen::draw) },
    Row { opens: events::opens, enter: events::enter, select: |m, by| m.ui.events.select(by), has_selection: |m| m.ui.events.selected().is_some(), detail: view::events::extent,
        ..row(shows(Screen::Events, "events", "Screen 5: what happened", &[Key::Char('5')]), "Events",
            &[&[On(Screen::Events), Rows]], view::events::screen) },
    Row { lists_runs: true, opens: review::opens, enter: review::enter, select: |m, by| m.review.select(&m.home, by),
        has_selection: |m| m.review.run(&m.home).is_some(), detail: view::review::extent,
        filter: Some((|m| &m.review.filter, |m| &mut m.review.filter)),
        run: |m| m.review.run(&m.home).map(|run| run.name.clone()),
        ..row(shows(Screen::Review, "review", "Screen 6: past runs: replay, compare", &[Key::Char('6')]), "Review",
            &[&[On(Screen::Review), Rows]], view::review::draw) },
    Row { first: ActionId::Rescan, select: go::select_in_result,
        ..row(shows(Screen::Result, "result", "Screen 7: what was achieved", &[Key::Char('7')])
                .when(|m| offer::demand(m.live.result.is_some(), offer::no_result(m))), "Result",
            &[&[On(Screen::Result), Map, Rows], &[On(Screen::Result), Map, Pan, Cursor]], view::result::draw) },
    Row { first: ActionId::Reload, select: act::select_plugin, has_selection: act::has_plugin, detail: view::plugins::extent,
        ..row(shows(Screen::Plugins, "plugins", "Screen 8: plugins and their planners", &[Key::Char('8')]), "Plugins",
            &[&[On(Screen::Plugins), Rows]], view::plugins::draw) },
];

/// The index of the plan screen's contexts: by pane or cursor.
fn of_plan(model: &Model) -> usize {
    match model.ui.pane {
        _ if model.ui.cursor.is_some() => 3,
        Pane::LeftOut => 1,
        Pane::Map => 0,
        _ => 2,
    }
}

/// The index of the mission screen's contexts: by pane or cursor, followed by the same sets for a replay.
fn of_mission(model: &Model) -> usize {
    let here = match model.ui.pane {
        _ if model.ui.cursor.is_some() => 3,
        Pane::Map => 0,
        Pane::Events | Pane::Stations => 1,
        _ => 2,
    };
    here + if model.live.is_replay() { 4 } else { 0 }
}

/// The label of Enter on the mission screen.
fn opens_on_mission(model: &Model) -> Option<&'static str> {
    match model.ui.pane {
        Pane::Events => Some("open"),
        Pane::Stations => stations::opens(model),
        _ => None,
    }
}

fn enter_on_mission(model: &mut Model) -> Vec<Effect> {
    if model.ui.pane == Pane::Stations { stations::open(model) } else { events::enter(model) }
}

fn select_on_mission(model: &mut Model, by: isize) {
    if model.ui.pane == Pane::Stations { stations::select(model, by) } else { model.ui.events.select(by) }
}

/// The screen-specific contexts.
#[rustfmt::skip]
pub(crate) const EACH: &[Context; ROWS.len()] = &[
    On(Screen::Home), On(Screen::Plan), On(Screen::Mission), On(Screen::Alarms),
    On(Screen::Events), On(Screen::Review), On(Screen::Result), On(Screen::Plugins),
];

impl Screen {
    /// All screens, in the order of their keys.
    #[rustfmt::skip]
    pub const ALL: [Self; ROWS.len()] = [
        Self::Home, Self::Plan, Self::Mission, Self::Alarms, Self::Events, Self::Review, Self::Result, Self::Plugins,
    ];

    pub(crate) fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }

    /// The screen's name in the top line.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The digit that shows the screen.
    pub fn digit(self) -> u8 {
        self as u8 + 1
    }

    /// Whether the screen has a map.
    pub(crate) fn has_map(self) -> bool {
        self.row().contexts.iter().any(|contexts| contexts.contains(&Map))
    }
}

/// The actions that show the screens, as rows of the action table.
pub(crate) fn actions() -> Vec<Action> {
    ROWS.iter().map(|row| row.go).collect()
}

/// The active contexts of the current screen without an overlay.
pub(crate) fn contexts(model: &Model) -> &'static [Context] {
    let row = model.ui.screen.row();
    let last = row.contexts.len() - 1;
    row.contexts[(row.active)(model).min(last)]
}

/// Every set of contexts that can be active on a screen without an overlay.
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
