//! Places on the map.

use super::message::Effect;
use super::offer::refuse;
use crate::model::ui::MapView;
use crate::model::{Model, Pane, Screen};
use mission::Severity;
use world::Point;

/// The minimum zoom for showing a place, in doublings of the scale: a quarter of the tank.
const PLACE_ZOOM: u8 = 2;

/// Shows a place on the mission screen's map, centred and with the cursor on it.
pub(super) fn show(model: &mut Model, place: Point, what: &str) -> Vec<Effect> {
    let Some(about) = &model.live.run.about else { return refuse(model, "no mission loaded yet".into()) };
    let (low, high) = about.world.boundary.bounds();
    let zoom = model.ui.map.zoom.max(PLACE_ZOOM);
    let offset = place - nalgebra::center(&low, &high);
    model.ui.map = MapView { zoom, follow: false, offset };
    (model.ui.pane, model.ui.cursor) = (Pane::Map, Some(place));
    model.say(Severity::Info, format!("map centred at {:.2}, {:.2} m: {what}", place.x, place.y));
    model.ui.go(Screen::Mission);
    Vec::new()
}
