//! What the operator does about alarms.

use super::message::Effect;
use super::offer::refuse;
use super::place;
use crate::actions::ActionId;
use crate::guide::{guide, name};
use crate::model::alarms::State;
use crate::model::ui::Shelving;
use crate::model::{Cause, LineEdit, Model, Overlay, Screen};
use mission::Severity;

fn selected_cause(model: &Model) -> Option<Cause> {
    model.selected_alarm().map(|alarm| alarm.cause.clone())
}

/// Selects another alarm, so many further down.
pub(super) fn select(model: &mut Model, by: isize) {
    let table = model.live.run.alarms.table();
    let at = model.selected_alarm().and_then(|here| table.iter().position(|alarm| alarm.cause == here.cause));
    let next = at.unwrap_or(0).saturating_add_signed(by).min(table.len().saturating_sub(1));
    model.ui.alarm = table.get(next).map(|alarm| alarm.cause.clone());
}

/// Acknowledges the selected alarm of the table if it waits for that, else the most severe one.
pub(super) fn acknowledge(model: &mut Model) -> Vec<Effect> {
    let chosen = (model.ui.screen == Screen::Alarms).then(|| selected_cause(model)).flatten();
    let alarms = &mut model.live.run.alarms;
    let text = chosen.and_then(|cause| alarms.acknowledge_one(&cause)).or_else(|| alarms.acknowledge());
    if let Some(text) = text {
        model.say(Severity::Info, format!("acknowledged: {text}"));
    }
    Vec::new()
}

/// Acknowledges every alarm.
pub(super) fn acknowledge_all(model: &mut Model) -> Vec<Effect> {
    let count = model.live.run.alarms.acknowledge_all();
    model.say(Severity::Info, format!("{count} alarms acknowledged"));
    Vec::new()
}

/// Asks for how long and why the selected alarm shall be put aside; takes a shelved one back.
pub(super) fn shelve(model: &mut Model) -> Vec<Effect> {
    let Some(alarm) = model.selected_alarm() else { return Vec::new() };
    let cause = alarm.cause.clone();
    if !matches!(alarm.state, State::Shelved(_)) {
        model.ui.overlay = Overlay::Shelve(Shelving { cause, line: LineEdit::default(), refusal: None });
        return Vec::new();
    }
    model.live.run.alarms.unshelve(&cause);
    model.say(Severity::Info, format!("taken back: {}", name(&cause, &model.live.run)));
    Vec::new()
}

/// Puts an alarm aside as typed, or says what is wrong with it.
pub(super) fn take_shelving(model: &mut Model, shelving: Shelving) -> Vec<Effect> {
    let typed = parse_shelving(shelving.line.text());
    match typed.and_then(|(minutes, reason)| put_aside(model, &shelving.cause, minutes, &reason)) {
        Ok(()) => model.ui.overlay = Overlay::None,
        Err(why) => model.ui.overlay = Overlay::Shelve(Shelving { refusal: Some(why), ..shelving }),
    }
    Vec::new()
}

/// Puts the named alarm aside, or the one that is selected, for so many seconds.
///
/// # Errors
/// Why not, and what would be right.
pub(super) fn shelve_for(
    model: &mut Model,
    named: Option<Cause>,
    for_s: f64,
    reason: &str,
) -> Result<(), String> {
    let selected = || (model.ui.screen == Screen::Alarms).then(|| selected_cause(model)).flatten();
    let cause =
        named.or_else(selected).ok_or("no alarm is selected; name one (alarm=NAME) or go to <alarms>");
    let cause = cause.map_err(|why| model.console.keys.spelled(why))?;
    put_aside(model, &cause, for_s / 60.0, reason)
}

fn put_aside(model: &mut Model, cause: &Cause, minutes: f64, reason: &str) -> Result<(), String> {
    let alarm = model.live.run.alarms.get(cause).ok_or("there is no such alarm")?;
    if matches!(alarm.state, State::Shelved(_)) {
        return Err("it is shelved already".into());
    }
    if let Some(why) = alarm.cannot_be_shelved() {
        return Err(why.to_owned());
    }
    let longest_min = model.console.preferences.shelve_max_min;
    if !(minutes > 0.0 && minutes <= f64::from(longest_min)) {
        return Err(format!("1 to {longest_min} minutes"));
    }
    if reason.is_empty() {
        return Err("a reason is needed, such as: 15 pump noise".into());
    }
    let until_s = model.live.run.clock.t_s + 60.0 * minutes;
    model.live.run.alarms.shelve(cause, until_s, reason);
    let text = format!("shelved for {minutes} min: {}", name(cause, &model.live.run));
    model.say(Severity::Info, text);
    Ok(())
}

/// Minutes of mission time and a reason: `15 pump noise`.
fn parse_shelving(text: &str) -> Result<(f64, String), String> {
    let text = text.trim();
    let end = text.find(|letter: char| !letter.is_ascii_digit() && letter != '.').unwrap_or(text.len());
    let minutes: f64 = text[..end].parse().map_err(|_| "minutes first, such as: 15 pump noise".to_owned())?;
    let reason = text[end..].trim_start_matches(|letter: char| !letter.is_alphanumeric()).trim();
    let unit = ["min ", "m "].iter().find_map(|unit| reason.strip_prefix(unit));
    Ok((minutes, unit.unwrap_or(reason).trim().to_owned()))
}

/// Opens the actions of the selected alarm.
pub(super) fn open_actions(model: &mut Model) -> Vec<Effect> {
    let Some(cause) = selected_cause(model) else { return refuse(model, "no alarms".into()) };
    model.ui.overlay = Overlay::Remedies { cause, selected: 0 };
    Vec::new()
}

/// The action that a number stands for in the actions that are open, from 1 on; they close for it. Those that move the
/// robot ask.
///
/// # Errors
/// Why there is none to run.
pub(super) fn chosen_remedy(model: &mut Model, number: usize) -> Result<ActionId, String> {
    let Overlay::Remedies { cause, .. } = &model.ui.overlay else { return Err("no actions are open".into()) };
    let cause = cause.clone();
    let remedy = number.checked_sub(1).and_then(|index| guide(&cause).remedies.get(index));
    let remedy = remedy.ok_or_else(|| format!("there is no action {number}"))?;
    let action = remedy.action.ok_or_else(|| format!("nothing to run: {}", remedy.text))?;
    model.ui.alarm = Some(cause);
    model.ui.overlay = Overlay::None;
    Ok(action)
}

/// Shows the place of the selected alarm on the map.
pub(super) fn show_place(model: &mut Model) -> Vec<Effect> {
    let shown =
        model.selected_alarm().and_then(|alarm| Some((alarm.place?, name(&alarm.cause, &model.live.run))));
    match shown {
        Some((at, what)) => place::show(model, at, &what),
        None => refuse(model, "this alarm has no place on the map".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minutes_and_a_reason_are_taken_however_they_are_separated() {
        for text in ["15 pump noise", " 15m pump noise", "15 min pump noise ", "15,pump noise"] {
            assert_eq!(parse_shelving(text), Ok((15.0, "pump noise".to_owned())), "{text}");
        }
        for text in ["", "pump", "m pump"] {
            assert!(parse_shelving(text).is_err_and(|error| error.contains("minutes first")), "{text}");
        }
        for text in ["15", "15 ", "15 ;"] {
            assert_eq!(parse_shelving(text), Ok((15.0, String::new())), "{text}");
        }
    }
}
