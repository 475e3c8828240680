//! The keys that do something now, from the one table.

use super::look::Look;
use super::text;
use crate::actions::{
    ACTIONS, Action, ActionId,
    context::{Context, contexts},
};
use crate::keys::Key;
use crate::model::{Model, Overlay, Screen, ui::Arrangement};
use crate::theme::Role;
use crate::update::{is_typing, offered};
use mission::Phase;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// What goes first when there is too little room.
const DISPENSABLE: [ActionId; 9] = [
    ActionId::Complete,
    ActionId::NextPane,
    ActionId::Parameters,
    ActionId::Faster,
    ActionId::ChoosePlanner,
    ActionId::Acknowledge,
    ActionId::Commands,
    ActionId::Step,
    ActionId::Help,
];

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    frame.render_widget(line(look, usize::from(area.width)), area);
}

/// As many keys as fit into some columns.
pub(super) fn line(look: &Look, columns: usize) -> Line<'static> {
    let mut hints = hints(look.model);
    let paged = look.model.ui.arrangement() == Arrangement::Paged;
    for id in DISPENSABLE {
        // One pane at a time: without the key to the next one the others are lost.
        let kept = paged && id == ActionId::NextPane;
        if width(&hints) > columns && !kept {
            hints.retain(|hint| hint.id != id);
        }
    }
    let parts = hints
        .into_iter()
        .flat_map(|hint| [(Role::Key, format!(" {}", hint.keys)), (Role::Dim, format!(" {} ", hint.label))]);
    look.line(parts)
}

/// A key and what it does.
struct Hint {
    id: ActionId,
    keys: String,
    label: String,
}

fn width(hints: &[Hint]) -> usize {
    hints.iter().map(|hint| text::width(&hint.keys) + text::width(&hint.label) + 3).sum()
}

/// The keys that do something now; keys with the same label stand together.
fn hints(model: &Model) -> Vec<Hint> {
    let contexts = contexts(model);
    let mut hints: Vec<Hint> = Vec::new();
    for action in ACTIONS.iter().filter(|action| shown(action, &contexts, model)) {
        let is_text = contexts.contains(&Context::Text);
        let mut keys = model.console.keys.of(action).iter();
        // In a text field a character is no key.
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
    // In a list or line the stop keys only stop, so there they are shown only while something can be stopped.
    let idle =
        matches!(action.id, ActionId::Hold | ActionId::Interrupt) && !in_screen && !model.live.may_move();
    action.works_in(contexts)
        && !idle
        && !label(action, model).is_empty()
        && offered(model, action.id).is_ok()
}

fn label(action: &Action, model: &Model) -> String {
    let word = match (action.id, &model.ui.overlay) {
        (ActionId::Hold, _) if matches!(model.live.run.phase(), Phase::Held(_)) && !model.live.may_move() => {
            "resume?"
        }
        (ActionId::Interrupt, _) if is_typing(model) => "HOLD",
        (ActionId::Accept, Overlay::None) => "open",
        (ActionId::Back, _) if model.ui.screen == Screen::Home => "quit",
        (ActionId::Accept, Overlay::Commands(_)) => "run",
        (ActionId::Accept, Overlay::Planners { .. }) => "choose",
        (ActionId::Accept, Overlay::Layers { .. }) => "show/hide",
        (ActionId::Accept, Overlay::Parameters { edit: None, .. }) => "edit",
        (ActionId::Accept, Overlay::Parameters { edit: Some(_), .. }) => "send",
        (ActionId::Accept, Overlay::Filter(_)) => "keep",
        (ActionId::Accept, Overlay::Stepping) => "step",
        (ActionId::Cancel, Overlay::Filter(_)) => "clear",
        (
            ActionId::Cancel,
            Overlay::Commands(_)
            | Overlay::Planners { .. }
            | Overlay::Layers { .. }
            | Overlay::Parameters { edit: None, .. },
        ) => "close",
        _ => action.label,
    };
    word.into()
}
