//! No-go zones drawn by the operator: with two corners in a command, or on the map.

use super::command::Value;
use super::message::{Effect, Query};
use super::offer::{accepted, demand, refuse};
use super::overlay::ask;
use super::unseen;
use crate::model::ui::Ask;
use crate::model::zone_draft::Form;
use crate::model::{Model, Overlay, ZoneDraft};
use crate::view::text;
use mission::{Order, ZoneCost, outline};
use world::{Point, Shape, polyline};

/// Checks that a zone can be drawn now.
///
/// # Errors
/// Returns the reason why not, as a sentence.
pub(crate) fn can(model: &Model) -> Result<(), String> {
    demand(model.live.run.about.is_some(), "no mission loaded yet")?;
    accepted(model, &Order::DrawZone(Vec::new()))
}

/// The corners of the box between two corners; `None` if the second corner is missing.
pub(super) fn corners(a: Point, mut values: impl Iterator<Item = Value>) -> Option<Vec<Point>> {
    let b = values.find_map(|value| match value {
        Value::Corner(corner) => Some(corner),
        _ => None,
    })?;
    Some(outline::boxed(a, b))
}

/// Shows a zone on the map and asks whether to close it; meanwhile, the mission computes what the zone costs.
pub(super) fn propose(model: &mut Model, corners: Vec<Point>) -> Vec<Effect> {
    model.live.zone_cost = None;
    let query = Effect::Ask(Query::ZoneCost(corners.clone()));
    ask(model, Ask::DrawZone(corners));
    vec![query]
}

/// Receives the cost of the zone in the open question; a zone that would be refused closes the question.
pub(super) fn priced(model: &mut Model, corners: &[Point], cost: Result<ZoneCost, String>) {
    let is_asked =
        matches!(&model.ui.overlay, Overlay::Confirm(Ask::DrawZone(asked)) if asked.as_slice() == corners);
    match cost {
        _ if !is_asked => {}
        Ok(cost) => {
            model.live.zone_cost = Some(cost);
            unseen::changed(model);
        }
        Err(why) => {
            model.ui.overlay = Overlay::None;
            refuse(model, why);
        }
    }
}

/// Checks that a zone can be drawn from the cursor on.
pub(crate) fn can_draw(model: &Model) -> Result<(), String> {
    can(model)?;
    demand(model.ui.cursor.is_some(), "<inspect>: open the cursor first")
}

/// Begins a zone at the cursor.
pub(crate) fn draw(model: &mut Model) -> Vec<Effect> {
    if let Some(cursor) = model.ui.cursor {
        model.ui.overlay = Overlay::ZoneDraft(ZoneDraft::begun(cursor));
    }
    Vec::new()
}

/// The zone being drawn and the cursor.
fn draft(model: &mut Model) -> Option<(&mut ZoneDraft, Point)> {
    let cursor = model.ui.cursor?;
    match &mut model.ui.overlay {
        Overlay::ZoneDraft(draft) => Some((draft, cursor)),
        _ => None,
    }
}

/// Handles Enter: sets the corner at the cursor. The second point of a box or circle completes it.
pub(super) fn set(model: &mut Model) -> Vec<Effect> {
    let Some((draft, cursor)) = draft(model) else { return Vec::new() };
    if draft.form != Form::Polygon {
        return close(model);
    }
    if !draft.points.contains(&cursor) {
        draft.points.push(cursor);
    }
    Vec::new()
}

/// Checks that the polygon has an area.
pub(crate) fn can_close(model: &Model) -> Result<(), String> {
    let corners = drawn(model).map_or(0, |corners| corners.len());
    let is_polygon = matches!(&model.ui.overlay, Overlay::ZoneDraft(draft) if draft.form == Form::Polygon);
    demand(is_polygon && corners >= 3, "a polygon needs three corners; <accept>: set a corner")
}

/// Completes the zone with the cursor as its last point and asks whether to close it.
pub(crate) fn close(model: &mut Model) -> Vec<Effect> {
    match drawn(model).filter(|corners| corners.len() >= 3) {
        Some(corners) => propose(model, corners),
        None => refuse(model, "the zone has no area yet; move the cursor first".into()),
    }
}

/// Changes the form of the zone.
pub(crate) fn reshape(model: &mut Model) {
    if let Some((draft, _)) = draft(model) {
        draft.reshape();
    }
}

/// Checks that a corner can be removed.
pub(crate) fn can_undo(model: &Model) -> Result<(), String> {
    let corners = match &model.ui.overlay {
        Overlay::ZoneDraft(draft) => draft.points.len(),
        _ => 0,
    };
    demand(corners > 1, "only the first corner is set; <cancel>: cancel")
}

/// Removes the last corner of a polygon.
pub(crate) fn undo(model: &mut Model) {
    if let Some((draft, _)) = draft(model) {
        draft.points.pop();
    }
}

/// Puts the cursor at a clicked point while a zone is being drawn; returns whether one is.
pub(super) fn point_at(model: &mut Model, place: Point) -> bool {
    let is_drawing = matches!(model.ui.overlay, Overlay::ZoneDraft(_));
    if is_drawing {
        super::map::read(model, place);
    }
    is_drawing
}

/// Draws a box or circle with the mouse: it begins where the drag began; returns whether a zone is being drawn.
pub(super) fn drag(model: &mut Model, from: Point, to: Point) -> bool {
    let Some((draft, cursor)) = draft(model) else { return false };
    // Each step of a drag begins where the previous one ended.
    let goes_on = cursor == from;
    if !goes_on && draft.form != Form::Polygon {
        draft.points = vec![from];
    }
    super::map::read(model, to);
    true
}

/// The corners of the zone in the open question.
pub(crate) fn asked(model: &Model) -> Option<Vec<Point>> {
    match &model.ui.overlay {
        Overlay::Confirm(Ask::DrawZone(corners)) => Some(corners.clone()),
        _ => None,
    }
}

/// The zone as drawn so far, and its distance to the hull, as a sentence; `None` if no zone is being drawn.
pub(crate) fn drawn_words(model: &Model) -> Option<String> {
    let Overlay::ZoneDraft(draft) = &model.ui.overlay else { return None };
    let corners = drawn(model)?;
    let words = match (draft.form, corners.len()) {
        (Form::Polygon, n) => text::counted(n, "corner"),
        (_, 3..) => text::capitalized(&outline::words(&corners)),
        _ => "No area yet".to_owned(),
    };
    let hull = hull_gap_m(model, &corners).map_or_else(String::new, |gap_m| {
        if gap_m <= 0.0 {
            let has_area = draft.form == Form::Polygon || corners.len() >= 3;
            if has_area { ", touches the hull" } else { "; the hull is at the corner" }.to_owned()
        } else {
            format!(", {} m from the hull", text::number(gap_m, 2))
        }
    });
    Some(format!("{words}{hull}."))
}

/// The gap between the hull and a zone with these corners, metres; zero or less if they overlap.
fn hull_gap_m(model: &Model, corners: &[Point]) -> Option<f64> {
    let run = &model.live.run;
    let at = run.position.pose.as_ref()?.position;
    let radius_m = run.about.as_ref()?.mission.limits.radius_m;
    let shape = Shape::Polygon { vertices: outline::turned(corners) };
    let inside = corners.len() >= 3 && shape.distance_m(at) <= 0.0;
    let off_m = if inside { 0.0 } else { polyline::distance_to_ring_m(corners, at) };
    Some(off_m - radius_m)
}

/// The outline to show on the map: of the zone being drawn or of the zone in the open question.
pub(crate) fn drawn(model: &Model) -> Option<Vec<Point>> {
    match &model.ui.overlay {
        Overlay::ZoneDraft(draft) => Some(draft.corners(model.ui.cursor?)),
        _ => asked(model),
    }
}
