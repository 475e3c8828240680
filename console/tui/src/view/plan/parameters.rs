//! The parameters of the planner: first those that were changed, then as many of the unchanged ones as
//! fit.

use crate::model::{Pane, parameter};
use crate::theme::Role;
use crate::view::look::{Look, fill};
use crate::view::text;
use mission::ParamInfo;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// Blanks between parameters in a line.
const GAP: &str = "   ";
/// Width of a key and of a value if each parameter has its own line, columns.
const KEY: usize = 22;
const VALUE: usize = 20;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    if look.run.is_survey() {
        let block = look.pane(Pane::Parameters, "Parameters", "");
        let line = look.line([(Role::Dim, " A survey drives without a planner.".into())]);
        return fill(frame, area, block, vec![line]);
    }
    let (changed, others) = parameters(look);
    let n = changed.len() + others.len();
    let state =
        if changed.is_empty() { "all default".to_owned() } else { format!("{} changed", changed.len()) };
    let title = if n == 0 { "Parameters".to_owned() } else { format!("Parameters  {n}, {state}") };
    let keys = if usize::from(area.width) >= text::width(&title) + 14 {
        look.keys("<parameters> edit")
    } else {
        String::new()
    };
    let block = look.pane(Pane::Parameters, &title, &keys);
    let columns = usize::from(block.inner(area).width).saturating_sub(1);
    let rows = usize::from(block.inner(area).height);
    let mut lines = written(look, Role::Title, &changed, columns);
    lines.extend(written(look, Role::Text, &others, columns));
    if lines.len() < n && n <= rows && columns > KEY + VALUE + 4 {
        lines = one_each(look, columns);
    }
    if n == 0 {
        lines.push(look.line([(Role::Dim, " none".into())]));
    }
    fill(frame, area, block, lines);
}

fn written(look: &Look, role: Role, parameters: &[String], columns: usize) -> Vec<Line<'static>> {
    let lines = text::wrap_items(parameters, columns, GAP);
    lines.into_iter().map(|line| look.line([(role, format!(" {line}"))])).collect()
}

/// One line for each parameter, with its meaning.
fn one_each(look: &Look, columns: usize) -> Vec<Line<'static>> {
    let infos = look.model.planner().map_or(&[][..], |info| info.parameters.as_slice());
    let line = |info: &ParamInfo| {
        let (unset, now) =
            (parameter::default(&info.kind), parameter::value(look.run.planning.choice.as_ref(), info));
        let change = if now == unset { now.to_string() } else { format!("{unset} → {now}") };
        let value = format!("{change} {}", info.unit);
        let role = if now == unset { Role::Text } else { Role::Title };
        let room = columns.saturating_sub(KEY + VALUE + 2);
        look.line([
            (role, format!(" {} {} ", text::column(&info.key, KEY), text::column(value.trim_end(), VALUE))),
            (Role::Dim, text::wording([info.label.clone(), String::new()], room)),
        ])
    };
    infos.iter().map(line).collect()
}

/// The changed parameters with their defaults and values, and the others with their values.
fn parameters(look: &Look) -> (Vec<String>, Vec<String>) {
    let infos = look.model.planner().map_or(&[][..], |info| info.parameters.as_slice());
    let (mut changed, mut others) = (Vec::new(), Vec::new());
    for info in infos {
        let unset = parameter::default(&info.kind);
        let now = parameter::value(look.run.planning.choice.as_ref(), info);
        let unit = if info.unit.is_empty() { String::new() } else { format!(" {}", info.unit) };
        if now == unset {
            others.push(format!("{} {now}{unit}", info.key));
        } else {
            changed.push(format!("{} {unset} → {now}{unit}", info.key));
        }
    }
    (changed, others)
}
