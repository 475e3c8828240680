//! Overlay lists: commands, planners, parameters, layers.

mod commands;
pub(super) mod list;
mod parameters;
mod planners;
mod preflight;
mod preset;

use super::alarm_screen;
use super::look::Look;
use crate::model::{Overlay, ui::MapLayer};
use crate::theme::Role;
use list::List;
pub(super) use list::place_cursor;
use ratatui::Frame;
use ratatui::layout::Rect;

/// Maximum width of a list, columns.
const WIDTH: u16 = 78;
/// Maximum width of the list of parameters, columns.
const WIDE: u16 = 116;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    // The keys, and the line above them, stay visible.
    let rows = area.height.saturating_sub(if area.height >= 10 { 3 } else { 0 });
    // The words of a parameter may be long.
    let is_wide = matches!(look.model.ui.overlay, Overlay::Parameters { .. });
    let columns = area.width.min(if is_wide { WIDE } else { WIDTH });
    let list = match &look.model.ui.overlay {
        Overlay::Commands(palette) => commands::list(look, palette, columns),
        Overlay::Planners { purpose, selected } => planners::list(look, *purpose, *selected, columns),
        Overlay::Parameters { selected, edit } => parameters::list(look, *selected, edit.as_ref(), columns),
        Overlay::Preset { name, choice, selected } => preset::list(look, name, choice, *selected, columns),
        Overlay::Preflight { selected } => preflight::list(look, *selected, columns),
        Overlay::Layers { selected } => layers(look, *selected),
        Overlay::Remedies { cause, selected } if !alarm_screen::shows_actions(look.model) => {
            alarm_screen::action_list(look, cause, *selected, columns)
        }
        _ => return,
    };
    let wanted = list.above.len() + list.rows.len() + list.below.len() + 2;
    let height = rows.min(wanted as u16).max(3).min(area.height);
    let x = area.x + (area.width - columns) / 2;
    let y = area.y + 1.min(area.height - height);
    list.draw(look, frame, Rect { x, y, width: columns, height });
}

fn layers(look: &Look, selected: usize) -> List {
    let rows = MapLayer::ALL.into_iter().map(|layer| {
        let mark = if look.model.ui.layers.shows(layer) { "[x]" } else { "[ ]" };
        vec![(Role::Text, format!("{mark} {}", layer.name()))]
    });
    List { title: "Map layers".into(), rows: rows.collect(), selected, ..List::default() }
}
