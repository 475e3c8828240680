//! What the operator sees of the map: zoom, part of the floor, cursor.

use super::offer::demand;
use crate::model::ui::{MAX_ZOOM, MapView};
use crate::model::{Model, Pane};
use world::{Point, Vector};

/// Steps of the cursor across what the map shows.
const CURSOR_STEPS: f64 = 64.0;
/// Steps of the map's window across what it shows.
const PAN_STEPS: f64 = 4.0;

/// Whether the map is shown.
pub(crate) fn is_shown(model: &Model) -> Result<(), String> {
    demand(model.ui.shows(Pane::Map), "the map is not shown; <next-pane>: next pane (needs 60x16)")
}

/// Whether the map can be moved, or a cursor on it.
pub(crate) fn can_pan(model: &Model) -> Result<(), String> {
    is_shown(model)?;
    let moves = model.ui.map.zoom > 0 || model.ui.cursor.is_some();
    demand(moves, "the whole tank is shown; <zoom-in>: zoom in first")
}

/// Enlarges or reduces the map about its middle.
pub(crate) fn zoom(model: &mut Model, by: i8) {
    let map = &mut model.ui.map;
    map.zoom = map.zoom.saturating_add_signed(by).min(MAX_ZOOM);
    if map.zoom == 0 {
        *map = MapView { follow: map.follow, ..MapView::default() };
    }
}

/// Enlarges or reduces the map so that a place stays where it is.
pub(super) fn zoom_at(model: &mut Model, by: i8, place: Point) {
    let (before, Some(center)) = (model.ui.map.zoom, center(model)) else { return };
    zoom(model, by);
    let shrunk = f64::from(i32::from(before) - i32::from(model.ui.map.zoom)).exp2();
    if model.ui.map.zoom > 0 {
        show(model, place + (center - place) * shrunk);
    }
}

/// Moves the map by a quarter of what it shows, or its cursor by a small step.
pub(crate) fn pan(model: &mut Model, direction: Vector) {
    let Some((low, high)) = bounds(model) else { return };
    let seen_m = (high - low).max() / f64::from(1_u32 << model.ui.map.zoom);
    match model.ui.cursor {
        Some(cursor) => {
            let moved = cursor + direction * (seen_m / CURSOR_STEPS);
            let moved = within(moved, (low, high));
            model.ui.cursor = Some(moved);
            // The cursor takes the window along.
            let is_seen = center(model).is_none_or(|center| (moved - center).amax() <= seen_m / 2.0);
            if model.ui.map.zoom > 0 && !is_seen {
                show(model, moved);
            }
        }
        None => shift(model, direction * (seen_m / PAN_STEPS)),
    }
}

/// Moves the map by some way; the robot need not stay in the middle then.
pub(super) fn shift(model: &mut Model, way: Vector) {
    if let Some(center) = center(model) {
        show(model, center + way);
    }
}

/// Begins to read the map, at the robot's place if the whole tank is seen, or ends it.
pub(crate) fn inspect(model: &mut Model) {
    let robot = model.live.run.position.pose.map(|pose| pose.position);
    let begin = robot.filter(|_| model.ui.map.zoom == 0).or_else(|| center(model));
    model.ui.cursor = if model.ui.cursor.is_some() { None } else { begin };
    turn_to_map(model);
}

/// Reads the map at a place.
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

/// The middle of the map.
fn center(model: &Model) -> Option<Point> {
    let (low, high) = bounds(model)?;
    let robot = model.live.run.position.pose.as_ref().map(|pose| pose.position);
    Some(model.ui.map_center(nalgebra::center(&low, &high), robot))
}

/// Puts a place into the middle of the map.
fn show(model: &mut Model, place: Point) {
    let Some((low, high)) = bounds(model) else { return };
    model.ui.map.follow = false;
    model.ui.map.offset = within(place, (low, high)) - nalgebra::center(&low, &high);
}
