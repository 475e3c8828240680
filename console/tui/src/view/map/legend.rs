//! What the marks on the map stand for.

use crate::caps::Glyphs;
use crate::model::ui::MapLayer;
use crate::theme::Role;
use crate::view::look::Look;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::Clear;

/// Columns and rows of the legend.
const SIZE: (u16, u16) = (12, 9);

/// Draws it in the corner of an area.
pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let layers = look.model.ui.layers;
    let plain = look.is_plain();
    let braille = look.caps.glyphs == Glyphs::Braille;
    let swatch = |filled: &'static str| if plain { filled } else { "██" };
    let line = |dots: &'static str, letters: &'static str| if braille { dots } else { letters };
    let found = look.run.about.iter().flat_map(|run| &run.world.obstacles).any(|obstacle| !obstacle.known);
    let entries = [
        (layers.shows(MapLayer::Scanned), Role::Scanned, swatch("▒▒"), "scanned"),
        (layers.shows(MapLayer::Scanned), Role::Partly, swatch("░░"), "partial"),
        (layers.shows(MapLayer::Accuracy), Role::Crit, if plain { "%%" } else { "██" }, "poor fix"),
        (layers.shows(MapLayer::Trail), Role::Trail, line("⠤⠤", ".."), "trail"),
        (layers.shows(MapLayer::Plan), Role::Plan, line("⠄⠠", ",,"), "plan"),
        (look.run.tether.is_some(), Role::Tether, line("⠤⠤", "~~"), "tether"),
        (true, Role::Obstacle, "# ", "obstacle"),
        (found, Role::Found, "? ", "found"),
        (layers.shows(MapLayer::Stations), Role::Station, "S ", "station"),
        (true, Role::Target, "× ", "target"),
    ];
    let lines: Vec<Line> = entries
        .into_iter()
        .filter(|(shown, ..)| *shown)
        .map(|(_, role, mark, word)| {
            Line::from(vec![look.span(role, mark), look.span(Role::Dim, format!(" {word}"))])
        })
        .collect();
    let area = Rect { x: area.x, width: SIZE.0 + 1, height: SIZE.1.min(lines.len() as u16), ..area };
    frame.render_widget(Clear, area);
    let area = Rect { x: area.x + 1, width: SIZE.0, ..area };
    for (line, row) in lines.into_iter().zip(area.rows()) {
        frame.render_widget(line, row);
    }
}
