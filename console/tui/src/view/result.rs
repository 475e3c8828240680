//! The result screen: the achieved figures alongside the plan's estimate, the missed areas with their reasons, and
//! what comes next.

mod figures;
mod floor;
mod missed;

use super::look::{Look, fill};
use super::map;
use crate::model::{RunResult, ui::Arrangement};
use crate::theme::Role;
use mission::Outcome;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};

/// Width of the side panes on a wide and on a narrow screen, columns.
const SIDE: (u16, u16) = (62, 42);
/// Minimum rows for the floor shares, including the frame.
const FLOOR: u16 = 6;
/// Rows of the list of missed areas, including the frame.
const MISSED: u16 = 10;

pub(crate) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    let Some(result) = &look.model.live.result else {
        let block = look.block(Role::Border, "Result", "");
        return fill(frame, area, block, vec![look.line([(Role::Dim, " No run has ended yet.".into())])]);
    };
    let wide = arrangement == Arrangement::Wide;
    let missed_rows = if look.model.live.missed().is_empty() {
        3
    } else if wide {
        MISSED
    } else {
        MISSED / 2 + 1
    };
    let [above, below] = Layout::vertical([Constraint::Fill(1), Constraint::Length(missed_rows)]).areas(area);
    let side = if wide { SIDE.0 } else { SIDE.1 };
    let side = if arrangement == Arrangement::Paged { area.width } else { side };
    let [left, right] = Layout::horizontal([Constraint::Fill(1), Constraint::Length(side)]).areas(above);
    let rows = figures::rows(look, result, right.width.saturating_sub(2)) + 2;
    let [achieved, floor] = Layout::vertical([Constraint::Length(rows), Constraint::Fill(1)]).areas(right);
    // If there is no room for both, the shares matter more than the map, which is one key away.
    let floor = if left.width > 0 && floor.height < FLOOR { left } else { floor };
    if left.width > 0 && floor != left {
        map::draw(look, frame, left);
    }
    let title = format!("Result  {}", ending(result));
    figures::draw(look, frame, achieved, &title, result);
    floor::draw(look, frame, floor, result);
    missed::draw(look, frame, below, result);
}

fn ending(result: &RunResult) -> String {
    result.summary.outcome.map_or_else(|| "CUT OFF".into(), |outcome| outcome.word().to_uppercase())
}

/// The role of the result's title.
fn role(result: &RunResult) -> Role {
    if result.summary.outcome == Some(Outcome::Complete) { Role::Good } else { Role::Warn }
}
