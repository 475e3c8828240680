//! Forecasts of how a held mission would continue with different planners.

use super::message::Effect;
use super::offer::refuse;
use super::setting;
use crate::model::ui::Ask;
use crate::model::what_if::MOST;
use crate::model::{Candidate, Forecast, Model, Overlay, WhatIf, preset};
use mission::{Order, ParamValue, Parameters, Phase, PlannerChoice, Severity};

/// Opens the comparison of the active planner, unchanged, with the others that can run this mission.
pub(crate) fn open(model: &mut Model) -> Vec<Effect> {
    model.ui.overlay = Overlay::WhatIf;
    let run = &model.live.run;
    let current = run.planning.choice.clone();
    let others = model.console.planners.iter().filter(|info| run.covers() && run.cannot_fly(info).is_none());
    let others = others
        .filter(|info| Some(info.id.as_str()) != run.planner_id())
        .map(|info| PlannerChoice { id: info.id.clone(), parameters: Parameters::new() });
    let choices: Vec<PlannerChoice> = current.into_iter().chain(others).take(MOST).collect();
    begin(model, &choices, MOST)
}

/// Forecasts the active planner unchanged and changed, so that the effect of the change can be shown before it is sent.
/// The comparison of the operator keeps its candidates; it has at most one more until the question is closed.
pub(super) fn estimate(model: &mut Model, changed: PlannerChoice) -> Vec<Effect> {
    drop_outdated(model);
    let is_known = model.live.what_if.as_ref().is_some_and(|what_if| what_if.position(&changed).is_some());
    let current = model.live.run.planning.choice.clone();
    let choices: Vec<PlannerChoice> = current.into_iter().chain([changed.clone()]).collect();
    let effects = begin(model, &choices, MOST + 1);
    if let Some(what_if) = &mut model.live.what_if {
        what_if.estimated = (!is_known).then_some(changed);
    }
    effects
}

/// Ends the forecast of a change. The comparison of a held mission goes on; it keeps the forecast of the change if that
/// is finished and the comparison has room for it.
pub(super) fn stop_estimate(model: &mut Model) -> Vec<Effect> {
    let is_held = matches!(model.live.run.phase(), Phase::Held(_));
    let Some(what_if) = &mut model.live.what_if else { return Vec::new() };
    let added = what_if.estimated.take();
    // A change whose forecast was known before needed none of its own.
    if added.is_none() && is_held {
        return Vec::new();
    }
    let has_room = what_if.candidates.len() <= MOST;
    what_if.candidates.retain(|candidate| {
        added.as_ref() != Some(&candidate.choice) || (has_room && candidate.made.is_some())
    });
    what_if.selected = what_if.selected.min(what_if.candidates.len().saturating_sub(1));
    let open: Vec<_> = what_if.open().cloned().collect();
    // A comparison needs a second planner beside the active one.
    if !is_held || (what_if.candidates.len() < 2 && what_if.n_done() == 0) {
        model.live.what_if = None;
        return vec![Effect::StopForecasting];
    }
    vec![if open.is_empty() { Effect::StopForecasting } else { Effect::Forecast(open) }]
}

/// Drops a comparison with a planner that is not active any more.
fn drop_outdated(model: &mut Model) {
    let current = model.live.run.planning.choice.as_ref();
    let first = |what_if: &WhatIf| what_if.candidates.first().map(|first| first.choice.clone());
    model.live.what_if.take_if(|what_if| first(what_if).as_ref() != current);
}

/// Adds planners to the comparison, up to `most`, and has them forecast first. Finished forecasts are kept.
fn begin(model: &mut Model, choices: &[PlannerChoice], most: usize) -> Vec<Effect> {
    drop_outdated(model);
    let current = model.live.run.planning.choice.clone();
    let t_s = model.live.run.clock.t_s;
    let fresh = || WhatIf { t_s, candidates: Vec::new(), selected: 0, draft: None, estimated: None };
    let what_if = model.live.what_if.get_or_insert_with(fresh);
    let before = what_if.candidates.len();
    for choice in choices {
        if what_if.candidates.len() < most && what_if.position(choice).is_none() {
            what_if.candidates.push(candidate(choice.clone()));
        }
    }
    if what_if.candidates.len() == before {
        return Vec::new();
    }
    let is_urgent = |choice: &PlannerChoice| choices.contains(choice) || current.as_ref() == Some(choice);
    let (first, later): (Vec<_>, Vec<_>) = what_if.open().cloned().partition(is_urgent);
    vec![Effect::Forecast(first.into_iter().chain(later).collect())]
}

fn candidate(choice: PlannerChoice) -> Candidate {
    Candidate { choice, at: None, made: None }
}

/// Adds a planner to the comparison with the active one, and selects it; existing forecasts are kept.
pub(super) fn add(model: &mut Model, choice: &PlannerChoice) -> Vec<Effect> {
    model.ui.overlay = Overlay::WhatIf;
    drop_outdated(model);
    if let Some(what_if) = &mut model.live.what_if {
        if what_if.position(choice).is_some() {
            return refuse(model, format!("planner {} is already in the comparison", choice.id));
        }
        what_if.candidates.truncate(MOST - 1);
    }
    let current = model.live.run.planning.choice.clone();
    let choices: Vec<PlannerChoice> = current.into_iter().chain([choice.clone()]).collect();
    let effects = begin(model, &choices, MOST);
    if let Some(what_if) = &mut model.live.what_if {
        what_if.selected = what_if.position(choice).unwrap_or(0);
    }
    effects
}

/// Opens the parameters of the selected candidate so that they can be changed for another forecast.
pub(crate) fn draft(model: &mut Model) -> Vec<Effect> {
    let chosen = model.live.what_if.as_ref().and_then(WhatIf::candidate).map(|found| found.choice.clone());
    let Some(choice) = chosen else { return Vec::new() };
    if model.info_of(&choice.id).is_none_or(|info| info.parameters.is_empty()) {
        return refuse(model, format!("planner {} has no parameters", choice.id));
    }
    if let Some(what_if) = &mut model.live.what_if {
        what_if.draft = Some(choice);
    }
    model.ui.overlay = Overlay::Parameters { selected: 0, edit: None };
    Vec::new()
}

/// Sets a parameter of the draft.
pub(super) fn set(model: &mut Model, key: &str, value: ParamValue) {
    let Some(mut draft) = take_draft(model) else { return };
    draft.parameters.insert(key.to_owned(), value);
    let info = model.info_of(&draft.id);
    let draft = info.map_or_else(|| draft.clone(), |info| preset::by_hand(&draft, info));
    if let Some(what_if) = &mut model.live.what_if {
        what_if.draft = Some(draft);
    }
}

/// Removes the draft from the comparison and returns it.
pub(super) fn take_draft(model: &mut Model) -> Option<PlannerChoice> {
    model.live.what_if.as_mut()?.draft.take()
}

/// Starts a forecast for the draft.
pub(crate) fn forecast_draft(model: &mut Model) -> Vec<Effect> {
    take_draft(model).map_or_else(Vec::new, |draft| add(model, &draft))
}

/// Moves the selection by `by` candidates.
pub(crate) fn select(model: &mut Model, by: isize) {
    if let Some(what_if) = &mut model.live.what_if {
        let last = what_if.candidates.len().saturating_sub(1);
        what_if.selected = what_if.selected.saturating_add_signed(by).min(last);
    }
}

/// Chooses the selected candidate, asking first unless it is the unchanged active planner. The comparison is recorded
/// in the journal.
pub(super) fn choose(model: &mut Model) -> Vec<Effect> {
    let Some(what_if) = &model.live.what_if else { return Vec::new() };
    let Some(candidate) = what_if.candidate() else { return Vec::new() };
    let choice = candidate.choice.clone();
    match &candidate.made {
        None => return refuse(model, format!("the forecast for {} is not finished", choice.id)),
        Some(Err(why)) => {
            let why = format!("{} cannot be selected: {why}", choice.id);
            return refuse(model, why);
        }
        Some(Ok(_)) => {}
    }
    let noted = Effect::Order(Order::NoteOutlooks(what_if.outlooks()));
    if model.live.run.planning.choice.as_ref() == Some(&choice) {
        model.ui.overlay = Overlay::None;
        let text = format!("planner {} stays active; <hold>: resume", choice.id);
        model.say(Severity::Info, model.console.keys.spelled(&text));
        return vec![noted];
    }
    std::iter::once(noted).chain(setting::propose_planner(model, Ask::Swap(choice))).collect()
}

/// Closes the comparison; finished forecasts are kept until the mission continues.
pub(super) fn close(model: &mut Model) {
    model.ui.overlay = Overlay::None;
}

/// Discards forecasts that are out of date.
pub(super) fn forget(model: &mut Model) -> Vec<Effect> {
    let Some(what_if) = model.live.what_if.take() else { return Vec::new() };
    let is_drafting = what_if.draft.is_some() && matches!(model.ui.overlay, Overlay::Parameters { .. });
    if is_drafting || model.ui.overlay == Overlay::WhatIf {
        model.ui.overlay = Overlay::None;
    }
    vec![Effect::StopForecasting]
}

/// Records the progress of a forecast.
pub(super) fn at(model: &mut Model, choice: &PlannerChoice, share: f64) {
    if let Some(candidate) = find(model, choice) {
        candidate.at = Some(share);
    }
}

/// Records a forecast.
pub(super) fn made(model: &mut Model, choice: &PlannerChoice, forecast: Result<Forecast, String>) {
    if let Some(candidate) = find(model, choice) {
        candidate.made = Some(forecast);
    }
}

fn find<'a>(model: &'a mut Model, choice: &PlannerChoice) -> Option<&'a mut Candidate> {
    model.live.what_if.as_mut()?.candidates.iter_mut().find(|candidate| candidate.choice == *choice)
}
