//! Where keys mean something, and which of these places are active.

use crate::model::{Model, Overlay, Pane, Screen};

/// Where keys mean something.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Context {
    /// On every screen, in every list and line.
    Anywhere,
    /// On every screen with nothing over it.
    Screen,
    /// On the home screen.
    Home,
    /// On the plan screen.
    Plan,
    /// On the mission screen.
    Mission,
    /// On the alarms screen.
    Alarms,
    /// On the events screen.
    Events,
    /// On the mission screen while a past run is played back.
    Replay,
    /// On the review screen.
    Review,
    /// On the result screen.
    Result,
    /// On the plugins screen.
    Plugins,
    /// On a screen with a map.
    Map,
    /// While the map takes the arrow keys.
    Pan,
    /// While a cursor on the map takes the arrow keys.
    Cursor,
    /// While a list takes the arrow keys.
    Rows,
    /// In a list over the screen.
    List,
    /// In the comparison of forecasts.
    WhatIf,
    /// In the list of checks before the start.
    Preflight,
    /// In the list of parameters.
    Parameters,
    /// In the list of parameters that are changed for a forecast.
    Draft,
    /// In the actions of an alarm.
    Remedies,
    /// In a line where text is typed.
    Text,
    /// In a list that is filtered by typing.
    Commands,
    /// In the line that asks before something moves or ends.
    Confirm,
    /// In the line for single steps.
    Stepping,
}

impl Context {
    /// What people call it, as far as it is a screen.
    pub fn screen(self) -> Option<&'static str> {
        match self {
            Self::Home => Some("Home"),
            Self::Plan => Some("Plan"),
            Self::Mission => Some("Mission"),
            Self::Replay => Some("Replay"),
            Self::Review => Some("Review"),
            Self::Result => Some("Result"),
            Self::Plugins => Some("Plugins"),
            _ => None,
        }
    }

    /// Whether its actions are commands of their own, and no mere steps within a list or a line.
    pub fn has_commands(self) -> bool {
        use Context::{
            Alarms, Anywhere, Events, Home, Map, Mission, Pan, Plan, Plugins, Replay, Result, Review, Screen,
        };
        let of_screen =
            matches!(self, Home | Plan | Mission | Replay | Alarms | Events | Review | Result | Plugins);
        of_screen || matches!(self, Anywhere | Screen | Map | Pan)
    }
}

/// Every set of contexts that can be active together.
pub const TOGETHER: &[&[Context]] = &[
    &[Context::Anywhere, Context::Screen, Context::Home, Context::Rows],
    &[Context::Anywhere, Context::Screen, Context::Plan, Context::Map, Context::Pan],
    &[Context::Anywhere, Context::Screen, Context::Mission, Context::Map, Context::Pan],
    &[Context::Anywhere, Context::Screen, Context::Mission, Context::Map, Context::Rows],
    &[Context::Anywhere, Context::Screen, Context::Mission, Context::Map],
    &[Context::Anywhere, Context::Screen, Context::Replay, Context::Map, Context::Pan],
    &[Context::Anywhere, Context::Screen, Context::Replay, Context::Map, Context::Rows],
    &[Context::Anywhere, Context::Screen, Context::Replay, Context::Map],
    &[Context::Anywhere, Context::Screen, Context::Review, Context::Rows],
    &[Context::Anywhere, Context::Screen, Context::Result, Context::Map, Context::Rows],
    &[Context::Anywhere, Context::Screen, Context::Map, Context::Pan, Context::Cursor],
    &[Context::Anywhere, Context::Screen, Context::Mission, Context::Map, Context::Pan, Context::Cursor],
    &[Context::Anywhere, Context::Screen, Context::Replay, Context::Map, Context::Pan, Context::Cursor],
    &[Context::Anywhere, Context::Screen, Context::Result, Context::Map, Context::Pan, Context::Cursor],
    &[Context::Anywhere, Context::Screen, Context::Plugins, Context::Rows],
    &[Context::Anywhere, Context::List, Context::Rows],
    &[Context::Anywhere, Context::List, Context::Rows, Context::Parameters],
    &[Context::Anywhere, Context::List, Context::Rows, Context::Parameters, Context::Draft],
    &[Context::Anywhere, Context::List, Context::Rows, Context::Preflight],
    &[Context::Anywhere, Context::WhatIf, Context::Map],
    &[Context::Anywhere, Context::Text],
    &[Context::Anywhere, Context::Text, Context::Commands],
    &[Context::Anywhere, Context::Confirm],
    &[Context::Anywhere, Context::Stepping],
];

/// The contexts whose keys work now.
pub fn contexts(model: &Model) -> Vec<Context> {
    let here = match &model.ui.overlay {
        Overlay::None => return [&[Context::Anywhere, Context::Screen], of_screen(model)].concat(),
        Overlay::Confirm(_) | Overlay::Quit => [Context::Confirm].as_slice(),
        Overlay::Stepping => &[Context::Stepping],
        Overlay::Commands(_) => &[Context::Text, Context::Commands],
        Overlay::Parameters { edit: Some(_), .. }
        | Overlay::Filter(_)
        | Overlay::Shelve(_)
        | Overlay::Bookmark(_) => &[Context::Text],
        Overlay::Parameters { edit: None, .. }
            if model.live.what_if.as_ref().is_some_and(|what_if| what_if.draft.is_some()) =>
        {
            &[Context::List, Context::Rows, Context::Parameters, Context::Draft]
        }
        Overlay::Parameters { edit: None, .. } => &[Context::List, Context::Rows, Context::Parameters],
        Overlay::WhatIf => &[Context::WhatIf, Context::Map],
        Overlay::Preflight { .. } => &[Context::List, Context::Rows, Context::Preflight],
        Overlay::Remedies { .. } => &[Context::List, Context::Rows, Context::Remedies],
        Overlay::Planners { .. } | Overlay::Preset { .. } | Overlay::Layers { .. } => {
            &[Context::List, Context::Rows]
        }
    };
    [&[Context::Anywhere], here].concat()
}

/// The contexts of the screen that is shown, with nothing over it.
pub(crate) fn of_screen(model: &Model) -> &'static [Context] {
    let is_replay = model.live.is_replay();
    if model.ui.cursor.is_some() {
        match model.ui.screen {
            Screen::Home | Screen::Alarms | Screen::Events | Screen::Review | Screen::Plugins => {}
            // Esc ends the cursor here, and nothing else.
            Screen::Plan => return &[Context::Map, Context::Pan, Context::Cursor],
            Screen::Mission if is_replay => {
                return &[Context::Replay, Context::Map, Context::Pan, Context::Cursor];
            }
            Screen::Mission => return &[Context::Mission, Context::Map, Context::Pan, Context::Cursor],
            Screen::Result => return &[Context::Result, Context::Map, Context::Pan, Context::Cursor],
        }
    }
    match (model.ui.screen, model.ui.pane) {
        (Screen::Home, _) => &[Context::Home, Context::Rows],
        (Screen::Plan, _) => &[Context::Plan, Context::Map, Context::Pan],
        (Screen::Mission, Pane::Map) if is_replay => &[Context::Replay, Context::Map, Context::Pan],
        (Screen::Mission, Pane::Events) if is_replay => &[Context::Replay, Context::Map, Context::Rows],
        (Screen::Mission, _) if is_replay => &[Context::Replay, Context::Map],
        (Screen::Mission, Pane::Map) => &[Context::Mission, Context::Map, Context::Pan],
        (Screen::Mission, Pane::Events) => &[Context::Mission, Context::Map, Context::Rows],
        (Screen::Mission, _) => &[Context::Mission, Context::Map],
        (Screen::Plugins, _) => &[Context::Plugins, Context::Rows],
        (Screen::Alarms, _) => &[Context::Alarms, Context::Rows],
        (Screen::Events, _) => &[Context::Events, Context::Rows],
        (Screen::Review, _) => &[Context::Review, Context::Rows],
        (Screen::Result, _) => &[Context::Result, Context::Map, Context::Rows],
    }
}
