//! While a better plan is on offer, a fast simulation is slowed to real time, so that the operator can judge the
//! plan.

use super::message::Effect;
use crate::model::{Model, Speed};
use crate::view::text;
use mission::Severity;

/// Whether a better plan waits for the operator's decision on this console.
pub(super) fn is_open(model: &Model) -> bool {
    let offer = model.live.run.planning.offer.as_ref();
    offer.is_some_and(|offer| !offer.is_taken) && !model.live.is_look_only()
}

/// Slows the simulation when a plan is offered, and restores its speed when the offer has been decided or has ended.
/// `was_open` states whether a plan was on offer before the message.
pub(super) fn follow(model: &mut Model, was_open: bool) -> Vec<Effect> {
    let before = model.live.speed;
    match (was_open, is_open(model)) {
        (false, true) if before.is_fast() && model.console.preferences.slows_for_offers => {
            (model.live.speed, model.live.slowed_from) = (Speed::default(), Some(before));
            let offer = model.notice().map(|notice| format!("{}; ", notice.text)).unwrap_or_default();
            model.say(Severity::Watch, format!("{offer}simulation slowed to real time"));
        }
        (true, false) => {
            let Some(speed) = model.live.slowed_from.take() else { return Vec::new() };
            model.live.speed = speed;
            let end = model.notice().map(|notice| format!("{}; ", notice.text)).unwrap_or_default();
            model.say(Severity::Info, format!("{end}simulation speed is {} again", text::speed(speed)));
        }
        _ => return Vec::new(),
    }
    vec![Effect::Speed(model.live.speed)]
}
