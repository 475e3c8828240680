//! The rows of the table, one an action, in the order of the footer and of help.

mod alarms;
mod console;
mod lists;
mod map;
mod mission;
mod runs;

use super::Action;
use crate::screens::GO;

/// The parts of the table.
const PARTS: [&[Action]; 8] =
    [mission::ROWS, alarms::ROWS, runs::ROWS, console::ROWS, &GO, console::LEAVING, map::ROWS, lists::ROWS];

/// All of them.
pub(super) const ALL: [Action; count()] = joined();

const fn count() -> usize {
    let (mut n, mut part) = (0, 0);
    while part < PARTS.len() {
        n += PARTS[part].len();
        part += 1;
    }
    n
}

const fn joined<const N: usize>() -> [Action; N] {
    let mut all = [PARTS[0][0]; N];
    let (mut n, mut part) = (0, 0);
    while part < PARTS.len() {
        let mut row = 0;
        while row < PARTS[part].len() {
            all[n] = PARTS[part][row];
            (n, row) = (n + 1, row + 1);
        }
        part += 1;
    }
    all
}
