//! Where keys mean something, and which of these places are active.

use crate::model::{Model, Overlay, Screen};
use crate::screens;

/// Where keys mean something.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Context {
    /// On every screen, in every list and line.
    Anywhere,
    /// On every screen with nothing over it.
    Screen,
    /// On one screen with nothing over it.
    On(Screen),
    /// On the mission screen while a past run is played back.
    Replay,
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
            Self::On(screen) => Some(screen.name()),
            Self::Replay => Some("Replay"),
            _ => None,
        }
    }

    /// Whether its actions are commands of their own, and no mere steps within a list or a line.
    pub fn has_commands(self) -> bool {
        matches!(self, Self::On(_) | Self::Replay | Self::Anywhere | Self::Screen | Self::Map | Self::Pan)
    }
}

/// The sets of contexts that can be active together while something lies over the screen.
const OVER: &[&[Context]] = &[
    &[Context::Anywhere, Context::List, Context::Rows],
    &[Context::Anywhere, Context::List, Context::Rows, Context::Parameters],
    &[Context::Anywhere, Context::List, Context::Rows, Context::Parameters, Context::Draft],
    &[Context::Anywhere, Context::List, Context::Rows, Context::Preflight],
    &[Context::Anywhere, Context::List, Context::Rows, Context::Remedies],
    &[Context::Anywhere, Context::WhatIf, Context::Map],
    &[Context::Anywhere, Context::Text],
    &[Context::Anywhere, Context::Text, Context::Commands],
    &[Context::Anywhere, Context::Confirm],
    &[Context::Anywhere, Context::Stepping],
];

/// Every set of contexts that can be active together.
pub fn together() -> impl Iterator<Item = Vec<Context>> {
    let of_screens = screens::together().map(|own| [&[Context::Anywhere, Context::Screen], own].concat());
    of_screens.chain(OVER.iter().map(|contexts| contexts.to_vec()))
}

/// The contexts whose keys work now.
pub fn contexts(model: &Model) -> Vec<Context> {
    let here = match &model.ui.overlay {
        Overlay::None => return [&[Context::Anywhere, Context::Screen], screens::contexts(model)].concat(),
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
