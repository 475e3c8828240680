//! Parameter presets: saving, reviewing and applying.

use super::alarms;
use super::message::Effect;
use super::offer::{accepted, demand, refuse};
use super::overlay::open;
use super::send::send;
use super::setting;
use crate::model::{Model, Overlay, preset};
use mission::{Noted, Order, PlannerChoice, Severity};
use std::collections::BTreeSet;

/// Checks that a preset can be applied now.
///
/// # Errors
/// Returns the reason why not, as a sentence.
pub(crate) fn can_load(model: &Model) -> Result<(), String> {
    let why = "a preset cannot be loaded while the robot moves; <hold>: HOLD";
    demand(!model.live.run.is_running(), why)?;
    demand(!model.console.presets.is_empty(), "no presets yet; :preset-save NAME saves one")?;
    accepted(model, &Order::ChoosePlanner(PlannerChoice::default()))
}

/// Saves the active planner's parameters as a preset. An existing preset is never overwritten.
pub(super) fn save(model: &mut Model, name: String) -> Vec<Effect> {
    let Some(info) = model.planner() else { return refuse(model, "no planner loaded yet".into()) };
    if let Err(why) = preset::check_name(&name) {
        return refuse(model, why);
    }
    if model.console.presets.iter().any(|preset| preset.name == name) {
        return refuse(model, format!("preset {name} already exists; choose another name"));
    }
    vec![Effect::SavePreset { name, choice: preset::whole(model.live.run.planning.choice.as_ref(), info) }]
}

/// Shows what a preset would change; the operator applies it from there.
pub(super) fn load(model: &mut Model, name: &str) -> Vec<Effect> {
    match loaded(model, name) {
        Ok(choice) => {
            let estimate = setting::estimate(model, choice.clone());
            let preset =
                Overlay::Preset { name: name.to_owned(), choice, selected: 0, left: BTreeSet::new() };
            [open(model, preset), estimate].concat()
        }
        Err(why) => refuse(model, why),
    }
}

/// Takes or leaves the selected value, and requests an estimate of the effect of those that are taken.
pub(crate) fn tick(model: &mut Model) -> Vec<Effect> {
    let Overlay::Preset { choice, selected, left, .. } = &model.ui.overlay else { return Vec::new() };
    let (now, mut left) = (model.live.run.planning.choice.as_ref(), left.clone());
    let Some(info) = model.info_of(&choice.id) else { return Vec::new() };
    let differences = preset::differences(now, choice, info);
    let Some(key) = differences.get(*selected).map(|difference| difference.info.key.clone()) else {
        return Vec::new();
    };
    if !left.remove(&key) {
        left.insert(key);
    }
    let takes_any = left.len() < differences.len();
    let picked = preset::picked(now, choice, info, &left);
    if let Overlay::Preset { left: of_list, .. } = &mut model.ui.overlay {
        *of_list = left;
    }
    let stop = setting::stop(model);
    if takes_any { [stop, setting::estimate(model, picked)].concat() } else { stop }
}

fn loaded(model: &Model, name: &str) -> Result<PlannerChoice, String> {
    let found = model.console.presets.iter().find(|preset| preset.name == name);
    let choice = found.ok_or_else(|| format!("no preset {name}"))?.choice.clone();
    let choice = choice.map_err(|why| format!("preset {name} is refused: {why}"))?;
    let info = model.info_of(&choice.id).ok_or_else(|| format!("planner {} not found", choice.id))?;
    if let Some(why) = model.live.run.cannot_fly(info) {
        return Err(format!("planner {} {why}", info.id));
    }
    let now = model.live.run.planning.choice.as_ref();
    let is_other = now.is_none_or(|now| now.id != choice.id);
    if !is_other && preset::differences(now, &choice, info).is_empty() {
        return Err(format!("preset {name} changes nothing"));
    }
    Ok(preset::by_hand(&choice, info))
}

/// Applies a preset after the review. Nothing moves: the planner replans with the new parameters.
pub(super) fn take(
    model: &mut Model,
    name: &str,
    choice: &PlannerChoice,
    left: &BTreeSet<String>,
) -> Vec<Effect> {
    model.ui.overlay = Overlay::None;
    let Some(info) = model.info_of(&choice.id) else {
        return refuse(model, format!("planner {} not found", choice.id));
    };
    let now = model.live.run.planning.choice.as_ref();
    let n_changes = preset::differences(now, choice, info).len();
    if n_changes > 0 && left.len() >= n_changes {
        return refuse(model, format!("nothing was sent: no value of preset {name} is ticked"));
    }
    let choice = preset::picked(now, choice, info, left);
    let planner = choice.id.clone();
    let order = Order::ChoosePlanner(choice);
    // Check again: the mission may have changed in the meantime.
    if let Err(why) = accepted(model, &order) {
        return refuse(model, why);
    }
    model.say(Severity::Info, format!("preset {name} applied; the planner replans with it"));
    let noted = alarms::note(model, Noted::PresetTaken { preset: name.to_owned(), planner });
    noted.into_iter().chain(send(model, order)).collect()
}
