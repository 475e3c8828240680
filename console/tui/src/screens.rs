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
    screen: Screen,
    name: &'static str,
    /// What shows it: its digit, its command, its line in the help, and whether there is anything to show.
    go: Action,
    /// Draws it between the line on top and the lines at the foot.
    pub draw: fn(&Look, &mut Frame, Rect, Arrangement),
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

/// Where the filter of a list is.
#[derive(Clone, Copy)]
pub(crate) struct Filter {
    pub text: fn(&Model) -> &str,
    pub text_mut: fn(&mut Model) -> &mut String,
}

/// A screen on which Enter opens nothing and no line is selected.
const fn row(go: Action, name: &'static str, contexts: &'static [&'static [Context]], draw: Draw) -> Row {
    let ActionId::Go(screen) = go.id else { panic!("a screen is shown by an action of its own") };
    Row {
        screen,
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

type Draw = fn(&Look, &mut Frame, Rect, Arrangement);

/// What shows a screen.
const fn shows(screen: Screen, name: &'static str, about: &'static str, keys: &'static [Key]) -> Action {
    action(ActionId::Go(screen), name, about, keys, &[Context::Screen])
}

/// Every screen, in the order of the digits.
const ROWS: &[Row] = &[
    Row {
        opens: |_| Some("open"),
        enter: go::open_selected,
        select: |model, by| model.home.select(by),
        filter: Some(Filter { text: |model| &model.home.filter, text_mut: |model| &mut model.home.filter }),
        run: go::run_at_home,
        lists_runs: true,
        ..row(
            shows(Screen::Home, "home", "Screen 1: scenarios and past runs", &[Key::Char('1')]),
            "Home",
            &[&[On(Screen::Home), Rows]],
            view::home::draw,
        )
    },
    row(
        shows(Screen::Plan, "plan", "Screen 2: the plan before it moves", &[Key::Char('2')])
            .when(offer::is_open),
        "Plan",
        // Esc ends the cursor here, and nothing else.
        &[&[On(Screen::Plan), Map, Pan], &[Map, Pan, Cursor]],
        view::plan::draw,
    ),
    Row {
        active: |model| {
            let here = match model.ui.pane {
                _ if model.ui.cursor.is_some() => 3,
                Pane::Map => 0,
                Pane::Events => 1,
                _ => 2,
            };
            here + if model.live.is_replay() { 4 } else { 0 }
        },
        opens: |model| (model.ui.pane == Pane::Events).then_some("open"),
        enter: events::enter,
        select: |model, by| model.ui.events.select(by),
        ..row(
            shows(Screen::Mission, "mission", "Screen 3: the mission", &[Key::Char('3')])
                .when(offer::is_open),
            "Mission",
            &[
                &[On(Screen::Mission), Map, Pan],
                &[On(Screen::Mission), Map, Rows],
                &[On(Screen::Mission), Map],
                &[On(Screen::Mission), Map, Pan, Cursor],
                &[Replay, Map, Pan],
                &[Replay, Map, Rows],
                &[Replay, Map],
                &[Replay, Map, Pan, Cursor],
            ],
            view::mission,
        )
    },
    Row {
        opens: |_| Some("actions"),
        enter: alarms::open_actions,
        select: alarms::select,
        ..row(
            shows(Screen::Alarms, "alarms", "Screen 4: what is wrong, what to do", &[Key::Char('4')]),
            "Alarms",
            &[&[On(Screen::Alarms), Rows]],
            view::alarm_screen::draw,
        )
    },
    Row {
        opens: |model| Some(if model.ui.events.is_open { "close detail" } else { "detail" }),
        enter: events::enter,
        select: |model, by| model.ui.events.select(by),
        ..row(
            shows(Screen::Events, "events", "Screen 5: what happened", &[Key::Char('5')]),
            "Events",
            &[&[On(Screen::Events), Rows]],
            view::events::screen,
        )
    },
    Row {
        opens: |_| Some("replay"),
        enter: review::enter,
        select: |model, by| model.review.select(&model.home, by),
        filter: Some(Filter {
            text: |model| &model.review.filter,
            text_mut: |model| &mut model.review.filter,
        }),
        run: |model| model.review.run(&model.home).map(|run| run.name.clone()),
        lists_runs: true,
        ..row(
            shows(Screen::Review, "review", "Screen 6: past runs: replay, compare", &[Key::Char('6')]),
            "Review",
            &[&[On(Screen::Review), Rows]],
            view::review::draw,
        )
    },
    Row {
        select: go::select_missed,
        ..row(
            shows(Screen::Result, "result", "Screen 7: what was achieved", &[Key::Char('7')])
                .when(|model| offer::demand(model.live.result.is_some(), "no run has ended yet")),
            "Result",
            &[&[On(Screen::Result), Map, Rows], &[On(Screen::Result), Map, Pan, Cursor]],
            view::result::draw,
        )
    },
    Row {
        select: act::select_plugin,
        ..row(
            shows(Screen::Plugins, "plugins", "Screen 8: plugins and their planners", &[Key::Char('8')]),
            "Plugins",
            &[&[On(Screen::Plugins), Rows]],
            view::plugins::draw,
        )
    },
];

/// What shows each screen, as rows of the table of actions.
pub(crate) const GO: [Action; ROWS.len()] = {
    let mut all = [ROWS[0].go; ROWS.len()];
    let mut index = 1;
    while index < ROWS.len() {
        all[index] = ROWS[index].go;
        index += 1;
    }
    all
};

/// The contexts of their own that the screens have.
pub(crate) const EACH: [Context; ROWS.len()] = {
    let mut all = [On(Screen::Home); ROWS.len()];
    let mut index = 0;
    while index < ROWS.len() {
        all[index] = On(ROWS[index].screen);
        index += 1;
    }
    all
};

impl Screen {
    /// Every screen, in the order of their keys.
    pub const ALL: [Self; ROWS.len()] = {
        let mut all = [Self::Home; ROWS.len()];
        let mut index = 0;
        while index < ROWS.len() {
            all[index] = ROWS[index].screen;
            index += 1;
        }
        all
    };

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
        for screen in Screen::ALL {
            let row = screen.row();
            assert_eq!(row.screen, screen);
            assert_eq!(row.go.keys, [Key::Char(char::from(b'0' + screen.digit()))], "{}", row.name);
            assert_eq!(row.go.name, row.name.to_lowercase());
            assert!(row.go.about.starts_with(&format!("Screen {}: ", screen.digit())), "{}", row.go.about);
        }
    }
}
