//! The pre-flight check.

use super::message::Effect;
use super::offer::refuse;
use super::send::send;
use crate::model::{Model, Overlay, Screen, ui::Ask};
use mission::{Check, Order, PlanId, Severity};

/// The growth of a recording, bytes per second of mission time; the measured rate is 90 to 110 MB an hour.
const BYTES_PER_S: f64 = 30_000.0;
/// A safety factor, because missions take longer than planned.
const MARGIN: f64 = 2.0;

/// Opens the list of checks and repeats the checks.
pub(crate) fn open(model: &mut Model) -> Vec<Effect> {
    model.ui.overlay = Overlay::Preflight { selected: 0 };
    look(model)
}

/// The operator has agreed to start with the plan shown: repeats all checks now.
pub(super) fn start(model: &mut Model, seen: Option<PlanId>) -> Vec<Effect> {
    (model.live.preflight.is_starting, model.live.preflight.seen) = (true, seen);
    look(model)
}

fn look(model: &mut Model) -> Vec<Effect> {
    model.live.preflight.is_checking = true;
    let time_s = model.live.estimate().map_or(0.0, |estimate| estimate.time_s);
    vec![Effect::Check { needed_bytes: (time_s * MARGIN * BYTES_PER_S) as u64 }]
}

/// Receives the results of the checks; starts the mission if the operator has agreed to that and nothing blocks it.
pub(super) fn checked(model: &mut Model, found: Vec<Check>) -> Vec<Effect> {
    let preflight = &mut model.live.preflight;
    (preflight.found, preflight.is_checking) = (Some(found), false);
    if !std::mem::take(&mut preflight.is_starting) {
        return Vec::new();
    }
    if let Some(why) = model.start_is_blocked() {
        model.ui.overlay = Overlay::Preflight { selected: 0 };
        return refuse(model, why);
    }
    model.ui.go(Screen::Mission);
    let noted = Effect::Order(Order::NoteChecks(model.checks()));
    let start = Ask::Start(model.live.preflight.seen.take()).order();
    std::iter::once(noted).chain(send(model, start)).collect()
}

/// Cancels a confirmed start.
pub(super) fn cancel(model: &mut Model) {
    if std::mem::take(&mut model.live.preflight.is_starting) {
        model.say(Severity::Info, "start cancelled");
    }
}

/// Ticks or unticks the selected item; nothing moves.
pub(super) fn tick(model: &mut Model) -> Vec<Effect> {
    let Overlay::Preflight { selected } = model.ui.overlay else { return Vec::new() };
    let n_by_hand = model.n_by_hand();
    let Some(point) = model.grouped_checks().get(selected).and_then(|(_, item)| *item) else {
        let why = model.console.keys.spelled("checked automatically; <check-again>: check again");
        return refuse(model, why);
    };
    let ticked = &mut model.live.preflight.ticked;
    ticked.resize(n_by_hand, false);
    if let Some(tick) = ticked.get_mut(point) {
        *tick = !*tick;
    }
    Vec::new()
}
