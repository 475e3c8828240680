//! What a plan promises, in figures, beside those of a second plan.

use crate::theme::Role;
use crate::view::look::{Look, Parts, fill};
use crate::view::text;
use ratatui::Frame;
use ratatui::layout::Rect;
use report::Estimate;

/// Rows of the table, its head included.
pub(super) const ROWS: u16 = 9;
/// Columns of a label.
const LABEL: usize = 12;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let block = look.block(Role::Border, "Estimate", "on the drawing");
    let columns = usize::from(block.inner(area).width);
    let live = &look.model.live;
    let ghost =
        live.plans.ghost.as_ref().and_then(|ghost| Some((ghost, ghost.made.as_ref()?.as_ref().ok()?)));
    let width = columns.saturating_sub(LABEL + 2) / if ghost.is_some() { 2 } else { 1 };
    let head =
        (look.run.planner_id().unwrap_or("-").to_owned(), ghost.map(|(ghost, _)| ghost.choice.id.clone()));
    let mut rows = vec![row("", Role::Title, head, width)];
    let other = ghost.map(|(_, plan)| &plan.estimate);
    let estimate = live.estimate();
    for (label, figure) in FIGURES {
        let of = |estimate: Option<&Estimate>| {
            estimate.map_or_else(|| "-".to_owned(), |estimate| figure(estimate, width))
        };
        rows.push(row(label, Role::Text, (of(estimate), other.map(|other| of(Some(other)))), width));
    }
    fill(frame, area, block, rows.into_iter().map(|parts| look.line(parts)).collect());
}

fn row(label: &str, role: Role, (mine, other): (String, Option<String>), width: usize) -> Parts {
    let mut parts = vec![(Role::Dim, format!(" {label:<LABEL$}")), (role, text::column(&mine, width))];
    parts.extend(other.map(|other| (Role::Ghost, text::column(&other, width))));
    parts
}

type Figure = fn(&Estimate, usize) -> String;

/// The figures in the order of the table; where there is room, also the place where a figure is worst.
const FIGURES: [(&str, Figure); 8] = [
    ("time", |e, _| text::clock(e.time_s)),
    ("length", |e, _| format!("{} m", text::number(e.length_m, 1))),
    ("coverage", |e, _| {
        e.reachable.map_or_else(|| "-".into(), |share| format!("{} % reachable", text::percent(share)))
    }),
    ("clearance", |e, width| worst(e.clearance_min, "m", 2, width)),
    ("tether out", |e, width| worst(e.tether.as_ref().map(|t| t.length_max), "m", 1, width)),
    ("wrap", |e, width| {
        let Some(tether) = &e.tether else { return "-".into() };
        let on = if tether.wrapped.is_empty() { String::new() } else { format!(" on {}", tether.wrapped) };
        text::fit(&format!("{}°{on}", text::number(tether.wrap_max.value.to_degrees(), 0)), width)
    }),
    ("AE error", |e, width| worst(e.accuracy_worst, "m", 2, width)),
    ("without fix", |e, _| format!("{} m", text::number(e.without_fix_m, 1))),
];

fn worst(worst: Option<report::estimate::Worst>, unit: &str, decimals: usize, width: usize) -> String {
    let Some(worst) = worst else { return "-".into() };
    let figure = format!("{} {unit}", text::number(worst.value, decimals));
    let full = format!("{figure} at {}", text::place(worst.at));
    if text::width(&full) <= width { full } else { figure }
}
