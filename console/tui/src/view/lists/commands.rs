//! The command line and its list; if opened as help, the list shows every key.

use super::list::{List, hint, paragraph};
use crate::actions::{Action, ActionId, find, keymap::Keymap};
use crate::model::Palette;
use crate::theme::Role;
use crate::update::{Choice, Group, choices, group, offered, values};
use crate::view::field::field;
use crate::view::look::{Look, Parts as Row};
use crate::view::map;
use crate::view::next::joined;
use crate::view::text;

/// Width of a command's keys, columns.
const KEYS: usize = 10;
/// Width of a command's name, columns: the longest name and a blank.
const NAME: usize = 18;
/// The prompt of the command line.
const PROMPT: &str = " > ";

pub(super) fn list(look: &Look, palette: &Palette, columns: u16) -> List {
    let found = choices(look.model, palette);
    let room = usize::from(columns).saturating_sub(3);
    let is_whole = palette.line.text().trim().is_empty();
    let (rows, headings, selected) = grouped(look, &found, palette.selected, (columns, is_whole));
    let (below, needed_below) = if palette.help {
        let why: Vec<Row> = why_not(look, found.get(palette.selected), room).into_iter().collect();
        let legend = legend(look, room);
        let needed = why.len() + legend.len();
        (why.into_iter().chain(legend).chain(rules(&look.model.console.keys, room)).collect(), needed)
    } else {
        (below(look, palette, found.get(palette.selected), room), 0)
    };
    let (above, cursor) = line(palette, found.len(), (is_whole, room));
    List {
        title: if palette.help { "Keys and commands" } else { "Commands" }.into(),
        note: if palette.help { "what works here" } else { "type to filter" }.into(),
        above,
        rows,
        headings,
        selected,
        below,
        needed_below,
        cursor: Some((0, cursor)),
        ..List::default()
    }
}

/// The rows of the list, those that are headings, and the row of the selected entry; each group of the whole list has a
/// heading.
fn grouped(
    look: &Look,
    found: &[Choice],
    selected: usize,
    (columns, is_whole): (u16, bool),
) -> (Vec<Row>, Vec<usize>, usize) {
    let (mut rows, mut headings, mut at, mut last) = (Vec::new(), Vec::new(), 0, None);
    for (index, choice) in found.iter().enumerate() {
        if let (Choice::Command(action), true) = (choice, is_whole) {
            let group = Some(group(look.model, action));
            if group != last {
                headings.push(rows.len());
                rows.push(vec![(Role::Title, heading(look, group))]);
                last = group;
            }
        }
        if index == selected {
            at = rows.len();
        }
        rows.push(row(look, choice, columns));
    }
    (rows, headings, at)
}

fn heading(look: &Look, group: Option<Group>) -> String {
    match group {
        Some(Group::Topic(topic)) => topic.name().into(),
        Some(Group::Here) | None => format!("This screen: {}", look.model.ui.screen.name()),
    }
}

/// The input line with its error below it, if there is one, and the column of the cursor.
fn line(palette: &Palette, found: usize, (is_whole, room): (bool, usize)) -> (Vec<Row>, usize) {
    let count = match found {
        0 => "   no match".to_owned(),
        // The title counts the whole list.
        _ if is_whole => String::new(),
        1 => "   1 match".to_owned(),
        found => format!("   {found} matches"),
    };
    let is_named = palette.line.text().trim_start().contains(' ') || palette.fault.is_some();
    let count = if is_named { String::new() } else { count };
    let shown = field(&palette.line, room.saturating_sub(text::width(PROMPT) + text::width(&count)));
    let cursor = text::width(PROMPT) + shown.cursor;
    let mut rows = vec![vec![(Role::Title, format!("{PROMPT}{}", shown.text)), (Role::Dim, count)]];
    if let Some(fault) = &palette.fault {
        let whole = palette.line.text();
        let columns = |from: usize, to: usize| text::width(whole.get(from..to).unwrap_or_default());
        let (begin, end) = (fault.at.start.max(shown.skipped), fault.at.end.max(shown.skipped));
        let indent = text::width(PROMPT) + columns(shown.skipped, begin);
        let mark =
            "^".repeat(columns(begin, end.min(whole.len())).clamp(1, room.saturating_sub(indent).max(1)));
        rows.push(vec![(Role::Warn, text::fit(&format!("{}{mark}", " ".repeat(indent)), room))]);
        rows.extend(paragraph(Role::Warn, &text::capitalized(&fault.what), room));
    }
    (rows, cursor)
}

fn row(look: &Look, choice: &Choice, columns: u16) -> Row {
    match choice {
        Choice::Command(action) => command_row(look, action, columns),
        Choice::Alias(name, line) => {
            vec![(Role::Key, text::column(name, NAME)), (Role::Text, format!("short for {line}"))]
        }
        Choice::Value(value) => vec![(Role::Key, value.clone())],
    }
}

/// The row of a command: name and description if they fit, otherwise the description, otherwise the name.
fn command_row(look: &Look, action: &Action, columns: u16) -> Row {
    let (name, about) = match columns {
        74.. => (NAME, usize::from(columns) - 2 - 1 - NAME - KEYS - 6),
        58.. => (0, usize::from(columns) - 2 - 1 - KEYS - 6),
        _ => (NAME, 0),
    };
    let now = offered(look.model, action.id).is_ok();
    let role = if now { Role::Text } else { Role::Dim };
    let risk = if now { action.risk.word() } else { "-" };
    vec![
        (Role::Key, text::column(action.name, name)),
        (role, text::column(&about_of(look, action), about)),
        (Role::Key, text::column(&fitting_keys(&look.model.console.keys, action), KEYS)),
        (role, risk.into()),
    ]
}

/// The first keys of an action that fit whole, with a blank behind them.
fn fitting_keys(keys: &Keymap, action: &Action) -> String {
    let mut texts = keys.texts(action);
    while texts.len() > 1 && text::width(&texts.join(" ")) >= KEYS {
        texts.pop();
    }
    texts.join(" ")
}

/// What an action does; for Enter, on the screen that is shown.
fn about_of(look: &Look, action: &Action) -> String {
    let opens = (look.model.ui.screen.row().opens)(look.model).filter(|_| action.id == ActionId::Accept);
    opens.map_or_else(|| look.keys(action.about), |word| format!("Open the selected line: {word}"))
}

/// The reason why the selected command is not possible now.
fn why_not(look: &Look, selected: Option<&Choice>, room: usize) -> Option<Row> {
    let Some(Choice::Command(action)) = selected else { return None };
    let why = offered(look.model, action.id).err()?;
    Some(vec![(Role::Warn, text::clauses(&format!(" Not now: {why}."), room))])
}

/// The usage of the selected command, and hints about keys, as far as they fit.
fn below(look: &Look, palette: &Palette, selected: Option<&Choice>, room: usize) -> Vec<Row> {
    // While values are typed, the usage names those that are missing.
    let typed = palette.line.text().trim_start();
    let usage = match selected {
        Some(Choice::Command(action)) => Some(*action),
        _ => typed.split_once(' ').and_then(|(name, _)| find::named(name)),
    };
    let usage = usage.filter(|action| !action.args.is_empty()).map(|action| format!("{}.", action.usage()));
    let refused = why_not(look, selected, room);
    let values = match selected {
        Some(Choice::Command(action)) => values(look.model, action),
        _ => Vec::new(),
    };
    let listed =
        (!values.is_empty()).then(|| hint(&format!(" {}", listing(&values, room.saturating_sub(1)))));
    let keys = [
        "<accept>: run.",
        "<cancel>: close.",
        "<complete>: complete.",
        "-: not available.",
        "<up>: earlier lines.",
    ]
    .map(|clause| look.keys(clause));
    let clauses: Vec<String> = usage.into_iter().chain(keys).collect();
    refused.into_iter().chain(listed).chain([hint(&format!(" {}", joined(&clauses, room)))]).collect()
}

/// As many values as fit, and the number of values left out.
fn listing(values: &[String], room: usize) -> String {
    let mut line = String::new();
    for (index, value) in values.iter().enumerate() {
        let more = values.len() - index;
        let needed = text::width(&line) + text::width(value) + 2 + more.to_string().len();
        if needed > room && index > 0 {
            return format!("{line}+{more}");
        }
        line.push_str(value);
        line.push_str("  ");
    }
    line.trim_end().to_owned()
}

/// The legend of the map.
fn legend(look: &Look, room: usize) -> Vec<Row> {
    let indented = |mut line: Row| {
        line.insert(0, (Role::Dim, " ".into()));
        line
    };
    map::legend(look, room.saturating_sub(1)).into_iter().map(indented).collect()
}

/// General rules; the keys that they mention come from the table.
fn rules(keys: &Keymap, columns: usize) -> Vec<Row> {
    let of = |id: ActionId| {
        let action = crate::actions::ACTIONS.iter().rfind(|action| action.id == id);
        action.map(|action| keys.text(action)).unwrap_or_default()
    };
    let (up, down, accept) = (of(ActionId::Up), of(ActionId::Down), of(ActionId::Accept));
    let lists = format!("{up} {down}: select, {accept}: run, <cancel>: close, -: not available.");
    let few = if columns < 60 { 1 } else { 4 };
    [
        lists.as_str(),
        "HOLD never asks first; commands marked ASKS, MOVES or ENDS do.",
        "<hold>: HOLD; once text is typed, <interrupt>: HOLD.",
        "Alarms: unack: not acknowledged.",
    ]
    .into_iter()
    .take(few)
    .flat_map(|rule| paragraph(Role::Dim, &keys.spelled(rule), columns))
    .collect()
}
