//! The plan screen: the path on the map, what the plan promises and what it leaves out, its parameters, the pre-flight
//! checks, and a second plan, by a different planner.

mod along;
mod checks;
mod left_out;
mod parameters;
pub(super) mod promise;
mod state;

use super::look::{Look, fill};
use super::{map, text};
use crate::layout::{self, PlanRows};
use crate::model::{Pane, ui::Arrangement};
use crate::theme::Role;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};

/// Rows of the estimate below the map on a small screen.
const BELOW_MAP: u16 = 2;

pub(crate) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    if let Some(why) = &look.model.live.failure {
        return failure(look, frame, area, why);
    }
    let size = (frame.area().width, frame.area().height);
    let rows = |width| PlanRows { state: state::rows(look, width), checks: checks::rows(look, width) };
    for (pane, area) in layout::plan(area, size, look.model.ui.pane, &rows) {
        match pane {
            Pane::Map if arrangement == Arrangement::Paged => map_with_estimate(look, frame, area),
            Pane::Map => map::draw(look, frame, area),
            Pane::LeftOut => left_out::draw(look, frame, area),
            Pane::Parameters => parameters::draw(look, frame, area),
            Pane::Checks => checks::draw(look, frame, area),
            Pane::Promise => promise::draw(look, frame, area),
            _ => state::draw(look, frame, area),
        }
    }
}

fn map_with_estimate(look: &Look, frame: &mut Frame, area: Rect) {
    let [map, below] = Layout::vertical([Constraint::Fill(1), Constraint::Length(BELOW_MAP)]).areas(area);
    map::draw(look, frame, map);
    let columns = usize::from(below.width).saturating_sub(1);
    // The checks that need attention are counted beside the state.
    let counts = checks::in_a_line(look);
    let room = columns.saturating_sub(counts.as_ref().map_or(0, |(_, words)| text::width(words) + 2));
    let (role, state) = state::in_a_line(look, room);
    let mut first = vec![(role, format!(" {}", text::column(&state, room)))];
    first.extend(counts.map(|(role, words)| (role, format!("  {words}"))));
    let second = vec![(Role::Text, format!(" {}", promise::in_a_line(look, columns)))];
    for (parts, row) in [first, second].into_iter().zip(below.rows()) {
        frame.render_widget(look.line(parts), row);
    }
}

fn failure(look: &Look, frame: &mut Frame, area: Rect, why: &str) {
    let block = look.block(Role::Warn, "The scenario cannot be opened", "");
    let columns = usize::from(block.inner(area).width).saturating_sub(2);
    let lines = why.lines().flat_map(|line| text::wrap(line, columns));
    let lines = lines.map(|line| look.line([(Role::Text, format!(" {line}"))])).collect();
    fill(frame, area, block, lines);
}
