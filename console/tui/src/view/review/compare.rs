//! The figures of two reports side by side, and their differences.

use crate::model::Replay;
use crate::model::replay::Other;
use crate::theme::Role;
use crate::view::look::{Look, fill};
use crate::view::text;
use account::Summary;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use world::coverage::percent;

/// A figure of a report.
struct Figure {
    what: &'static str,
    unit: &'static str,
    decimals: usize,
    of: fn(&Summary) -> Option<f64>,
}

const fn figure(
    what: &'static str,
    unit: &'static str,
    decimals: usize,
    of: fn(&Summary) -> Option<f64>,
) -> Figure {
    Figure { what, unit, decimals, of }
}

/// The figures, most important first.
const FIGURES: [Figure; 15] = [
    figure("scanned", "% reach.", 1, |s| s.coverage.as_ref().map(|c| percent(c.reachable))),
    figure("missed", "m²", 2, |s| s.coverage.as_ref()?.missed_area_m2),
    figure("time", "s", 0, |s| s.mission_time_s),
    figure("path", "m", 1, |s| s.path_length_m),
    figure("overlap", "%", 1, |s| s.coverage.as_ref()?.overlap.map(|share| 100.0 * share)),
    figure("clearance", "m", 2, |s| s.clearance_min_m),
    figure("AE p95", "m", 3, |s| s.accuracy.map(|a| a.p95_m)),
    figure("AE largest", "m", 3, |s| s.accuracy.map(|a| a.max_m)),
    figure("tether", "m", 1, |s| s.tether.as_ref().map(|t| t.tether_length_max_m)),
    figure("wrap", "°", 0, |s| s.tether.as_ref().map(|t| t.wrap_max_rad.to_degrees())),
    figure("collisions", "", 0, |s| s.collisions.map(|n| n as f64)),
    figure("holds", "", 0, |s| Some(s.holds as f64)),
    figure("faults", "", 0, |s| Some(s.planner_faults as f64)),
    figure("found", "", 0, |s| Some(s.obstacles_found as f64)),
    figure("turns", "", 0, |s| s.turns.map(|n| n as f64)),
];

/// The rows that the comparison needs, including the frame.
pub(super) fn rows(look: &Look, (_, other): (&Replay, &Other)) -> u16 {
    let a = look.model.live.result.as_ref().map(|result| &*result.summary);
    known(a, other.summary.as_deref()).count() as u16 + 4
}

/// The figures that one of the reports has.
fn known<'a>(
    a: Option<&'a Summary>,
    b: Option<&'a Summary>,
) -> impl Iterator<Item = &'static Figure> + use<'a> {
    FIGURES.iter().filter(move |figure| [a, b].into_iter().flatten().any(|s| (figure.of)(s).is_some()))
}

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, (replay, other): (&Replay, &Other)) {
    let note = look.keys("<compare-run>: another run (same run again: end)");
    let block = look.block(Role::Border, "Compare", &note);
    let columns = usize::from(block.inner(area).width);
    let rows = usize::from(block.inner(area).height).saturating_sub(2);
    let a = look.model.live.result.as_ref().map(|result| &*result.summary);
    let b = other.summary.as_deref();
    let width = columns.saturating_sub(LABEL + 1) / 3;
    let mut lines = vec![row(look, Role::Dim, "", ["A", "B", "A-B"].map(str::to_owned), width)];
    lines.extend(known(a, b).take(rows).map(|figure| line(look, figure, (a, b), width)));
    lines.push(look.line([(Role::Dim, format!(" {}", text::fit(&same(replay, other, (a, b)), columns)))]));
    fill(frame, area, block, lines);
}

/// Width of a figure's name with its unit, columns.
const LABEL: usize = 17;

fn line(
    look: &Look,
    figure: &Figure,
    (a, b): (Option<&Summary>, Option<&Summary>),
    width: usize,
) -> Line<'static> {
    let [a, b] = [a, b].map(|summary| summary.and_then(figure.of));
    let number = |value: Option<f64>| value.map_or_else(|| "-".into(), |v| text::number(v, figure.decimals));
    // The difference between the numbers as shown.
    let scale = 10_f64.powi(figure.decimals as i32);
    let shown = |value: f64| (value * scale).round() / scale;
    let difference = a.zip(b).map(|(a, b)| shown(a) - shown(b));
    let sign = if difference.is_some_and(|by| by * scale > 0.5) { "+" } else { "" };
    let difference = format!("{sign}{}", number(difference));
    let label = format!("{} {}", figure.what, figure.unit);
    row(look, Role::Text, label.trim_end(), [number(a), number(b), difference], width)
}

fn row(look: &Look, role: Role, label: &str, values: [String; 3], width: usize) -> Line<'static> {
    let values = values.map(|value| format!("{value:>width$}")).concat();
    look.line([(Role::Dim, format!(" {}", text::column(label, LABEL))), (role, values)])
}

/// The line about what the two runs have in common, so that the reader can judge the comparison.
fn same(replay: &Replay, other: &Other, summaries: (Option<&Summary>, Option<&Summary>)) -> String {
    let (Some(a), Some(b)) = summaries else {
        let missing = if summaries.0.is_none() { &replay.name } else { &other.name };
        return format!("The report of {missing} is being read.");
    };
    let word = |is_same: bool| if is_same { "same" } else { "different" };
    let seed = word(a.seed == b.seed);
    format!(
        "{} scenario, {seed} seed, {} planner",
        word(a.scenario == b.scenario),
        word(a.planner == b.planner)
    )
}
