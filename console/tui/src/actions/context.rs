//! Where keys mean something, and which of these places are active.

use crate::model::{Model, Overlay, Pane};

/// Where keys mean something.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Context {
    /// On every screen, in every list and line.
    Anywhere,
    /// On the mission screen.
    Mission,
    /// On the mission screen, while the map takes the arrow keys.
    Map,
    /// On the mission screen, while the events take the arrow keys.
    Events,
    /// In a list.
    List,
    /// In the list of parameters.
    Parameters,
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
    /// Whether its actions are commands of their own, and no mere steps within a list or a line.
    pub fn has_commands(self) -> bool {
        matches!(self, Self::Anywhere | Self::Mission | Self::Map | Self::Events)
    }
}

/// The contexts whose keys work now.
pub fn contexts(model: &Model) -> Vec<Context> {
    let here: &[Context] = match &model.ui.overlay {
        Overlay::None => match model.ui.pane {
            Pane::Map => &[Context::Mission, Context::Map],
            Pane::Events => &[Context::Mission, Context::Events],
            _ => &[Context::Mission],
        },
        Overlay::Confirm(_) | Overlay::Quit => &[Context::Confirm],
        Overlay::Stepping => &[Context::Stepping],
        Overlay::Commands { .. } => &[Context::Text, Context::Commands],
        Overlay::Parameters { edit: Some(_), .. } | Overlay::Filter => &[Context::Text],
        Overlay::Parameters { edit: None, .. } => &[Context::List, Context::Parameters],
        Overlay::Planners { .. } | Overlay::Layers { .. } => &[Context::List],
    };
    [&[Context::Anywhere], here].concat()
}
