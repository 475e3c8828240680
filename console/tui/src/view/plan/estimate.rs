//! The figures in the estimate for a plan, alongside those for a second plan.

use crate::theme::Role;
use crate::view::look::{Look, Parts, fill};
use crate::view::text;
use account::Estimate;
use mission::MissionConfig;
use ratatui::Frame;
use ratatui::layout::Rect;

/// Rows of the table, including its heading.
pub(super) const ROWS: u16 = 9;
/// Width of a label, columns.
const LABEL: usize = 12;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let block = look.block(Role::Border, "Estimate", "on the drawing");
    let columns = usize::from(block.inner(area).width);
    let live = &look.model.live;
    let ghost =
        live.plans.ghost.as_ref().and_then(|ghost| Some((ghost, ghost.made.as_ref()?.as_ref().ok()?)));
    let width = columns.saturating_sub(LABEL + 2) / if ghost.is_some() { 2 } else { 1 };
    let mine = look.run.planner_id().unwrap_or("-");
    let head = match ghost.map(|(ghost, _)| ghost.choice.id.as_str()) {
        // The planner pane names the second planner.
        Some(other) if text::width(mine).max(text::width(other)) >= width => ("active", Some("compared")),
        other => (mine, other),
    };
    let title = |role: Role, words: &str| (role, words.to_owned());
    let head = (title(Role::Title, head.0), head.1.map(|other| title(Role::Ghost, other)));
    let mut rows = vec![row("", head, width)];
    let other = ghost.map(|(_, plan)| &plan.estimate);
    let estimate = live.estimate();
    let mission = look.run.about.as_ref().map(|about| &about.mission);
    for (label, figure) in FIGURES {
        let of = |estimate: Option<&Estimate>, role: Role| {
            let Some(estimate) = estimate else { return (role, "-".to_owned()) };
            match mission.and_then(|mission| beyond(label, estimate, mission, width)) {
                Some(words) => (Role::Warn, words),
                None => (role, figure(estimate, width)),
            }
        };
        let other = other.map(|other| of(Some(other), Role::Ghost));
        rows.push(row(label, (of(estimate, Role::Text), other), width));
    }
    fill(frame, area, block, rows.into_iter().map(|parts| look.line(parts)).collect());
}

/// A cell in the table: role and text.
type Figured = (Role, String);

fn row(label: &str, (mine, other): (Figured, Option<Figured>), width: usize) -> Parts {
    let cells = std::iter::once(mine).chain(other);
    let cells = cells.map(|(role, words)| (role, text::column(&words, width)));
    std::iter::once((Role::Dim, format!(" {label:<LABEL$}"))).chain(cells).collect()
}

/// A figure that exceeds a limit of the mission, with the limit if it fits.
fn beyond(label: &str, estimate: &Estimate, mission: &MissionConfig, width: usize) -> Option<String> {
    let said = |found: String, limit: String| {
        text::wording([format!("{found} > {limit}"), format!("{found}!")], width.saturating_sub(1))
    };
    let metres = |value: f64, limit: f64, decimals| {
        let metres = |value| format!("{} m", text::number(value, decimals));
        (value > limit).then(|| said(metres(value), metres(limit)))
    };
    let tether = || Some((estimate.tether.as_ref()?, mission.tether.as_ref()?.limits));
    match label {
        "tether out" => {
            tether().and_then(|(tether, limits)| metres(tether.length_max.value, limits.reel_length_m, 1))
        }
        "wrap" => tether().and_then(|(tether, limits)| {
            let (wrap, limit) = (tether.wrap_max.value.to_degrees(), limits.wrap_max_rad.to_degrees());
            let degrees = |value| format!("{}°", text::number(value, 0));
            (wrap > limit).then(|| said(degrees(wrap), degrees(limit)))
        }),
        "AE error" => {
            estimate.accuracy_worst.and_then(|worst| metres(worst.value, mission.position_limit_m, 2))
        }
        "time" => (estimate.time_s > mission.time_limit_s)
            .then(|| said(text::clock(estimate.time_s), text::clock(mission.time_limit_s))),
        _ => None,
    }
}

type Figure = fn(&Estimate, usize) -> String;

/// The figures in table order; if space allows, also the place where a figure is worst.
const FIGURES: [(&str, Figure); 8] = [
    ("time", |e, _| text::clock(e.time_s)),
    ("length", |e, _| format!("{} m", text::number(e.length_m, 1))),
    ("coverage", |e, width| {
        let Some(share) = e.reachable.map(text::percent) else { return "-".into() };
        text::wording([format!("{share} % reachable"), format!("{share} %")], width.saturating_sub(1))
    }),
    ("clearance", |e, width| worst(e.clearance_min, "m", 2, width)),
    ("tether out", |e, width| worst(e.tether.as_ref().map(|t| t.length_max), "m", 1, width)),
    ("wrap", |e, width| {
        let Some(tether) = &e.tether else { return "-".into() };
        let wrap = format!("{}°", text::number(tether.wrap_max.value.to_degrees(), 0));
        let on = if tether.wrapped.is_empty() { String::new() } else { format!(" on {}", tether.wrapped) };
        text::wording([format!("{wrap}{on}"), wrap], width.saturating_sub(1))
    }),
    ("AE error", |e, width| worst(e.accuracy_worst, "m", 2, width)),
    ("without fix", |e, _| format!("{} m", text::number(e.without_fix_m, 1))),
];

fn worst(worst: Option<account::estimate::Worst>, unit: &str, decimals: usize, width: usize) -> String {
    let Some(worst) = worst else { return "-".into() };
    let figure = format!("{} {unit}", text::number(worst.value, decimals));
    text::wording([format!("{figure} at {}", text::place(worst.at)), figure], width)
}
