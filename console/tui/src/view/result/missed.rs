//! The missed areas: the position and a short reason for each one, and all reasons for the selected one.

use crate::model::RunResult;
use crate::theme::Role;
use crate::update::Rows;
use crate::view::look::{Look, Parts, fill};
use crate::view::missed::brief;
use crate::view::{table, text};
use account::{Area, MissReason};
use ratatui::Frame;
use ratatui::layout::Rect;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, result: &RunResult) {
    let listed = &look.model.live.missed()[..];
    let note = if listed.is_empty() { "" } else { "<next-missed> <previous-missed> walk" };
    let block = look.block(Role::Focus, &title(look, listed), &look.keys(note));
    let inner = block.inner(area);
    let (columns, height) = (usize::from(inner.width), usize::from(inner.height).saturating_sub(1));
    let why = listed.get(look.model.ui.missed).map_or_else(Vec::new, |area| {
        whole_reason(area, columns.saturating_sub(3), height.saturating_sub(1))
    });
    let rows: Vec<Parts> = listed.iter().enumerate().map(|(index, area)| row(index, area, columns)).collect();
    let height = height - why.len();
    table::place(look, inner, Rows::Missed, table::window(look.model.ui.missed, rows.len(), height));
    let mut lines = table::rows(look, rows, Some(look.model.ui.missed), (columns, height));
    lines.extend(why.into_iter().map(|line| look.line([(Role::Text, format!("   {line}"))])));
    let kept_role = if result.is_kept { Role::Dim } else { Role::Crit };
    let kept = text::fit(&format!(" {}", text::capitalized(&result.kept)), columns);
    lines.push(look.line([(kept_role, kept)]));
    fill(frame, area, block, lines);
}

fn title(look: &Look, listed: &[&Area<MissReason>]) -> String {
    let others_m2 = look.model.live.not_requested_m2();
    let others = if others_m2 > 0.0 {
        format!("; {} m² not requested", text::number(others_m2, 2))
    } else {
        String::new()
    };
    if listed.is_empty() {
        return format!("Missed  no area{others}");
    }
    let total_m2: f64 = listed.iter().map(|area| area.area_m2).sum();
    let slivers = look.model.live.floor().map(|floor| &floor.slivers);
    let small = slivers.filter(|slivers| slivers.count > 0).map_or_else(String::new, |slivers| {
        format!(", {} smaller, {} m²", slivers.count, text::number(slivers.area_m2, 2))
    });
    let areas = if listed.len() == 1 { "area" } else { "areas" };
    format!("Missed  {} {areas}, {} m²{small}{others}", listed.len(), text::number(total_m2, 2))
}

fn row(index: usize, area: &Area<MissReason>, columns: usize) -> Parts {
    let plate = area.plate.as_deref().unwrap_or("-");
    let place = format!(
        "{:>3} {} {:>16} {:>7} m² ",
        index + 1,
        text::column(plate, 8),
        text::place(area.at),
        text::number(area.area_m2, 3)
    );
    // The mark of the selected row takes one column.
    let room = columns.saturating_sub(text::width(&place) + 1);
    vec![(Role::Text, place + &text::wording([area.why(), brief(area)], room))]
}

/// All causes of an area, in a limited number of rows; the number of causes that do not fit is shown instead.
fn whole_reason(area: &Area<MissReason>, columns: usize, rows: usize) -> Vec<String> {
    let whole = text::wrap(&area.why(), columns);
    if whole.len() <= rows {
        return whole;
    }
    let mut lines: Vec<String> = Vec::new();
    for (index, cause) in area.causes.iter().enumerate() {
        let next = text::wrap(&cause.text, columns);
        let rest = &area.causes[index..];
        if lines.len() + next.len() + usize::from(rest.len() > 1) > rows {
            let rest_m2: f64 = rest.iter().map(|cause| cause.area_m2).sum();
            lines.push(format!("{} more causes, {} m²", rest.len(), text::number(rest_m2, 3)));
            break;
        }
        lines.extend(next);
    }
    lines.truncate(rows);
    lines
}
