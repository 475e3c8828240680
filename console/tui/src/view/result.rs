//! The result screen: what a mission has achieved against what its plan promised, what was missed and why, what comes next.

mod figures;
mod floor;

use super::look::{Look, Parts, fill};
use super::{map, table, text};
use crate::model::{RunResult, ui::Arrangement};
use crate::theme::Role;
use crate::update::Rows;
use mission::Outcome;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use report::account::{Area, MissReason};

/// Columns of the panes at the side, on a wide and on a narrow screen.
const SIDE: (u16, u16) = (62, 42);
/// Rows of the list of missed areas with its frame.
const MISSED: u16 = 10;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
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
    if left.width > 0 {
        map::draw(look, frame, left);
    }
    let [achieved, floor] = Layout::vertical([
        Constraint::Length(figures::rows(look, result, right.width.saturating_sub(2)) + 2),
        Constraint::Fill(1),
    ])
    .areas(right);
    let title = format!("Result  {}", ending(result));
    figures::draw(look, frame, achieved, &title, result);
    floor::draw(look, frame, floor, result);
    missed(look, frame, below, result);
}

fn ending(result: &RunResult) -> String {
    result.summary.outcome.map_or_else(|| "CUT OFF".into(), |outcome| outcome.word().to_uppercase())
}

/// How the title of the result looks.
fn role(result: &RunResult) -> Role {
    if result.summary.outcome == Some(Outcome::Complete) { Role::Good } else { Role::Warn }
}

fn missed(look: &Look, frame: &mut Frame, area: Rect, result: &RunResult) {
    let listed = look.model.live.missed();
    let kept_role = if result.is_kept { Role::Dim } else { Role::Crit };
    let total_m2: f64 = listed.iter().map(|area| area.area_m2).sum();
    let slivers = result.summary.floor.as_ref().map(|floor| floor.slivers);
    let small = slivers.filter(|slivers| slivers.count > 0).map_or_else(String::new, |slivers| {
        format!(", {} smaller ones {} m²", slivers.count, text::number(slivers.area_m2, 2))
    });
    let title = if listed.is_empty() {
        "Missed  no area".to_owned()
    } else {
        format!("Missed  {} areas, {} m²{small}", listed.len(), text::number(total_m2, 2))
    };
    let block = look.block(Role::Focus, &title, if listed.is_empty() { "" } else { "n N walk" });
    let inner = block.inner(area);
    let columns = usize::from(inner.width);
    let rows: Vec<Parts> = listed.iter().enumerate().map(|(index, area)| row(index, area, columns)).collect();
    let height = usize::from(inner.height).saturating_sub(1);
    table::place(look, inner, Rows::Missed, table::window(look.model.ui.missed, rows.len(), height));
    let mut lines = table::rows(look, rows, Some(look.model.ui.missed), (columns, height));
    lines
        .push(look.line([(kept_role, text::fit(&format!(" {}", text::capitalized(&result.kept)), columns))]));
    fill(frame, area, block, lines);
}

fn row(index: usize, area: &Area<MissReason>, columns: usize) -> Parts {
    let plate = area.plate.as_deref().unwrap_or("-");
    let words = format!(
        "{:>3} {} {:>16} {:>7} m² {}",
        index + 1,
        text::column(plate, 8),
        text::place(area.at),
        text::number(area.area_m2, 3),
        area.why()
    );
    vec![(Role::Text, text::fit(&words, columns.saturating_sub(1)))]
}
