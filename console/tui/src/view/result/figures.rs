//! What was achieved against what the plan promised.

use super::role;
use crate::model::RunResult;
use crate::theme::Role;
use crate::view::look::{Look, Parts, fill};
use crate::view::text;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// A figure: what it is, as the plan promised it, as it came, and the limit.
type Figure = [String; 4];

/// Rows of the table, in some columns.
pub(super) fn rows(look: &Look, result: &RunResult, columns: u16) -> u16 {
    let words = reason(result, columns.into()).len() + trouble(look, result, columns.into()).len();
    1 + (words + figures(look, result).len()) as u16
}

/// Why the mission ended, in lines.
fn reason(result: &RunResult, columns: usize) -> Vec<String> {
    let reason = result.summary.reason.as_deref().unwrap_or("cut off");
    text::wrap(&text::capitalized(reason), columns.saturating_sub(1))
}

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, title: &str, result: &RunResult) {
    let block = look.block(role(result), title, "");
    let columns = usize::from(block.inner(area).width);
    let label = 11.min(columns / 3);
    let width = columns.saturating_sub(label + 2) / 3;
    let why = reason(result, columns).into_iter();
    let mut lines: Vec<Line> = why.map(|line| look.line([(role(result), format!(" {line}"))])).collect();
    let head = ["", "predicted", "actual", "limit"].map(str::to_owned);
    let table = std::iter::once((Role::Dim, head))
        .chain(figures(look, result).into_iter().map(|row| (Role::Text, row)));
    lines.extend(table.map(|(role, [what, predicted, actual, limit])| {
        look.line([
            (Role::Dim, format!(" {}", text::column(&what, label))),
            (Role::Dim, format!("{predicted:>width$}")),
            (role, format!("{actual:>width$}")),
            (Role::Dim, format!("{limit:>width$}")),
        ])
    }));
    lines.extend(trouble(look, result, columns).into_iter().map(|parts| look.line(parts)));
    fill(frame, area, block, lines);
}

fn figures(look: &Look, result: &RunResult) -> Vec<Figure> {
    let (run, summary) = (look.run, &result.summary);
    let promised = look.model.live.plans.estimate.as_ref().map(|(_, estimate)| estimate);
    let mission = run.about.as_ref().map(|about| &about.mission);
    let metres = |value: Option<f64>, decimals| {
        value.map_or_else(dash, |m| format!("{} m", text::number(m, decimals)))
    };
    let degrees =
        |value: Option<f64>| value.map_or_else(dash, |rad| format!("{}°", text::number(rad.to_degrees(), 0)));
    let clock = |value: Option<f64>| value.map_or_else(dash, text::clock);
    let mut figures = vec![
        row(
            "time",
            [
                clock(promised.map(|p| p.time_s)),
                clock(summary.mission_time_s),
                clock(mission.map(|mission| mission.time_limit_s)),
            ],
        ),
        row(
            "path",
            [metres(promised.map(|p| p.length_m), 1), metres(summary.path_length_m, 1), String::new()],
        ),
        row(
            "clearance",
            [
                metres(promised.and_then(|p| p.clearance_min).map(|worst| worst.value), 2),
                metres(summary.clearance_min_m, 2),
                metres(mission.map(|mission| mission.clearance_m), 2),
            ],
        ),
    ];
    if let Some(tether) = &summary.tether {
        let (estimate, limits) =
            (promised.and_then(|p| p.tether.as_ref()), mission.and_then(|m| m.tether.as_ref()));
        figures.push(row(
            "tether out",
            [
                metres(estimate.map(|t| t.length_max.value), 1),
                metres(Some(tether.tether_length_max_m), 1),
                metres(limits.map(|t| t.limits.reel_length_m), 1),
            ],
        ));
        figures.push(row(
            "wrap",
            [
                degrees(estimate.map(|t| t.wrap_max.value)),
                degrees(Some(tether.wrap_max_rad)),
                degrees(limits.map(|t| t.limits.wrap_max_rad)),
            ],
        ));
    }
    figures.push(row(
        "95 % error",
        [
            String::new(),
            metres(summary.accuracy.as_ref().map(|accuracy| accuracy.p95_m), 2),
            metres(summary.accuracy.as_ref().map(|accuracy| accuracy.limit_m), 2),
        ],
    ));
    figures
}

fn row(what: &str, [predicted, actual, limit]: [String; 3]) -> Figure {
    [what.to_owned(), predicted, actual, limit]
}

fn dash() -> String {
    "-".to_owned()
}

/// Holds, collisions, faults and alarms, in lines.
fn trouble(look: &Look, result: &RunResult, columns: usize) -> Vec<Parts> {
    let summary = &result.summary;
    let alarms = look.run.alarms.open().count();
    let words = format!(
        "Holds {}, collisions {}, planner faults {}, alarms open {alarms}.",
        summary.holds,
        summary.collisions.unwrap_or(0),
        summary.planner_faults
    );
    let lines = text::wrap(&words, columns.saturating_sub(1)).into_iter();
    lines.map(|line| vec![(Role::Text, format!(" {line}"))]).collect()
}
