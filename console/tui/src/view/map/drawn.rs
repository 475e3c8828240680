//! The planner's drawings on the map.

use crate::model::{Screen, ui::MapLayer};
use crate::theme::Role;
use crate::view::look::Look;
use planner_api::{Drawing, Layer};

/// The number of ticks after which the last drawings disappear.
const SHOWN_TICKS: u64 = 10;

/// The kinds of drawings, each with its role and legend text.
pub(super) const KINDS: [(Role, &str); 3] =
    [(Role::Pull, "pull"), (Role::Push, "push"), (Role::Drawn, "planner")];

/// The drawings that are visible now.
pub(super) fn shown<'a>(look: &Look<'a>) -> &'a [Drawing] {
    let planning = &look.run.planning;
    let old = look.run.clock.tick.saturating_sub(planning.drawings_tick) > SHOWN_TICKS;
    // The plan screen shows what is planned, not what is steered.
    let old = old || look.model.ui.screen == Screen::Plan;
    if old || !look.model.ui.layers.shows(MapLayer::Drawings) { &[] } else { &planning.drawings }
}

pub(super) fn role(drawing: &Drawing) -> Role {
    let (Drawing::Arrow { layer, .. } | Drawing::Line { layer, .. } | Drawing::Circle { layer, .. }) =
        drawing;
    match layer {
        Layer::Attraction => Role::Pull,
        Layer::Repulsion => Role::Push,
        _ => Role::Drawn,
    }
}
