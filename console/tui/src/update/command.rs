//! Parses and runs command lines: a command and its values.

pub(super) mod line;
pub(super) mod so_far;
mod value;

pub(super) use value::Value;

use super::act::{act, hold_only, set_speed};
use super::alarms;
use super::events;
use super::go;
use super::look_only::allowed;
use super::message::Effect;
use super::offer::{accepted, offered, refuse};
use super::overlay;
use super::preset;
use super::replay;
use super::send::send;
use super::setting;
use super::stations;
use super::typing;
use super::zones;
use crate::actions::{Action, ActionId, Arg, Kind, find, keymap::Keymap};
use crate::handover;
use crate::model::{
    Model,
    palette::LineFault,
    ui::{MapView, Purpose},
};
use line::Word;
use mission::{Order, Parameters, PlannerChoice};

/// A parsed command with its values.
pub(super) struct Command {
    action: &'static Action,
    values: Vec<Value>,
}

impl Command {
    /// Whether the command stops the robot; such a command runs whatever overlay is open.
    pub(super) fn stops(&self) -> bool {
        matches!(
            self.action.id,
            ActionId::Hold | ActionId::Interrupt | ActionId::Suspend | ActionId::Abort | ActionId::Leave
        )
    }
}

/// Parses a command line; an alias is replaced by its command line.
///
/// # Errors
/// Returns the invalid part of the line, and how to correct it.
pub(super) fn read(model: &Model, text: &str) -> Result<Command, LineFault> {
    let value = |kind, text: &str| value::read(model, kind, text);
    let (action, values) = read_with(&model.console.keys, text, &value)?;
    Ok(Command { action, values })
}

/// Checks a line independently of any mission: the name of the command, the number of values, and the values that
/// depend on neither a run nor files.
///
/// # Errors
/// Returns what is wrong and how to correct it, as a clause.
pub fn check_line(keys: &Keymap, text: &str) -> Result<(), String> {
    let nothing = Model::default();
    let value = |kind: Kind, text: &str| match kind {
        Kind::Parameter if !text.contains('=') => value::read(&nothing, kind, text).map(drop),
        _ if kind.depends_on_run() => Ok(()),
        _ => value::read(&nothing, kind, text).map(drop),
    };
    read_with(keys, text, &value).map(drop).map_err(|fault| fault.what)
}

/// A command, with its values as parsed by `value`.
type Read<V> = (&'static Action, Vec<V>);

fn read_with<V>(
    keys: &Keymap,
    text: &str,
    value: &impl Fn(Kind, &str) -> Result<V, String>,
) -> Result<Read<V>, LineFault> {
    let first = text.split(' ').next().unwrap_or_default();
    if let Some(line) = keys.aliases.get(first) {
        // An alias stands for a command, not for another alias; any words after it are arguments of its command.
        let line = format!("{line}{}", &text[first.len()..]);
        return read_line(&line, value).map_err(|fault| LineFault { at: 0..text.len(), ..fault });
    }
    read_line(text, value)
}

fn read_line<V>(text: &str, value: &impl Fn(Kind, &str) -> Result<V, String>) -> Result<Read<V>, LineFault> {
    let words = line::words(text)?;
    let (name, rest) = words.split_first().ok_or(LineFault { at: 0..0, what: "no command given".into() })?;
    let unknown = || LineFault { at: name.at.clone(), what: format!("unknown command `{}`", name.text) };
    let action = find::named(&name.text).ok_or_else(unknown)?;
    let (mut values, mut given) = (Vec::new(), Vec::new());
    for (index, word) in rest.iter().enumerate() {
        let (arg, text) = arg_of(action, index, word)?;
        values.push(value(arg.kind, text).map_err(|what| LineFault { at: word.at.clone(), what })?);
        given.push(arg);
    }
    if action.args.iter().any(|arg| arg.is_required && !given.contains(&arg)) {
        return Err(LineFault { at: text.len()..text.len() + 1, what: format!("usage: {}", action.usage()) });
    }
    Ok((action, values))
}

/// The argument to which a word belongs, and its value. The first word always belongs to the first argument; any
/// other word belongs to an argument by name or by position.
fn arg_of<'a>(
    action: &'static Action,
    index: usize,
    word: &'a Word,
) -> Result<(&'static Arg, &'a str), LineFault> {
    let fault = |what| Err(LineFault { at: word.at.clone(), what });
    if index == 0
        && let Some(arg) = action.args.first()
    {
        return Ok((arg, &word.text));
    }
    let named = word.text.split_once('=');
    let named = named.and_then(|(name, text)| Some((action.args.iter().find(|arg| arg.name == name)?, text)));
    match named.or_else(|| action.args.get(index).map(|arg| (arg, word.text.as_str()))) {
        Some(found) => Ok(found),
        None if action.args.is_empty() => fault(format!("{} takes no value", action.name)),
        None => fault(format!("usage: {}", action.usage())),
    }
}

/// The completions of the last word of a line; `None` while the command itself is being typed.
pub(super) fn candidates(model: &Model, before: &str) -> Option<Vec<String>> {
    let begin = line::word_begin(before);
    let mut words = before[..begin].split_whitespace();
    let action = find::named(words.next()?).filter(|action| !action.args.is_empty())?;
    let typed = before[begin..].trim_start_matches('"');
    let index = words.count();
    let by_name = |arg: &Arg| {
        let name = arg.name;
        let values = value::candidates(model, arg.kind, typed);
        values.into_iter().map(move |value| format!("{name}={value}"))
    };
    let all = match action.args.get(index) {
        Some(arg) if index == 0 || arg.is_required => value::candidates(model, arg.kind, typed),
        _ => action.args.iter().skip(1).filter(|arg| !arg.is_required).flat_map(by_name).collect(),
    };
    // A planner for another scenario is judged when that scenario is opened.
    let refused = |value: &str| {
        let planner = model.console.planners.iter().find(|planner| planner.id == value);
        action.id != ActionId::Open
            && planner.is_some_and(|planner| model.live.run.cannot_fly(planner).is_some())
    };
    let all = all.into_iter().filter(|value| !refused(value));
    let small = typed.to_lowercase();
    let fits = |value: &String| value.trim_start_matches('"').to_lowercase().starts_with(&small);
    Some(all.filter(fits).collect())
}

/// Runs a command.
pub(super) fn run(model: &mut Model, Command { action, values }: Command) -> Vec<Effect> {
    let mut values = values.into_iter();
    let Some(first) = values.next() else {
        return if action.id == ActionId::Hold { hold_only(model) } else { act(model, action.id) };
    };
    // A command that names its object does not need a screen on which something is selected.
    let is_named = matches!(first, Value::Run(_) | Value::Duration(_)) && action.id != ActionId::CompareRun;
    let can = if is_named { allowed(model, action) } else { offered(model, action.id) };
    if let Err(why) = can {
        return refuse(model, why);
    }
    match first {
        Value::Speed(speed) => return set_speed(model, speed),
        Value::Planner(planner) => {
            let purpose = match action.id {
                ActionId::Compare => Purpose::Compare,
                ActionId::Shadow => Purpose::Shadow,
                _ => Purpose::Drive,
            };
            return overlay::choose(model, purpose, planner);
        }
        Value::Parameter { key, value } => return setting::propose(model, key, value, None),
        Value::Scenario(source) => {
            let planner = values.find_map(|value| match value {
                Value::Planner(info) => Some(PlannerChoice { id: info.id, parameters: Parameters::new() }),
                _ => None,
            });
            return go::open(model, source, planner);
        }
        Value::Run(run) => return go::begin_on(model, action.id, run),
        Value::Screen(screen) => return act(model, ActionId::Go(screen)),
        Value::Layer(layer) => model.ui.layers.toggle(layer),
        Value::Place(offset) => model.ui.map = MapView { follow: false, offset, ..model.ui.map },
        Value::Severity(least) => events::set_least(model, least),
        Value::Theme(theme) => model.ui.theme = theme,
        Value::Duration(for_s) => return shelve(model, for_s, values),
        Value::Corner(corner) => {
            let corners = zones::corners(corner, values);
            return corners.map_or_else(Vec::new, |corners| zones::propose(model, corners));
        }
        Value::Station(station) => {
            let order = stations::order(model, action.id, station, values);
            return order.map_or_else(Vec::new, |order| give(model, order));
        }
        // Alarms and faults occur only as second arguments.
        Value::Alarm(_) | Value::Fault(_) => {}
        Value::Preset(name) => return preset::load(model, &name),
        Value::Text(name) if action.id == ActionId::PresetSave => return preset::save(model, name),
        Value::Text(file) if action.id == ActionId::HandOver => return hand_over(model, file, values),
        Value::Text(text) if action.id == ActionId::Remark => return replay::remark(model, &text),
        Value::Text(text) if action.id == ActionId::Bookmark => {
            let t_s = model.live.run.clock.t_s;
            return replay::bookmark(model, t_s, &text);
        }
        Value::Moment(t_s) => return replay::seek_to(model, t_s),
        Value::Text(text) => typing::filter(model, &text),
    }
    Vec::new()
}

/// Gives an order that needs no confirmation, if the mission accepts it.
fn give(model: &mut Model, order: Order) -> Vec<Effect> {
    match accepted(model, &order) {
        Ok(()) => send(model, order),
        Err(why) => refuse(model, why),
    }
}

/// Writes the handover page; an earlier page is only replaced if the operator says so.
fn hand_over(model: &mut Model, file: String, mut values: impl Iterator<Item = Value>) -> Vec<Effect> {
    let overwrite = match values.next() {
        None => false,
        Some(Value::Text(word)) if word == "overwrite" => true,
        Some(_) => {
            return refuse(model, "write `overwrite` after the file to replace an earlier page".into());
        }
    };
    vec![Effect::HandOver { file, page: handover::page(model), overwrite }]
}

/// Shelves the named or selected alarm.
fn shelve(model: &mut Model, for_s: f64, values: impl Iterator<Item = Value>) -> Vec<Effect> {
    let (mut reason, mut named) = (String::new(), None);
    for value in values {
        match value {
            Value::Text(text) => reason = text,
            Value::Alarm(cause) => named = Some(cause),
            _ => {}
        }
    }
    match alarms::shelve_for(model, named, for_s, &reason) {
        Ok(effects) => effects,
        Err(why) => refuse(model, why),
    }
}
