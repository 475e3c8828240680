//! Orders to the mission.

use super::message::Effect;
use crate::model::Model;
use mission::Order;

/// Sends an order and remembers that an answer is due if it makes the robot move.
pub(super) fn send(model: &mut Model, order: Order) -> Vec<Effect> {
    if matches!(order, Order::Start | Order::Resume | Order::FlyUncertified | Order::Step) {
        model.console.asked = Some(order.clone());
        // A HOLD that was sent before it does not stop what comes after it.
        model.console.hold_asked = false;
    }
    vec![Effect::Order(order)]
}

/// Sends HOLD whenever the mission would accept it, and after an order that makes the robot move.
pub(super) fn hold_now(model: &mut Model) -> Vec<Effect> {
    let is_accepted = model.standing.standing().allows(&Order::Hold).is_ok();
    if !is_accepted && model.console.asked.is_none() {
        return Vec::new();
    }
    model.console.hold_asked = true;
    vec![Effect::Order(Order::Hold)]
}
