//! The plugins screen: the files found, with their states and planners, and the reasons for refused
//! files.

use super::look::{Look, Parts, fill};
use super::scroll::{self, Extent};
use super::{table, text};
use crate::model::plugins::{Plugin, PluginState, plugins};
use crate::model::ui::Arrangement;
use crate::model::{Pane, parameter};
use crate::theme::Role;
use crate::update::Rows;
use mission::{ParamInfo, PlannerInfo, Sandbox};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};

/// Width of the key of a parameter, and of its allowed values, columns.
const KEY: usize = 20;
const ALLOWED: usize = 26;
/// Minimum width of a table of parameters, columns.
const LEAST: usize = 60;
/// The number of digits shown of a hash.
const HASH: usize = 12;
/// Width of a state and of the version of the interface, and the least width for names of planners, columns.
const STATE: usize = 9;
const ABI: usize = 5;
const NAMES: usize = 24;
/// Rows of the list of files beside those of the files: the frame, the headings and a blank.
const FRAME: u16 = 4;
/// Width of the last changes, columns.
const CHANGES: u16 = 50;

/// The areas of the files, of the details of the selected one, and of the last changes. A small screen shows one of
/// them at a time.
fn divided(look: &Look, area: Rect, files: usize) -> [Option<Rect>; 3] {
    let is_detail = look.model.ui.focus() == Pane::Detail;
    match look.model.ui.arrangement() {
        Arrangement::Paged if is_detail => return [None, Some(area), None],
        Arrangement::Paged | Arrangement::Strip => return [Some(area), None, None],
        Arrangement::Narrow | Arrangement::Wide => {}
    }
    let rows = (files as u16).saturating_add(FRAME).min(area.height / 2).max(5);
    let [above, below] = Layout::vertical([Constraint::Length(rows), Constraint::Fill(1)]).areas(area);
    let beside = if look.model.ui.arrangement() == Arrangement::Wide { CHANGES } else { 0 };
    let [left, right] = Layout::horizontal([Constraint::Fill(1), Constraint::Length(beside)]).areas(below);
    [Some(above), Some(left), (beside > 0).then_some(right)]
}

pub(crate) fn draw(look: &Look, frame: &mut Frame, area: Rect, _: Arrangement) {
    let found = plugins(&look.model.console, look.run);
    let selected = look.model.ui.plugin.min(found.len().saturating_sub(1));
    let [above, left, right] = divided(look, area, found.len());
    if let Some(area) = above {
        files(look, frame, area, (&found, selected));
    }
    let Some(plugin) = found.get(selected) else { return };
    if let Some(area) = left {
        let lines = about(look, area, plugin).into_iter().map(|parts| look.line(parts)).collect();
        scroll::draw(look, frame, area, (plugin.file, ""), lines);
    }
    if let Some(area) = right {
        changes(look, frame, area);
    }
}

/// How much of the details of the selected file is visible.
pub(crate) fn extent(look: &Look, area: Rect) -> Option<Extent> {
    let found = plugins(&look.model.console, look.run);
    let plugin = found.get(look.model.ui.plugin.min(found.len().saturating_sub(1)))?;
    // A small screen shows the details when the operator turns to them.
    let area = divided(look, area, found.len())[1].unwrap_or(area);
    Some(scroll::extent(area, about(look, area, plugin).len()))
}

fn files(look: &Look, frame: &mut Frame, area: Rect, (found, selected): (&[Plugin<'_>], usize)) {
    let planners = text::counted(look.model.console.planners.len(), "planner");
    let title = format!("Plugins  {planners} in {}", text::counted(found.len(), "file"));
    let block = look.pane(Pane::List, &title, &look.keys("<reload> reload"));
    let inner = block.inner(area);
    let columns = Columns::of(found, usize::from(inner.width));
    let rows: Vec<Parts> = found.iter().map(|plugin| columns.row(plugin)).collect();
    let height = usize::from(inner.height).saturating_sub(1);
    let place = Rect { y: inner.y + 1, height: height as u16, ..inner };
    let shown = table::window(selected, found.len(), height);
    table::place(look, place, Rows::Plugins, shown.clone());
    let mut lines = vec![look.line([(Role::Dim, columns.head())])];
    lines.extend(table::rows(look, rows, Some(selected), (usize::from(inner.width), height)));
    if found.is_empty() {
        lines = vec![look.line([(
            Role::Warn,
            " No plugins found; `tankops planners` shows where tankops looks for them.".into(),
        )])];
    }
    fill(frame, area, block, lines);
    table::bar(look, frame, place, &shown, found.len());
}

/// The widths of the columns of the files; 0 for a column that does not fit.
#[derive(Clone, Copy)]
struct Columns {
    name: usize,
    hash: usize,
    /// What is left for the names of the planners.
    rest: usize,
}

impl Columns {
    /// A name may take half of the width; the hash is left out first.
    fn of(found: &[Plugin<'_>], room: usize) -> Self {
        let widest = found.iter().map(|plugin| text::width(plugin.file)).max().unwrap_or(0).max(4) + 1;
        let name = widest.min(room / 2);
        let left = room.saturating_sub(1 + name + STATE + ABI);
        let hash = if left >= HASH + 2 + NAMES { HASH + 2 } else { 0 };
        Self { name, hash, rest: left.saturating_sub(hash) }
    }

    fn head(self) -> String {
        let hash = if self.hash > 0 { "sha256" } else { "" };
        [
            format!(" {}", text::column("file", self.name)),
            text::column("state", STATE),
            text::column("ABI", ABI),
            text::column(hash, self.hash),
            "planners".to_owned(),
        ]
        .concat()
    }

    fn row(self, plugin: &Plugin<'_>) -> Parts {
        let mut parts = vec![
            (Role::Text, text::column(&text::fit(plugin.file, self.name - 1), self.name)),
            (role(plugin.state), text::column(plugin.state.word(), STATE)),
        ];
        let words = match plugin.planners.first() {
            None => text::clauses(plugin.reason, ABI + self.hash + self.rest),
            Some(first) => {
                let ids: Vec<&str> = plugin.planners.iter().map(|info| info.id.as_str()).collect();
                let hash = first.sha256.get(..HASH).unwrap_or(&first.sha256);
                let hash = if self.hash > 0 { text::column(hash, self.hash) } else { String::new() };
                format!("{}{hash}{}", text::column(&first.abi, ABI), text::names(&ids, self.rest))
            }
        };
        parts.push((Role::Text, words));
        parts
    }
}

fn role(state: PluginState) -> Role {
    match state {
        PluginState::Ready => Role::Text,
        PluginState::Active => Role::Good,
        PluginState::Changed => Role::Watch,
        PluginState::Refused => Role::Warn,
    }
}

/// All about a file and its planners. A large screen has room for a line about each parameter, or for two parameters in
/// a line.
fn about(look: &Look, area: Rect, plugin: &Plugin<'_>) -> Vec<Parts> {
    let (columns, height) =
        (usize::from(area.width).saturating_sub(3), usize::from(area.height).saturating_sub(2));
    let most = if columns >= 2 * LEAST { 2 } else { 1 };
    let in_tables = |tables: usize| about_in(look, plugin, (tables, columns));
    (1..most).map(in_tables).find(|rows| rows.len() <= height).unwrap_or_else(|| in_tables(most))
}

fn about_in(look: &Look, plugin: &Plugin<'_>, (tables, columns): (usize, usize)) -> Vec<Parts> {
    let wrapped = |role: Role, words: &str| -> Vec<Parts> {
        text::wrap(words, columns).into_iter().map(|line| vec![(role, format!(" {line}"))]).collect()
    };
    let mut rows = wrapped(role(plugin.state), &look.keys(state_words(plugin.state)));
    if !plugin.reason.is_empty() {
        rows.extend(wrapped(Role::Warn, plugin.reason));
    }
    for info in &plugin.planners {
        rows.push(vec![
            (Role::Title, format!(" {} {}", info.id, info.version)),
            (Role::Dim, format!("  {}", abilities(info))),
        ]);
        if let Some(sandbox) = &info.sandbox {
            let role = if *sandbox == Sandbox::Full { Role::Dim } else { Role::Warn };
            rows.extend(wrapped(role, &format!("sandbox: {sandbox}")));
        }
        rows.extend(wrapped(Role::Text, &info.about));
        if info.parameters.is_empty() {
            rows.extend(wrapped(Role::Dim, "no parameters"));
        }
        rows.extend(parameter_rows(&info.parameters, tables, columns));
    }
    rows
}

fn state_words(state: PluginState) -> &'static str {
    match state {
        PluginState::Ready => "ready",
        PluginState::Active => "active: one of its planners is driving",
        PluginState::Changed => "CHANGED on disk; <planner>: choose the planner again to use the new build",
        PluginState::Refused => "REFUSED",
    }
}

fn abilities(info: &PlannerInfo) -> String {
    let abilities = [(info.covers, "coverage"), (info.snapshots, "keeps its state")];
    abilities.iter().filter(|(has, _)| *has).map(|(_, word)| *word).collect::<Vec<_>>().join(", ")
}

/// The parameters in `tables` columns, to be read downwards.
fn parameter_rows(infos: &[ParamInfo], tables: usize, columns: usize) -> Vec<Parts> {
    let height = infos.len().div_ceil(tables);
    let width = columns / tables;
    let row = |line: usize| -> Parts {
        let listed = infos.iter().skip(line).step_by(height.max(1));
        listed.flat_map(|info| parameter_row(info, width)).collect()
    };
    (0..height).map(row).collect()
}

/// A parameter: its key, its allowed values, and its meaning if there is room.
fn parameter_row(info: &ParamInfo, columns: usize) -> Parts {
    let key = text::column(&info.key, KEY);
    let allowed = text::column(&parameter::range(info), ALLOWED);
    let room = columns.saturating_sub(KEY + ALLOWED + 5);
    let label = text::wording([info.label.clone(), String::new()], room);
    let room = columns.saturating_sub(KEY + 3);
    let allowed = text::column(&text::fit(&format!(" {allowed}  {label}"), room), room);
    vec![(Role::Text, format!("   {key}")), (Role::Dim, allowed)]
}

fn changes(look: &Look, frame: &mut Frame, area: Rect) {
    let block = look.block(Role::Border, "Last reload", "");
    let columns = usize::from(block.inner(area).width).saturating_sub(1);
    let words = match &look.model.console.reloaded {
        None => vec!["Not reloaded since the console was started.".to_owned()],
        Some(changes) if changes.is_empty() => vec!["Nothing has changed.".to_owned()],
        Some(changes) => changes.clone(),
    };
    let lines = words.iter().flat_map(|words| text::wrap(words, columns));
    fill(frame, area, block, lines.map(|line| look.line([(Role::Text, format!(" {line}"))])).collect());
}
