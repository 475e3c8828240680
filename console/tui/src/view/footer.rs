//! The keys that are active now, taken from the action table.

use super::look::Look;
use super::{notice, text};
use crate::actions::{
    ACTIONS, Action, ActionId,
    context::{Context, contexts},
};
use crate::keys::Key;
use crate::model::planner_list::PlannerLine;
use crate::model::replay::Jump;
use crate::model::zone_draft::Form;
use crate::model::{Model, Overlay, Screen, ui::Arrangement};
use crate::theme::Role;
use crate::update::{is_typing, offer::accepted, offered, typing::holds_by_space};
use mission::{Order, Phase};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// The actions that are dropped first if space is short.
const DISPENSABLE: [ActionId; 24] = [
    ActionId::Difference,
    ActionId::Align,
    ActionId::Jump(Jump::Minute),
    ActionId::Complete,
    ActionId::AcknowledgeAll,
    ActionId::NextPane,
    ActionId::Copy,
    ActionId::NextLike,
    ActionId::PlannerMessages,
    ActionId::Parameters,
    ActionId::Faster,
    ActionId::Bookmark,
    ActionId::Jump(Jump::Tick),
    ActionId::ChoosePlanner,
    ActionId::Acknowledge,
    ActionId::PreviousMissed,
    ActionId::NextMissed,
    ActionId::Again,
    ActionId::Commands,
    ActionId::Step,
    ActionId::View,
    ActionId::Report,
    ActionId::Verify,
    ActionId::Rescan,
];

/// Columns around a notice beside the keys.
const GAP: usize = 3;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let columns = usize::from(area.width);
    let notice = notice::beside(look.model, columns);
    let taken = notice.as_ref().map_or(0, |(_, said)| text::width(said) + GAP);
    let hints = fitting(look.model, columns.saturating_sub(taken));
    let mut x = area.x;
    for hint in &hints {
        let width = hint.width() as u16;
        let place = Rect { x, width, ..area }.intersection(area);
        look.cache.borrow_mut().place_key(place, hint.id);
        x = x.saturating_add(width);
    }
    frame.render_widget(written(look, hints), area);
    if let Some((role, said)) = notice {
        frame.render_widget(look.line([(role, format!("{said} "))]).right_aligned(), area);
    }
}

/// The columns that remain for a notice beside the keys that are always shown, except the key of the help.
pub(super) fn room(model: &Model, columns: usize) -> usize {
    let mut always = lasting(model, 0);
    // A message stays for a few seconds only.
    always.retain(|hint| !matches!(hint.id, ActionId::Help | ActionId::NextPane));
    columns.saturating_sub(width(&always) + GAP)
}

/// The footer line, with as many keys as fit.
pub(super) fn line(look: &Look, columns: usize) -> Line<'static> {
    written(look, fitting(look.model, columns))
}

/// The keys that fit, each with its whole label; at least one.
fn fitting(model: &Model, columns: usize) -> Vec<Hint> {
    let mut hints = lasting(model, columns);
    while width(&hints) > columns && hints.len() > 1 {
        // Of several keys with the same weight, the last one is dropped.
        let least = (0..hints.len()).max_by_key(|index| weight(model, hints[*index].id));
        hints.remove(least.unwrap_or_default());
    }
    hints
}

/// The keys without the dispensable ones that do not fit.
fn lasting(model: &Model, columns: usize) -> Vec<Hint> {
    let mut hints = hints(model);
    for id in DISPENSABLE {
        if width(&hints) > columns && !is_way_on(model, id) {
            hints.retain(|hint| hint.id != id);
        }
    }
    hints
}

/// Whether an action is the only way to the other panes, because the panes have no keys of their own.
fn is_way_on(model: &Model, id: ActionId) -> bool {
    let is_small = matches!(model.ui.arrangement(), Arrangement::Paged | Arrangement::Narrow);
    id == ActionId::NextPane && is_small
}

/// How soon a key is left out, from the last one to the first.
fn weight(model: &Model, id: ActionId) -> u8 {
    match id {
        ActionId::Hold | ActionId::Interrupt => 0,
        ActionId::Accept => 1,
        ActionId::Cancel if model.ui.overlay != Overlay::None => 1,
        id if model.ui.screen.row().first == id => 1,
        ActionId::Help => 2,
        ActionId::Abort => 3,
        id if is_way_on(model, id) => 4,
        ActionId::Back => 4,
        _ => 5,
    }
}

fn written(look: &Look, hints: Vec<Hint>) -> Line<'static> {
    let parts = hints
        .into_iter()
        .flat_map(|hint| [(Role::Key, format!(" {}", hint.keys)), (Role::Dim, format!(" {} ", hint.label))]);
    look.line(parts)
}

/// A key and its label.
struct Hint {
    id: ActionId,
    keys: String,
    label: String,
}

impl Hint {
    fn width(&self) -> usize {
        text::width(&self.keys) + text::width(&self.label) + 3
    }
}

fn width(hints: &[Hint]) -> usize {
    hints.iter().map(Hint::width).sum()
}

/// The active keys; keys with the same label are grouped.
fn hints(model: &Model) -> Vec<Hint> {
    let contexts = contexts(model);
    let mut shown: Vec<&Action> = ACTIONS.iter().filter(|action| shown(action, &contexts, model)).collect();
    shown.sort_by_key(|action| place(model, action));
    let mut hints: Vec<Hint> = Vec::new();
    for action in shown {
        let is_text = contexts.contains(&Context::Text);
        let mut keys = model.console.keys.of(action).iter();
        // In an input line a character is text, not a key; only the space holds until text has been typed.
        let is_key = |key: &&Key| match key {
            Key::Char(' ') if is_text => action.id == ActionId::Hold && holds_by_space(model),
            Key::Char(_) => !is_text,
            _ => true,
        };
        let Some(key) = keys.find(is_key) else { continue };
        let label = label(action, model);
        match hints.last_mut().filter(|last| last.label == label) {
            Some(last) => {
                last.keys = format!("{} {}", last.keys, model.console.keys.key_text(*key));
                last.id = action.id;
            }
            None => hints.push(Hint { id: action.id, keys: model.console.keys.key_text(*key), label }),
        }
    }
    hints
}

/// The place of an action in the line: first the key that stops a robot, then the screen's own key. The other keys
/// keep their order.
fn place(model: &Model, action: &Action) -> u8 {
    let is_over = model.ui.overlay != Overlay::None;
    match action.id {
        ActionId::Hold if model.live.may_move() => 0,
        // The help and the command list do not show the effect of Enter.
        ActionId::Accept if !is_over => 1,
        // A different planner is the way on if this plan cannot be started.
        ActionId::ChoosePlanner if !is_over && leads_on(model) => 1,
        id if !is_over && model.ui.screen.row().first == id => 1,
        _ => 2,
    }
}

/// Whether the plan screen shows a plan that cannot be started.
fn leads_on(model: &Model) -> bool {
    model.ui.screen == Screen::Plan && model.live.waits() && model.start_is_blocked().is_some()
}

fn shown(action: &Action, contexts: &[Context], model: &Model) -> bool {
    let in_screen = contexts.contains(&Context::Screen);
    // In a list or input line the stop keys only stop the robot, so they are shown only while there is something to
    // stop.
    let idle =
        matches!(action.id, ActionId::Hold | ActionId::Interrupt) && !in_screen && !model.live.may_move();
    action.works_in(contexts)
        && !idle
        && !is_pointless(action.id, model)
        && !label(action, model).is_empty()
        && offered(model, action.id).is_ok()
}

/// Whether a key that works would do nothing useful now.
fn is_pointless(id: ActionId, model: &Model) -> bool {
    match id {
        // The checks would refuse the start.
        ActionId::Start => model.start_is_blocked().is_some(),
        // There is nothing left to scan.
        ActionId::Rescan => {
            let is_known = model.ui.screen == Screen::Result && model.live.floor().is_some();
            is_known && model.live.missed().is_empty()
        }
        // They cannot be changed on a console that gives no orders, and a survey has no planner.
        ActionId::Parameters => model.live.is_look_only() || model.live.run.is_survey(),
        // Nothing on the home screen moves.
        ActionId::Slower | ActionId::Faster => model.ui.screen == Screen::Home,
        _ => false,
    }
}

fn label(action: &Action, model: &Model) -> String {
    let is_playing = model.live.replay.as_ref().map(|replay| replay.is_playing);
    let word = match (action.id, &model.ui.overlay) {
        (ActionId::Hold, Overlay::None) if is_playing == Some(true) => "pause",
        (ActionId::Hold, Overlay::None) if is_playing == Some(false) => "play",
        (ActionId::Hold, _) if matches!(model.live.run.phase(), Phase::Held(_)) && !model.live.may_move() => {
            if accepted(model, &Order::Resume).is_ok() {
                "resume…"
            } else {
                ""
            }
        }
        (ActionId::Interrupt, _) if is_typing(model) => "HOLD",
        (ActionId::Rescan, Overlay::None) if model.rescans_a_survey() => "plan a scan",
        (ActionId::Cancel, Overlay::None) => "close cursor",
        (ActionId::Accept, Overlay::None) => (model.ui.screen.row().opens)(model).unwrap_or_default(),
        (ActionId::Back, _) if model.ui.screen == Screen::Home => "quit",
        (ActionId::Accept, Overlay::Commands(_) | Overlay::Remedies { .. }) => "run",
        (ActionId::Remedy(number), Overlay::Remedies { steps, .. }) if usize::from(number) <= steps.len() => {
            "run"
        }
        (ActionId::Accept, Overlay::Planners { selected, is_unfolded, .. })
            if matches!(model.planner_lines(*is_unfolded).get(*selected), Some(PlannerLine::Others(_))) =>
        {
            "unfold"
        }
        (ActionId::Accept, Overlay::Planners { .. } | Overlay::WhatIf) => "choose",
        (ActionId::Accept, Overlay::Preflight { .. }) => "tick",
        (ActionId::Accept, Overlay::Preset { .. }) => "take",
        (ActionId::Accept, Overlay::Messages { .. }) => "",
        (ActionId::Accept, Overlay::Finish { selected: 0 }) => "end here",
        (ActionId::Accept, Overlay::Finish { .. }) => "drive back",
        (ActionId::Accept, Overlay::ZoneDraft(draft)) if draft.form == Form::Polygon => "set corner",
        (ActionId::Accept, Overlay::Layers { .. }) => "show/hide",
        (ActionId::Accept, Overlay::Parameters { edit: None, .. }) => "edit",
        (ActionId::Accept, Overlay::Parameters { edit: Some(_), .. }) => "send",
        (ActionId::Accept, Overlay::Filter(_)) => "keep",
        (ActionId::Accept, Overlay::Shelve(_)) => "shelve",
        (ActionId::Accept, Overlay::Bookmark(_) | Overlay::ZoneDraft(_)) => "set",
        (ActionId::Accept, Overlay::Stepping) => "step",
        (ActionId::Cancel, Overlay::Filter(_)) => "clear",
        (
            ActionId::Cancel,
            Overlay::Commands(_)
            | Overlay::Planners { .. }
            | Overlay::Layers { .. }
            | Overlay::Preset { .. }
            | Overlay::Preflight { .. }
            | Overlay::WhatIf
            | Overlay::Messages { .. }
            | Overlay::Remedies { .. }
            | Overlay::Parameters { edit: None, .. },
        ) => "close",
        _ => action.label,
    };
    word.into()
}
