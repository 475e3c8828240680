//! No-go zones that the operator draws.

use super::command::Value;
use super::offer::{accepted, demand};
use crate::model::Model;
use mission::Order;
use world::{Point, Shape, Zone, ZoneKind};

/// Whether a zone can be drawn now.
///
/// # Errors
/// Why not, as a sentence.
pub(super) fn can(model: &Model) -> Result<(), String> {
    demand(model.live.run.about.is_some(), "no mission loaded yet")?;
    accepted(model, &Order::DrawZone(zone(model, Point::origin(), Point::origin())))
}

/// The order to draw a box between two corners; nothing if the other one is missing.
pub(super) fn order(model: &Model, corner: Point, mut values: impl Iterator<Item = Value>) -> Option<Order> {
    let opposite = values.find_map(|value| match value {
        Value::Corner(opposite) => Some(opposite),
        _ => None,
    });
    Some(Order::DrawZone(zone(model, corner, opposite?)))
}

/// A box with a name that no other zone has.
fn zone(model: &Model, a: Point, b: Point) -> Zone {
    let drawn = model.live.run.about.iter().flat_map(|about| &about.world.zones);
    let names: Vec<&str> = drawn.map(|zone| zone.name.as_str()).collect();
    let name =
        (1..=names.len() + 1).map(|n| format!("no-go {n}")).find(|name| !names.contains(&name.as_str()));
    let (low, high) = (a.inf(&b), a.sup(&b));
    let vertices = vec![low, Point::new(high.x, low.y), high, Point::new(low.x, high.y)];
    Zone { name: name.unwrap_or_default(), kind: ZoneKind::NoGo, shape: Shape::Polygon { vertices } }
}
