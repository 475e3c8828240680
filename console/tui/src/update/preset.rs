//! Parameter presets: saving, reviewing and applying.

use super::alarms;
use super::message::Effect;
use super::offer::{accepted, demand, refuse};
use super::overlay::open;
use super::send::send;
use crate::model::{Model, Overlay, preset};
use mission::{Noted, Order, PlannerChoice, Severity};

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
        Ok(choice) => open(model, Overlay::Preset { name: name.to_owned(), choice, selected: 0 }),
        Err(why) => refuse(model, why),
    }
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
pub(super) fn take(model: &mut Model, name: &str, choice: PlannerChoice) -> Vec<Effect> {
    model.ui.overlay = Overlay::None;
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
