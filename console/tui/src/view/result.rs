//! The result screen: what a mission has achieved, and what can be done next.

use super::look::{Look, fill};
use super::{map, text};
use crate::model::ui::Arrangement;
use crate::theme::Role;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    let Some(result) = &look.model.live.result else {
        let block = look.block(Role::Border, "Result", "");
        return fill(frame, area, block, vec![look.line([(Role::Dim, " No run has ended yet.".into())])]);
    };
    let wide = arrangement == Arrangement::Wide;
    let [left, right] = match arrangement {
        Arrangement::Paged => [Rect { width: 0, ..area }, area],
        _ => Layout::horizontal([Constraint::Fill(1), Constraint::Length(if wide { 60 } else { 44 })])
            .areas(area),
    };
    if left.width > 0 {
        map::draw(look, frame, left);
    }
    let block = look.block(Role::Border, "Result", "");
    let columns = usize::from(block.inner(right).width).saturating_sub(1);
    let report = report::human(&result.summary);
    let words = report.lines().chain([result.kept.as_str()]);
    let lines: Vec<Line> = words
        .flat_map(|line| text::wrap(line, columns))
        .map(|line| look.line([(Role::Text, format!(" {line}"))]))
        .collect();
    fill(frame, right, block, lines);
}
