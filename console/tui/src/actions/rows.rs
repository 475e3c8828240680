//! The rows of the table, one an action, in the order of the footer and of help.

mod alarms;
mod console;
mod lists;
mod map;
mod mission;
mod runs;

use super::Action;
use crate::screens;

/// All of them.
pub(super) fn all() -> Vec<Action> {
    let before = [mission::ROWS, alarms::ROWS, runs::ROWS, console::ROWS].concat();
    let after = [console::LEAVING, map::ROWS, lists::ROWS].concat();
    [before, screens::actions(), after].concat()
}
