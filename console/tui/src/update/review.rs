//! The review screen: selects past runs to replay or compare.

use super::message::Effect;
use super::offer::{offered, refuse};
use super::replay;
use crate::actions::ActionId;
use crate::model::Model;
use mission::Severity;

/// The label of Enter: `None` if the selected run cannot be replayed now.
pub(crate) fn opens(model: &Model) -> Option<&'static str> {
    let run = model.review.run(&model.home)?;
    let is_replayed = model.live.replay.as_ref().is_some_and(|replay| replay.name == run.name);
    if is_replayed {
        return Some("show");
    }
    offered(model, ActionId::Replay).is_ok().then_some("replay")
}

/// Replays the selected run; if it is already being replayed, shows it.
pub(crate) fn enter(model: &mut Model) -> Vec<Effect> {
    let selected = model.review.run(&model.home).map(|run| run.name.clone());
    let Some(run) = selected else { return refuse(model, "no run is selected".into()) };
    if model.live.replay.as_ref().is_some_and(|replay| replay.name == run) {
        return replay::show(model);
    }
    match offered(model, ActionId::Replay) {
        Ok(()) => replay::open(model, run),
        Err(why) => refuse(model, why),
    }
}

/// Changes to the next sort order.
pub(crate) fn sort(model: &mut Model) -> Vec<Effect> {
    model.review.sort = model.review.sort.next();
    model.review.selected = 0;
    model.say(Severity::Info, format!("sorted by {}", model.review.sort.word()));
    Vec::new()
}
