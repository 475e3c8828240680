//! The latest notice to the operator: beside the keys if it fits there, otherwise in lines of its own just above the
//! state. It covers nothing: a pane that it covered could show a certificate or an alarm.

use super::look::Look;
use super::{events, footer, text};
use crate::model::Model;
use crate::theme::Role;
use mission::Severity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

/// The maximum rows of a notice.
const MOST_ROWS: usize = 3;

/// The notice in the line of keys, if it fits beside the keys that are always shown.
pub(super) fn beside(model: &Model, columns: usize) -> Option<(Role, String)> {
    let (role, said) = said(model)?;
    (text::width(&said) <= footer::room(model, columns)).then_some((role, said))
}

/// The role and the wrapped lines of a notice.
pub(super) fn lines(model: &Model, columns: usize) -> Option<(Role, Vec<String>)> {
    let (role, said) = said(model)?;
    let mut lines = text::wrap(&said, columns.saturating_sub(2));
    lines.truncate(MOST_ROWS);
    Some((role, lines))
}

/// The role and the text of a notice.
fn said(model: &Model) -> Option<(Role, String)> {
    let notice = model.notice()?;
    let role = if notice.severity == Severity::Info { Role::Dim } else { events::role(notice.severity) };
    Some((role, text::capitalized(&notice.text)))
}

/// The rows that the notice takes from a screen with `free` rows between the top lines and the state; at least one of
/// them stays.
pub(super) fn rows(model: &Model, columns: u16, free: u16) -> u16 {
    let columns = usize::from(columns);
    if beside(model, columns).is_some() {
        return 0;
    }
    lines(model, columns).map_or(0, |(_, lines)| lines.len() as u16).min(free.saturating_sub(1))
}

/// Draws a notice that does not fit beside the keys in its own rows.
pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let columns = usize::from(area.width);
    let Some((role, lines)) = lines(look.model, columns).filter(|_| area.height > 0) else { return };
    let lines = lines.iter().map(|line| look.line([(role, text::column(&format!(" {line}"), columns))]));
    frame.render_widget(Paragraph::new(lines.collect::<Vec<Line>>()), area);
}
