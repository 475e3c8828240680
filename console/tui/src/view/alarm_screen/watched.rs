//! What the screen shows while the table lists no alarm: the limits that are watched, with the values now, and their
//! curves.

use crate::model::health::{DISK_MB, RECORDER_LAG};
use crate::model::ui::Chart;
use crate::theme::Role;
use crate::view::look::{Look, Parts, fill};
use crate::view::plan::promise::{Watched, watched};
use crate::view::{charts, text};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};

/// Widths of a label, of a value and of a limit, columns.
const LABEL: usize = 18;
const VALUE: usize = 18;
const LIMIT: usize = 14;
/// Rows of a curve, including the frame.
const CURVE: u16 = 10;
/// The fewest rows of a curve, including the frame.
pub(super) const LEAST_CURVE: u16 = 7;
/// The width that a curve needs beside others, columns.
const CURVE_COLUMNS: u16 = 38;

/// The rows that the limits need, including the frame and the headings.
pub(super) fn rows(look: &Look) -> u16 {
    all(look).len() as u16 + 3
}

/// The figures of the mission, then those of the console.
fn all(look: &Look) -> Vec<Watched> {
    let model = look.model;
    let moves = model.live.may_move();
    let free = model.home.found.as_ref().and_then(|found| found.free_bytes);
    let disk = free.map(|bytes| Watched {
        label: "disk space left",
        now: format!("{} MB", bytes / 1_000_000),
        limit: format!("{} MB", text::number(DISK_MB.of(moves).alarm, 0)),
    });
    let lag = Watched {
        label: "ticks to record",
        now: model.live.health.recorder_lag.to_string(),
        limit: text::number(RECORDER_LAG.of(moves).alarm, 0),
    };
    let of_console = disk.into_iter().chain(model.live.run.about.is_some().then_some(lag));
    watched(look.run).into_iter().chain(of_console).collect()
}

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let head = row("figure", "now", "alarm at", Role::Dim);
    let rows = all(look).into_iter().map(|figure| row(figure.label, &figure.now, &figure.limit, Role::Text));
    let lines = std::iter::once(head).chain(rows).map(|parts| look.line(parts)).collect();
    fill(frame, area, look.block(Role::Border, "Limits that are watched", ""), lines);
}

fn row(label: &str, now: &str, limit: &str, role: Role) -> Parts {
    vec![
        (Role::Dim, format!(" {}", text::column(label, LABEL))),
        (role, format!("{now:>VALUE$}")),
        (Role::Dim, format!("{limit:>LIMIT$}")),
    ]
}

/// The charts of the figures that this mission has.
fn figures_charted(look: &Look) -> impl Iterator<Item = Chart> + use<> {
    let tether = look.run.tether.is_some();
    let all = [Chart::Error, Chart::Residual, Chart::TetherOut, Chart::Wrap];
    all.into_iter().filter(move |chart| tether || matches!(chart, Chart::Error | Chart::Residual))
}

/// The curves beside each other, as many as fit, and the robot in the tank.
pub(super) fn curves_in_a_row(look: &Look, frame: &mut Frame, area: Rect) {
    let shown: Vec<Chart> =
        figures_charted(look).take(usize::from(area.width / CURVE_COLUMNS).saturating_sub(1)).collect();
    let columns = Layout::horizontal(vec![Constraint::Fill(1); shown.len() + 1]).split(area);
    for (chart, area) in shown.iter().zip(columns.iter()) {
        charts::draw(look, frame, *area, *chart);
    }
    if let Some(area) = columns.last() {
        super::draw_place(look, frame, *area, None);
    }
}

/// The curves beside each other, as many as fit.
pub(super) fn curves_alone(look: &Look, frame: &mut Frame, area: Rect) {
    let shown: Vec<Chart> = figures_charted(look).take(usize::from(area.width / CURVE_COLUMNS)).collect();
    let columns = Layout::horizontal(vec![Constraint::Fill(1); shown.len()]).split(area);
    for (chart, area) in shown.iter().zip(columns.iter()).filter(|(_, area)| area.height > 0) {
        charts::draw(look, frame, *area, *chart);
    }
}

/// The curves of the figures with their limits, and the robot in the tank.
pub(super) fn curves(look: &Look, frame: &mut Frame, area: Rect) {
    let shown: Vec<Chart> =
        figures_charted(look).take(usize::from(area.height / CURVE).saturating_sub(1)).collect();
    let rows = Layout::vertical(shown.iter().map(|_| Constraint::Length(CURVE)).chain([Constraint::Fill(1)]))
        .split(area);
    for (chart, area) in shown.iter().zip(rows.iter()) {
        charts::draw(look, frame, *area, *chart);
    }
    if let Some(area) = rows.last() {
        super::draw_place(look, frame, *area, None);
    }
}
