//! The keys that are active now, taken from the action table.

use super::look::Look;
use super::text;
use crate::actions::{
    ACTIONS, Action, ActionId,
    context::{Context, contexts},
};
use crate::keys::Key;
use crate::model::replay::Jump;
use crate::model::{Model, Overlay, Screen, ui::Arrangement};
use crate::theme::Role;
use crate::update::{is_typing, offered};
use mission::Phase;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// The actions that are dropped first if space is short.
const DISPENSABLE: [ActionId; 19] = [
    ActionId::Difference,
    ActionId::Align,
    ActionId::Jump(Jump::Minute),
    ActionId::Complete,
    ActionId::AcknowledgeAll,
    ActionId::NextPane,
    ActionId::Parameters,
    ActionId::Faster,
    ActionId::Bookmark,
    ActionId::Jump(Jump::Tick),
    ActionId::ChoosePlanner,
    ActionId::Acknowledge,
    ActionId::Commands,
    ActionId::Step,
    ActionId::View,
    ActionId::Report,
    ActionId::Verify,
    ActionId::Rescan,
    ActionId::Help,
];

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let hints = fitting(look.model, usize::from(area.width));
    let mut x = area.x;
    for hint in &hints {
        let width = hint.width() as u16;
        let place = Rect { x, width, ..area }.intersection(area);
        look.cache.borrow_mut().place_key(place, hint.id);
        x = x.saturating_add(width);
    }
    frame.render_widget(written(look, hints), area);
}

/// The footer line, with as many keys as fit.
pub(super) fn line(look: &Look, columns: usize) -> Line<'static> {
    written(look, fitting(look.model, columns))
}

/// The keys that fit.
fn fitting(model: &Model, columns: usize) -> Vec<Hint> {
    let mut hints = hints(model);
    let paged = model.ui.arrangement() == Arrangement::Paged;
    for id in DISPENSABLE {
        // With one pane at a time, the other panes could not be reached without the key for the next pane.
        let kept = paged && id == ActionId::NextPane;
        if width(&hints) > columns && !kept {
            hints.retain(|hint| hint.id != id);
        }
    }
    hints
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
    let mut hints: Vec<Hint> = Vec::new();
    for action in ACTIONS.iter().filter(|action| shown(action, &contexts, model)) {
        let is_text = contexts.contains(&Context::Text);
        let mut keys = model.console.keys.of(action).iter();
        // In an input line a character is text, not a key.
        let Some(key) = keys.find(|key| !(is_text && matches!(key, Key::Char(_)))) else { continue };
        let label = label(action, model);
        match hints.last_mut().filter(|last| last.label == label) {
            Some(last) => {
                last.keys = format!("{} {key}", last.keys);
                last.id = action.id;
            }
            None => hints.push(Hint { id: action.id, keys: key.to_string(), label }),
        }
    }
    hints
}

fn shown(action: &Action, contexts: &[Context], model: &Model) -> bool {
    let in_screen = contexts.contains(&Context::Screen);
    // In a list or input line the stop keys only stop the robot, so they are shown only while there is something to
    // stop.
    let idle =
        matches!(action.id, ActionId::Hold | ActionId::Interrupt) && !in_screen && !model.live.may_move();
    action.works_in(contexts)
        && !idle
        && !label(action, model).is_empty()
        && offered(model, action.id).is_ok()
}

fn label(action: &Action, model: &Model) -> String {
    let is_playing = model.live.replay.as_ref().map(|replay| replay.is_playing);
    let word = match (action.id, &model.ui.overlay) {
        (ActionId::Hold, Overlay::None) if is_playing == Some(true) => "pause",
        (ActionId::Hold, Overlay::None) if is_playing == Some(false) => "play",
        (ActionId::Hold, _) if matches!(model.live.run.phase(), Phase::Held(_)) && !model.live.may_move() => {
            "resume?"
        }
        (ActionId::Interrupt, _) if is_typing(model) => "HOLD",
        (ActionId::Cancel, Overlay::None) => "close cursor",
        (ActionId::Accept, Overlay::None) => (model.ui.screen.row().opens)(model).unwrap_or_default(),
        (ActionId::Back, _) if model.ui.screen == Screen::Home => "quit",
        (ActionId::Accept, Overlay::Commands(_) | Overlay::Remedies { .. }) => "run",
        (ActionId::Accept, Overlay::Planners { .. } | Overlay::WhatIf) => "choose",
        (ActionId::Accept, Overlay::Preflight { .. }) => "tick",
        (ActionId::Accept, Overlay::Preset { .. }) => "take",
        (ActionId::Accept, Overlay::Layers { .. }) => "show/hide",
        (ActionId::Accept, Overlay::Parameters { edit: None, .. }) => "edit",
        (ActionId::Accept, Overlay::Parameters { edit: Some(_), .. }) => "send",
        (ActionId::Accept, Overlay::Filter(_)) => "keep",
        (ActionId::Accept, Overlay::Shelve(_)) => "shelve",
        (ActionId::Accept, Overlay::Bookmark(_)) => "set",
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
            | Overlay::Remedies { .. }
            | Overlay::Parameters { edit: None, .. },
        ) => "close",
        _ => action.label,
    };
    word.into()
}
