//! The operator's actions on AE stations: excluding a station, using it again, making a simulated one fail.

use super::command::Value;
use super::offer::{accepted, demand};
use crate::actions::ActionId;
use crate::model::Model;
use mission::{Injection, Order, RangeFault};
use world::StationId;

/// Checks that an action on a station is possible now.
///
/// # Errors
/// Returns the reason why not, as a sentence.
pub(crate) fn can(model: &Model, id: ActionId) -> Result<(), String> {
    demand(model.live.run.about.is_some(), "no mission loaded yet")?;
    let station = model.live.run.stations().first().ok_or("this mission has no AE stations")?.id;
    let order = match id {
        ActionId::Inject => {
            Order::Inject(Injection { station, fault: RangeFault::Dead, for_s: 1.0, by: None })
        }
        _ => Order::UseStation { station, used: true, by: None },
    };
    accepted(model, &order)
}

/// The order for a command about a station; `None` if a value is missing.
pub(super) fn order(
    model: &Model,
    id: ActionId,
    station: StationId,
    values: impl Iterator<Item = Value>,
) -> Option<Order> {
    let by = model.console.preferences.operator.clone();
    if id != ActionId::Inject {
        return Some(Order::UseStation { station, used: id == ActionId::Include, by });
    }
    let (mut fault, mut for_s) = (None, None);
    for value in values {
        match value {
            Value::Fault(found) => fault = Some(found),
            Value::Duration(seconds) => for_s = Some(seconds),
            _ => {}
        }
    }
    Some(Order::Inject(Injection { station, fault: fault?, for_s: for_s?, by }))
}
