//! The rows of the action table, one per action, in the order of the footer and the help.

mod alarms;
mod console;
mod lists;
mod map;
mod mission;
mod runs;

use super::Action;
use crate::screens;

/// Every row.
pub(super) fn all() -> Vec<Action> {
    let before = [mission::ROWS, alarms::ROWS, runs::ROWS, console::ROWS].concat();
    let after = [console::LEAVING, map::ROWS, lists::ROWS].concat();
    [before, screens::actions(), after].concat()
}
