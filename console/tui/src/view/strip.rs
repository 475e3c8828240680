//! The control strip, for a terminal too small for a map: state, alarm, position, and the most important keys.

use super::look::Look;
use super::next::Clauses;
use super::{confirm, coverage, footer, next, notice, text, top};
use crate::model::{Model, Overlay};
use crate::theme::Role;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let framed = area.width >= 24 && area.height >= 7;
    let title = format!("small terminal {}x{}", area.width, area.height);
    let block = look.block(Role::Border, &title, "");
    let inner = if framed { block.inner(area) } else { area };
    if framed {
        frame.render_widget(block, area);
    }
    let columns = usize::from(inner.width);
    // A question comes first, so that at this size nothing can push it off the screen.
    let mut lines = Vec::new();
    if asks(look.model) {
        lines.extend(wrapped(look, &confirm::clauses(look.model), columns));
    }
    lines.push(state(look));
    lines.extend(alarm(look, columns));
    if !asks(look.model) {
        lines.extend(wrapped(look, &next::clauses(look.model), columns));
    }
    if let Some((role, said)) = notice::lines(look.model, columns) {
        lines.extend(said.iter().map(|line| look.line([(role, format!(" {line}"))])));
    }
    lines.push(Line::from(look.span(Role::Text, text::fit(&position(look), columns))));
    lines.push(footer::line(look, columns));
    lines.push(Line::from(
        look.span(Role::Dim, text::fit(" Map requires 60x16. Controls work here.", columns)),
    ));
    frame.render_widget(Paragraph::new(lines), inner);
}

fn state(look: &Look) -> Line<'static> {
    let mut parts = vec![(Role::Text, " ".to_owned())];
    parts.extend(top::state(look.model));
    parts.push((Role::Text, " ".into()));
    parts.extend(top::time(look.model));
    look.line(parts)
}

fn alarm(look: &Look, columns: usize) -> Option<Line<'static>> {
    let alarm = look.run.alarms.worst()?;
    let mut parts = vec![(Role::Text, " ".to_owned())];
    parts.extend(top::alarms(look.model, false));
    let used: usize = parts.iter().map(|(_, text)| text::width(text)).sum();
    parts.push((Role::Text, text::fit(&format!(" {}", alarm.text), columns.saturating_sub(used))));
    Some(look.line(parts))
}

fn position(look: &Look) -> String {
    let model = look.model;
    let scanned = coverage::shares(&model.live.run).0;
    let error =
        model.live.run.position.error_m().map_or_else(|| "-".into(), |error_m| text::number(error_m, 2));
    let lost = if model.live.run.position.lost { " LOST" } else { "" };
    format!(" {scanned} % of reachable floor, ±{error} m{lost}")
}

/// Clauses, wrapped into lines.
fn wrapped(look: &Look, (role, clauses): &Clauses, columns: usize) -> Vec<Line<'static>> {
    let lines = text::wrap(&clauses.join(" "), columns.saturating_sub(1));
    lines.into_iter().map(|line| Line::from(look.span(*role, format!(" {line}")))).collect()
}

/// Whether a question about moving or about quitting is open.
fn asks(model: &Model) -> bool {
    matches!(model.ui.overlay, Overlay::Confirm(_) | Overlay::Quit | Overlay::Stepping)
}
