//! Keys in lists, input lines and questions.

use super::act::act;
use super::alarms;
use super::message::Effect;
use super::offer::{accepted, demand, offered, refuse};
use super::preflight;
use super::preset::take as take_preset;
use super::replay;
use super::send::send;
use super::{finish, palette, setting, shadow, typing, what_if, zones};
use crate::actions::ActionId;
use crate::model::ui::{Ask, Edit, MapLayer, Purpose};
use crate::model::{Ghost, Model, Overlay, Palette, parameter, planner_list::PlannerLine, preset};
use mission::{Order, ParamValue, Parameters, PlannerChoice, PlannerInfo, Severity};

/// Opens an overlay.
pub(crate) fn open(model: &mut Model, overlay: Overlay) -> Vec<Effect> {
    model.ui.overlay = overlay;
    Vec::new()
}

/// Opens the confirmation line; the robot does not move yet.
pub(crate) fn ask(model: &mut Model, ask: Ask) -> Vec<Effect> {
    model.console.notice = None;
    open(model, Overlay::Confirm(ask))
}

/// Withdraws a question whose confirmation would move the robot, or whose text a HOLD makes untrue; returns whether such a question was open.
pub(super) fn withdraw_motion(model: &mut Model) -> bool {
    let moves = matches!(
        model.ui.overlay,
        Overlay::Stepping
            | Overlay::Finish { .. }
            | Overlay::Confirm(
                Ask::Start(_)
                    | Ask::Resume
                    | Ask::DriveBack
                    | Ask::FlyUncertified
                    | Ask::TakePlan
                    | Ask::Promote
                    | Ask::Set { .. }
            )
    );
    if moves {
        model.ui.overlay = Overlay::None;
        model.say(Severity::Info, "cancelled by HOLD");
    }
    moves
}

/// Confirms the question or takes the selected line; without an overlay, has the effect of Enter on the screen.
pub(crate) fn accept(model: &mut Model) -> Vec<Effect> {
    match model.ui.overlay.clone() {
        Overlay::None => (model.ui.screen.row().enter)(model),
        Overlay::Stepping => act(model, ActionId::Step),
        Overlay::Remedies { selected, .. } => u8::try_from(selected + 1)
            .map_or_else(|_| Vec::new(), |number| act(model, ActionId::Remedy(number))),
        Overlay::Confirm(ask) => agree(model, &ask),
        Overlay::Quit => quit(model),
        Overlay::Commands(palette) => palette::accept(model, palette),
        Overlay::Planners { purpose, selected, is_unfolded } => {
            choose_planner(model, purpose, (selected, is_unfolded))
        }
        Overlay::Parameters { selected, edit: Some(edit) } => take_value(model, selected, edit),
        Overlay::Parameters { edit: None, .. } => edit(model),
        Overlay::Layers { selected } => {
            if let Some(layer) = MapLayer::ALL.get(selected) {
                model.ui.layers.toggle(*layer);
            }
            Vec::new()
        }
        Overlay::Preset { name, choice, left, .. } => take_preset(model, &name, &choice, &left),
        Overlay::WhatIf => what_if::choose(model),
        Overlay::Finish { selected } => finish::choose(model, selected),
        Overlay::ZoneDraft(_) => zones::set(model),
        Overlay::Preflight { .. } => preflight::tick(model),
        // The filter is in effect already, and the selected message is shown in full.
        Overlay::Filter(_) | Overlay::Messages { .. } => open(model, Overlay::None),
        Overlay::Shelve(shelving) => alarms::take_shelving(model, shelving),
        Overlay::Bookmark(line) => replay::take_bookmark(model, &line),
    }
}

/// Opens the planner's parameters.
pub(crate) fn open_parameters(model: &mut Model) -> Vec<Effect> {
    what_if::take_draft(model);
    open(model, Overlay::Parameters { selected: 0, edit: None })
}

/// Closes the overlay without any effect.
pub(super) fn cancel(model: &mut Model) {
    if let Overlay::Parameters { edit: edit @ Some(_), .. } = &mut model.ui.overlay {
        *edit = None;
        return;
    }
    match &model.ui.overlay {
        Overlay::Filter(_) => {
            typing::filter(model, "");
            model.ui.overlay = Overlay::None;
        }
        Overlay::WhatIf => what_if::close(model),
        Overlay::Parameters { .. } => {
            let was_draft = what_if::take_draft(model).is_some();
            model.ui.overlay = if was_draft { Overlay::WhatIf } else { Overlay::None };
        }
        Overlay::Planners { purpose: Purpose::WhatIf, .. } => model.ui.overlay = Overlay::WhatIf,
        Overlay::Confirm(Ask::Set { list: Some(selected), .. }) => {
            model.ui.overlay = Overlay::Parameters { selected: *selected, edit: None };
        }
        _ => model.ui.overlay = Overlay::None,
    }
}

/// Carries out a confirmed question. Checks again first: conditions may have changed since the question was asked.
fn agree(model: &mut Model, ask: &Ask) -> Vec<Effect> {
    model.ui.overlay = Overlay::None;
    let id = match ask {
        Ask::Start(_) => ActionId::Start,
        Ask::Resume => ActionId::Resume,
        Ask::FlyUncertified => ActionId::FlyUncertified,
        Ask::Swap(_) => ActionId::ChoosePlanner,
        Ask::Promote => ActionId::Promote,
        Ask::TakePlan => ActionId::TakePlan,
        Ask::DriveBack => ActionId::DriveBack,
        Ask::DrawZone(_) => ActionId::DrawZone,
        Ask::Set { .. } => ActionId::SetParameter,
    };
    let can = offered(model, id).and_then(|()| match ask {
        Ask::Set { .. } => accepted(model, &ask.order()),
        Ask::DriveBack => finish::can_drive_back(model),
        Ask::DrawZone(_) => demand(model.live.zone_cost.is_some(), "the cost of the zone is not known yet"),
        _ => Ok(()),
    });
    match (can, ask) {
        (Ok(()), Ask::Start(seen)) => preflight::start(model, *seen),
        (Ok(()), Ask::Set { key, value, list }) => setting::take(model, key.clone(), value.clone(), *list),
        (Ok(()), ask) => send(model, ask.order()),
        (Err(why), _) => refuse(model, why),
    }
}

fn quit(model: &mut Model) -> Vec<Effect> {
    model.ui.overlay = Overlay::None;
    let end = model.live.is_under_way().then_some(Effect::Order(Order::Abort));
    end.into_iter().chain([Effect::Quit { signal: None }]).collect()
}

/// Takes the selected planner, or unfolds the list. Checks again first: the mission continued while the list was open.
fn choose_planner(
    model: &mut Model,
    purpose: Purpose,
    (selected, is_unfolded): (usize, bool),
) -> Vec<Effect> {
    let planner = match model.planner_lines(is_unfolded).get(selected) {
        Some(PlannerLine::Planner(planner)) => (*planner).clone(),
        Some(PlannerLine::Others(_)) => {
            return open(model, Overlay::Planners { purpose, selected, is_unfolded: true });
        }
        None => return Vec::new(),
    };
    let id = match purpose {
        Purpose::Drive => ActionId::ChoosePlanner,
        Purpose::Compare => ActionId::Compare,
        Purpose::WhatIf => ActionId::WhatIf,
        Purpose::Shadow => ActionId::Shadow,
    };
    if let Err(why) = offered(model, id) {
        model.ui.overlay = Overlay::None;
        return refuse(model, why);
    }
    choose(model, purpose, planner)
}

/// Takes a planner for a purpose, if it can run the mission; asks for confirmation before the planner drives.
pub(super) fn choose(model: &mut Model, purpose: Purpose, planner: PlannerInfo) -> Vec<Effect> {
    if let Some(why) = model.live.run.cannot_fly(&planner) {
        let why = format!("planner {} {why}", planner.id);
        return refuse(model, why);
    }
    let choice = PlannerChoice { id: planner.id, parameters: Parameters::new() };
    match purpose {
        Purpose::Drive => setting::propose_planner(model, Ask::Swap(choice)),
        Purpose::Compare => compare(model, choice),
        Purpose::WhatIf => what_if::add(model, &choice),
        Purpose::Shadow => shadow::begin(model, choice),
    }
}

/// Has a different planner plan the waiting mission, for comparison.
fn compare(model: &mut Model, choice: PlannerChoice) -> Vec<Effect> {
    model.ui.overlay = Overlay::None;
    let since_mono_s = model.console.now.mono_s;
    model.live.plans.ghost = Some(Ghost { choice: choice.clone(), since_mono_s, at: None, made: None });
    vec![Effect::Compare(choice)]
}

/// Cancels a confirmed start or planning in progress, or removes the second plan from the map.
pub(crate) fn cancel_plan(model: &mut Model) -> Vec<Effect> {
    if model.live.preflight.is_starting {
        preflight::cancel(model);
        return Vec::new();
    }
    if let Some(ghost) = model.live.plans.ghost.take() {
        let news = if ghost.made.is_some() { "second plan removed" } else { "comparison cancelled" };
        model.say(Severity::Info, news);
        return vec![Effect::StopComparing];
    }
    let news = model.console.keys.spelled("planning cancelled; <plan-again>: plan again");
    model.say(Severity::Watch, news);
    // Restarting the same planner does not request a plan.
    let choice = model.live.run.planning.choice.clone();
    choice.into_iter().map(|choice| Effect::Order(Order::ChoosePlanner(choice))).collect()
}

/// Opens the input line for a value.
pub(crate) fn edit(model: &mut Model) -> Vec<Effect> {
    let Overlay::Parameters { selected, .. } = model.ui.overlay else { return Vec::new() };
    let Some((planner, choice)) = model.edited() else { return Vec::new() };
    let Some(info) = planner.parameters.get(selected) else { return Vec::new() };
    let value = parameter::value(choice, info);
    if let Err(why) = settable(model, &info.key, &value) {
        return refuse(model, why);
    }
    let line = value.to_string().as_str().into();
    model.ui.overlay = Overlay::Parameters { selected, edit: Some(Edit { line, refusal: None }) };
    Vec::new()
}

/// Checks that a parameter can be set now; parameters in a draft always can.
fn settable(model: &Model, key: &str, value: &ParamValue) -> Result<(), String> {
    if is_drafting(model) {
        return Ok(());
    }
    accepted(model, &Order::SetParameter { key: key.to_owned(), value: value.clone() })
}

fn is_drafting(model: &Model) -> bool {
    model.live.what_if.as_ref().is_some_and(|what_if| what_if.draft.is_some())
}

fn take_value(model: &mut Model, selected: usize, edit: Edit) -> Vec<Effect> {
    let info = model.edited().and_then(|(planner, _)| planner.parameters.get(selected));
    let Some(info) = info else { return open(model, Overlay::None) };
    let key = info.key.clone();
    // Check again: the mission may have changed while the value was being typed.
    let checked = parameter::parse(info, edit.line.text()).and_then(|value| {
        settable(model, &key, &value)?;
        Ok(value)
    });
    match checked {
        Ok(value) => {
            model.ui.overlay = Overlay::Parameters { selected, edit: None };
            if is_drafting(model) {
                what_if::set(model, &key, value);
                return Vec::new();
            }
            setting::propose(model, key, value, Some(selected))
        }
        Err(why) => {
            let refused = Edit { refusal: Some(why), ..edit };
            model.ui.overlay = Overlay::Parameters { selected, edit: Some(refused) };
            Vec::new()
        }
    }
}

/// Moves the selection down by `by` lines.
pub(super) fn select(model: &mut Model, by: isize) {
    let lines = match &model.ui.overlay {
        Overlay::Commands(palette) => palette::choices(model, palette).len(),
        Overlay::Planners { is_unfolded, .. } => model.planner_lines(*is_unfolded).len(),
        Overlay::Parameters { .. } => model.edited().map_or(0, |(info, _)| info.parameters.len()),
        Overlay::Preset { choice, .. } => {
            let now = model.live.run.planning.choice.as_ref();
            model.info_of(&choice.id).map_or(0, |info| preset::differences(now, choice, info).len())
        }
        Overlay::Layers { .. } => MapLayer::ALL.len(),
        Overlay::Preflight { .. } => model.checks().len(),
        Overlay::Messages { .. } => model.console.messages.len(),
        Overlay::Finish { .. } => finish::WAYS,
        Overlay::Remedies { steps, .. } => steps.len(),
        Overlay::None
        | Overlay::Confirm(_)
        | Overlay::Stepping
        | Overlay::Quit
        | Overlay::ZoneDraft(_)
        | Overlay::WhatIf
        | Overlay::Filter(_)
        | Overlay::Shelve(_)
        | Overlay::Bookmark(_) => 0,
    };
    if let Overlay::Commands(Palette { selected, .. })
    | Overlay::Planners { selected, .. }
    | Overlay::Parameters { selected, .. }
    | Overlay::Preset { selected, .. }
    | Overlay::Preflight { selected }
    | Overlay::Messages { selected }
    | Overlay::Finish { selected }
    | Overlay::Remedies { selected, .. }
    | Overlay::Layers { selected } = &mut model.ui.overlay
    {
        *selected = selected.saturating_add_signed(by).min(lines.saturating_sub(1));
    }
}
