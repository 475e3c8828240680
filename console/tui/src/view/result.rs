//! The result screen: the achieved figures alongside the plan's estimate, the missed areas with their reasons, and
//! what comes next.

mod figures;
mod floor;
mod missed;
pub(super) mod plates;

use super::look::{Look, Parts, fill};
use super::{charts, map, table, text};
use crate::model::ui::{Arrangement, Chart};
use crate::model::{Model, Pane, RunResult};
use crate::theme::Role;
use mission::Outcome;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};

/// Width of the side panes on a narrow, a wide and a large screen, columns.
const SIDE: [u16; 3] = [42, 62, 88];
/// Columns from which a screen is large.
const LARGE: u16 = 170;
/// Rows of the list of missed areas, including the frame, on a narrow, a wide and a large screen.
const MISSED: [u16; 3] = [8, 10, 20];
/// Rows of that list on a narrow screen, including the frame, if text above it would be cut otherwise: two areas.
const LEAST_MISSED: u16 = 5;
/// Rows of the panes above the list of missed areas while the list has the focus.
const ABOVE_MISSED: u16 = 8;
/// Minimum rows of a curve, including the frame.
const CURVE: u16 = 7;
/// The share of the side panes' rows that the floor shares get beside figures that need more than the rest: one part in
/// this many.
const FLOOR_PART: u16 = 3;

pub(crate) fn draw(look: &Look, frame: &mut Frame, area: Rect, _: Arrangement) {
    let Some(result) = &look.model.live.result else {
        let block = look.block(Role::Border, "Result", "");
        return fill(frame, area, block, vec![look.line([(Role::Dim, " No run has ended yet.".into())])]);
    };
    if look.model.ui.parts.without_scan && look.model.ui.arrangement() != Arrangement::Paged {
        return without_scan(look, frame, area, result);
    }
    for (pane, area) in placed(look.model, area, result) {
        match pane {
            Pane::Map => map::draw(look, frame, area),
            Pane::Coverage => floor::draw(look, frame, area, result),
            Pane::Missed => missed::draw(look, frame, area, result),
            Pane::Plates => plates::draw(look, frame, area),
            _ => figures::draw(look, frame, area, result),
        }
    }
}

/// The result of a mission that does not scan: the map, the figures, and their curves below them.
fn without_scan(look: &Look, frame: &mut Frame, area: Rect, result: &RunResult) {
    let (figures, curves) = beside_map(look.model, area, result);
    let map = Rect { width: area.width - figures.width, ..area };
    map::draw(look, frame, map);
    figures::draw(look, frame, figures, result);
    let tether = look.run.tether.is_some();
    let shown = [Chart::Error, Chart::TetherOut, Chart::Wrap].into_iter();
    let shown = shown.filter(|chart| *chart == Chart::Error || tether);
    let shown: Vec<Chart> = shown.take(usize::from(curves.height / CURVE)).collect();
    let areas = Layout::vertical(shown.iter().map(|_| Constraint::Fill(1))).split(curves);
    for (chart, area) in shown.iter().zip(areas.iter()) {
        charts::draw(look, frame, *area, *chart);
    }
}

/// The areas of the figures and of their curves beside the map of a mission that does not scan. Figures that leave too
/// little room for a curve get all rows.
fn beside_map(model: &Model, area: Rect, result: &RunResult) -> (Rect, Rect) {
    let size = match model.ui.arrangement() {
        Arrangement::Wide if area.width >= LARGE => 2,
        Arrangement::Wide => 1,
        _ => 0,
    };
    let side = SIDE[size];
    let [_, side] = Layout::horizontal([Constraint::Fill(1), Constraint::Length(side)]).areas(area);
    let wanted = figures::rows(model, result, side.width.saturating_sub(2)) + 2;
    let rows = if wanted + CURVE > side.height { side.height } else { wanted };
    let [figures, curves] = Layout::vertical([Constraint::Length(rows), Constraint::Fill(1)]).areas(side);
    (figures, curves)
}

/// The panes and their areas. The pane that responds to the arrow keys gets the rows that it needs; on a small screen, it
/// is the only one.
fn placed(model: &Model, area: Rect, result: &RunResult) -> Vec<(Pane, Rect)> {
    let pane = model.ui.pane;
    let size = match model.ui.arrangement() {
        Arrangement::Paged | Arrangement::Strip => return vec![(pane, area)],
        Arrangement::Narrow => 0,
        Arrangement::Wide if area.width < LARGE => 1,
        Arrangement::Wide => 2,
    };
    let needed = missed::rows(model, area.width).max(3);
    let missed_rows = match size {
        // Rows that the reasons for the selected area do not need go to the figures, if these are cut otherwise.
        1 if pane != Pane::Missed && are_figures_cut(model, area, result, needed.min(MISSED[1])) => {
            missed::rows_now(model, area.width).clamp(3, MISSED[1])
        }
        // A narrow screen has no room to spare: the reasons have the rows of the list once it has the focus.
        0 if pane != Pane::Missed => {
            let most = if is_text_cut(model, area, result) { LEAST_MISSED } else { MISSED[0] };
            missed::rows_now(model, area.width).clamp(3, most)
        }
        _ if pane == Pane::Missed => needed.min(area.height.saturating_sub(ABOVE_MISSED)).max(3),
        2 => beside_plates(model, area, result, needed.min(MISSED[2])),
        size => needed.min(MISSED[size]),
    };
    let [above, below] = Layout::vertical([Constraint::Fill(1), Constraint::Length(missed_rows)]).areas(area);
    let missed = (Pane::Missed, below);
    // The table of the plates needs the whole width of a narrow screen.
    if size == 0 && pane == Pane::Plates {
        return vec![(Pane::Plates, above), missed];
    }
    let [left, right] =
        Layout::horizontal([Constraint::Fill(1), Constraint::Length(SIDE[size])]).areas(above);
    // A narrow screen shows the shares of the floor in one place only.
    if size == 0 && pane != Pane::Map {
        return vec![(Pane::Coverage, left), (Pane::Figures, right), missed];
    }
    let mut panes = vec![(if pane == Pane::Plates { pane } else { Pane::Map }, left), missed];
    panes.extend(side(model, right, (result, size)));
    panes
}

/// Whether a narrow screen cuts the figures or the shares of the floor if the missed areas take all their rows.
fn is_text_cut(model: &Model, area: Rect, result: &RunResult) -> bool {
    let left = area.height.saturating_sub(missed::rows_now(model, area.width).clamp(3, MISSED[0]) + 2);
    let figures = figures::rows(model, result, SIDE[0] - 2);
    figures.max(floor::rows(model, result, area.width.saturating_sub(SIDE[0] + 2))) > left
}

/// Whether the column beside the map is too short for all figures and shares of the floor if the missed areas take this
/// number of rows.
fn are_figures_cut(model: &Model, area: Rect, result: &RunResult, missed_rows: u16) -> bool {
    let columns = SIDE[1] - 2;
    let needed = figures::rows(model, result, columns) + floor::least(model, result, columns) + 2;
    needed > area.height.saturating_sub(missed_rows)
}

/// The panes beside the map: the figures, the shares of the floor and, on a large screen, the plates.
fn side(model: &Model, area: Rect, (result, size): (&RunResult, usize)) -> Vec<(Pane, Rect)> {
    let columns = area.width.saturating_sub(2);
    let figures = figures::rows(model, result, columns) + 2;
    let floor = floor::rows(model, result, columns) + 2;
    let least = floor::least(model, result, columns).min(floor);
    let has_focus = model.ui.pane == Pane::Coverage;
    let floor_rows = match area.height.saturating_sub(figures) {
        _ if has_focus => floor.min(area.height.saturating_sub(area.height / FLOOR_PART)),
        left if left >= floor => left,
        _ => floor.min(least.max(area.height / FLOOR_PART)),
    };
    // A narrow screen with a map has no room for both panes.
    if floor_rows + least > area.height {
        return vec![(if has_focus { Pane::Coverage } else { Pane::Figures }, area)];
    }
    let has_plates = size == 2 && n_plates(model) > 0 && model.ui.pane != Pane::Plates;
    let shares = if has_plates { floor.min(floor_rows) } else { floor_rows };
    let [achieved, rest] =
        Layout::vertical([Constraint::Length(figures.min(area.height - floor_rows)), Constraint::Fill(1)])
            .areas(area);
    let shares = if has_plates { shares } else { rest.height };
    let [floor, plates] = Layout::vertical([Constraint::Length(shares), Constraint::Fill(1)]).areas(rest);
    let mut panes = vec![(Pane::Figures, achieved), (Pane::Coverage, floor)];
    panes.extend((has_plates && plates.height > 3).then_some((Pane::Plates, plates)));
    panes
}

fn n_plates(model: &Model) -> usize {
    model.live.floor().map_or(0, |floor| floor.plates.len())
}

/// The rows of the list of missed areas on a large screen: fewer if the plates would not all fit above it.
fn beside_plates(model: &Model, area: Rect, result: &RunResult, missed_rows: u16) -> u16 {
    if n_plates(model) == 0 {
        return missed_rows;
    }
    let columns = SIDE[2].saturating_sub(2);
    let above = figures::rows(model, result, columns) + floor::rows(model, result, columns) + 4;
    // The frame and the headings.
    let plates = (n_plates(model) + 3).min(usize::from(u16::MAX)) as u16;
    let left = area.height.saturating_sub(above + plates);
    missed_rows.min(left.max(MISSED[0]))
}

/// How many rows a pane of text can be scrolled at most, at the size of the screen; 0 if all of it is visible, or if the
/// pane is not shown.
pub(crate) fn most_scrolled(model: &Model, pane: Pane) -> usize {
    let Some(result) = &model.live.result else { return 0 };
    let area = super::body(model, Rect::new(0, 0, model.ui.width, model.ui.height));
    let is_alone = model.ui.arrangement() == Arrangement::Paged;
    let shown = if model.ui.parts.without_scan && !is_alone {
        Some((pane, beside_map(model, area, result).0))
    } else {
        placed(model, area, result).into_iter().find(|(other, _)| *other == pane)
    };
    shown.map_or(0, |(_, area)| {
        let columns = area.width.saturating_sub(2);
        let rows = match pane {
            Pane::Figures => figures::rows(model, result, columns),
            Pane::Coverage => floor::rows(model, result, columns),
            _ => 0,
        };
        usize::from(rows).saturating_sub(area.height.saturating_sub(2).into())
    })
}

/// Draws the visible part of a pane of text; its title says which rows are visible if not all of them are.
fn scrolled(
    look: &Look,
    frame: &mut Frame,
    (pane, area): (Pane, Rect),
    (role, title): (Role, &str),
    rows: Vec<Parts>,
) {
    let has_focus = look.model.ui.pane == pane;
    let height = usize::from(area.height.saturating_sub(2));
    let most = rows.len().saturating_sub(height);
    let first = if has_focus { look.model.ui.scrolled.min(most) } else { 0 };
    let shown = first..(first + height).min(rows.len());
    let title = format!("{}{title}", look.pane_key(pane));
    let place = if most > 0 { table::counted(&shown, rows.len()) } else { String::new() };
    let next = next_page(look);
    let keys = if most > 0 && has_focus { look.keys("<down> <up>") } else { String::new() };
    let scroll = if keys.is_empty() { String::new() } else { format!("{keys} scroll") };
    let joined =
        |parts: &[&str]| parts.iter().filter(|part| !part.is_empty()).copied().collect::<Vec<_>>().join("  ");
    let notes = [
        joined(&[&place, &scroll, &next]),
        joined(&[&place, &keys, &next]),
        joined(&[&place, &keys]),
        place.clone(),
    ];
    let room = usize::from(area.width).saturating_sub(text::width(&title) + 11);
    let border = if has_focus && role == Role::Border { Role::Focus } else { role };
    let note = text::wording(notes, room);
    let block =
        if has_focus { look.focused(border, &title, &note) } else { look.block(border, &title, &note) };
    let (inner, len) = (block.inner(area), rows.len());
    let lines = rows.into_iter().skip(first).take(height).map(|parts| look.line(parts)).collect();
    fill(frame, area, block, lines);
    table::bar(look, frame, inner, &shown, len);
}

/// The title of the figures.
fn title(model: &Model, result: &RunResult) -> String {
    let ending =
        result.summary.outcome.map_or_else(|| "CUT OFF".into(), |outcome| outcome.word().to_uppercase());
    let task = if model.ui.parts.without_scan { ", not a scan" } else { "" };
    let whole = if model.live.is_replay() { ", whole run" } else { "" };
    format!("Result  {ending}{task}{whole}")
}

/// The role of the result's title.
fn role(result: &RunResult) -> Role {
    if result.summary.outcome == Some(Outcome::Complete) { Role::Good } else { Role::Warn }
}

/// The way to the other panes where they have no keys of their own, as a note in a title.
fn next_page(look: &Look) -> String {
    let is_numbered = !look.model.ui.numbered_panes().is_empty();
    let is_alone = is_numbered || look.model.ui.panes().is_empty();
    if is_alone { String::new() } else { look.keys("<next-pane> pane") }
}
