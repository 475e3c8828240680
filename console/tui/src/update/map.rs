//! The operator's view of the map: zoom, position, cursor.

use super::offer::demand;
use crate::model::history::stepped_span_s;
use crate::model::ui::{MAX_ZOOM, MapView};
use crate::model::{Model, Pane};
use world::{Point, Vector};

/// The number of cursor steps across the visible part of the map.
const CURSOR_STEPS: f64 = 64.0;
/// The number of pan steps across the visible part of the map.
const PAN_STEPS: f64 = 4.0;

/// Checks that the map is shown.
pub(crate) fn is_shown(model: &Model) -> Result<(), String> {
    demand(model.ui.screen.has_map(), "no map on this screen; <mission>: the mission's map")?;
    demand(model.ui.shows(Pane::Map), "the map is not shown (it needs 60x16); <next-pane>: next pane")
}

/// Checks that the map or its cursor can be moved.
pub(crate) fn can_pan(model: &Model) -> Result<(), String> {
    is_shown(model)?;
    let moves = model.ui.map.zoom > 0 || model.ui.cursor.is_some();
    demand(moves, "the whole tank is shown; <zoom-in>: zoom in first")
}

/// Checks that the map can be zoomed or, while a chart is shown alone, the time that charts show.
pub(crate) fn can_zoom(model: &Model, into: bool) -> Result<(), String> {
    if shows_chart(model) {
        let (span_s, other_s) = (model.ui.span_s, stepped_span_s(model.ui.span_s, !into));
        return demand(
            span_s != other_s,
            if into { "the shortest time is shown" } else { "all times are shown" },
        );
    }
    is_shown(model)?;
    if into {
        demand(model.ui.map.zoom < MAX_ZOOM, "already at maximum zoom")
    } else {
        demand(model.ui.map.zoom > 0, "the whole tank is already shown")
    }
}

/// Zooms the map about its centre or, while a chart is shown alone, the time that charts show.
pub(crate) fn zoom_shown(model: &mut Model, into: bool) {
    if shows_chart(model) {
        model.ui.span_s = stepped_span_s(model.ui.span_s, !into);
    } else {
        zoom(model, if into { 1 } else { -1 });
    }
}

/// Whether the mission screen shows a chart alone.
fn shows_chart(model: &Model) -> bool {
    matches!(model.ui.pane, Pane::Chart(_)) && model.ui.shows_one()
}

/// Zooms the map about its centre.
fn zoom(model: &mut Model, by: i8) {
    let map = &mut model.ui.map;
    map.zoom = map.zoom.saturating_add_signed(by).min(MAX_ZOOM);
    if map.zoom == 0 {
        *map = MapView { follow: map.follow, ..MapView::default() };
    }
}

/// Zooms the map while keeping a point in place.
pub(super) fn zoom_at(model: &mut Model, by: i8, place: Point) {
    let (before, Some(center)) = (model.ui.map.zoom, center(model)) else { return };
    zoom(model, by);
    let shrunk = f64::from(i32::from(before) - i32::from(model.ui.map.zoom)).exp2();
    if model.ui.map.zoom > 0 {
        show(model, place + (center - place) * shrunk);
    }
}

/// Pans the map by a quarter of its visible part, or moves its cursor by a small step.
pub(crate) fn pan(model: &mut Model, direction: Vector) {
    let Some((low, high)) = bounds(model) else { return };
    let seen_m = (high - low).max() / f64::from(1_u32 << model.ui.map.zoom);
    match model.ui.cursor {
        Some(cursor) => {
            let moved = cursor + direction * (seen_m / CURSOR_STEPS);
            let moved = within(moved, (low, high));
            model.ui.cursor = Some(moved);
            // The visible part follows the cursor.
            let is_seen = center(model).is_none_or(|center| (moved - center).amax() <= seen_m / 2.0);
            if model.ui.map.zoom > 0 && !is_seen {
                show(model, moved);
            }
        }
        None => shift(model, direction * (seen_m / PAN_STEPS)),
    }
}

/// Pans the map by a given distance; the map then no longer follows the robot.
pub(super) fn shift(model: &mut Model, way: Vector) {
    if let Some(center) = center(model) {
        show(model, center + way);
    }
}

/// Opens the map cursor, at the robot's position if the whole tank is visible; closes it if it is open.
pub(crate) fn inspect(model: &mut Model) {
    let robot = model.live.run.position.pose.map(|pose| pose.position);
    let begin = robot.filter(|_| model.ui.map.zoom == 0).or_else(|| center(model));
    model.ui.cursor = if model.ui.cursor.is_some() { None } else { begin };
    turn_to_map(model);
}

/// Puts the map cursor at a point.
pub(super) fn read(model: &mut Model, place: Point) {
    model.ui.cursor = bounds(model).map(|bounds| within(place, bounds));
    turn_to_map(model);
}

fn turn_to_map(model: &mut Model) {
    if model.ui.panes().contains(&Pane::Map) {
        model.ui.pane = Pane::Map;
    }
}

fn bounds(model: &Model) -> Option<(Point, Point)> {
    Some(model.live.run.about.as_ref()?.world.boundary.bounds())
}

fn within(place: Point, (low, high): (Point, Point)) -> Point {
    Point::new(place.x.clamp(low.x, high.x), place.y.clamp(low.y, high.y))
}

/// The centre of the map.
fn center(model: &Model) -> Option<Point> {
    let (low, high) = bounds(model)?;
    let robot = model.live.run.position.pose.as_ref().map(|pose| pose.position);
    Some(model.ui.map_center(nalgebra::center(&low, &high), robot))
}

/// Centres the map on a point.
fn show(model: &mut Model, place: Point) {
    let Some((low, high)) = bounds(model) else { return };
    model.ui.map.follow = false;
    model.ui.map.offset = within(place, (low, high)) - nalgebra::center(&low, &high);
}
