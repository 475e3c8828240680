//! A survey on the map: floor that has not been seen, the frontiers, the columns found, and the way.

use super::ink;
use super::pen::Pen;
use super::shade::Shade;
use super::shapes::Filled;
use crate::model::survey::{Seen, Survey};
use crate::model::{Run, Screen, ui::MapLayer};
use crate::theme::Role;
use crate::view::look::Look;
use crate::view::survey::rest;
use ratatui::widgets::canvas::Context;
use world::{Obstacle, Point};

/// The mark of a frontier.
pub(super) const FRONTIER: &str = "f";

/// The survey, if its map is shown.
pub(super) fn shown<'a>(look: &Look<'a>) -> Option<&'a Survey> {
    look.run.survey.as_deref().filter(|_| look.model.ui.layers.shows(MapLayer::Explored))
}

/// The shade of a square of the floor.
pub(super) fn shade(survey: &Survey, at: Point, edge_m: f64) -> Option<Shade> {
    Some(match survey.seen_in(at, edge_m)? {
        Seen::Not => Shade::NotSeen,
        Seen::Object => Shade::Object,
    })
}

/// The rest of the way that the robot takes; empty without one.
pub(super) fn way<'a>(look: &Look<'a>) -> &'a [Point] {
    let way = shown(look).and_then(|survey| survey.way.as_ref());
    let way = way.filter(|_| look.run.is_running() && look.model.ui.screen != Screen::Plan);
    let here = look.run.position.pose.map(|pose| pose.position);
    way.zip(here).map_or(&[], |(way, here)| rest(&way.path, here))
}

/// The frontiers that are left.
pub(super) fn frontiers<'a>(look: &Look<'a>) -> &'a [Point] {
    shown(look).filter(|_| !look.run.has_ended()).map_or(&[], |survey| survey.frontiers.as_slice())
}

/// Whether a found obstacle is a column on the map of the survey, which then stands for it.
pub(super) fn is_mapped(look: &Look, obstacle: &Obstacle) -> bool {
    let columns = shown(look).map_or(&[][..], |survey| survey.columns.as_slice());
    !obstacle.known && columns.iter().any(|column| column.shape().distance_m(obstacle.shape.center()) <= 0.0)
}

/// The mark of the columns in the legend: their numbers.
pub(super) fn numbers(run: &Run) -> String {
    let numbers = run.column_numbers();
    match (numbers.iter().min(), numbers.iter().max()) {
        (Some(first), Some(last)) if first == last => first.to_string(),
        (Some(first), Some(last @ ..=9)) => format!("{first}-{last}"),
        _ => "1-n".into(),
    }
}

impl Pen<'_> {
    /// The columns on the map of a survey, and the rest of the way.
    pub(super) fn survey(&self, ctx: &mut Context<'_>) {
        self.draw(ctx, way(&self.look), ink::LEG);
        let Some(survey) = shown(&self.look) else { return };
        self.take_up(ctx, '#');
        let color = self.look.theme.color(Role::Found);
        for column in &survey.columns {
            ctx.draw(&Filled { shape: &column.shape(), window: self.window, hatched: false, color });
        }
    }
}
