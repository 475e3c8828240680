//! Keys within lists, lines and questions.

use super::alarms;
use super::message::Effect;
use super::offer::{accepted, offered, refuse};
use super::preflight;
use super::send::send;
use super::what_if;
use crate::actions::{ActionId, find};
use crate::guide::guide;
use crate::keys::Key;
use crate::model::ui::{Ask, Edit, MapLayer, Purpose};
use crate::model::{Ghost, Model, Overlay, Screen, parameter};
use mission::{Order, Parameters, PlannerChoice, Severity};

/// Longest text that can be typed.
const MAX_TYPED: usize = 64;

/// Puts something over the screen.
pub(super) fn open(model: &mut Model, overlay: Overlay) -> Vec<Effect> {
    model.ui.overlay = overlay;
    Vec::new()
}

/// Opens the line that asks; the robot does not move yet.
pub(super) fn ask(model: &mut Model, ask: Ask) -> Vec<Effect> {
    model.console.notice = None;
    open(model, Overlay::Confirm(ask))
}

/// The action that Enter runs in the line or list that is open; the list of commands closes for it.
pub(super) fn chosen(model: &mut Model) -> Option<ActionId> {
    match &model.ui.overlay {
        Overlay::Stepping => Some(ActionId::Step),
        Overlay::Commands { filter, selected, .. } => {
            let action = find::listed(model, filter).get(*selected).copied()?;
            model.ui.overlay = Overlay::None;
            Some(action.id)
        }
        Overlay::Remedies { selected, .. } => u8::try_from(*selected + 1).ok().map(ActionId::Remedy),
        _ => None,
    }
}

/// Agrees, or takes the selected line.
pub(super) fn accept(model: &mut Model) -> Vec<Effect> {
    match model.ui.overlay.clone() {
        Overlay::None | Overlay::Stepping | Overlay::Remedies { .. } => Vec::new(),
        Overlay::Confirm(ask) => agree(model, &ask),
        Overlay::Quit => quit(model),
        Overlay::Commands { filter, .. } => refuse(model, format!("no command matches `{filter}`")),
        Overlay::Planners { purpose, selected } => choose_planner(model, purpose, selected),
        Overlay::Parameters { selected, edit: Some(edit) } => take_value(model, selected, edit),
        Overlay::Parameters { edit: None, .. } => edit(model),
        Overlay::Layers { selected } => {
            if let Some(layer) = MapLayer::ALL.get(selected) {
                model.ui.layers.toggle(*layer);
            }
            Vec::new()
        }
        Overlay::WhatIf => what_if::choose(model),
        Overlay::Preflight { .. } => preflight::tick(model),
        Overlay::Filter => {
            model.ui.needle.truncate(model.ui.needle.trim_end().len());
            open(model, Overlay::None)
        }
        Overlay::Shelve(shelving) => alarms::take_shelving(model, shelving),
    }
}

/// Back without doing anything.
pub(super) fn cancel(model: &mut Model) {
    match &mut model.ui.overlay {
        Overlay::Parameters { edit, .. } if edit.is_some() => *edit = None,
        Overlay::Filter => {
            if let Some(text) = typed(model) {
                text.clear();
            }
            typing_changed(model);
            model.ui.overlay = Overlay::None;
        }
        Overlay::WhatIf => what_if::close(model),
        Overlay::Planners { purpose: Purpose::WhatIf, .. } => model.ui.overlay = Overlay::WhatIf,
        other => *other = Overlay::None,
    }
}

/// Checks again at the moment of the answer: things may have changed since the question.
fn agree(model: &mut Model, ask: &Ask) -> Vec<Effect> {
    model.ui.overlay = Overlay::None;
    let id = match ask {
        Ask::Start => ActionId::Start,
        Ask::Resume => ActionId::Resume,
        Ask::FlyUncertified => ActionId::FlyUncertified,
        Ask::Abort => ActionId::Abort,
        Ask::Swap(_) => ActionId::ChoosePlanner,
    };
    match offered(model, id) {
        Ok(()) => {
            if *ask == Ask::Start {
                preflight::start(model)
            } else {
                send(model, ask.order())
            }
        }
        Err(why) => refuse(model, why),
    }
}

fn quit(model: &mut Model) -> Vec<Effect> {
    model.ui.overlay = Overlay::None;
    let end = model.live.is_under_way().then_some(Effect::Order(Order::Abort));
    end.into_iter().chain([Effect::Quit { signal: None }]).collect()
}

fn choose_planner(model: &mut Model, purpose: Purpose, selected: usize) -> Vec<Effect> {
    let Some(planner) = model.console.planners.get(selected) else { return Vec::new() };
    if let Some(why) = model.live.run.cannot_fly(planner) {
        let why = format!("planner {} {why}", planner.id);
        return refuse(model, why);
    }
    let choice = PlannerChoice { id: planner.id.clone(), parameters: Parameters::new() };
    match purpose {
        Purpose::Drive => ask(model, Ask::Swap(choice)),
        Purpose::Compare => compare(model, choice),
        Purpose::WhatIf => what_if::add(model, choice),
    }
}

/// Has another planner plan the mission that waits.
fn compare(model: &mut Model, choice: PlannerChoice) -> Vec<Effect> {
    model.ui.overlay = Overlay::None;
    let since_mono_s = model.console.now.mono_s;
    model.live.plans.ghost = Some(Ghost { choice: choice.clone(), since_mono_s, at: None, made: None });
    vec![Effect::Compare(choice)]
}

/// Gives up the start that was agreed to, or what is being planned, or takes the second plan from the map.
pub(super) fn cancel_plan(model: &mut Model) -> Vec<Effect> {
    if model.live.preflight.is_starting {
        preflight::cancel(model);
        return Vec::new();
    }
    if model.live.plans.ghost.take().is_some() {
        return vec![Effect::StopComparing];
    }
    // The same planner anew is not asked for a plan.
    let choice = model.live.run.planning.choice.clone();
    choice.into_iter().map(|choice| Effect::Order(Order::ChoosePlanner(choice))).collect()
}

/// Opens the line in which a value is typed.
pub(super) fn edit(model: &mut Model) -> Vec<Effect> {
    let Overlay::Parameters { selected, .. } = model.ui.overlay else { return Vec::new() };
    let info = model.planner().and_then(|info| info.parameters.get(selected));
    let Some(info) = info else { return Vec::new() };
    let value = parameter::value(&model.live.run.planning, info);
    let order = Order::SetParameter { key: info.key.clone(), value: value.clone() };
    if let Err(why) = accepted(model, &order) {
        return refuse(model, why);
    }
    let text = value.to_string();
    model.ui.overlay = Overlay::Parameters { selected, edit: Some(Edit { text, refusal: None }) };
    Vec::new()
}

fn take_value(model: &mut Model, selected: usize, edit: Edit) -> Vec<Effect> {
    let info = model.planner().and_then(|info| info.parameters.get(selected));
    let Some(info) = info else { return open(model, Overlay::None) };
    let order = |value| Order::SetParameter { key: info.key.clone(), value };
    // Checked again: the mission may have changed while the value was typed.
    let checked = parameter::parse(info, &edit.text).map(order).and_then(|order| {
        accepted(model, &order)?;
        Ok(order)
    });
    match checked {
        Ok(order) => {
            model.ui.overlay = Overlay::Parameters { selected, edit: None };
            send(model, order)
        }
        Err(why) => {
            let refused = Edit { refusal: Some(why), ..edit };
            model.ui.overlay = Overlay::Parameters { selected, edit: Some(refused) };
            Vec::new()
        }
    }
}

/// Selects another line, so many further down.
pub(super) fn select(model: &mut Model, by: isize) {
    let lines = match &model.ui.overlay {
        Overlay::Commands { filter, .. } => find::listed(model, filter).len(),
        Overlay::Planners { .. } => model.console.planners.len(),
        Overlay::Parameters { .. } => model.planner().map_or(0, |info| info.parameters.len()),
        Overlay::Layers { .. } => MapLayer::ALL.len(),
        Overlay::Preflight { .. } => model.checks().len(),
        Overlay::Remedies { cause, .. } => guide(cause).remedies.len(),
        Overlay::None
        | Overlay::Confirm(_)
        | Overlay::Stepping
        | Overlay::Quit
        | Overlay::WhatIf
        | Overlay::Filter
        | Overlay::Shelve(_) => 0,
    };
    if let Overlay::Commands { selected, .. }
    | Overlay::Planners { selected, .. }
    | Overlay::Parameters { selected, .. }
    | Overlay::Preflight { selected }
    | Overlay::Remedies { selected, .. }
    | Overlay::Layers { selected } = &mut model.ui.overlay
    {
        *selected = selected.saturating_add_signed(by).min(lines.saturating_sub(1));
    }
}

/// Types a key into the line that is open; whether there is such a line and the key can be typed.
pub(super) fn type_key(model: &mut Model, key: Key) -> bool {
    let Some(text) = typed(model) else { return false };
    match key {
        Key::Char(letter) if text.chars().count() < MAX_TYPED => text.push(letter),
        Key::Backspace => {
            text.pop();
        }
        _ => return false,
    }
    typing_changed(model);
    true
}

/// Puts pasted text into the line that is open; without one it goes nowhere, so that no paste is ever a command.
pub(super) fn paste(model: &mut Model, pasted: &str) {
    let Some(text) = typed(model) else { return model.say(Severity::Info, "nowhere to paste") };
    let room = MAX_TYPED.saturating_sub(text.chars().count());
    text.extend(pasted.chars().filter(|letter| !letter.is_control()).take(room));
    typing_changed(model);
}

/// Whether a line is open in which text is typed.
pub(super) fn is_typing(model: &mut Model) -> bool {
    typed(model).is_some()
}

fn typed(model: &mut Model) -> Option<&mut String> {
    match &mut model.ui.overlay {
        Overlay::Commands { filter, .. } => Some(filter),
        Overlay::Parameters { edit: Some(edit), .. } => Some(&mut edit.text),
        Overlay::Shelve(shelving) => Some(&mut shelving.text),
        Overlay::Filter => {
            Some(if model.ui.screen == Screen::Home { &mut model.home.filter } else { &mut model.ui.needle })
        }
        _ => None,
    }
}

fn typing_changed(model: &mut Model) {
    match &mut model.ui.overlay {
        Overlay::Commands { selected, .. } => *selected = 0,
        Overlay::Parameters { edit: Some(edit), .. } => edit.refusal = None,
        Overlay::Shelve(shelving) => shelving.refusal = None,
        Overlay::Filter => {
            (model.home.scenario, model.home.run) = (0, 0);
            model.ui.events.at = None;
        }
        _ => {}
    }
}
