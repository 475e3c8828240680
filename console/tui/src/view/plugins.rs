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
/// Width of the default of a parameter, columns.
const DEFAULT: usize = 18;
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
const CHANGES: u16 = 36;

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

/// How much is said about a file.
#[derive(Clone, Copy)]
struct Form {
    /// The parameters in a line.
    tables: usize,
    /// Whether the digest is written out and each parameter is explained.
    is_full: bool,
}

/// All about a file and its planners. A large screen explains each parameter; with less room, each one has a line, or two
/// share one.
fn about(look: &Look, area: Rect, plugin: &Plugin<'_>) -> Vec<Parts> {
    let (columns, height) =
        (usize::from(area.width).saturating_sub(3), usize::from(area.height).saturating_sub(2));
    let is_wide = columns >= 2 * LEAST;
    let in_form = |form: Form| about_in(look, plugin, (form, columns));
    let full = Form { tables: 1, is_full: true };
    let lines = Form { is_full: false, ..full };
    let last = Form { tables: if is_wide { 2 } else { 1 }, ..lines };
    let longer = [full, lines].into_iter().filter(|form| is_wide || !form.is_full).map(in_form);
    longer.into_iter().find(|rows| rows.len() <= height).unwrap_or_else(|| in_form(last))
}

fn about_in(look: &Look, plugin: &Plugin<'_>, (form, columns): (Form, usize)) -> Vec<Parts> {
    let wrapped = |role: Role, words: &str| -> Vec<Parts> {
        text::wrap(words, columns).into_iter().map(|line| vec![(role, format!(" {line}"))]).collect()
    };
    let mut rows = wrapped(role(plugin.state), &look.keys(state_words(look, plugin.state)));
    if !plugin.reason.is_empty() {
        rows.extend(wrapped(Role::Warn, plugin.reason));
    }
    for info in &plugin.planners {
        rows.push(vec![
            (Role::Title, format!(" {} {}", info.id, info.version)),
            (Role::Dim, format!("  {}", abilities(info))),
        ]);
        if form.is_full {
            let (file, abi, sha256) = (plugin.file, &info.abi, &info.sha256);
            rows.extend(wrapped(Role::Dim, &format!("{file}, ABI {abi}, SHA-256 {sha256}")));
        }
        if let Some(sandbox) = &info.sandbox {
            let role = if *sandbox == Sandbox::Full { Role::Dim } else { Role::Warn };
            rows.extend(wrapped(role, &format!("sandbox: {sandbox}")));
        }
        rows.extend(wrapped(Role::Text, &info.about));
        if info.parameters.is_empty() {
            rows.extend(wrapped(Role::Dim, "no parameters"));
        }
        if form.is_full {
            rows.extend(info.parameters.iter().flat_map(|info| explained(info, columns)));
        } else {
            rows.extend(parameter_rows(&info.parameters, form.tables, columns));
        }
    }
    rows
}

fn state_words(look: &Look, state: PluginState) -> &'static str {
    match state {
        PluginState::Ready => "ready",
        PluginState::Active if look.model.live.is_replay() => "active in the replayed run",
        PluginState::Active => "active: one of its planners is driving",
        PluginState::Changed => "CHANGED on disk; <planner>: choose the planner again to use the new build",
        PluginState::Refused => "REFUSED",
    }
}

fn abilities(info: &PlannerInfo) -> String {
    let abilities = [(info.covers, "plans scans of the floor"), (info.snapshots, "keeps its state")];
    abilities.iter().filter(|(has, _)| *has).map(|(_, word)| *word).collect::<Vec<_>>().join(", ")
}

/// A parameter with its allowed values, its default and its meaning, in as many lines as it needs.
fn explained(info: &ParamInfo, columns: usize) -> Vec<Parts> {
    let default = format!("default {}", parameter::default(&info.kind));
    let front = [
        format!("   {}", text::column(&info.key, KEY)),
        format!(" {}", text::column(&parameter::range(info), ALLOWED)),
        format!(" {}", text::column(&default, DEFAULT)),
    ]
    .concat();
    let when = if info.live { "" } else { "Changes only while the robot is held" };
    let meaning = [info.label.as_str(), info.help.as_str(), when];
    let meaning = meaning.into_iter().filter(|words| !words.is_empty());
    let meaning =
        meaning.map(|words| format!("{}.", words.trim_end_matches('.'))).collect::<Vec<_>>().join(" ");
    let indent = text::width(&front);
    let lines = text::wrap(&meaning, columns.saturating_sub(indent + 1)).into_iter().enumerate();
    let rows: Vec<Parts> = lines
        .map(|(line, words)| {
            let front = if line == 0 { front.clone() } else { " ".repeat(indent) };
            vec![(Role::Text, front), (Role::Dim, format!(" {words}"))]
        })
        .collect();
    if rows.is_empty() { vec![vec![(Role::Text, front)]] } else { rows }
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
    let room = columns.saturating_sub(KEY + ALLOWED + 6);
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
