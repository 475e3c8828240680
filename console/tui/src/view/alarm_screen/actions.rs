//! The actions on an alarm, numbered, and the advice about it.

use crate::guide::{effect, meaning, name};
use crate::model::step::Step;
use crate::model::{Alarm, Cause, Overlay};
use crate::theme::Role;
use crate::update::remedies;
use crate::view::lists::list::{List, paragraph};
use crate::view::look::{Look, Parts};
use crate::view::{table, text};
use ratatui::text::Line;

/// The keys that run the actions while the action list is open.
const NUMBERS: [&str; remedies::MOST] =
    ["<first-action>", "<second-action>", "<third-action>", "<fourth-action>", "<fifth-action>"];
/// Rows that a list cannot use: its frame, and the three lines that always stay visible.
const FRAME: usize = 5;

/// The actions, numbered; while the list is open, the selected action is marked. The advice follows without numbers,
/// because the operator follows it without the console.
pub(super) fn lines(look: &Look, alarm: &Alarm, columns: usize) -> Vec<Line<'static>> {
    let selected = match &look.model.ui.overlay {
        Overlay::Remedies { cause, selected, .. } if *cause == alarm.cause => Some(*selected),
        _ => None,
    };
    let steps = remedies::steps(look.model, &alarm.cause);
    let numbered = steps.iter().enumerate().flat_map(|(index, step)| {
        let is_selected = selected == Some(index);
        let rows = rows(&number(look, index), role(look, step), &look.keys(&step.text), columns);
        let rows = rows.into_iter().enumerate();
        rows.map(move |(line, row)| (row, is_selected && line == 0))
    });
    let advice = advice(look, &alarm.cause).into_iter();
    let advice = advice.flat_map(|words| rows("·", Role::Text, &words, columns)).map(|row| (row, false));
    numbered.chain(advice).map(|(row, is_selected)| table::row(look, row, is_selected, columns)).collect()
}

/// The actions and the advice without a heading, each in one row; rows that are left go to the first sentences that are
/// longer.
pub(super) fn briefly(look: &Look, alarm: &Alarm, (columns, most): (usize, usize)) -> Vec<Line<'static>> {
    let steps = remedies::steps(look.model, &alarm.cause);
    let numbered = steps.iter().enumerate().map(|(index, step)| {
        rows(&format!(" {}", number(look, index)), role(look, step), &look.keys(&step.text), columns)
    });
    let advice = advice(look, &alarm.cause).into_iter();
    let all: Vec<Vec<Parts>> =
        numbered.chain(advice.map(|words| rows(" ·", Role::Text, &words, columns))).collect();
    let mut spare = most.saturating_sub(all.len());
    let fitted = all.into_iter().flat_map(|mut entry| {
        let more = entry.len().saturating_sub(1);
        if more <= spare {
            spare -= more;
        } else if let Some((_, words)) = entry.first_mut().and_then(|first| first.last_mut()) {
            words.push('…');
            entry.truncate(1);
        }
        entry
    });
    fitted.map(|row| look.line(row)).collect()
}

/// The keys that run the actions: `1-3`; `None` if there is only advice.
pub(super) fn keys(look: &Look, cause: &Cause) -> Option<String> {
    let steps = remedies::steps(look.model, cause).len();
    let first = number(look, 0);
    match steps {
        0 => None,
        1 => Some(first),
        n => Some(format!("{first}-{}", number(look, n - 1))),
    }
}

/// Advice: what the operator can do without a key of the console.
fn advice(look: &Look, cause: &Cause) -> Vec<String> {
    remedies::advice(look.model, cause).into_iter().map(|words| look.keys(words)).collect()
}

/// The actions as an overlay list, with advice, cause and effect.
pub(in crate::view) fn list(look: &Look, cause: &Cause, selected: usize, columns: u16) -> List {
    let room = usize::from(columns).saturating_sub(3);
    let steps = remedies::steps(look.model, cause);
    let text = |(index, step): (usize, &Step)| {
        let words = format!("{} {}", number(look, index), look.keys(&step.text));
        vec![(role(look, step), text::fit(&words, room))]
    };
    let chosen = steps.get(selected).map_or_else(String::new, |step| look.keys(&step.text));
    let is_cut = text::width(&chosen) + 2 > room;
    let mut below: Vec<Parts> = Vec::new();
    if is_cut {
        below.extend(paragraph(Role::Text, &chosen, room));
    }
    let advice = advice(look, cause).into_iter();
    below.extend(advice.flat_map(|words| rows("·", Role::Text, &words, room)));
    let effect =
        look.run.alarms.get(cause).map_or_else(String::new, |alarm| look.keys(&effect(alarm, look.run)));
    below.extend(paragraph(Role::Dim, &format!("{} {effect}", meaning(cause, look.run).cause), room));
    // If space is short, the last lines about the alarm are dropped, never an action.
    below.truncate(usize::from(look.model.ui.height).saturating_sub(FRAME + steps.len()));
    List {
        title: name(cause, look.run),
        note: keys(look, cause).map_or_else(|| "advice only".into(), |keys| format!("{keys} run")),
        rows: steps.iter().enumerate().map(text).collect(),
        selected,
        below,
        ..List::default()
    }
}

/// A sentence behind its number or mark, wrapped.
fn rows(mark: &str, role: Role, sentence: &str, columns: usize) -> Vec<Parts> {
    let width = text::width(mark) + 1;
    let wrapped = text::wrap(sentence, columns.saturating_sub(width + 1));
    let front = |line: usize| text::column(if line == 0 { mark } else { "" }, width);
    let row = |(line, words)| vec![(Role::Key, front(line)), (role, words)];
    wrapped.into_iter().enumerate().map(row).collect()
}

fn number(look: &Look, index: usize) -> String {
    look.keys(NUMBERS.get(index).copied().unwrap_or_default())
}

/// Actions that cannot run now are dimmed.
fn role(look: &Look, step: &Step) -> Role {
    if remedies::can(look.model, &step.deed).is_ok() { Role::Text } else { Role::Dim }
}
