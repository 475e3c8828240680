//! The points of the last scan on the map.

use super::pattern::braille;
use super::pen::Pen;
use crate::model::{Screen, ui::MapLayer};
use crate::theme::Role;
use crate::view::look::Look;
use ratatui::widgets::canvas::{Context, Points};
use world::Point;

/// Maximum age of a scan whose points are drawn, seconds.
const SHOWN_S: f64 = 1.0;
/// The letter that replaces the dots.
const LETTER: char = ':';

/// The scanned points that are visible now.
pub(super) fn shown<'a>(look: &Look<'a>) -> &'a [Point] {
    let ui = &look.model.ui;
    // The plan screen shows the plan, and not what the robot sees.
    let is_shown = ui.layers.shows(MapLayer::Scan) && ui.screen != Screen::Plan;
    let scan = look
        .run
        .scanner
        .scan
        .as_ref()
        .filter(|scan| is_shown && !look.run.has_ended() && look.run.clock.t_s - scan.t_s < SHOWN_S);
    scan.map_or(&[], |scan| scan.placed())
}

/// The mark of the legend.
pub(super) fn mark(look: &Look) -> String {
    if look.caps.glyphs.has_dots() {
        braille(3, |x, y| (x + 2 * y).is_multiple_of(5))
    } else {
        String::from(LETTER).repeat(2)
    }
}

impl Pen<'_> {
    /// The points of the last scan, each a single dot.
    pub(super) fn scan(&self, ctx: &mut Context<'_>) {
        let points = shown(&self.look);
        if points.is_empty() {
            return;
        }
        self.take_up(ctx, LETTER);
        let coords: Vec<(f64, f64)> = points.iter().map(|point| (point.x, point.y)).collect();
        ctx.draw(&Points { coords: &coords, color: self.look.theme.color(Role::Watch) });
    }
}
