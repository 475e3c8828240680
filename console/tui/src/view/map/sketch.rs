//! The no-go zone that the operator is drawing or is asked about.

use super::pattern::Pattern;
use super::pen::Pen;
use crate::theme::Role;
use crate::update::zones;
use ratatui::widgets::canvas::Context;
use world::Point;

impl Pen<'_> {
    /// Draws the outline; two points are only a line.
    pub(super) fn sketch(&self, ctx: &mut Context<'_>) {
        let Some(corners) = zones::drawn(self.look.model) else { return };
        self.take_up(ctx, 'x');
        let ring: Vec<Point> = corners.iter().chain(corners.first()).copied().collect();
        self.stroke(ctx, &ring, Role::NoGo, Pattern::Solid);
    }
}
