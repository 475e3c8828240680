//! Warnings of a planner that say the same thing, apart from their figures.

use super::entry::Entry;
use mission::{EventKind, Severity};

/// Whether a line is a message of a planner to the operator, not one about the planner's own work.
pub(super) fn is_warning(entry: &Entry) -> bool {
    entry.severity > Severity::Debug && planner(entry).is_some()
}

/// Whether two lines are the same warning of the same planner, apart from their figures.
pub(super) fn are_alike(one: &Entry, other: &Entry) -> bool {
    is_warning(one)
        && planner(one) == planner(other)
        && one.severity == other.severity
        && words(one).eq(words(other))
}

fn planner(entry: &Entry) -> Option<&str> {
    match &entry.what.event()?.kind {
        EventKind::PlannerLogged { planner, .. } => Some(planner),
        _ => None,
    }
}

/// The text without its figures.
fn words(entry: &Entry) -> impl Iterator<Item = char> {
    entry.text.chars().filter(|c| !c.is_ascii_digit() && !matches!(c, '.' | '-'))
}
