//! The command line: suggestions, completion, history, and running what was typed.

use super::command::{self, line, so_far};
use super::message::Effect;
use super::offer::{offered, refuse};
use super::overlay::open;
use crate::actions::context::Context;
use crate::actions::find::{self, Match};
use crate::actions::{Action, ActionId, Risk, Topic};
use crate::model::{Model, Overlay, Palette, palette::LineFault};
use crate::screens;
use mission::spelling::nearest;
use std::cmp::Reverse;

/// The maximum number of command lines that are remembered.
const MAX_HISTORY: usize = 100;

/// A suggestion in the command line's list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Choice {
    /// A command.
    Command(&'static Action),
    /// An alias defined by the operator, and the command line it stands for.
    Alias(String, String),
    /// A value for the typed command.
    Value(String),
}

/// The suggestions for a command line, best first.
pub fn choices(model: &Model, palette: &Palette) -> Vec<Choice> {
    let text = palette.line.text();
    if let Some(values) = command::candidates(model, palette.line.before()) {
        return values.into_iter().map(Choice::Value).collect();
    }
    let typed = text.trim();
    let aliases =
        model.console.keys.aliases.iter().filter(|(name, _)| !typed.is_empty() && name.starts_with(typed));
    let aliases = aliases.map(|(name, line)| Choice::Alias(name.clone(), line.clone()));
    let (exact, others): (Vec<_>, Vec<_>) =
        aliases.partition(|alias| matches!(alias, Choice::Alias(name, _) if name == typed));
    exact
        .into_iter()
        .chain(ranked(model, palette, typed).into_iter().map(Choice::Command))
        .chain(others)
        .collect()
}

/// The group of a command in the list of all commands: those of this screen come first, the screens last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// The commands of this screen.
    Here,
    /// The other commands about a topic.
    Topic(Topic),
}

/// The group of a command.
pub fn group(model: &Model, action: &Action) -> Group {
    if action.works_in(screens::contexts(model)) { Group::Here } else { Group::Topic(action.topic) }
}

/// The values to choose from for the first argument of a command, if any.
pub fn values(model: &Model, action: &Action) -> Vec<String> {
    command::candidates(model, &format!("{} ", action.name)).unwrap_or_default()
}

/// The commands that match the typed text, best first; if nothing is typed, in groups.
fn ranked(model: &Model, palette: &Palette, typed: &str) -> Vec<&'static Action> {
    if typed.is_empty() {
        // The list of keys shows what works here, and all keys of this screen.
        let is_own = |action: &Action| action.works_in(&[Context::On(model.ui.screen)]);
        let is_listed =
            |action: &&Action| !palette.help || is_own(action) || offered(model, action.id).is_ok();
        let keys = find::keys_of(screens::contexts(model)).filter(|_| palette.help);
        let mut all: Vec<&Action> = keys.chain(find::commands()).filter(is_listed).collect();
        all.sort_by_key(|action| group(model, action));
        return all;
    }
    let here = [&[Context::Anywhere, Context::Screen], screens::contexts(model)].concat();
    let found = find::commands().filter_map(|action| Some((Match::of(action, typed)?, action)));
    let mut found: Vec<(Match, &Action)> = found.collect();
    found.sort_by_cached_key(|(how, action)| {
        let is_now = offered(model, action.id).is_ok();
        (*how, !is_now, !action.works_in(&here), weight(action.risk), Reverse(last_use(model, action)))
    });
    found.into_iter().map(|(_, action)| action).collect()
}

fn weight(risk: Risk) -> u8 {
    match risk {
        Risk::Safe => 0,
        Risk::Changes | Risk::Moves => 1,
        Risk::Destroys => 2,
    }
}

/// The position in the history where a command was last used; larger means more recent.
fn last_use(model: &Model, action: &Action) -> Option<usize> {
    let is_of = |line: &String| line.split_whitespace().next() == Some(action.name);
    model.console.history.iter().rposition(is_of)
}

/// Opens the command line with the name of a command that needs a value.
pub(super) fn begin(model: &mut Model, id: ActionId) -> Vec<Effect> {
    let name = find::commands().find(|action| action.id == id).map_or("", |action| action.name);
    open(model, Overlay::Commands(Palette::begun(&format!("{name} "))))
}

/// Handles Enter: runs the line or the selected command; an error is shown in the line, which stays open.
pub(super) fn accept(model: &mut Model, palette: Palette) -> Vec<Effect> {
    let text = palette.line.text().trim().to_owned();
    match choices(model, &palette).into_iter().nth(palette.selected) {
        Some(Choice::Command(action)) => return chosen(model, action, &text),
        Some(Choice::Value(value)) if palette.selected > 0 => {
            let begin = line::word_begin(palette.line.before());
            let mut palette = palette;
            palette.line.replace_word(begin, &value);
            let text = palette.line.text().trim().to_owned();
            return run(model, palette, &text);
        }
        Some(Choice::Alias(_, line)) => return run(model, palette, &line),
        None if find::named(text.split(' ').next().unwrap_or_default()).is_none() => {
            return fail(model, palette, LineFault { at: 0..text.len(), what: unknown(&text) });
        }
        Some(Choice::Value(_)) | None => {}
    }
    run(model, palette, &text)
}

fn unknown(text: &str) -> String {
    let known = find::commands().flat_map(|action| action.synonyms.iter().copied().chain([action.name]));
    let near = nearest(text, known).map(|name| format!("; did you mean {name}?"));
    format!("no such command{}", near.unwrap_or_default())
}

/// Runs a command from the list; if the command needs a value, the line stays open for the value.
fn chosen(model: &mut Model, action: &'static Action, typed: &str) -> Vec<Effect> {
    model.ui.overlay = Overlay::None;
    if action.runs_alone() {
        remember(model, if find::named(typed) == Some(action) { typed } else { action.name });
    }
    super::act(model, action.id)
}

/// Runs a line that was not typed on the screen. Such a line cannot answer a question; a command that stops the robot
/// runs even while a question is open.
pub(super) fn obey(model: &mut Model, line: &str) -> Vec<Effect> {
    let stops = command::read(model, line).is_ok_and(|command| command.stops());
    if !stops && model.ui.overlay.is_question() {
        return refuse(model, "a question is open; answer it first".into());
    }
    run(model, Palette::begun(line), line)
}

fn run(model: &mut Model, palette: Palette, text: &str) -> Vec<Effect> {
    match command::read(model, text) {
        Ok(command) if command.stops() => {
            remember(model, text);
            let effects = command::run(model, command);
            if matches!(model.ui.overlay, Overlay::Commands(_)) {
                model.ui.overlay = Overlay::None;
            }
            effects
        }
        Ok(command) => {
            model.ui.overlay = Overlay::None;
            remember(model, text);
            command::run(model, command)
        }
        Err(fault) => fail(model, palette, fault),
    }
}

fn fail(model: &mut Model, palette: Palette, fault: LineFault) -> Vec<Effect> {
    open(model, Overlay::Commands(Palette { fault: Some(fault), ..palette }))
}

fn remember(model: &mut Model, line: &str) {
    let history = &mut model.console.history;
    history.retain(|before| before != line);
    history.push(line.to_owned());
    let surplus = history.len().saturating_sub(MAX_HISTORY);
    history.drain(..surplus);
}

/// Handles Tab: completes the word at the cursor from the selected line in the list.
pub(super) fn complete(model: &mut Model) {
    let Overlay::Commands(palette) = &model.ui.overlay else { return };
    let mut palette = palette.clone();
    match choices(model, &palette).into_iter().nth(palette.selected) {
        Some(Choice::Command(action)) => {
            let space = if action.args.is_empty() { "" } else { " " };
            palette.line = format!("{}{space}", action.name).as_str().into();
        }
        Some(Choice::Alias(name, _)) => palette.line = name.as_str().into(),
        Some(Choice::Value(value)) => {
            palette.line.replace_word(line::word_begin(palette.line.before()), &value);
        }
        None => return,
    }
    model.ui.overlay = Overlay::Commands(Palette { selected: 0, ..palette });
    judge(model);
}

/// Marks a value of the typed line that is wrong, whatever is typed next.
pub(super) fn judge(model: &mut Model) {
    let Overlay::Commands(palette) = &model.ui.overlay else { return };
    let fault = so_far::fault(model, palette.line.text(), palette.line.before());
    if let Overlay::Commands(palette) = &mut model.ui.overlay {
        palette.fault = fault;
    }
}

/// Moves through the history: from the first line of the list, Up goes back, and Down goes forward; returns whether
/// it moved.
pub(super) fn recalls(model: &mut Model, by: isize) -> bool {
    let Overlay::Commands(palette) = &mut model.ui.overlay else { return false };
    let recalled = match by {
        -1 if palette.selected == 0 && palette.recalled < model.console.history.len() => palette.recalled + 1,
        1 if palette.recalled > 0 => palette.recalled - 1,
        _ => return false,
    };
    let line = recalled.checked_sub(1).and_then(|back| model.console.history.iter().rev().nth(back));
    let line = line.map_or("", String::as_str);
    *palette = Palette { help: palette.help, recalled, ..Palette::begun(line) };
    judge(model);
    true
}
