//! What the planner draws on the map: which of it is shown, and how.

use crate::model::ui::MapLayer;
use crate::theme::Role;
use crate::view::look::Look;
use planner_api::{Drawing, Layer};

/// Ticks after which the last drawings are no longer shown.
const SHOWN_TICKS: u64 = 10;

/// Each kind of drawing: its role, and its word in the legend.
pub(super) const KINDS: [(Role, &str); 3] =
    [(Role::Pull, "pull"), (Role::Push, "push"), (Role::Drawn, "planner")];

/// The drawings that are shown.
pub(super) fn shown<'a>(look: &Look<'a>) -> &'a [Drawing] {
    let planning = &look.run.planning;
    let old = look.run.clock.tick.saturating_sub(planning.drawings_tick) > SHOWN_TICKS;
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
