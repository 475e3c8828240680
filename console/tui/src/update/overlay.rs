//! Keys within lists, lines and questions.

use super::{Effect, act as do_action, act::ask, offered};
use crate::actions::{self, ActionId};
use crate::keys::Key;
use crate::model::ui::{Ask, Edit, MapLayer};
use crate::model::{Model, Overlay, parameter};
use mission::{Order, PlannerChoice, Severity};

/// Longest text that can be typed.
const MAX_TYPED: usize = 64;

/// Agreeing, going back and selecting.
pub(super) fn act(model: &mut Model, id: ActionId) -> Vec<Effect> {
    match id {
        ActionId::Accept => accept(model),
        ActionId::Cancel => cancel(model),
        ActionId::Up => select(model, -1),
        ActionId::Down => select(model, 1),
        ActionId::Edit => edit(model),
        _ => Vec::new(),
    }
}

/// Sends an order and remembers that an answer is due if it makes the robot move.
pub(super) fn send(model: &mut Model, order: Order) -> Vec<Effect> {
    if matches!(order, Order::Start | Order::Resume | Order::FlyUncertified | Order::Step) {
        model.console.asked = Some(order.clone());
        // A HOLD that was sent before it does not stop what comes after it.
        model.console.hold_asked = false;
    }
    vec![Effect::Order(order)]
}

fn accept(model: &mut Model) -> Vec<Effect> {
    match model.ui.overlay.clone() {
        Overlay::None => Vec::new(),
        Overlay::Confirm(ask) => agree(model, &ask),
        Overlay::Stepping => do_action(model, ActionId::Step),
        Overlay::Quit => quit(model),
        Overlay::Commands { filter, selected, .. } => run_command(model, &filter, selected),
        Overlay::Planners { selected } => choose_planner(model, selected),
        Overlay::Parameters { selected, edit: Some(edit) } => take_value(model, selected, edit),
        Overlay::Parameters { edit: None, .. } => edit(model),
        Overlay::Layers { selected } => {
            if let Some(layer) = MapLayer::ALL.get(selected) {
                model.ui.layers.toggle(*layer);
            }
            Vec::new()
        }
        Overlay::Filter => close(model),
    }
}

fn close(model: &mut Model) -> Vec<Effect> {
    model.ui.overlay = Overlay::None;
    Vec::new()
}

fn cancel(model: &mut Model) -> Vec<Effect> {
    match &mut model.ui.overlay {
        Overlay::Parameters { edit, .. } if edit.is_some() => *edit = None,
        Overlay::Filter => {
            model.ui.needle.clear();
            model.ui.overlay = Overlay::None;
        }
        other => *other = Overlay::None,
    }
    Vec::new()
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
        Ok(()) => send(model, ask.order()),
        Err(why) => {
            model.say(Severity::Watch, why);
            Vec::new()
        }
    }
}

fn quit(model: &mut Model) -> Vec<Effect> {
    model.ui.overlay = Overlay::None;
    let end = model.is_under_way().then_some(Effect::Order(Order::Abort));
    end.into_iter().chain([Effect::Quit { signal: None }]).collect()
}

fn run_command(model: &mut Model, filter: &str, selected: usize) -> Vec<Effect> {
    let Some(action) = actions::listed(filter, model.ui.pane).get(selected).copied() else {
        model.say(Severity::Watch, format!("No command matches `{filter}`"));
        return Vec::new();
    };
    model.ui.overlay = Overlay::None;
    do_action(model, action.id)
}

fn choose_planner(model: &mut Model, selected: usize) -> Vec<Effect> {
    let Some(planner) = model.console.planners.get(selected) else { return Vec::new() };
    if let Some(why) = model.cannot_fly(planner) {
        let text = format!("planner {} {why}", planner.id);
        model.say(Severity::Watch, text);
        return Vec::new();
    }
    let choice = PlannerChoice { id: planner.id.clone(), parameters: mission::Parameters::new() };
    ask(model, Ask::Swap(choice))
}

fn edit(model: &mut Model) -> Vec<Effect> {
    let Overlay::Parameters { selected, .. } = model.ui.overlay else { return Vec::new() };
    let info = model.planner().and_then(|info| info.parameters.get(selected));
    let Some(info) = info else { return Vec::new() };
    let value = parameter::value(&model.planning, info);
    let order = Order::SetParameter { key: info.key.clone(), value: value.clone() };
    if let Err(why) = super::offer::accepted(model, &order) {
        model.say(Severity::Watch, why);
        return Vec::new();
    }
    let text = value.to_string();
    model.ui.overlay = Overlay::Parameters { selected, edit: Some(Edit { text, refusal: None }) };
    Vec::new()
}

fn take_value(model: &mut Model, selected: usize, edit: Edit) -> Vec<Effect> {
    let info = model.planner().and_then(|info| info.parameters.get(selected));
    let Some(info) = info else { return close(model) };
    let order = |value| Order::SetParameter { key: info.key.clone(), value };
    // Checked again: the mission may have changed while the value was typed.
    let checked = parameter::parse(info, &edit.text).map(order).and_then(|order| {
        super::offer::accepted(model, &order)?;
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

fn select(model: &mut Model, by: isize) -> Vec<Effect> {
    let lines = match &model.ui.overlay {
        Overlay::Commands { filter, .. } => actions::listed(filter, model.ui.pane).len(),
        Overlay::Planners { .. } => model.console.planners.len(),
        Overlay::Parameters { .. } => model.planner().map_or(0, |info| info.parameters.len()),
        Overlay::Layers { .. } => MapLayer::ALL.len(),
        _ => 0,
    };
    if let Overlay::Commands { selected, .. }
    | Overlay::Planners { selected }
    | Overlay::Parameters { selected, .. }
    | Overlay::Layers { selected } = &mut model.ui.overlay
    {
        *selected = selected.saturating_add_signed(by).min(lines.saturating_sub(1));
    }
    Vec::new()
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
pub(super) fn paste(model: &mut Model, pasted: &str) -> Vec<Effect> {
    let Some(text) = typed(model) else {
        model.say(Severity::Info, "Nowhere to paste");
        return Vec::new();
    };
    let room = MAX_TYPED.saturating_sub(text.chars().count());
    text.extend(pasted.chars().filter(|letter| !letter.is_control()).take(room));
    typing_changed(model);
    Vec::new()
}

/// Whether a line is open in which text is typed.
pub(super) fn is_typing(model: &mut Model) -> bool {
    typed(model).is_some()
}

fn typed(model: &mut Model) -> Option<&mut String> {
    match &mut model.ui.overlay {
        Overlay::Commands { filter, .. } => Some(filter),
        Overlay::Parameters { edit: Some(edit), .. } => Some(&mut edit.text),
        Overlay::Filter => Some(&mut model.ui.needle),
        _ => None,
    }
}

fn typing_changed(model: &mut Model) {
    match &mut model.ui.overlay {
        Overlay::Commands { selected, .. } => *selected = 0,
        Overlay::Parameters { edit: Some(edit), .. } => edit.refusal = None,
        Overlay::Filter => model.ui.scroll = 0,
        _ => {}
    }
}
