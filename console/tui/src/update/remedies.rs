//! The actions on an alarm: those of its guide, and those that depend on the state of the alarm.

use super::act::{act, hold_only};
use super::message::Effect;
use super::offer::{accepted, demand, offered, refuse};
use crate::actions::{Action, ActionId, context::Context, find};
use crate::guide;
use crate::keys::Key;
use crate::model::step::{Deed, Step};
use crate::model::{Alarm, Cause, Model, Overlay};
use crate::screens;
use mission::Order;
use positioning::Exclusion;
use std::borrow::Cow;
use world::StationId;

/// The number of actions that have a key.
pub(crate) const MOST: usize = 5;

/// The actions on an alarm, in the order of their numbers. An open list keeps the actions with which it was opened, so
/// that a number never gets another action under the operator's hand.
pub(crate) fn steps<'a>(model: &'a Model, cause: &Cause) -> Cow<'a, [Step]> {
    match &model.ui.overlay {
        Overlay::Remedies { cause: open, steps, .. } if open == cause => Cow::Borrowed(steps),
        _ => Cow::Owned(steps_now(model, cause)),
    }
}

/// The actions that an alarm has now.
pub(super) fn steps_now(model: &Model, cause: &Cause) -> Vec<Step> {
    let remedies = guide::remedies(cause, &model.live.run);
    let of_guide = remedies.filter_map(|remedy| Some((remedy.text, remedy.action?)));
    let of_guide = of_guide.map(|(text, action)| Step { text: text.to_owned(), deed: Deed::Act(action) });
    // A mission that takes no more orders keeps only the actions that are still possible; until then, actions that are not
    // possible for the moment keep their numbers.
    let is_over = model.live.is_cut_off || model.live.run.has_ended();
    let is_left = |step: &Step| !is_over || can(model, &step.deed).is_ok();
    if model.live.is_cut_off {
        return of_guide.filter(is_left).take(MOST).collect();
    }
    let alarm = model.live.run.alarms.get(cause);
    let acknowledge = alarm.filter(|alarm| alarm.is_unacknowledged()).map(|_| Step {
        text: "Acknowledge (<acknowledge>).".to_owned(),
        deed: Deed::Act(ActionId::Acknowledge),
    });
    of_guide.chain(station(model, cause)).chain(acknowledge).filter(is_left).take(MOST).collect()
}

/// Advice: what the operator can do about an alarm apart from the actions.
pub(crate) fn advice(model: &Model, cause: &Cause) -> Vec<&'static str> {
    if model.live.is_cut_off && *cause != Cause::Writer {
        return vec!["No console controls this run any more. Check the robot on site."];
    }
    let remedies = guide::remedies(cause, &model.live.run).filter(|remedy| remedy.action.is_none());
    let left: Vec<&str> = remedies.map(|remedy| remedy.text).collect();
    if model.live.run.has_ended() && left.is_empty() && steps(model, cause).is_empty() {
        return vec!["Nothing to do: the mission has ended."];
    }
    left
}

/// Excluding the station that an alarm is about, or using it again.
fn station(model: &Model, cause: &Cause) -> Option<Step> {
    let run = &model.live.run;
    let excluded = run.position.fix.iter().flat_map(|fix| &fix.excluded);
    let by_order =
        |id: StationId| excluded.clone().any(|(other, why)| *other == id && *why == Exclusion::ByOrder);
    // Once the ranges agree again, every station may be sound.
    let is_active = run.alarms.get(cause).is_some_and(Alarm::is_active);
    let (id, why) = match cause {
        Cause::Station(id) if is_active || by_order(*id) => (*id, String::new()),
        Cause::Contradiction if is_active => {
            let (id, residual_m) = largest_residual(model)?;
            (id, format!(" (largest residual, {residual_m:+.2} m)"))
        }
        _ => return None,
    };
    let name = run.station_name(id);
    let name = name.trim_start_matches("station ");
    let is_excluded = by_order(id);
    let text = if is_excluded {
        format!("Use station {name} again.")
    } else {
        format!("Exclude station {name} from the fix{why}.")
    };
    Some(Step { text, deed: Deed::UseStation(id, is_excluded) })
}

/// The station whose range disagrees most with the last fix.
fn largest_residual(model: &Model) -> Option<(StationId, f64)> {
    let fix = model.live.run.position.fix.as_ref()?;
    let used = fix.residuals.iter().map(|residual| (residual.station, residual.residual_m));
    let rejected = fix.excluded.iter().filter_map(|(station, why)| match why {
        Exclusion::Residual { residual_m, .. } => Some((*station, *residual_m)),
        Exclusion::Silent | Exclusion::ByOrder | Exclusion::Impossible { .. } | Exclusion::Biased { .. } => {
            None
        }
    });
    used.chain(rejected).max_by(|one, other| one.1.abs().total_cmp(&other.1.abs()))
}

/// Checks that an action on an alarm is possible now.
///
/// # Errors
/// Returns the reason why not, as a sentence.
pub(crate) fn can(model: &Model, deed: &Deed) -> Result<(), String> {
    match deed {
        // The parameters can be viewed at any time, but the action on an alarm is to change them.
        Deed::Act(ActionId::Parameters) => {
            demand(!model.live.run.has_ended(), "the mission has ended")?;
            offered(model, ActionId::Parameters)
        }
        Deed::Act(ActionId::Hold) => {
            offered(model, ActionId::Hold)?;
            demand(model.live.is_replay() || model.live.may_move(), "already held")
        }
        Deed::Act(action) => offered(model, *action),
        Deed::UseStation(station, used) => accepted(model, &order(model, *station, *used)),
    }
}

fn order(model: &Model, station: StationId, used: bool) -> Order {
    Order::UseStation { station, used, by: model.console.preferences.operator.clone() }
}

/// Whether a number is not among the actions of the open action list.
pub(super) fn is_unused(model: &Model, id: ActionId) -> bool {
    match (&model.ui.overlay, id) {
        (Overlay::Remedies { steps, .. }, ActionId::Remedy(number)) => usize::from(number) > steps.len(),
        _ => false,
    }
}

/// The action of a key that the open action list does not use: the one that the key has on the screen behind the list,
/// so that every key that the screen and the list name works. The alarm of the list is the selected one there.
pub(super) fn behind(model: &Model, key: Key) -> Option<&'static Action> {
    let Overlay::Remedies { .. } = &model.ui.overlay else { return None };
    let contexts = [&[Context::Anywhere, Context::Screen], screens::contexts(model)].concat();
    find::action_for(&model.console.keys, key, &contexts)
}

/// Runs the action with the given number, from 1, in the open action list, and closes the list. Actions that move the
/// robot still ask first.
pub(super) fn run(model: &mut Model, number: usize) -> Vec<Effect> {
    let Overlay::Remedies { cause, .. } = &model.ui.overlay else {
        return refuse(model, "open the actions of an alarm first".into());
    };
    let cause = cause.clone();
    let steps = steps(model, &cause);
    let Some(step) = number.checked_sub(1).and_then(|index| steps.get(index)) else {
        let why = if steps.is_empty() { "this alarm has advice only" } else { "no action with this number" };
        return refuse(model, why.into());
    };
    let deed = step.deed.clone();
    let holds = deed == Deed::Act(ActionId::Hold) && model.live.may_move();
    // The list stays open with an action that is not possible now, and the operator reads why.
    match can(model, &deed) {
        Err(why) if !holds => return refuse(model, why),
        _ => {}
    }
    model.ui.alarm = Some(cause);
    model.ui.overlay = Overlay::None;
    match deed {
        Deed::Act(ActionId::Hold) => hold_only(model),
        Deed::Act(action) => act(model, action),
        Deed::UseStation(station, used) => vec![Effect::Order(order(model, station, used))],
    }
}
