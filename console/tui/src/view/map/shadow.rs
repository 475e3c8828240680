//! The planner in shadow on the map: its plan, and the ghost of the robot under its command.

use super::course;
use super::ink::{self, Ink};
use super::pattern::Pattern;
use super::pen::{Pen, within};
use super::shapes::ellipse;
use super::thin::Thin;
use crate::model::ui::MapLayer;
use ratatui::widgets::canvas::Context;

/// The length of its plan that is drawn while the robot moves, metres; while the robot is held, the whole
/// plan is drawn.
const AHEAD_M: f64 = 4.0;

impl Pen<'_> {
    /// Draws the plan and the ghost.
    pub(super) fn shadow(&self, ctx: &mut Context<'_>) {
        let run = self.look.run;
        let Some(shadow) = run.shown_shadow() else { return };
        if let Some(track) = course::shadow(&self.look) {
            let [_, thinning] = course::thinnings(&self.look, self.window);
            let thin = Thin::new(track.path, track.lanes, thinning);
            for line in thin.lines((0, track.path.len() - 1)) {
                self.draw(ctx, &line, ink::SHADOW);
            }
        } else if run.is_running() && self.look.model.ui.layers.shows(MapLayer::Plan) && shadow.path.len() > 1
        {
            let robot = run.position.pose.as_ref().map(|pose| pose.position);
            let from = robot.map_or(0, |robot| super::pen::nearest(&shadow.path, robot));
            self.draw(ctx, within(&shadow.path[from..], AHEAD_M), ink::SHADOW);
        }
        let Some(ghost) = run.ghost() else { return };
        self.draw(ctx, &ghost, Ink { pattern: Pattern::Solid, ..ink::SHADOW });
        let radius_m = run.about.as_ref().map_or(0.0, |about| about.mission.limits.radius_m);
        if let Some(end) = ghost.last().filter(|_| radius_m > self.window.column_m) {
            self.draw(ctx, &ellipse(*end, (radius_m, radius_m), 0.0, 48), ink::SHADOW);
        }
    }
}
