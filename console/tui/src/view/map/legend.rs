//! The legend of the map: the floor on the left, lines and marks on the right.

use super::drawn;
use super::shade::{Shade, compared};
use crate::model::{Raster, ui::MapLayer};
use crate::theme::Role;
use crate::view::look::Look;
use account::Shares;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::Clear;
use world::FloorClass;

/// Width of the right side in columns, and its maximum number of rows.
const SIZE: (u16, u16) = (12, 10);

/// A legend entry: role, mark and text.
type Entry = (Role, String, &'static str);

/// Draws the legend in the upper corners of an area.
pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let right = Rect { x: area.right().saturating_sub(SIZE.0), ..area };
    draw_side(look, frame, area, &floor(look));
    draw_side(look, frame, right, &marks(look));
}

fn draw_side(look: &Look, frame: &mut Frame, area: Rect, entries: &[Entry]) {
    for ((role, mark, word), row) in entries.iter().take(usize::from(SIZE.1)).zip(area.rows()) {
        let color = Style::new().fg(look.theme.color(*role));
        let line =
            Line::from(vec![Span::styled(mark.as_str(), color), look.span(Role::Dim, format!(" {word} "))]);
        let row = Rect { width: (line.width() as u16).min(row.width), ..row };
        frame.render_widget(Clear, row);
        frame.render_widget(line, row);
    }
}

/// The classes of floor that occur.
fn floor(look: &Look) -> Vec<Entry> {
    let (run, layers) = (look.run, look.model.ui.layers);
    let scanned = layers.shows(MapLayer::Scanned);
    let division = run.coverage.as_ref().map(Raster::whole);
    let some = |share: fn(&Shares) -> f64| {
        scanned && division.as_ref().is_some_and(|division| share(division) > 0.0)
    };
    let again = run.coverage.as_ref().and_then(Raster::overlap).is_some_and(|share| share > 0.0);
    if compared(look).is_some() {
        let shades =
            [(Shade::OnlyA, "only A"), (Shade::OnlyB, "only B"), (Shade::Floor(FloorClass::Partial), "both")];
        return shades.map(|(shade, word)| (shade.role(), shade.glyph().to_string().repeat(2), word)).into();
    }
    let entries = [
        (scanned, Shade::Floor(FloorClass::Scanned), "scanned"),
        (scanned && again, Shade::Floor(FloorClass::Again), "overlap"),
        (scanned, Shade::Floor(FloorClass::Partial), "partial"),
        (run.has_missed() && some(|division| division.missed), Shade::Floor(FloorClass::Missed), "missed"),
        (some(|division| division.unreachable), Shade::Floor(FloorClass::Unreachable), "unreachable"),
        (some(|division| division.margin), Shade::Floor(FloorClass::Margin), "margin"),
        (layers.shows(MapLayer::Accuracy), Shade::PoorFix, "poor fix"),
        (layers.shows(MapLayer::Accuracy), Shade::WeakFix, "weak fix"),
    ];
    let shown = entries.into_iter().filter(|(shown, ..)| *shown);
    shown.map(|(_, shade, word)| (shade.role(), shade.glyph().to_string().repeat(2), word)).collect()
}

fn marks(look: &Look) -> Vec<Entry> {
    let layers = look.model.ui.layers;
    let has_dots = look.caps.glyphs.has_dots();
    let line = |dots: &'static str, letters: &'static str| if has_dots { dots } else { letters };
    let found = look.run.about.iter().flat_map(|run| &run.world.obstacles).any(|obstacle| !obstacle.known);
    let has_other = look.model.live.replay.as_ref().is_some_and(|replay| replay.other.is_some());
    let drawings = drawn::shown(look);
    let drawn = drawn::KINDS.map(|(role, word)| {
        let shown = drawings.iter().any(|drawing| drawn::role(drawing) == role);
        (shown, role, line("⠤⠤", "''"), word)
    });
    let lines = [
        (layers.shows(MapLayer::Trail), Role::Trail, line("⠤⠤", ".."), "trail"),
        (has_other, Role::Ghost, line("⠤⠤", ";;"), "run B"),
        (layers.shows(MapLayer::Plan), Role::Plan, line("⠄⠠", ",,"), "plan"),
        (look.run.shadow.is_some(), Role::Ghost, line("⠤⠤", ";;"), "shadow"),
        (look.run.tether.is_some(), Role::Tether, line("⠤⠤", "~~"), "tether"),
    ];
    let marks = [
        (true, Role::Obstacle, "# ", "obstacle"),
        (found, Role::Found, "? ", "found"),
        (layers.shows(MapLayer::Stations), Role::Station, "S ", "station"),
        (true, Role::Target, "× ", "target"),
    ];
    let shown = lines.into_iter().chain(drawn).chain(marks).filter(|(shown, ..)| *shown);
    shown.map(|(_, role, mark, word)| (role, mark.to_owned(), word)).collect()
}
