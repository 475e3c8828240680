//! The missed areas: the position and a short reason for each one, and all reasons for the selected one.

use super::next_page;
use crate::model::{Model, Pane, RunResult};
use crate::theme::Role;
use crate::update::Rows;
use crate::view::look::{Look, Parts, fill};
use crate::view::missed::{brief, briefest, small};
use crate::view::{table, text};
use account::{Area, Cause, MissReason};
use ratatui::Frame;
use ratatui::layout::Rect;

/// Width of the areas and shares in the table of reasons, columns.
const AREA: usize = 12;
const SHARE: usize = 8;
/// The minimum width of a pane at which an area is beside the name of its plate, columns.
const WITH_PLATE: usize = 64;

/// The fewest rows of the list beside the reasons for the selected area.
const LEAST_LISTED: usize = 3;

/// The rows that the pane would fill, including the frame, at a width.
pub(super) fn rows(model: &Model, columns: u16) -> u16 {
    let listed = model.live.missed();
    let columns = usize::from(columns).saturating_sub(2);
    let why = listed.iter().map(|area| reasons(area, columns, usize::MAX).len()).max().unwrap_or(0);
    with_reasons(listed.len(), why)
}

/// The rows that the pane fills while the reasons for the selected area are shown, including the frame, at a width.
pub(super) fn rows_now(model: &Model, columns: u16) -> u16 {
    let listed = model.live.missed();
    let columns = usize::from(columns).saturating_sub(2);
    let selected = listed.get(model.ui.missed.min(listed.len().saturating_sub(1)));
    with_reasons(listed.len(), selected.map_or(0, |area| reasons(area, columns, usize::MAX).len()))
}

fn with_reasons(listed: usize, why: usize) -> u16 {
    (listed + why + 3).min(usize::from(u16::MAX)) as u16
}

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, result: &RunResult) {
    let listed = &look.model.live.missed()[..];
    let inner = look.block(Role::Border, "", "").inner(area);
    let (columns, height) = (usize::from(inner.width), usize::from(inner.height).saturating_sub(1));
    let selected = look.model.ui.missed.min(listed.len().saturating_sub(1));
    let has_focus = look.model.ui.pane == Pane::Missed;
    // The list keeps at least half of the rows; if the arrow keys apply to it, or it needs fewer, the reasons may take
    // more.
    let least = if has_focus { LEAST_LISTED } else { height - height / 2 };
    let most = height.saturating_sub(least.min(listed.len()));
    let why = listed.get(selected).map_or_else(Vec::new, |area| reasons(area, columns, most));
    let rows: Vec<Parts> = listed.iter().enumerate().map(|(index, area)| row(index, area, columns)).collect();
    let height = height.saturating_sub(why.len());
    let shown = table::window(selected, rows.len(), height);
    table::place(look, inner, Rows::Missed, shown.clone());
    let is_cut = shown.len() < rows.len();
    let place = if is_cut { format!("{}  ", table::counted(&shown, rows.len())) } else { String::new() };
    let walk =
        if listed.is_empty() { String::new() } else { look.keys("<next-missed> <previous-missed> step") };
    let next = next_page(look);
    let notes =
        [format!("{place}{walk}  {next}"), format!("{place}{next}"), place.trim().to_owned(), String::new()];
    let key = look.pane_key(Pane::Missed);
    let titles = titles(look, listed).map(|title| format!("{key}{title}"));
    let title = text::wording(titles, columns.saturating_sub(4));
    let room = columns.saturating_sub(text::width(&title) + 8);
    let border = if has_focus { Role::Focus } else { Role::Border };
    let block = look.block(border, &title, text::wording(notes, room).trim());
    let mut lines = table::rows(look, rows, Some(selected), (columns, height));
    lines.extend(why.into_iter().map(|parts| look.line(parts)));
    let kept_role = if result.is_kept { Role::Dim } else { Role::Crit };
    let kept = text::fit(&format!(" {}", text::capitalized(&result.kept)), columns);
    lines.push(look.line([(kept_role, kept)]));
    fill(frame, area, block, lines);
}

/// The missed areas and, apart from them, those that were not reached because the mission ended; from the longest wording to
/// the shortest.
fn titles(look: &Look, listed: &[&Area<MissReason>]) -> [String; 4] {
    if look.model.live.floor().is_none() {
        return ["Missed: this mission does not scan", "Missed: not a scan", "Missed", ""].map(str::to_owned);
    }
    let is_ahead = |area: &&&Area<MissReason>| area.reason == MissReason::NotReached;
    let missed: Vec<_> = listed.iter().filter(|area| !is_ahead(area)).collect();
    let ahead: Vec<_> = listed.iter().filter(is_ahead).collect();
    let total = |areas: &[&&Area<MissReason>]| text::number(areas.iter().map(|area| area.area_m2).sum(), 2);
    let counted = |areas: &[&&Area<MissReason>], total: &str| match areas.len() {
        0 => "no area".to_owned(),
        n => format!("{}{total}", text::counted(n, "area")),
    };
    let sum = |areas: &[&&Area<MissReason>]| counted(areas, &format!(", {} m²", total(areas)));
    let others_m2 = look.model.live.not_requested_m2();
    let others = (others_m2 > 0.0).then(|| format!("; not requested: {} m²", text::number(others_m2, 2)));
    let not_reached =
        |words: String| if ahead.is_empty() { String::new() } else { format!("; not reached: {words}") };
    let small = look.model.live.floor().map_or_else(String::new, small);
    [
        format!("Missed: {}{small}{}{}", sum(&missed), not_reached(sum(&ahead)), others.unwrap_or_default()),
        format!("Missed: {}{}", sum(&missed), not_reached(sum(&ahead))),
        format!("Missed: {} m²{}", total(&missed), not_reached(format!("{} m²", total(&ahead)))),
        format!("Missed: {}", counted(&missed, "")),
    ]
}

/// An area; one that was not reached because the mission ended is dim, because nothing went wrong there.
fn row(index: usize, area: &Area<MissReason>, columns: usize) -> Parts {
    // The plates have a page of their own; the reason has not.
    let plate = if columns < WITH_PLATE {
        String::new()
    } else {
        text::column(area.plate.as_deref().unwrap_or("-"), 8) + " "
    };
    let place = format!(
        "{:>3} {plate}{:>16} {:>7} m² ",
        index + 1,
        text::place(area.at),
        text::number(area.area_m2, 3)
    );
    // The mark of the selected row takes one column.
    let room = columns.saturating_sub(text::width(&place) + 1);
    let role = if area.reason == MissReason::NotReached { Role::Dim } else { Role::Text };
    vec![(role, place + &text::wording([area.why(), brief(area), briefest(area)], room))]
}

/// The reasons for an area as a table of areas and shares, largest first. If the rows do not suffice, the last one says
/// how many reasons are left out.
fn reasons(area: &Area<MissReason>, columns: usize, rows: usize) -> Vec<Parts> {
    // A single reason that fits is in the row of the area.
    if rows == 0 || area.causes.is_empty() {
        return Vec::new();
    }
    let room = columns.saturating_sub(AREA + SHARE + 4);
    let mut lines: Vec<Parts> = Vec::new();
    for (index, cause) in area.causes.iter().enumerate() {
        let words = reason(cause, area.area_m2, room);
        let rest = &area.causes[index + 1..];
        if lines.len() + words.len() + usize::from(!rest.is_empty()) > rows {
            let left = &area.causes[index..];
            let left_m2: f64 = left.iter().map(|cause| cause.area_m2).sum();
            let plural = if left.len() == 1 { "" } else { "s" };
            lines.push(vec![(
                Role::Dim,
                format!("   {:>AREA$}  {} more reason{plural}", square_metres(left_m2), left.len()),
            )]);
            break;
        }
        lines.extend(words);
    }
    lines.truncate(rows);
    lines
}

fn reason(cause: &Cause<MissReason>, of_m2: f64, room: usize) -> Vec<Parts> {
    let share = if of_m2 > 0.0 { 100.0 * cause.area_m2 / of_m2 } else { 0.0 };
    let front = format!(
        "   {:>AREA$}{:>SHARE$}  ",
        square_metres(cause.area_m2),
        format!("{} %", text::number(share, 0))
    );
    let wrapped = text::wrap(&text::capitalized(&cause.text), room.max(8)).into_iter().enumerate();
    wrapped
        .map(|(line, words)| {
            let front = if line == 0 { front.clone() } else { " ".repeat(text::width(&front)) };
            vec![(Role::Dim, front), (Role::Text, words)]
        })
        .collect()
}

fn square_metres(m2: f64) -> String {
    format!("{} m²", text::number(m2, 3))
}
