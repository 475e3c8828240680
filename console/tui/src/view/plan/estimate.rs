//! What a plan promises, in figures, beside those of a second plan.

use crate::theme::Role;
use crate::view::look::{Look, Parts, fill};
use crate::view::text;
use mission::MissionConfig;
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
    let (mine, other) = head;
    let head = ((Role::Title, mine), other.map(|other| (Role::Ghost, other)));
    let mut rows = vec![row("", head, width)];
    let other = ghost.map(|(_, plan)| &plan.estimate);
    let estimate = live.estimate();
    let mission = look.run.about.as_ref().map(|about| &about.mission);
    for (label, figure) in FIGURES {
        let of = |estimate: Option<&Estimate>, role: Role| {
            let Some(estimate) = estimate else { return (role, "-".to_owned()) };
            match mission.and_then(|mission| beyond(label, estimate, mission)) {
                Some(words) => (Role::Warn, words),
                None => (role, figure(estimate, width)),
            }
        };
        let other = other.map(|other| of(Some(other), Role::Ghost));
        rows.push(row(label, (of(estimate, Role::Text), other), width));
    }
    fill(frame, area, block, rows.into_iter().map(|parts| look.line(parts)).collect());
}

/// A cell of the table.
type Figured = (Role, String);

fn row(label: &str, (mine, other): (Figured, Option<Figured>), width: usize) -> Parts {
    let cells = std::iter::once(mine).chain(other);
    let cells = cells.map(|(role, words)| (role, text::column(&words, width)));
    std::iter::once((Role::Dim, format!(" {label:<LABEL$}"))).chain(cells).collect()
}

/// A figure that breaks a limit of the mission, with the limit.
fn beyond(label: &str, estimate: &Estimate, mission: &MissionConfig) -> Option<String> {
    let metres = |value: f64, limit: f64, decimals| {
        let words = || format!("{} m > {} m", text::number(value, decimals), text::number(limit, decimals));
        (value > limit).then(words)
    };
    let tether = || Some((estimate.tether.as_ref()?, mission.tether.as_ref()?.limits));
    match label {
        "tether out" => {
            tether().and_then(|(tether, limits)| metres(tether.length_max.value, limits.reel_length_m, 1))
        }
        "wrap" => tether().and_then(|(tether, limits)| {
            let (wrap, limit) = (tether.wrap_max.value.to_degrees(), limits.wrap_max_rad.to_degrees());
            let words = || format!("{}° > {}°", text::number(wrap, 0), text::number(limit, 0));
            (wrap > limit).then(words)
        }),
        "AE error" => {
            estimate.accuracy_worst.and_then(|worst| metres(worst.value, mission.position_limit_m, 2))
        }
        "time" => {
            let words =
                || format!("{} > {}", text::clock(estimate.time_s), text::clock(mission.time_limit_s));
            (estimate.time_s > mission.time_limit_s).then(words)
        }
        _ => None,
    }
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
