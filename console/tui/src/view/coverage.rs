//! The coverage pane: how much has been scanned, of which floor, and what is left.

use super::look::{Look, fill};
use super::text;
use crate::model::coverage::{Division, Raster};
use crate::model::{Model, Pane, Speed};
use crate::theme::Role;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use world::coverage::percents;

/// What the two columns of shares are shares of, on a wide screen.
const BASES: &str = "reachable  whole floor";
/// Columns of a label, of a share of the whole floor, and of the bar on a narrow screen.
const LABEL: usize = 13;
const WHOLE: usize = 13;
const BAR: usize = 8;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, wide: bool) {
    let block = look.pane(Pane::Coverage, "Coverage", if wide { BASES } else { "" });
    let columns = usize::from(block.inner(area).width);
    let lines = if wide { wide_lines(look, columns) } else { narrow_lines(look) };
    fill(frame, area, block, lines);
}

fn wide_lines(look: &Look, columns: usize) -> Vec<Line<'static>> {
    let model = look.model;
    let (reachable, whole) = shares(model);
    let [_, to_do, margin, unreachable] = division(model);
    let row = |label: &str, value: String| {
        look.line([(Role::Dim, format!(" {label:<LABEL$}")), (Role::Text, value)])
    };
    // Each share ends below the name of its floor.
    let first = columns.saturating_sub(LABEL + WHOLE + 3);
    let row_of_shares = |label: &str, of_reachable: String, of_whole: &str| {
        row(label, format!("{of_reachable:>first$}{:>WHOLE$}", format!("{of_whole} %")))
    };
    vec![
        row_of_shares("scanned", format!("{reachable} %"), &whole),
        look.line([(Role::Good, format!(" {}", bar(model, columns.saturating_sub(2))))]),
        row_of_shares(to_do_label(model), format!("{} %", to_do_reachable(model)), &to_do),
        row_of_shares("unreachable", String::new(), &unreachable),
        row_of_shares("shell margin", String::new(), &margin),
        row("rate", rate(model)),
        row(way_label(model), way(model)),
        row("time left", left(model, true)),
    ]
}

fn narrow_lines(look: &Look) -> Vec<Line<'static>> {
    let model = look.model;
    let (reachable, whole) = shares(model);
    let text = |value: String| look.line([(Role::Text, format!(" {value}"))]);
    let left_or_missed = if model.has_ended() {
        format!("missed {} % of reachable", to_do_reachable(model))
    } else {
        format!("left {}", left(model, false))
    };
    vec![
        look.line([
            (Role::Good, format!(" {}", bar(model, BAR))),
            (Role::Text, format!(" {reachable:>5} % reachable")),
        ]),
        text(format!("{:BAR$} {whole:>5} % whole", "")),
        text(format!("{} {}", way_label(model), way(model))),
        text(left_or_missed),
    ]
}

/// Scanned shares of the reachable and of the whole floor; dashes before the first step.
pub(super) fn shares(model: &Model) -> (String, String) {
    model.progress.as_ref().map_or_else(
        || ("-".into(), "-".into()),
        |progress| (text::percent(progress.covered_reachable), text::percent(progress.covered_whole)),
    )
}

fn bar(model: &Model, columns: usize) -> String {
    text::bar(model.progress.as_ref().map_or(0.0, |progress| progress.covered_reachable), columns)
}

/// How the whole floor divides, in per cent that sum to 100.0: scanned, to do, shell margin, out of reach elsewhere.
fn division(model: &Model) -> [String; 4] {
    let Some(raster) = &model.coverage else { return [(); 4].map(|()| "-".into()) };
    let Division { scanned, to_do, margin, unreachable } = raster.division();
    percents([scanned, to_do, margin, unreachable]).map(|percent| text::number(percent, 1))
}

/// What is not scanned is still to do, and missed when the mission has ended.
fn to_do_label(model: &Model) -> &'static str {
    if model.has_ended() { "missed" } else { "to do" }
}

/// The same of the reachable floor.
fn to_do_reachable(model: &Model) -> String {
    let scanned = model.progress.as_ref().map(|progress| progress.covered_reachable);
    scanned.map_or_else(|| "-".into(), |scanned| text::number(percents([scanned, 1.0 - scanned])[1], 1))
}

fn rate(model: &Model) -> String {
    let scanned_m2 = model.coverage.as_ref().map_or(0.0, Raster::scanned_m2);
    let minutes = model.clock.moving_s / 60.0;
    let rate = if minutes > 0.2 { text::number(scanned_m2 / minutes, 1) } else { "-".into() };
    format!("{rate} m²/min, {} m² scanned", text::number(scanned_m2, 0))
}

fn way_label(model: &Model) -> &'static str {
    if model.run.as_ref().is_some_and(|run| run.preset_m.is_some()) { "path" } else { "plan" }
}

fn way(model: &Model) -> String {
    let preset_m = model.run.as_ref().and_then(|run| run.preset_m);
    match (preset_m, &model.progress) {
        (Some(preset_m), Some(progress)) => {
            let along = progress.along_m.map_or_else(|| "-".into(), |along_m| text::number(along_m, 1));
            format!("{along} m of {} m", text::number(preset_m, 1))
        }
        (Some(preset_m), None) => format!("0.0 m of {} m", text::number(preset_m, 1)),
        (None, _) => model
            .planning
            .plan
            .as_ref()
            .map_or_else(|| "- m".into(), |plan| format!("{} m", text::number(plan.length_m, 1))),
    }
}

/// Mission time still to go, and when that will be.
fn left(model: &Model, wide: bool) -> String {
    let Some(left_s) = model.left_s() else {
        return if model.has_ended() { "ended".into() } else { "-".into() };
    };
    let factor = match (model.console.speed, model.console.health.reached_speed) {
        (_, Some(reached)) if reached > 0.0 => Some(reached),
        (Speed::Times(factor), _) => Some(factor),
        (Speed::Max, _) => None,
    };
    let end = factor.map(|factor| text::time_of_day(model.console.now.wall_unix_s + left_s / factor));
    match (wide, end) {
        (true, Some(end)) => format!("{}, ends {end} UTC", text::clock(left_s)),
        (false, Some(end)) => format!("{} ETA {end}Z", text::clock(left_s)),
        (_, None) => text::clock(left_s),
    }
}
