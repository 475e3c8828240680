//! The result screen: the achieved figures alongside the plan's estimate, the missed areas with their reasons, and
//! what comes next.

mod figures;
mod floor;
mod missed;
pub(super) mod plates;

use super::look::{Look, fill};
use super::map;
use crate::model::{Pane, RunResult, ui::Arrangement};
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

pub(crate) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    let Some(result) = &look.model.live.result else {
        let block = look.block(Role::Border, "Result", "");
        return fill(frame, area, block, vec![look.line([(Role::Dim, " No run has ended yet.".into())])]);
    };
    let size = match arrangement {
        Arrangement::Paged | Arrangement::Strip => return page(look, frame, area, result),
        Arrangement::Narrow => 0,
        Arrangement::Wide if area.width < LARGE => 1,
        Arrangement::Wide => 2,
    };
    let missed_rows = missed::rows(look).min(MISSED[size]).max(3);
    let missed_rows = if size == 2 { beside_plates(look, area, result, missed_rows) } else { missed_rows };
    let [above, below] = Layout::vertical([Constraint::Fill(1), Constraint::Length(missed_rows)]).areas(area);
    let [left, right] =
        Layout::horizontal([Constraint::Fill(1), Constraint::Length(SIDE[size])]).areas(above);
    let columns = right.width.saturating_sub(2);
    // Beside a map, the figures leave room for the floor shares.
    let shares = if size > 0 { floor::least(look, result, columns) } else { 0 };
    let rows = (figures::rows(look, result, columns) + 2).min(right.height.saturating_sub(shares));
    let [achieved, rest] = Layout::vertical([Constraint::Length(rows), Constraint::Fill(1)]).areas(right);
    figures::draw(look, frame, achieved, result);
    match look.model.ui.pane {
        Pane::Plates => plates::draw(look, frame, left),
        Pane::Map => map::draw(look, frame, left),
        _ if size > 0 => map::draw(look, frame, left),
        _ => floor::draw(look, frame, left, result),
    }
    // A narrow screen shows the floor shares in one place only.
    if size > 0 || matches!(look.model.ui.pane, Pane::Map | Pane::Plates) {
        side(look, frame, rest, (result, size));
    }
    missed::draw(look, frame, below, result);
}

/// The panes that fit below the figures: the floor shares and, on a large screen, the plates.
fn side(look: &Look, frame: &mut Frame, area: Rect, (result, size): (&RunResult, usize)) {
    let columns = area.width.saturating_sub(2);
    if area.height < floor::least(look, result, columns) {
        return;
    }
    let wanted = floor::rows(look, result, columns) + 2;
    let has_plates = size == 2 && n_plates(look) > 0 && look.model.ui.pane != Pane::Plates;
    let shares = if has_plates { wanted.min(area.height) } else { area.height };
    let [floor, plates] = Layout::vertical([Constraint::Length(shares), Constraint::Fill(1)]).areas(area);
    floor::draw(look, frame, floor, result);
    if has_plates && plates.height > 3 {
        plates::draw(look, frame, plates);
    }
}

fn n_plates(look: &Look) -> usize {
    look.model.live.floor().map_or(0, |floor| floor.plates.len())
}

/// The rows of the list of missed areas on a large screen: fewer if the plates would not all fit above it.
fn beside_plates(look: &Look, area: Rect, result: &RunResult, missed_rows: u16) -> u16 {
    if n_plates(look) == 0 {
        return missed_rows;
    }
    let columns = SIDE[2].saturating_sub(2);
    let above = figures::rows(look, result, columns) + floor::rows(look, result, columns) + 4;
    // The frame and the headings.
    let plates = (n_plates(look) + 3).min(usize::from(u16::MAX)) as u16;
    let left = area.height.saturating_sub(above + plates);
    missed_rows.min(left.max(MISSED[0]))
}

/// One pane at a time.
fn page(look: &Look, frame: &mut Frame, area: Rect, result: &RunResult) {
    match look.model.ui.pane {
        Pane::Map => map::draw(look, frame, area),
        Pane::Coverage => floor::draw(look, frame, area, result),
        Pane::Missed => missed::draw(look, frame, area, result),
        Pane::Plates => plates::draw(look, frame, area),
        _ => figures::draw(look, frame, area, result),
    }
}

/// The title of the figures.
fn title(result: &RunResult) -> String {
    let ending =
        result.summary.outcome.map_or_else(|| "CUT OFF".into(), |outcome| outcome.word().to_uppercase());
    format!("Result  {ending}")
}

/// The role of the result's title.
fn role(result: &RunResult) -> Role {
    if result.summary.outcome == Some(Outcome::Complete) { Role::Good } else { Role::Warn }
}

/// The next page of a small screen, as a note in a title.
fn next_page(look: &Look) -> String {
    if look.model.ui.panes().is_empty() { String::new() } else { look.keys("<next-pane> next") }
}
