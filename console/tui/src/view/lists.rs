//! Overlay lists: commands, planners, parameters, layers.

mod commands;
mod finish;
pub(super) mod list;
mod messages;
mod parameters;
mod planners;
mod preflight;
mod preset;

use super::alarm_screen;
use super::look::Look;
use super::tabs;
use crate::model::{
    Overlay,
    ui::{Arrangement, MapLayer},
};
use crate::theme::Role;
use list::List;
pub(super) use list::place_cursor;
use ratatui::Frame;
use ratatui::layout::Rect;

/// Maximum width of a list, columns.
const WIDTH: u16 = 78;
/// Maximum width of the list of parameters, columns.
const WIDE: u16 = 116;
/// Width of the map beside the side panes on a wide terminal, columns.
const MAP: u16 = 70;
/// The least columns of the screen that stay visible on each side of a list.
const BESIDE: u16 = 4;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    // The keys, and the line above them, stay visible.
    let top = u16::from(tabs::has_row(area));
    let rows = area.height.saturating_sub(if area.height >= 10 { 3 + top } else { 0 });
    let wide = Arrangement::of(area.width, area.height) == Arrangement::Wide;
    let widest = match &look.model.ui.overlay {
        // The checks leave the estimate beside the map visible.
        Overlay::Preflight { .. } if wide => MAP,
        // The words of a parameter may be long.
        Overlay::Parameters { .. } => WIDE,
        _ => WIDTH,
    };
    // A strip of the screen that is too narrow to be read is covered, too.
    let columns = if area.width < widest + 2 * BESIDE { area.width } else { widest };
    let list = match &look.model.ui.overlay {
        Overlay::Commands(palette) => commands::list(look, palette, columns),
        Overlay::Planners { purpose, selected, is_unfolded } => {
            planners::list(look, *purpose, (*selected, *is_unfolded), columns)
        }
        Overlay::Parameters { selected, edit } => parameters::list(look, *selected, edit.as_ref(), columns),
        Overlay::Preset { name, choice, selected, left } => {
            preset::list(look, (name, choice), (*selected, left), columns)
        }
        Overlay::Preflight { selected } => preflight::list(look, *selected, columns),
        Overlay::Finish { selected } => finish::list(look, *selected, columns),
        Overlay::Messages { selected } => messages::list(look, *selected, columns),
        Overlay::Layers { selected } => layers(look, *selected),
        Overlay::Remedies { cause, selected, .. } if !alarm_screen::shows_actions(look.model) => {
            alarm_screen::action_list(look, cause, *selected, columns)
        }
        _ => return,
    };
    let wanted = list.above.len() + list.rows.len() + list.below.len() + 2;
    let height = rows.min(wanted as u16).max(3).min(area.height);
    let is_left = wide && matches!(look.model.ui.overlay, Overlay::Preflight { .. });
    let x = if is_left { area.x } else { area.x + (area.width - columns) / 2 };
    let y = area.y + (1 + top).min(area.height - height);
    list.draw(look, frame, Rect { x, y, width: columns, height });
}

fn layers(look: &Look, selected: usize) -> List {
    let rows = MapLayer::ALL.into_iter().map(|layer| {
        let mark = if look.model.ui.layers.shows(layer) { "[x]" } else { "[ ]" };
        vec![(Role::Text, format!("{mark} {}", layer.name()))]
    });
    List { title: "Map layers".into(), rows: rows.collect(), selected, ..List::default() }
}
