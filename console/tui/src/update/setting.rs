//! Changing a parameter of the active planner: the change and its estimated effect are shown before it is sent.

use super::message::Effect;
use super::offer::{accepted, refuse};
use super::overlay::{ask, open};
use super::send::set_parameter;
use super::what_if;
use crate::model::ui::Ask;
use crate::model::{Ghost, Model, Overlay, parameter};
use mission::{Order, ParamValue, PlannerChoice};

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
    let estimate = changed.map_or_else(Vec::new, |changed| estimate(model, changed));
    ask(model, Ask::Set { key, value, list });
    estimate
}

/// Requests an estimate of the effect of running a planner with changed parameters.
pub(super) fn estimate(model: &mut Model, changed: PlannerChoice) -> Vec<Effect> {
    if !model.live.waits() {
        return what_if::estimate(model, changed);
    }
    let since_mono_s = model.console.now.mono_s;
    model.live.plans.ghost = Some(Ghost { choice: changed.clone(), since_mono_s, at: None, made: None });
    vec![Effect::Compare(changed)]
}

/// Asks whether a different planner is to drive and, during a mission, requests a forecast with it: the operator must see
/// what the change loses.
pub(crate) fn propose_planner(model: &mut Model, question: Ask) -> Vec<Effect> {
    let next = match &question {
        Ask::Swap(choice) => Some(choice.clone()),
        _ => model.live.run.shadow.as_ref().map(|shadow| shadow.choice.clone()),
    };
    let next = next.filter(|_| !model.live.waits());
    let forecast = next.map_or_else(Vec::new, |next| what_if::estimate(model, next));
    forecast.into_iter().chain(ask(model, question)).collect()
}

/// Sends the value, and returns to the list from which the change was made.
pub(super) fn take(model: &mut Model, key: String, value: ParamValue, list: Option<usize>) -> Vec<Effect> {
    if let Some(selected) = list {
        open(model, Overlay::Parameters { selected, edit: None });
    }
    set_parameter(model, key, value)
}

/// Whether a question or a list is open that shows the estimated effect of a change.
pub(super) fn is_open(model: &Model) -> bool {
    match &model.ui.overlay {
        Overlay::Confirm(Ask::Set { .. }) | Overlay::Preset { .. } => true,
        // Before the start, the new planner shows its plan itself.
        Overlay::Confirm(Ask::Swap(_) | Ask::Promote) => !model.live.waits(),
        _ => false,
    }
}

/// Ends the estimate of a change that is not shown any more; `was_open` states whether it was shown before the message.
pub(super) fn follow(model: &mut Model, was_open: bool) -> Vec<Effect> {
    if was_open && !is_open(model) { stop(model) } else { Vec::new() }
}

/// Ends the estimate of a change.
pub(super) fn stop(model: &mut Model) -> Vec<Effect> {
    let plan = model.live.plans.ghost.take().map(|_| Effect::StopComparing);
    plan.into_iter().chain(what_if::stop_estimate(model)).collect()
}
