//! The events pane, newest line first.

use super::look::{Look, fill};
use super::text;
use crate::model::{Entry, Pane};
use crate::theme::Role;
use mission::Severity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let ui = &look.model.ui;
    let filter =
        if ui.needle.is_empty() { String::new() } else { format!(", `{}`", text::fit(&ui.needle, 16)) };
    let back = if ui.scroll > 0 { format!(", {} newer", ui.scroll) } else { String::new() };
    let title = format!("Events, {} and above{filter}{back}", word(ui.least));
    let note = if area.width >= 60 { "m severity  / filter" } else { "" };
    let block = look.pane(Pane::Events, &title, note);
    let inner = block.inner(area);
    let lines = look
        .run
        .log
        .shown(ui.least, &ui.needle)
        .skip(ui.scroll)
        .take(usize::from(inner.height))
        .map(|entry| row(look, entry, usize::from(inner.width)))
        .collect();
    fill(frame, area, block, lines);
}

/// How a severity is written.
pub(super) fn word(severity: Severity) -> &'static str {
    match severity {
        Severity::Info => "INFO",
        Severity::Watch => "WATCH",
        Severity::Warn => "WARN",
        Severity::Crit => "CRIT",
    }
}

/// How a severity looks.
pub(super) fn role(severity: Severity) -> Role {
    match severity {
        Severity::Info => Role::Text,
        Severity::Watch => Role::Watch,
        Severity::Warn => Role::Warn,
        Severity::Crit => Role::Crit,
    }
}

/// A line of the log as text.
pub(crate) fn log_line(entry: &Entry) -> String {
    let Entry { t_s, severity, source, text, .. } = entry;
    format!("T+{} {} {source}: {text}", text::clock(*t_s), word(*severity))
}

fn row(look: &Look, entry: &Entry, columns: usize) -> Line<'static> {
    let again = if entry.count > 1 { format!(" (×{})", entry.count) } else { String::new() };
    let front = format!(" T+{} ", text::clock(entry.t_s));
    let source = text::column(&entry.source, 8);
    let severity = format!("{:<5}", word(entry.severity));
    let room = columns.saturating_sub(text::width(&front) + 1 + 8 + severity.len() + text::width(&again) + 1);
    look.line([
        (Role::Dim, front),
        (role(entry.severity), severity),
        (Role::Dim, format!(" {source}")),
        (Role::Text, text::fit(&entry.text, room)),
        (Role::Dim, again),
    ])
}
