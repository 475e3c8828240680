//! Changing a parameter of the active planner: the change and its estimated effect are shown before it is sent.

use super::message::Effect;
use super::offer::{accepted, refuse};
use super::overlay::{ask, open};
use super::send::set_parameter;
use super::what_if;
use crate::model::ui::Ask;
use crate::model::{Ghost, Model, Overlay, parameter};
use mission::{Order, ParamValue};

/// Asks whether to send a new value, and requests an estimate of its effect. A value that is in effect already is not
/// sent. `list` is the line of the list of parameters to which the operator returns.
pub(super) fn propose(model: &mut Model, key: String, value: ParamValue, list: Option<usize>) -> Vec<Effect> {
    if let Err(why) = accepted(model, &Order::SetParameter { key: key.clone(), value: value.clone() }) {
        return refuse(model, why);
    }
    if model.settled_value(&key).as_ref() == Some(&value) {
        let value = parameter::with_unit(model.planner(), &key, &value);
        return refuse(model, format!("nothing was sent: {key} is already {value}"));
    }
    let changed = model.live.with_parameter(&key, &value);
    let estimate = match changed {
        Some(changed) if model.live.waits() => {
            let since_mono_s = model.console.now.mono_s;
            model.live.plans.ghost =
                Some(Ghost { choice: changed.clone(), since_mono_s, at: None, made: None });
            vec![Effect::Compare(changed)]
        }
        Some(changed) => what_if::estimate(model, changed),
        None => Vec::new(),
    };
    ask(model, Ask::Set { key, value, list });
    estimate
}

/// Sends the value, and returns to the list from which the change was made.
pub(super) fn take(model: &mut Model, key: String, value: ParamValue, list: Option<usize>) -> Vec<Effect> {
    if let Some(selected) = list {
        open(model, Overlay::Parameters { selected, edit: None });
    }
    set_parameter(model, key, value)
}

/// Ends the estimate of a change whose question has just been closed; `before` is the question that was open before the
/// message.
pub(super) fn follow(model: &mut Model, before: Option<&Overlay>) -> Vec<Effect> {
    let was_open = matches!(before, Some(Overlay::Confirm(Ask::Set { .. })));
    if !was_open || matches!(model.ui.overlay, Overlay::Confirm(Ask::Set { .. })) {
        return Vec::new();
    }
    let plan = model.live.plans.ghost.take().map(|_| Effect::StopComparing);
    plan.into_iter().chain(what_if::stop_estimate(model)).collect()
}
