//! No-go zones drawn by the operator.

use super::command::Value;
use super::offer::{accepted, demand};
use crate::model::Model;
use mission::Order;
use world::Point;

/// Checks that a zone can be drawn now.
///
/// # Errors
/// Returns the reason why not, as a sentence.
pub(crate) fn can(model: &Model) -> Result<(), String> {
    demand(model.live.run.about.is_some(), "no mission loaded yet")?;
    accepted(model, &Order::DrawZone(Vec::new()))
}

/// The order to draw a box between two corners; `None` if the second corner is missing.
pub(super) fn order(a: Point, mut values: impl Iterator<Item = Value>) -> Option<Order> {
    let b = values.find_map(|value| match value {
        Value::Corner(corner) => Some(corner),
        _ => None,
    })?;
    let (low, high) = (a.inf(&b), a.sup(&b));
    Some(Order::DrawZone(vec![low, Point::new(high.x, low.y), high, Point::new(low.x, high.y)]))
}
