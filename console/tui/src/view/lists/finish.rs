//! The ways to end a mission: here, or after a drive back to the anchor.

use super::list::{List, hint, paragraph};
use crate::theme::Role;
use crate::update::finish::can_drive_back;
use crate::view::look::{Look, Parts as Row};
use crate::view::{confirm, coverage, text};

/// Width of the names, columns.
const NAME: usize = 18;

pub(super) fn list(look: &Look, selected: usize, columns: u16) -> List {
    let room = usize::from(columns).saturating_sub(3);
    let scanned = coverage::Bases::shown(look).sentence();
    let can = can_drive_back(look.model);
    let (role, way) = match (&look.model.live.way_back, &can) {
        (Some(Ok(way)), Ok(())) => (Role::Text, confirm::finish_way(way)),
        (None, _) => (Role::Dim, "looking for a way back...".into()),
        (_, Err(why)) | (Some(Err(why)), Ok(())) => (Role::Dim, why.clone()),
    };
    let name = |name: &str| text::column(name, NAME.min(room));
    let short = |words: &str| text::fit(words, room.saturating_sub(NAME));
    let rows: Vec<Row> = vec![
        vec![(Role::Title, name("End here")), (Role::Text, short("The robot stays where it is."))],
        vec![(Role::Title, name("Drive back")), (role, short(&way))],
    ];
    let effect = match selected {
        0 => format!("The mission cannot be resumed. {scanned}"),
        _ if can.is_ok() => format!("The robot will move. {way}. The mission ends there; HOLD stops it."),
        _ => format!("Not possible now: {way}."),
    };
    let keys = look.keys(" <accept>: do it  <cancel>: stay held");
    let below: Vec<Row> = paragraph(Role::Dim, &effect, room).chain([hint(&keys)]).collect();
    List {
        title: "End the mission?".into(),
        rows,
        selected,
        needed_below: below.len(),
        below,
        ..List::default()
    }
}
