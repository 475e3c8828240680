//! The planner's drawings on the map.

use super::ink::{self, Ink};
use super::shapes::ellipse;
use crate::model::{Screen, ui::MapLayer};
use crate::view::look::Look;
use planner_api::{Drawing, Layer};
use world::Point;

/// The number of ticks after which the last drawings disappear.
const SHOWN_TICKS: u64 = 10;

/// The kinds of drawings, each with its legend text.
pub(super) const KINDS: [(Ink, &str); 3] =
    [(ink::PULL, "pull"), (ink::PUSH, "push"), (ink::DRAWN, "planner")];

/// The drawings that are visible now.
pub(super) fn shown<'a>(look: &Look<'a>) -> &'a [Drawing] {
    let planning = &look.run.planning;
    let old = look.run.clock.tick.saturating_sub(planning.drawings_tick) > SHOWN_TICKS;
    // The plan screen shows the plan, and not how the planner steers the robot.
    let old = old || look.model.ui.screen == Screen::Plan;
    if old || !look.model.ui.layers.shows(MapLayer::Drawings) { &[] } else { &planning.drawings }
}

/// How a drawing is drawn.
pub(super) fn ink(drawing: &Drawing) -> Ink {
    let (Drawing::Arrow { layer, .. } | Drawing::Line { layer, .. } | Drawing::Circle { layer, .. }) =
        drawing;
    match layer {
        Layer::Attraction => ink::PULL,
        Layer::Repulsion => ink::PUSH,
        _ => ink::DRAWN,
    }
}

/// The points of a drawing.
pub(super) fn points(drawing: &Drawing) -> Vec<Point> {
    match *drawing {
        Drawing::Arrow { at, vector, .. } => vec![at, at + vector],
        Drawing::Line { from, to, .. } => vec![from, to],
        Drawing::Circle { center, radius_m, .. } => ellipse(center, (radius_m, radius_m), 0.0, 32),
    }
}
