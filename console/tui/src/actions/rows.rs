//! The rows of the action table, one per action, in the order of the footer and the help.

mod alarms;
mod console;
mod lists;
mod map;
mod mission;
mod runs;

use super::{Action, Topic};
use crate::screens;

/// Every row.
pub(super) fn all() -> Vec<Action> {
    [
        (Topic::Mission, mission::ROWS),
        (Topic::Alarms, alarms::ROWS),
        (Topic::Runs, runs::ROWS),
        (Topic::Console, console::ROWS),
        (Topic::Screens, &screens::actions()),
        (Topic::Console, console::LEAVING),
        (Topic::Map, map::ROWS),
        (Topic::Console, lists::ROWS),
    ]
    .into_iter()
    .flat_map(|(topic, rows)| rows.iter().map(move |row| Action { topic, ..*row }))
    .collect()
}
