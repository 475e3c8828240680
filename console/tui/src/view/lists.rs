//! Lists over the screen: commands, planners, parameters, layers.

use super::{Look, text};
use crate::actions::{self, ActionId, Risk};
use crate::model::ui::{Edit, Layers};
use crate::model::{Overlay, parameter};
use crate::theme::Role;
use crate::update::offered;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::{Clear, Paragraph};
use std::ops::Range;

/// Widest list.
const WIDTH: u16 = 78;

type Row = Vec<(Role, String)>;

/// A list with something above and below it.
struct List {
    title: String,
    note: &'static str,
    above: Vec<Row>,
    rows: Vec<Row>,
    selected: usize,
    below: Vec<Row>,
}

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    // The line above the keys and the keys stay visible.
    let rows = area.height.saturating_sub(if area.height >= 10 { 3 } else { 0 });
    let columns = area.width.min(WIDTH);
    let list = match &look.model.ui.overlay {
        Overlay::Commands { help, filter, selected } => commands(look, *help, filter, *selected, columns),
        Overlay::Planners { selected } => planners(look, *selected, columns),
        Overlay::Parameters { selected, edit } => parameters(look, *selected, edit.as_ref(), columns),
        Overlay::Layers { selected } => layers(look, *selected),
        _ => return,
    };
    let wanted = list.above.len() + list.rows.len() + list.below.len() + 2;
    let height = rows.min(wanted as u16).max(3).min(area.height);
    let x = area.x + (area.width - columns) / 2;
    let y = area.y + 1.min(area.height - height);
    list.draw(look, frame, Rect { x, y, width: columns, height });
}

impl List {
    fn draw(self, look: &Look, frame: &mut Frame, area: Rect) {
        let block = look.block(Role::Focus, &self.title, self.note);
        let inner = block.inner(area);
        let room = usize::from(inner.height).saturating_sub(self.above.len());
        // The selected line is worth more than what stands below the list.
        let below = self.below.len().min(room.saturating_sub(3));
        let shown = window(self.selected, self.rows.len(), room - below);
        let mut lines: Vec<Line> = self.above.into_iter().map(|row| look.line(row)).collect();
        for (index, row) in self.rows.into_iter().enumerate() {
            if shown.contains(&index) {
                let mark = if index == self.selected { ">" } else { " " };
                let mut row = row;
                row.insert(0, (Role::Text, mark.into()));
                let line = look.line(row);
                let chosen = index == self.selected;
                lines.push(if chosen { line.patch_style(look.theme.style(Role::Selected)) } else { line });
            }
        }
        lines.extend(self.below.into_iter().take(below).map(|row| look.line(row)));
        frame.render_widget(Clear, area);
        frame.render_widget(Paragraph::new(lines).block(block), area);
    }
}

/// The part of a list that is shown: the selected line is always in it.
fn window(selected: usize, len: usize, rows: usize) -> Range<usize> {
    let first = (selected + 1).saturating_sub(rows).min(len.saturating_sub(rows));
    first..(first + rows).min(len)
}

fn commands(look: &Look, help: bool, filter: &str, selected: usize, columns: u16) -> List {
    let all = actions::listed("", look.model.ui.pane).len();
    let found = actions::listed(filter, look.model.ui.pane);
    let wide = columns >= 74;
    let about = usize::from(columns).saturating_sub(if wide { 2 + 1 + 15 + 14 + 6 } else { 2 + 1 + 14 + 6 });
    let rows = found.iter().map(|action| {
        let now = offered(look.model, action.id).is_ok();
        let role = if now { Role::Text } else { Role::Dim };
        let risk = match (now, action.risk) {
            (false, _) => "-",
            (true, Risk::Safe) => "safe",
            (true, Risk::Moves) => "MOVES",
            (true, Risk::Destroys) => "ENDS",
        };
        let name = if wide { text::column(action.name, 15) } else { String::new() };
        vec![
            (Role::Key, name),
            (role, text::column(action.about, about)),
            (Role::Key, text::column(&action.keys_text(), 14)),
            (role, risk.into()),
        ]
    });
    let below = if help { rules() } else { vec![hint(" Enter runs the line   Esc closes   - not now")] };
    List {
        title: if help { "Keys and commands here" } else { "Command" }.into(),
        note: "type to filter",
        above: vec![vec![
            (Role::Title, format!(" > {filter}_")),
            (Role::Dim, format!("   {} of {all}", found.len())),
        ]],
        rows: rows.collect(),
        selected,
        below,
    }
}

fn hint(text: &str) -> Row {
    vec![(Role::Dim, text.to_owned())]
}

/// What holds everywhere; the keys in it come from the table.
fn rules() -> Vec<Row> {
    let keys = |id: ActionId| {
        actions::ACTIONS
            .iter()
            .rfind(|action| action.id == id)
            .map(actions::Action::keys_text)
            .unwrap_or_default()
    };
    vec![
        hint(" Colour never stands alone: C W w are alarms, * is not acknowledged."),
        hint(" Nothing asks before it STOPS; all ask before they MOVE or END."),
        vec![(
            Role::Dim,
            format!(
                " {} {} select   {} runs the line   {} closes   - not now",
                keys(ActionId::Up),
                keys(ActionId::Down),
                keys(ActionId::Accept),
                crate::keys::Key::Esc,
            ),
        )],
    ]
}

fn planners(look: &Look, selected: usize, columns: u16) -> List {
    let driving = look.model.planner_id();
    let about = usize::from(columns).saturating_sub(2 + 1 + 18 + 8 + 8);
    let rows = look.model.console.planners.iter().map(|planner| {
        let drives = Some(planner.id.as_str()) == driving;
        vec![
            (Role::Title, text::column(&planner.id, 18)),
            (Role::Text, text::column(&planner.version, 8)),
            (Role::Good, text::column(if drives { "drives" } else { "" }, 8)),
            (Role::Dim, text::column(&planner.about, about)),
        ]
    });
    let room = usize::from(columns).saturating_sub(2 + 1);
    let refused = look.model.console.refused.iter().flat_map(|plugin| {
        [
            vec![(Role::Warn, text::fit(&format!(" {}  REFUSED", plugin.plugin), room))],
            vec![(Role::Text, text::fit(&format!("   {}", plugin.reason), room))],
        ]
    });
    List {
        title: "Planners".into(),
        note: "",
        above: Vec::new(),
        rows: rows.collect(),
        selected,
        below: refused.chain([hint(" Enter asks to change   Esc back   what was scanned stays")]).collect(),
    }
}

fn parameters(look: &Look, selected: usize, edit: Option<&Edit>, columns: u16) -> List {
    let Some(planner) = look.model.planner() else {
        return List {
            title: "Parameters".into(),
            note: "",
            above: Vec::new(),
            rows: Vec::new(),
            selected,
            below: vec![hint(" the planner is not known yet")],
        };
    };
    let room = usize::from(columns).saturating_sub(3);
    let rows = planner.parameters.iter().map(|info| {
        let (now, default) = (parameter::value(&look.model.planning, info), parameter::default(&info.kind));
        let changed = if now == default { " " } else { "*" };
        vec![
            (Role::Text, text::column(&info.key, 18)),
            (Role::Title, format!("{}{changed} ", text::column(&now.to_string(), 12))),
            (Role::Dim, format!("{} ", text::column(&default.to_string(), 12))),
            (Role::Dim, format!("{} ", text::column(parameter::unit(info), 8))),
            (Role::Dim, if info.live { "live" } else { "held" }.into()),
        ]
    });
    let mut below = vec![Row::new()];
    if let Some(info) = planner.parameters.get(selected) {
        let about = format!("{}. {}", info.label, info.help);
        below.extend(wrap(&about, room).into_iter().map(|line| vec![(Role::Text, format!(" {line}"))]));
        below.push(vec![(Role::Dim, text::fit(&format!(" takes {}", parameter::range(info)), room))]);
        below.extend(edit_rows(info, edit, room));
    }
    List {
        title: format!("Parameters of {} {}", planner.id, planner.version),
        note: "* changed",
        above: vec![hint(&format!(" {:<18}{:<13} {:<12} {:<8} changes", "name", "value", "default", "unit"))],
        rows: rows.collect(),
        selected,
        below,
    }
}

fn edit_rows(info: &mission::ParamInfo, edit: Option<&Edit>, room: usize) -> Vec<Row> {
    match edit {
        None => vec![hint(" Enter or e types a value   Esc back")],
        Some(Edit { text, refusal: None }) => vec![
            vec![(Role::Confirm, text::fit(&format!(" {} = {text}_ ", info.key), room))],
            hint(" Enter sends it   Esc keeps the old value"),
        ],
        Some(Edit { text, refusal: Some(why) }) => {
            let mut rows = vec![vec![(Role::Confirm, text::fit(&format!(" {} = {text}_ ", info.key), room))]];
            let why = format!("REFUSED: {why}");
            rows.extend(wrap(&why, room).into_iter().map(|line| vec![(Role::Warn, format!(" {line}"))]));
            rows
        }
    }
}

fn layers(look: &Look, selected: usize) -> List {
    let rows = Layers::NAMES.iter().enumerate().map(|(index, name)| {
        let mark = if look.model.ui.layers.is_on(index) { "[x]" } else { "[ ]" };
        vec![(Role::Text, format!("{mark} {name}"))]
    });
    List {
        title: "Layers of the map".into(),
        note: "",
        above: Vec::new(),
        rows: rows.collect(),
        selected,
        below: vec![hint(" Enter shows or hides   Esc back")],
    }
}

/// Words in lines of at most some columns.
pub(super) fn wrap(sentence: &str, columns: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in sentence.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text::width(line) + 1 + text::width(word) < columns => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_selected_line_is_always_shown() {
        for len in 0..12 {
            for rows in 1..8 {
                for selected in 0..len {
                    let shown = window(selected, len, rows);
                    assert!(shown.contains(&selected) && shown.len() == rows.min(len));
                }
            }
        }
    }

    #[test]
    fn words_are_wrapped_and_none_is_lost() {
        let lines = wrap("one planner drives at a time", 12);
        assert_eq!(lines, ["one planner", "drives at a", "time"]);
    }
}
