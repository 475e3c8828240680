//! The ways to end a mission: here, or after a drive back to the anchor.

use super::list::{List, hint, paragraph};
use crate::theme::Role;
use crate::update::finish::can_drive_back;
use crate::view::look::{Look, Parts as Row};
use crate::view::{confirm, coverage, text};

/// Width of the names, columns.
const NAME: usize = 18;
/// The width of the list from which an entry may have more than one line, columns.
const WRAPS: u16 = 60;

pub(super) fn list(look: &Look, selected: usize, columns: u16) -> List {
    let room = usize::from(columns).saturating_sub(3);
    let scanned = coverage::Bases::shown(look).sentence();
    let can = can_drive_back(look.model);
    let (role, way) = match (&look.model.live.way_back, &can) {
        (Some(Ok(way)), Ok(())) => (Role::Text, confirm::finish_way(look.model, way)),
        (None, _) => (Role::Dim, "looking for a way back...".into()),
        (_, Err(why)) | (Some(Err(why)), Ok(())) => (Role::Dim, why.clone()),
    };
    let name = |name: &str| text::column(name, NAME.min(room));
    let entry = |title: &str, role: Role, words: &str| -> Vec<Row> {
        let room = room.saturating_sub(NAME);
        // A warning is shown whole; a narrower screen has few rows and shows it below the list only.
        let has_rows = columns >= WRAPS || role == Role::Dim;
        let wraps = text::width(words) > room && has_rows;
        let lines = if wraps { text::wrap(words, room) } else { vec![text::fit(words, room)] };
        let front = |line| if line == 0 { name(title) } else { name("") };
        let lines = lines.into_iter().enumerate();
        lines.map(|(line, words)| vec![(Role::Title, front(line)), (role, words)]).collect()
    };
    let ways =
        [entry("End here", Role::Text, "The robot stays where it is."), entry("Drive back", role, &way)];
    let first = ways.iter().take(selected).map(Vec::len).sum();
    let selected_rows = ways.get(selected).map_or(1, Vec::len);
    let effect = match selected {
        0 => format!("The mission cannot be resumed. {scanned}"),
        _ if can.is_ok() => format!("The robot will move. {way}. The mission ends there; HOLD stops it."),
        _ => format!("Not possible now: {way}."),
    };
    let accept = if selected == 0 { "end here" } else { "drive back" };
    let keys = look.keys(&format!(" <accept>: {accept}  <cancel>: stay held"));
    let below: Vec<Row> = paragraph(Role::Dim, &effect, room).chain([hint(&keys)]).collect();
    List {
        title: "End the mission?".into(),
        rows: ways.concat(),
        selected: first,
        selected_rows,
        needed_below: below.len(),
        below,
        ..List::default()
    }
}
