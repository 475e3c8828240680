//! The operator's actions on alarms.

use super::message::Effect;
use super::offer::{accepted, demand, on_screen, refuse};
use super::{place, remedies};
use crate::guide::name;
use crate::model::alarms::State;
use crate::model::ui::Shelving;
use crate::model::{Alarm, Cause, LineEdit, Model, Overlay, Screen};
use crate::view::text;
use mission::{Note, Noted, Order, Severity};

fn selected_cause(model: &Model) -> Option<Cause> {
    model.selected_alarm().map(|alarm| alarm.cause.clone())
}

/// Moves the selection down by `by` alarms.
pub(crate) fn select(model: &mut Model, by: isize) {
    let table = model.live.run.alarms.table();
    let at = model.selected_alarm().and_then(|here| table.iter().position(|alarm| alarm.cause == here.cause));
    let next = at.unwrap_or(0).saturating_add_signed(by).min(table.len().saturating_sub(1));
    model.ui.alarm = table.get(next).map(|alarm| alarm.cause.clone());
}

/// Checks that the alarm to which a command applies can be acknowledged.
///
/// # Errors
/// Returns the reason why not, as a sentence.
pub(crate) fn can_acknowledge(model: &Model) -> Result<(), String> {
    can_acknowledge_all(model)?;
    demand(to_acknowledge(model).is_some(), "the selected alarm needs no acknowledgement; select another")
}

/// Checks that an alarm awaits acknowledgement.
pub(crate) fn can_acknowledge_all(model: &Model) -> Result<(), String> {
    demand(model.live.run.alarms.open().any(Alarm::is_unacknowledged), "no unacknowledged alarms")
}

/// Checks that the selected alarm can be shelved or unshelved.
pub(crate) fn can_shelve(model: &Model) -> Result<(), String> {
    on_screen(model, Screen::Alarms)?;
    let alarm = model.selected_alarm().ok_or("no alarm is selected")?;
    alarm.cannot_be_shelved().map_or(Ok(()), |why| Err(why.to_owned()))
}

/// The alarm to acknowledge: on the alarm screen only the selected one, elsewhere the most severe one.
fn to_acknowledge(model: &Model) -> Option<&Alarm> {
    if model.ui.screen == Screen::Alarms {
        return model.selected_alarm().filter(|alarm| alarm.is_unacknowledged());
    }
    model.live.run.alarms.worst_unacknowledged()
}

/// Acknowledges the alarm shown on the screen.
pub(crate) fn acknowledge(model: &mut Model) -> Vec<Effect> {
    let Some(alarm) = to_acknowledge(model) else { return Vec::new() };
    let (text, noted) = (alarm.text.clone(), acknowledged(alarm));
    model.say(Severity::Info, format!("acknowledged: {text}"));
    note(model, noted)
}

/// Acknowledges every alarm.
pub(crate) fn acknowledge_all(model: &mut Model) -> Vec<Effect> {
    let waiting = model.live.run.alarms.list().iter().filter(|alarm| alarm.is_unacknowledged());
    let all: Vec<Noted> = waiting.map(acknowledged).collect();
    model.say(Severity::Info, format!("{} acknowledged", text::counted(all.len(), "alarm")));
    all.into_iter().flat_map(|noted| note(model, noted)).collect()
}

fn acknowledged(alarm: &Alarm) -> Noted {
    Noted::Acknowledged { alarm: alarm.cause.key(), text: alarm.text.clone() }
}

/// Has the mission record what the operator did; the action takes effect when it arrives through the journal. After
/// the mission nothing is recorded, and the action takes effect directly.
pub(super) fn note(model: &mut Model, what: Noted) -> Vec<Effect> {
    let order = Order::Note(Note { what, by: model.console.preferences.operator.clone() });
    if model.live.run.about.is_some() && accepted(model, &order).is_ok() {
        return vec![Effect::Order(order)];
    }
    if let Order::Note(note) = &order {
        let t_s = model.live.run.clock.t_s;
        model.live.run.alarms.take(note, t_s);
    }
    Vec::new()
}

/// Asks for how long and why the selected alarm is to be shelved; unshelves a shelved alarm.
pub(crate) fn shelve(model: &mut Model) -> Vec<Effect> {
    let Some(alarm) = model.selected_alarm() else { return Vec::new() };
    let (cause, text) = (alarm.cause.clone(), alarm.text.clone());
    if !matches!(alarm.state, State::Shelved(_)) {
        model.ui.overlay = Overlay::Shelve(Shelving { cause, line: LineEdit::default(), refusal: None });
        return Vec::new();
    }
    model.say(Severity::Info, format!("unshelved: {}", name(&cause, &model.live.run)));
    note(model, Noted::Unshelved { alarm: cause.key(), text })
}

/// Opens the input line with the reason why the selected alarm cannot be shelved, so that the minutes that the operator
/// types next, and Enter, do not reach keys that move the robot. Returns whether an alarm is selected.
pub(super) fn refuse_on_line(model: &mut Model, why: &str) -> bool {
    let is_shown = model.ui.screen == Screen::Alarms && model.ui.overlay == Overlay::None;
    let Some(alarm) = model.selected_alarm().filter(|_| is_shown) else { return false };
    let (cause, refusal) = (alarm.cause.clone(), Some(why.to_owned()));
    model.ui.overlay = Overlay::Shelve(Shelving { cause, line: LineEdit::default(), refusal });
    true
}

/// Shelves an alarm as typed, or shows why the input was refused.
pub(super) fn take_shelving(model: &mut Model, shelving: Shelving) -> Vec<Effect> {
    let typed = parse_shelving(shelving.line.text());
    match typed.and_then(|(minutes, reason)| put_aside(model, &shelving.cause, minutes, &reason)) {
        Ok(effects) => {
            model.ui.overlay = Overlay::None;
            effects
        }
        Err(why) => {
            model.ui.overlay = Overlay::Shelve(Shelving { refusal: Some(why), ..shelving });
            Vec::new()
        }
    }
}

/// Shelves the named or selected alarm for the given number of seconds.
///
/// # Errors
/// Returns the reason why not, and how to correct the command.
pub(super) fn shelve_for(
    model: &mut Model,
    named: Option<Cause>,
    for_s: f64,
    reason: &str,
) -> Result<Vec<Effect>, String> {
    let selected = || (model.ui.screen == Screen::Alarms).then(|| selected_cause(model)).flatten();
    let cause =
        named.or_else(selected).ok_or("no alarm is selected; name one (alarm=NAME) or go to <alarms>");
    let cause = cause.map_err(|why| model.console.keys.spelled(why))?;
    put_aside(model, &cause, for_s / 60.0, reason)
}

fn put_aside(model: &mut Model, cause: &Cause, minutes: f64, reason: &str) -> Result<Vec<Effect>, String> {
    let alarm = model.live.run.alarms.get(cause).ok_or("no such alarm")?;
    if matches!(alarm.state, State::Shelved(_)) {
        return Err("the alarm is already shelved".into());
    }
    if let Some(why) = alarm.cannot_be_shelved() {
        return Err(why.to_owned());
    }
    let longest_min = model.console.preferences.shelve_max_min;
    if !(minutes > 0.0 && minutes <= f64::from(longest_min)) {
        return Err(format!("must be 1 to {longest_min} minutes"));
    }
    if reason.is_empty() {
        return Err("reason missing; for example: 15 pump noise".into());
    }
    let (text, reason) = (alarm.text.clone(), reason.to_owned());
    let said = format!("shelved for {minutes} min: {}", name(cause, &model.live.run));
    model.say(Severity::Info, said);
    Ok(note(model, Noted::Shelved { alarm: cause.key(), text, for_s: 60.0 * minutes, reason }))
}

/// Parses minutes of mission time and a reason: `15 pump noise`.
fn parse_shelving(text: &str) -> Result<(f64, String), String> {
    let text = text.trim();
    let end = text.find(|letter: char| !letter.is_ascii_digit() && letter != '.').unwrap_or(text.len());
    let minutes: f64 =
        text[..end].parse().map_err(|_| "minutes missing; for example: 15 pump noise".to_owned())?;
    let reason = text[end..].trim_start_matches(|letter: char| !letter.is_alphanumeric()).trim();
    let unit = ["min ", "m "].iter().find_map(|unit| reason.strip_prefix(unit));
    Ok((minutes, unit.unwrap_or(reason).trim().to_owned()))
}

/// Opens the action list of the selected alarm. The alarm stays selected, whatever alarms come before it in the table
/// from then on.
pub(crate) fn open_actions(model: &mut Model) -> Vec<Effect> {
    let Some(cause) = selected_cause(model) else { return refuse(model, "no alarms".into()) };
    model.ui.alarm = Some(cause.clone());
    let steps = remedies::steps_now(model, &cause);
    model.ui.overlay = Overlay::Remedies { cause, steps, selected: 0 };
    Vec::new()
}

/// Shows the position of the selected alarm on the map; of a biased station, the floor that is in doubt because of it.
pub(crate) fn show_place(model: &mut Model) -> Vec<Effect> {
    let live = &model.live;
    let of_alarm = |alarm: &Alarm| {
        let name = name(&alarm.cause, &live.run);
        let in_doubt = match &alarm.cause {
            Cause::Bias(station) => live.place_in_doubt(*station),
            _ => None,
        };
        match in_doubt {
            Some(at) => Some((at, format!("floor in doubt, {name}"))),
            None => Some((alarm.place?, name)),
        }
    };
    match model.selected_alarm().and_then(of_alarm) {
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
            assert!(parse_shelving(text).is_err_and(|error| error.contains("minutes missing")), "{text}");
        }
        for text in ["15", "15 ", "15 ;"] {
            assert_eq!(parse_shelving(text), Ok((15.0, String::new())), "{text}");
        }
    }
}
