//! The latest notice to the operator: beside the keys if it fits there, otherwise in separate lines just above the
//! state. It covers neither the state nor a question.

use super::look::Look;
use super::{confirm, events, footer, text};
use crate::model::Model;
use crate::theme::Role;
use mission::Severity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::{Clear, Paragraph};

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

/// Draws a notice that does not fit beside the keys over the last rows above the state; `area` is the whole screen.
pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let columns = usize::from(area.width);
    if beside(look.model, columns).is_some() {
        return;
    }
    let Some((role, lines)) = lines(look.model, columns) else { return };
    let foot = confirm::rows(look, area.width) + 1;
    // Leave the top line and one row of the screen visible.
    let most = area.height.saturating_sub(foot + 2);
    let rows = most.min(lines.len() as u16);
    let place = Rect { y: area.bottom().saturating_sub(foot + rows), height: rows, ..area };
    let lines = lines.iter().map(|line| look.line([(role, text::column(&format!(" {line}"), columns))]));
    frame.render_widget(Clear, place);
    frame.render_widget(Paragraph::new(lines.collect::<Vec<Line>>()), place);
}
