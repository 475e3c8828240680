//! Input lines.

use super::offer::demand;
use super::palette;
use crate::actions::{ActionId, find};
use crate::keys::Key;
use crate::model::{LineEdit, Model, Overlay, Pane, Screen};
use mission::{ParamKind, Severity};

/// Whether an input line is open, in which letters and spaces are text.
pub fn is_typing(model: &Model) -> bool {
    use Overlay::{Bookmark, Commands, Filter, Parameters, Shelve};
    let overlay = &model.ui.overlay;
    matches!(overlay, Commands(_) | Parameters { edit: Some(_), .. } | Filter(_) | Shelve(_) | Bookmark(_))
}

/// Whether the open input line has no text yet, so that a space would be its first character.
fn is_blank(model: &Model) -> bool {
    let text = match &model.ui.overlay {
        Overlay::Commands(palette) => palette.line.text(),
        Overlay::Parameters { edit: Some(edit), .. } => edit.line.text(),
        Overlay::Filter(line) | Overlay::Bookmark(line) => line.text(),
        Overlay::Shelve(shelving) => shelving.line.text(),
        _ => return false,
    };
    text.is_empty()
}

/// Whether the space key holds although an input line is open: the robot may move, and no text has been typed. No line
/// begins with a space.
pub(crate) fn holds_by_space(model: &Model) -> bool {
    let is_hold = |action| model.console.keys.of(action).contains(&Key::Char(' '));
    model.live.may_move() && is_blank(model) && find::row(ActionId::Hold).is_some_and(is_hold)
}

/// Passes a key to the open input line; returns whether there is one and it uses the key.
pub(super) fn press(model: &mut Model, key: Key) -> bool {
    // In a line without text, these keys go through the list.
    let is_empty = matches!(&model.ui.overlay, Overlay::Commands(palette) if palette.line.text().is_empty());
    if is_empty && matches!(key, Key::Home | Key::End) {
        return false;
    }
    edit(model, |line| line.press(key)).unwrap_or(false)
}

/// Inserts pasted text into the open input line. Without such a line the text is discarded, so that a paste never
/// becomes a command.
pub(super) fn paste(model: &mut Model, pasted: &str) {
    if edit(model, |line| line.insert(pasted)).is_none() {
        model.say(Severity::Info, "paste ignored: no text field is open");
    }
}

/// Checks that the open input line can be completed.
pub(crate) fn can_complete(model: &Model) -> Result<(), String> {
    let completes = matches!(model.ui.overlay, Overlay::Commands(_)) || !options(model).is_empty();
    demand(completes, "nothing to complete here")
}

/// The values of the parameter being edited, if they are words.
fn options(model: &Model) -> &[String] {
    let Overlay::Parameters { selected, edit: Some(_) } = &model.ui.overlay else { return &[] };
    let info = model.edited().and_then(|(planner, _)| planner.parameters.get(*selected));
    match info.map(|info| &info.kind) {
        Some(ParamKind::Choice { options, .. }) => options,
        _ => &[],
    }
}

/// Completes the word at the cursor.
pub(crate) fn complete(model: &mut Model) {
    match &model.ui.overlay {
        Overlay::Commands(_) => palette::complete(model),
        Overlay::Parameters { edit: Some(typed), .. } => {
            let options = options(model);
            let Some(word) = options.iter().find(|word| word.starts_with(typed.line.before())) else {
                return;
            };
            let word = word.clone();
            edit(model, |line| line.replace_word(0, &word));
        }
        _ => {}
    }
}

/// Edits the open input line, if there is one; clears an error about the old text.
fn edit<T>(model: &mut Model, how: impl FnOnce(&mut LineEdit) -> T) -> Option<T> {
    let line = line(&mut model.ui.overlay)?;
    let before = line.text().to_owned();
    let done = how(line);
    if line.text() != before {
        changed(model);
    }
    Some(done)
}

fn line(overlay: &mut Overlay) -> Option<&mut LineEdit> {
    match overlay {
        Overlay::Commands(palette) => Some(&mut palette.line),
        Overlay::Parameters { edit: Some(edit), .. } => Some(&mut edit.line),
        Overlay::Filter(line) | Overlay::Bookmark(line) => Some(line),
        Overlay::Shelve(shelving) => Some(&mut shelving.line),
        _ => None,
    }
}

fn changed(model: &mut Model) {
    match &mut model.ui.overlay {
        Overlay::Commands(palette) => {
            (palette.selected, palette.recalled) = (0, 0);
            palette::judge(model);
        }
        Overlay::Parameters { edit: Some(edit), .. } => edit.refusal = None,
        Overlay::Shelve(shelving) => shelving.refusal = None,
        Overlay::Filter(line) => {
            let text = line.text().to_owned();
            filter(model, &text);
        }
        _ => {}
    }
}

/// The filter text for the screen's list.
pub(super) fn filtered(model: &Model) -> &str {
    model.ui.screen.row().filter.map_or(model.ui.needle.as_str(), |(text, _)| text(model))
}

/// Clears the filter of the list on the screen; returns whether there was one.
pub(super) fn clear_filter(model: &mut Model) -> bool {
    let is_free = model.ui.overlay == Overlay::None && model.ui.cursor.is_none();
    let has_filter = has_list(model) && !filtered(model).is_empty();
    if is_free && has_filter {
        filter(model, "");
        model.hint("filter cleared");
    }
    is_free && has_filter
}

/// Whether the screen shows a list that is filtered.
fn has_list(model: &Model) -> bool {
    model.ui.screen.row().filter.is_some()
        || model.ui.screen == Screen::Events
        || model.ui.screen == Screen::Mission && model.ui.shows(Pane::Events)
}

/// Filters the list on the screen.
pub(super) fn filter(model: &mut Model, text: &str) {
    let filter = match model.ui.screen.row().filter {
        Some((_, text_mut)) => text_mut(model),
        None => &mut model.ui.needle,
    };
    text.clone_into(filter);
    (model.home.scenario, model.home.run, model.review.selected) = (0, 0, 0);
    model.ui.events.at = None;
}
