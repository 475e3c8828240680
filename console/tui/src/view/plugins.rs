//! The plugins screen: the files found, with their states and planners, and the reasons for refused
//! files.

use super::look::{Look, Parts, fill};
use super::{table, text};
use crate::model::parameter;
use crate::model::plugins::{Plugin, PluginState, plugins};
use crate::model::ui::Arrangement;
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

pub(crate) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    let found = plugins(&look.model.console, look.run);
    let selected = look.model.ui.plugin.min(found.len().saturating_sub(1));
    let rows = (found.len() as u16 + 3).min(area.height / 2).max(5);
    let [above, below] = Layout::vertical([Constraint::Length(rows), Constraint::Fill(1)]).areas(area);
    files(look, frame, above, (&found, selected));
    let Some(plugin) = found.get(selected) else { return };
    if arrangement == Arrangement::Wide {
        let [left, right] = Layout::horizontal([Constraint::Fill(1), Constraint::Length(50)]).areas(below);
        detail(look, frame, left, plugin);
        changes(look, frame, right);
    } else {
        detail(look, frame, below, plugin);
    }
}

fn files(look: &Look, frame: &mut Frame, area: Rect, (found, selected): (&[Plugin<'_>], usize)) {
    let planners = text::counted(look.model.console.planners.len(), "planner");
    let title = format!("Plugins  {planners} in {}", text::counted(found.len(), "file"));
    let block = look.block(Role::Focus, &title, &look.keys("<reload> reload"));
    let inner = block.inner(area);
    let columns = usize::from(inner.width);
    let name = 30.min(columns / 3);
    let rows = found.iter().map(|plugin| row(plugin, name, columns)).collect();
    table::place(look, inner, Rows::Plugins, table::window(selected, found.len(), usize::from(inner.height)));
    let mut lines = table::rows(look, rows, Some(selected), (columns, usize::from(inner.height)));
    if lines.is_empty() {
        lines.push(look.line([(
            Role::Warn,
            " No plugins found; `tankops planners` shows where tankops looks for them.".into(),
        )]));
    }
    fill(frame, area, block, lines);
}

fn role(state: PluginState) -> Role {
    match state {
        PluginState::Ready => Role::Text,
        PluginState::Active => Role::Good,
        PluginState::Changed => Role::Watch,
        PluginState::Refused => Role::Warn,
    }
}

fn row(plugin: &Plugin<'_>, name: usize, columns: usize) -> Parts {
    let mut parts = vec![
        (Role::Text, text::column(&text::fit(plugin.file, name - 1), name)),
        (role(plugin.state), text::column(plugin.state.word(), 9)),
    ];
    let rest = columns.saturating_sub(name + 9 + 1);
    let words = match plugin.planners.first() {
        None => text::clauses(plugin.reason, rest),
        Some(first) => {
            let ids: Vec<&str> = plugin.planners.iter().map(|info| info.id.as_str()).collect();
            let hash = first.sha256.get(..HASH).unwrap_or(&first.sha256);
            let about = format!("{:<5}{hash:<13} ", first.abi);
            let room = rest.saturating_sub(text::width(&about));
            about + &text::names(&ids, room)
        }
    };
    parts.push((Role::Text, words));
    parts
}

fn detail(look: &Look, frame: &mut Frame, area: Rect, plugin: &Plugin<'_>) {
    let block = look.block(Role::Border, plugin.file, "");
    let columns = usize::from(block.inner(area).width).saturating_sub(1);
    let wrapped = |role: Role, words: &str| -> Vec<Parts> {
        text::wrap(words, columns).into_iter().map(|line| vec![(role, format!(" {line}"))]).collect()
    };
    let about = |tables: usize| {
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
            if tables == 0 {
                rows.extend(wrapped(Role::Dim, &parameters(&info.parameters)));
            } else {
                rows.extend(parameter_rows(&info.parameters, tables, columns));
            }
        }
        rows
    };
    // A large screen has room for a line about each parameter, or for two parameters in a line.
    let height = usize::from(block.inner(area).height);
    let most = if columns >= 2 * LEAST { 2 } else { 1 };
    let mut tables = (1..=most).map(&about);
    let rows = tables.find(|rows| rows.len() <= height).unwrap_or_else(|| about(0));
    fill(frame, area, block, rows.into_iter().map(|parts| look.line(parts)).collect());
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

fn parameters(infos: &[ParamInfo]) -> String {
    let keys: Vec<&str> = infos.iter().map(|info| info.key.as_str()).collect();
    if keys.is_empty() { "no parameters".into() } else { format!("parameters: {}", keys.join(", ")) }
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
