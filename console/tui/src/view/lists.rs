//! Lists over the screen: commands, planners, parameters, layers.

use super::Look;
use super::text::{self, wrap};
use crate::actions::{self, ActionId, Risk};
use crate::model::ui::{Edit, MapLayer};
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
/// Columns of the keys of a command.
const KEYS: usize = 10;

type Row = Vec<(Role, String)>;

/// A list with something above and below it.
struct List {
    title: String,
    note: &'static str,
    above: Vec<Row>,
    rows: Vec<Row>,
    selected: usize,
    below: Vec<Row>,
    /// How many of the lines below are worth more than the list's last lines.
    needed_below: usize,
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
        // The selected line is worth more than anything below the list.
        let below =
            self.below.len().min(room.saturating_sub(3).max(self.needed_below)).min(room.saturating_sub(1));
        let shown = window(self.selected, self.rows.len(), room - below);
        let mut lines: Vec<Line> = self.above.into_iter().map(|row| look.line(row)).collect();
        for (index, row) in self.rows.into_iter().enumerate() {
            if shown.contains(&index) {
                lines.push(selectable(look, row, index == self.selected, usize::from(inner.width)));
            }
        }
        lines.extend(self.below.into_iter().take(below).map(|row| look.line(row)));
        frame.render_widget(Clear, area);
        frame.render_widget(Paragraph::new(lines).block(block), area);
    }
}

fn selectable(look: &Look, mut row: Row, selected: bool, columns: usize) -> Line<'static> {
    row.insert(0, (Role::Text, if selected { ">" } else { " " }.into()));
    if !selected {
        return look.line(row);
    }
    let used: usize = row.iter().map(|(_, text)| text::width(text)).sum();
    row.push((Role::Text, " ".repeat(columns.saturating_sub(used))));
    let mut line = look.line(row);
    for span in &mut line.spans {
        span.style = span.style.patch(look.theme.style(Role::Selected));
    }
    line
}

/// The part of a list that is shown: the selected line is always in it.
fn window(selected: usize, len: usize, rows: usize) -> Range<usize> {
    let first = (selected + 1).saturating_sub(rows).min(len.saturating_sub(rows));
    first..(first + rows).min(len)
}

fn commands(look: &Look, help: bool, filter: &str, selected: usize, columns: u16) -> List {
    let all = actions::listed("", look.model.ui.pane).len();
    let found = actions::listed(filter, look.model.ui.pane);
    // Name and description where there is room, else the description, else the name.
    let (name, about) = match columns {
        74.. => (16, usize::from(columns) - 2 - 1 - 16 - KEYS - 6),
        58.. => (0, usize::from(columns) - 2 - 1 - KEYS - 6),
        _ => (16, 0),
    };
    let rows = found.iter().map(|action| {
        let now = offered(look.model, action.id).is_ok();
        let role = if now { Role::Text } else { Role::Dim };
        let risk = match (now, action.risk) {
            (false, _) => "-",
            (true, Risk::Safe) => "safe",
            (true, Risk::Moves) => "MOVES",
            (true, Risk::Destroys) => "ENDS",
        };
        vec![
            (Role::Key, text::column(action.name, name)),
            (role, text::column(action.about, about)),
            (Role::Key, text::column(&action.keys_text(), KEYS)),
            (role, risk.into()),
        ]
    });
    let below = if help {
        rules(usize::from(columns).saturating_sub(3))
    } else {
        vec![hint(" Enter: run   Esc: close   -: not available")]
    };
    List {
        title: if help { "Keys and commands" } else { "Command" }.into(),
        note: "type to filter",
        above: vec![vec![
            (Role::Title, format!(" > {filter}_")),
            (Role::Dim, format!("   {} of {all}", found.len())),
        ]],
        rows: rows.collect(),
        selected,
        below,
        needed_below: 0,
    }
}

fn hint(text: &str) -> Row {
    vec![(Role::Dim, text.to_owned())]
}

/// What holds everywhere; the keys in it come from the table.
fn rules(columns: usize) -> Vec<Row> {
    let keys = |id: ActionId| {
        actions::ACTIONS
            .iter()
            .rfind(|action| action.id == id)
            .map(actions::Action::keys_text)
            .unwrap_or_default()
    };
    let (up, down, accept) = (keys(ActionId::Up), keys(ActionId::Down), keys(ActionId::Accept));
    let lists = format!("{up} {down}: select, {accept}: run, Esc: close, -: not available now.");
    [
        lists.as_str(),
        "Stopping never asks first; what MOVES the robot or ENDS the mission does.",
        "Alarms: C critical, W warning, w watch, * unacknowledged.",
    ]
    .into_iter()
    .flat_map(|rule| wrap(rule, columns))
    .map(|line| hint(&format!(" {line}")))
    .collect()
}

fn planners(look: &Look, selected: usize, columns: u16) -> List {
    let driving = look.model.planner_id();
    let rows = look.model.console.planners.iter().map(|planner| {
        let drives = Some(planner.id.as_str()) == driving;
        vec![
            (Role::Title, text::column(&planner.id, 18)),
            (Role::Text, text::column(&planner.version, 8)),
            match look.model.cannot_fly(planner) {
                _ if drives => (Role::Good, "active".into()),
                Some(why) => (Role::Dim, why.into()),
                None => (Role::Good, String::new()),
            },
        ]
    });
    let room = usize::from(columns).saturating_sub(2 + 1);
    let about =
        look.model.console.planners.get(selected).map(|planner| planner.about.as_str()).unwrap_or_default();
    let about = wrap(about, room).into_iter().map(|line| vec![(Role::Text, format!(" {line}"))]);
    let refused = look.model.console.refused.iter().flat_map(|plugin| {
        let name = vec![(Role::Warn, text::fit(&format!(" REFUSED {}", plugin.plugin), room))];
        let why = wrap(&plugin.reason, room.saturating_sub(2));
        [name].into_iter().chain(why.into_iter().map(|line| vec![(Role::Text, format!("   {line}"))]))
    });
    List {
        title: "Planners".into(),
        note: "",
        above: Vec::new(),
        rows: rows.collect(),
        selected,
        below: [Row::new()]
            .into_iter()
            .chain(about)
            .chain(refused)
            .chain([hint(" Enter: change planner (asks first); scanned floor is kept.")])
            .collect(),
        needed_below: 0,
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
            needed_below: 1,
        };
    };
    let room = usize::from(columns).saturating_sub(3);
    let widths = Columns::of(columns);
    let rows = planner.parameters.iter().map(|info| {
        let (now, default) = (parameter::value(&look.model.planning, info), parameter::default(&info.kind));
        let changed = if now == default { " " } else { "*" };
        vec![
            (Role::Text, text::column(&info.key, widths.name)),
            (Role::Title, format!("{}{changed} ", text::column(&now.to_string(), widths.value))),
            (Role::Dim, text::column(&default.to_string(), widths.default)),
            (Role::Dim, text::column(parameter::unit(info), widths.unit)),
            (Role::Dim, if info.live { "any time" } else { "held" }.into()),
        ]
    });
    let head = [
        text::column("name", widths.name),
        text::column("value", widths.value + 2),
        text::column("default", widths.default),
        text::column("unit", widths.unit),
        "changes".into(),
    ];
    let mut below = Vec::new();
    let mut needed_below = 0;
    if let Some(info) = planner.parameters.get(selected) {
        below.extend(edit_rows(info, edit, room));
        needed_below = below.len();
        // A refusal names the range already.
        if edit.is_none_or(|edit| edit.refusal.is_none()) {
            let takes = format!(" {} takes {}", info.key, parameter::range(info));
            below.push(vec![(Role::Dim, text::fit(&takes, room))]);
        }
        let about = format!("{}. {}", info.label, info.help);
        below.extend(wrap(&about, room).into_iter().map(|line| vec![(Role::Text, format!(" {line}"))]));
    }
    List {
        title: format!("Parameters of {} {}", planner.id, planner.version),
        note: "* changed",
        above: vec![hint(&format!(" {}", head.concat()))],
        rows: rows.collect(),
        selected,
        below,
        needed_below,
    }
}

/// Widths of the columns of the parameter list; a narrow one goes without defaults.
struct Columns {
    name: usize,
    value: usize,
    default: usize,
    unit: usize,
}

impl Columns {
    fn of(columns: u16) -> Self {
        match columns {
            74.. => Self { name: 20, value: 13, default: 15, unit: 10 },
            56.. => Self { name: 16, value: 9, default: 11, unit: 8 },
            _ => Self { name: 14, value: 9, default: 0, unit: 8 },
        }
    }
}

/// The value being typed, and why it was refused.
fn edit_rows(info: &mission::ParamInfo, edit: Option<&Edit>, room: usize) -> Vec<Row> {
    let Some(edit) = edit else { return Vec::new() };
    let typed = vec![(Role::Confirm, text::fit(&format!(" {} = {}_ ", info.key, edit.text), room))];
    let why = edit.refusal.iter().flat_map(|why| wrap(&format!("REFUSED: {why}"), room));
    [typed].into_iter().chain(why.map(|line| vec![(Role::Warn, format!(" {line}"))])).collect()
}

fn layers(look: &Look, selected: usize) -> List {
    let rows = MapLayer::ALL.into_iter().map(|layer| {
        let mark = if look.model.ui.layers.shows(layer) { "[x]" } else { "[ ]" };
        vec![(Role::Text, format!("{mark} {}", layer.name()))]
    });
    List {
        title: "Layers of the map".into(),
        note: "",
        above: Vec::new(),
        rows: rows.collect(),
        selected,
        below: Vec::new(),
        needed_below: 0,
    }
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
}
