//! The missed areas once the mission has ended, with reason and place, largest first.

use super::look::{Look, fill};
use super::text;
use crate::model::Pane;
use crate::theme::Role;
use account::{Account, Area, MissReason};
use ratatui::Frame;
use ratatui::layout::Rect;

/// The account of the floor for a run that has ended.
pub(super) fn account<'a>(look: &Look<'a>) -> Option<&'a Account> {
    look.model.live.result.as_ref()?;
    look.model.live.floor()
}

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let Some(account) = account(look) else { return };
    let listed = account.listed();
    let block = look.pane(
        Pane::Missed,
        &format!("Missed areas  {}{}", listed.len(), small(account)),
        &look.keys("<result> result"),
    );
    let inner = block.inner(area);
    let columns = usize::from(inner.width).saturating_sub(2);
    let mut lines: Vec<_> = listed
        .into_iter()
        .map(|area| look.line([(Role::Text, format!(" {}", row(area, columns)))]))
        .take(usize::from(inner.height))
        .collect();
    if lines.is_empty() {
        lines.push(look.line([(Role::Good, " None.".into())]));
    }
    fill(frame, area, block, lines);
}

fn row(area: &Area<MissReason>, columns: usize) -> String {
    let Area { at, area_m2, .. } = area;
    let place =
        format!("{} m² at {}, {} m", text::number(*area_m2, 2), text::number(at.x, 1), text::number(at.y, 1));
    text::wording(
        [
            area.to_string(),
            format!("{place}: {}", brief(area)),
            format!("{place}: {}", briefest(area)),
            place,
        ],
        columns,
    )
}

/// The missed areas that are too small to be listed, as an addition to those that are; empty if there are none.
pub(super) fn small(floor: &Account) -> String {
    match &floor.slivers {
        slivers if slivers.count == 0 => String::new(),
        slivers => format!(" (+ {} under 0.01 m², {} m²)", slivers.count, text::number(slivers.area_m2, 2)),
    }
}

/// The role of the number of an area on a map and of its line in a list: nothing went wrong in an area that was not
/// reached because the mission ended.
pub(super) fn role(area: &Area<MissReason>) -> Role {
    if area.reason == MissReason::NotReached { Role::Dim } else { Role::Missed }
}

/// The main reason for a missed area, and the number of further reasons.
pub(super) fn brief(area: &Area<MissReason>) -> String {
    match area.causes.len().saturating_sub(1) {
        0 => area.reason.briefly().to_owned(),
        1 => format!("{} (+1 reason)", area.reason.briefly()),
        more => format!("{} (+{more} reasons)", area.reason.briefly()),
    }
}

/// The main reason for a missed area, in as few words as possible.
pub(super) fn briefest(area: &Area<MissReason>) -> String {
    match area.causes.len().saturating_sub(1) {
        0 => area.reason.briefly().to_owned(),
        more => format!("{} +{more}", area.reason.briefly()),
    }
}
