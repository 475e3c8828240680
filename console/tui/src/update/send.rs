//! Sends orders to the mission.

use super::message::Effect;
use super::preflight;
use crate::model::{Model, Speed, parameter};
use mission::{Event, EventKind, Order, ParamValue, Severity};

/// Sends an order; if it makes the robot move, records that an answer is due.
pub(crate) fn send(model: &mut Model, order: Order) -> Vec<Effect> {
    let moves = matches!(
        order,
        Order::Resume | Order::DriveBack | Order::FlyUncertified | Order::Step | Order::StepTo(_)
    ) || order.is_start();
    if moves {
        model.live.asked = Some(order.clone());
        // An earlier HOLD does not stop a robot that was moved by a later order.
        model.live.hold_asked = false;
    }
    // Before the start, every change leads to a new plan.
    let plans = model.live.waits() && matches!(order, Order::ChoosePlanner(_) | Order::SetParameter { .. });
    let plan = plans.then_some(Effect::Order(Order::Plan));
    std::iter::once(Effect::Order(order)).chain(plan).collect()
}

/// Sends a new parameter value and shows the old one; while the robot is moving, the value takes effect immediately.
pub(super) fn set_parameter(model: &mut Model, key: String, value: ParamValue) -> Vec<Effect> {
    let change = parameter::change(model.planner(), model.live.run.planning.choice.as_ref(), &key, &value);
    let now = if model.live.run.is_running() { ", takes effect now" } else { "" };
    model.say(Severity::Info, format!("{change}{now}"));
    send(model, Order::SetParameter { key, value })
}

/// Sends HOLD whenever the mission would accept it, and also after an order that makes the robot move.
///
/// HOLD also limits the simulation to real time, because an operator who stops the robot is in no hurry; only the
/// operator can raise the speed again.
pub(crate) fn hold_now(model: &mut Model) -> Vec<Effect> {
    preflight::cancel(model);
    model.console.settling = None;
    if model.live.is_look_only() {
        return Vec::new();
    }
    let is_accepted = model.live.run.standing.standing().allows(&Order::Hold).is_ok();
    if !is_accepted && model.live.asked.is_none() {
        return Vec::new();
    }
    model.live.hold_asked = true;
    std::iter::once(Effect::Order(Order::Hold)).chain(slow_down(model)).collect()
}

/// Limits the simulation to real time after a hold that the mission itself has begun and that only an order can end: its
/// operator has to read and decide, as after HOLD.
pub(crate) fn slow_if_held(model: &mut Model, events: &[Event]) -> Option<Effect> {
    let is_hold = |event: &Event| match &event.kind {
        EventKind::Held { by, resumes } => resumes.is_never() && !by.is_ordered(),
        _ => false,
    };
    if model.live.is_look_only() || !events.iter().any(is_hold) { None } else { slow_down(model) }
}

/// Limits the simulation to real time; the effect if it was faster.
fn slow_down(model: &mut Model) -> Option<Effect> {
    let slower = model.live.speed.is_fast().then(Speed::default);
    (model.live.speed, model.live.slowed_from) = (slower.unwrap_or(model.live.speed), None);
    slower.map(Effect::Speed)
}
