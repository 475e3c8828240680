//! The plan screen: a mission before it moves.

use super::look::{Look, fill};
use super::{map, planner, text};
use crate::model::ui::Arrangement;
use crate::theme::Role;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    let live = &look.model.live;
    if let Some(why) = &live.failure {
        let block = look.block(Role::Warn, "The scenario cannot be opened", "");
        let columns = usize::from(block.inner(area).width).saturating_sub(2);
        let lines = why.lines().flat_map(|line| text::wrap(line, columns));
        let lines = lines.map(|line| look.line([(Role::Text, format!(" {line}"))])).collect();
        return fill(frame, area, block, lines);
    }
    if arrangement == Arrangement::Paged {
        return map::draw(look, frame, area);
    }
    let wide = arrangement == Arrangement::Wide;
    let side = if wide { 44 } else { 30 };
    let [left, right] = Layout::horizontal([Constraint::Fill(1), Constraint::Length(side)]).areas(area);
    map::draw(look, frame, left);
    planner::draw(look, frame, right);
}
