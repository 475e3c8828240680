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
    let effects = center(model, place, what);
    if model.live.run.about.is_some() {
        model.ui.go(Screen::Mission);
    }
    effects
}

/// Shows the selected area that the plan leaves out on the map of the plan screen.
pub(crate) fn left_out(model: &mut Model) -> Vec<Effect> {
    let area = model.live.left_out().and_then(|left_out| left_out.areas.get(model.ui.left_out));
    match area.map(|area| (area.at, area.reason.plainly())) {
        Some((place, why)) => center(model, place, why),
        None => refuse(model, "the plan leaves no area out".into()),
    }
}

/// Why Enter opens nothing on the Plan screen, as a clause.
pub(super) fn why_no_area(model: &Model) -> &'static str {
    match model.live.left_out() {
        _ if model.live.busy.is_some() => "nothing to open before the plan is ready",
        None => "nothing to open: the plan has no list of floor that it leaves out",
        Some(left_out) if left_out.areas.is_empty() => "nothing to open: the plan leaves out no area",
        Some(_) if !model.ui.panes().contains(&Pane::LeftOut) => {
            "nothing to open: the areas that the plan leaves out are not shown at this size"
        }
        Some(_) => "nothing to open in this pane; <next-pane>: next pane, to Left out",
    }
}

/// Selects an area that the plan leaves out.
pub(crate) fn select_left_out(model: &mut Model, by: isize) {
    let n = model.live.left_out().map_or(0, |left_out| left_out.areas.len());
    model.ui.left_out = model.ui.left_out.saturating_add_signed(by).min(n.saturating_sub(1));
}

/// Centres the map on a place, with the cursor on it.
fn center(model: &mut Model, place: Point, what: &str) -> Vec<Effect> {
    let Some(about) = &model.live.run.about else { return refuse(model, "no mission loaded yet".into()) };
    let (low, high) = about.world.boundary.bounds();
    let zoom = model.ui.map.zoom.max(PLACE_ZOOM);
    let offset = place - nalgebra::center(&low, &high);
    model.ui.map = MapView { zoom, follow: false, offset };
    (model.ui.pane, model.ui.cursor) = (Pane::Map, Some(place));
    model.say(Severity::Info, format!("map centred at {:.2}, {:.2} m: {what}", place.x, place.y));
    Vec::new()
}
