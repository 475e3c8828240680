//! The stations pane of a large screen: the measurement of each AE station, and whether it was used.

use super::look::{Look, Parts, fill, marked};
use super::{position, table, text};
use crate::model::Pane;
use crate::model::history::HISTORY_S;
use crate::theme::Role;
use positioning::Exclusion;
use ratatui::Frame;
use ratatui::layout::Rect;
use world::{Station, StationId};

/// The table columns: heading, width and rank; if space is short, columns with the highest rank numbers are dropped
/// first.
const TABLE: [(&str, usize, u8); 8] = [
    ("name", 5, 0),
    ("range", 7, 2),
    ("residual", 8, 0),
    ("limit", 6, 2),
    ("spread", 7, 3),
    ("state", 8, 0),
    ("unused", 6, 1),
    ("rejected", 8, 4),
];

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let is_old = position::old_figures(look).is_some();
    let note = if is_old { "in an earlier fix" } else { "in the last fix" };
    let block = look.pane(Pane::Stations, "Stations", note);
    let columns = usize::from(block.inner(area).width);
    let stations = look.run.about.as_ref().map_or(&[][..], |about| &about.world.stations);
    let head = vec![(Role::Dim, format!(" {}", laid_out(TABLE.map(|(head, ..)| head.to_owned()), columns)))];
    let has_history = usize::from(block.inner(area).height) > 2 * stations.len();
    let none = stations.is_empty().then(|| vec![(Role::Dim, " No AE stations.".to_owned())]);
    let selected = look.model.ui.station.min(stations.len().saturating_sub(1));
    let is_focused = look.model.ui.focus() == Pane::Stations;
    let rows = stations.iter().enumerate().flat_map(|(index, station)| {
        let history = has_history.then(|| look.line(history(look, station.id, columns)));
        let row = row(look, station, columns);
        let line = if is_focused && index == selected {
            table::row(look, unmarked(row), true, columns)
        } else {
            look.line(row)
        };
        std::iter::once(line).chain(history)
    });
    let head = std::iter::once(head).chain(none).map(|parts| look.line(parts));
    fill(frame, area, block, head.chain(rows).collect());
}

fn row(look: &Look, station: &Station, columns: usize) -> Parts {
    let position = &look.run.position;
    let ranged = position.ranges.iter().find(|ranging| ranging.station == station.id);
    let range = ranged.map_or_else(|| "-".into(), |ranging| metres(ranging.range_m, 2));
    let (role, residual_m, limit_m, state) = state(look, station.id);
    let millimetres = |value: Option<f64>| value.map_or_else(|| "-".into(), millimetres);
    let rejected = position.rejections.get(&station.id).copied().unwrap_or(0);
    let cells = [
        station.name.clone(),
        range,
        millimetres(residual_m),
        millimetres(limit_m),
        // The repetitions of one ranging cycle show how clear the signal is.
        millimetres(ranged.map(|ranging| ranging.most_m - ranging.least_m)),
        state.to_owned(),
        position
            .unused_share(station.id)
            .map_or_else(|| "-".into(), |share| format!("{} %", text::number(100.0 * share, 0))),
        rejected.to_string(),
    ];
    let (role, words) = marked(position::old_figures(look).is_some(), (role, laid_out(cells, columns)));
    vec![(role, if words.starts_with('◌') { words } else { format!(" {words}") })]
}

/// A row without its first column, in which the mark of the selection stands.
fn unmarked(row: Parts) -> Parts {
    let rest = |words: String| words.chars().skip(1).collect::<String>();
    row.into_iter().map(|(role, words)| (role, rest(words))).collect()
}

/// A length in metres, at most seven columns wide in any tank.
fn metres(m: f64, decimals: usize) -> String {
    format!("{} m", text::number(m, if m.abs() < 100.0 { decimals } else { 0 }))
}

/// A length in millimetres or, if it is long, in metres: at most six columns wide without its sign.
fn millimetres(m: f64) -> String {
    if m.abs() < 1.0 { format!("{} mm", text::number(1000.0 * m, 0)) } else { metres(m, 2) }
}

/// The curve of a station's residuals over the last minutes, up to its largest value.
fn history(look: &Look, station: StationId, columns: usize) -> Parts {
    let history = look.run.position.station_history_mm.get(&station);
    let Some(history) = history else { return vec![(Role::Dim, " no residual yet".into())] };
    let largest = history.last(HISTORY_S).fold(0.0, f64::max);
    let note = format!(" {}, 0-{} mm", text::minutes(history, HISTORY_S), text::number(largest, 0));
    let room = columns.saturating_sub(text::width(&note) + 2);
    let curve = text::sparkline(history, HISTORY_S, largest, room);
    vec![(Role::Watch, format!(" {curve}")), (Role::Dim, note)]
}

/// The cells of a row that fit; words are left-aligned, figures right-aligned.
fn laid_out(cells: [String; 8], columns: usize) -> String {
    let width = |most: u8| -> usize {
        TABLE.iter().filter(|(.., rank)| *rank <= most).map(|(_, width, _)| width + 1).sum()
    };
    let most = (0..=4).rev().find(|most| width(*most) <= columns).unwrap_or(0);
    let shown = TABLE.iter().zip(cells).filter(|((.., rank), _)| *rank <= most);
    let cells: Vec<String> = shown
        .map(|((head, width, _), cell)| match *head {
            "name" | "state" => text::column(&cell, *width),
            _ => format!("{cell:>width$}"),
        })
        .collect();
    cells.join(" ")
}

/// Whether the last fix did not use a station.
pub(super) fn is_unused(look: &Look, station: StationId) -> bool {
    let fix = look.run.position.fix.as_ref();
    fix.is_some_and(|fix| fix.excluded.iter().any(|(excluded, _)| *excluded == station))
}

/// The result of the last fix for a station: its residual and the largest one that does not contradict the fix, metres, and
/// a word for the result.
fn state(look: &Look, station: StationId) -> (Role, Option<f64>, Option<f64>, &'static str) {
    let Some(fix) = &look.run.position.fix else { return (Role::Text, None, None, "-") };
    let left_out = fix.excluded.iter().find(|(excluded, _)| *excluded == station);
    match left_out {
        Some((_, Exclusion::Silent)) => (Role::Watch, None, None, "SILENT"),
        Some((_, Exclusion::ByOrder)) => (Role::Watch, None, None, "EXCLUDED"),
        Some((_, Exclusion::Biased { bias_m })) => (Role::Watch, Some(*bias_m), None, "BIASED"),
        Some((_, Exclusion::Impossible { .. })) => (Role::Watch, None, None, "INVALID"),
        Some((_, Exclusion::Residual { residual_m, gate_m })) => {
            (Role::Watch, Some(*residual_m), Some(*gate_m), "REJECTED")
        }
        None => match fix.residuals.iter().find(|residual| residual.station == station) {
            Some(residual) => {
                let (role, word) =
                    if residual.is_beyond() { (Role::Warn, "used!") } else { (Role::Text, "used") };
                (role, Some(residual.residual_m), Some(residual.limit_m()), word)
            }
            None => (Role::Dim, None, None, "-"),
        },
    }
}
