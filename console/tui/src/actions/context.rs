//! The contexts in which keys work, and which of them are active.

use crate::model::{Model, Overlay, Screen};
use crate::screens;

/// A context in which keys work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Context {
    /// On every screen, and in every list and input line.
    Anywhere,
    /// On every screen with no overlay.
    Screen,
    /// On one screen with no overlay.
    On(Screen),
    /// On the mission screen during a replay.
    Replay,
    /// On a screen with a map.
    Map,
    /// While the arrow keys pan the map.
    Pan,
    /// While the arrow keys move the cursor on the map.
    Cursor,
    /// While a no-go zone is being drawn on the map.
    Drawing,
    /// While the arrow keys move through a list.
    Rows,
    /// In an overlay list.
    List,
    /// In the comparison of forecasts.
    WhatIf,
    /// In the list of pre-flight checks.
    Preflight,
    /// In the list of the changes that a preset would make.
    Preset,
    /// In the parameter list.
    Parameters,
    /// In the parameter list of a forecast draft.
    Draft,
    /// In the action list of an alarm.
    Remedies,
    /// In an input line.
    Text,
    /// In a list that is filtered by typing.
    Commands,
    /// In the line that asks for confirmation before the robot moves or the mission ends.
    Confirm,
    /// In the line for single steps.
    Stepping,
}

impl Context {
    /// The screen's name, if the context is a screen.
    pub fn screen(self) -> Option<&'static str> {
        match self {
            Self::On(screen) => Some(screen.name()),
            Self::Replay => Some("Replay"),
            _ => None,
        }
    }

    /// Whether the context's actions are commands in their own right, rather than steps within a list or input line.
    pub fn has_commands(self) -> bool {
        matches!(self, Self::On(_) | Self::Replay | Self::Anywhere | Self::Screen | Self::Map | Self::Pan)
    }
}

/// The sets of contexts that can be active together while an overlay is open.
const OVER: &[&[Context]] = &[
    &[Context::Anywhere, Context::List, Context::Rows],
    &[Context::Anywhere, Context::List, Context::Rows, Context::Parameters],
    &[Context::Anywhere, Context::List, Context::Rows, Context::Parameters, Context::Draft],
    &[Context::Anywhere, Context::List, Context::Rows, Context::Preset],
    &[Context::Anywhere, Context::List, Context::Rows, Context::Preflight],
    &[Context::Anywhere, Context::List, Context::Rows, Context::Remedies],
    &[Context::Anywhere, Context::WhatIf, Context::Map],
    &[Context::Anywhere, Context::Drawing, Context::Pan],
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
        Overlay::ZoneDraft(_) => &[Context::Drawing, Context::Pan],
        Overlay::Preset { .. } => &[Context::List, Context::Rows, Context::Preset],
        Overlay::Preflight { .. } => &[Context::List, Context::Rows, Context::Preflight],
        Overlay::Remedies { .. } => &[Context::List, Context::Rows, Context::Remedies],
        Overlay::Planners { .. }
        | Overlay::Layers { .. }
        | Overlay::Finish { .. }
        | Overlay::Messages { .. } => &[Context::List, Context::Rows],
    };
    [&[Context::Anywhere], here].concat()
}
