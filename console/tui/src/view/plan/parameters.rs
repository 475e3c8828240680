//! The changed parameters of the planner.

use crate::model::parameter;
use crate::theme::Role;
use crate::view::look::{Look, Parts, fill};
use crate::view::text;
use ratatui::Frame;
use ratatui::layout::Rect;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let changed = changed(look);
    let title = format!("Parameters  {} changed", changed.len());
    let block = look.block(Role::Border, &title, &look.keys("<parameters> edit"));
    let columns = usize::from(block.inner(area).width);
    let rows: Vec<Parts> = if changed.is_empty() {
        vec![vec![(Role::Dim, " all at their defaults".into())]]
    } else {
        changed.into_iter().map(|(key, change)| row(&key, &change, columns)).collect()
    };
    fill(frame, area, block, rows.into_iter().map(|parts| look.line(parts)).collect());
}

fn row(key: &str, change: &str, columns: usize) -> Parts {
    let label = (columns / 2).min(24);
    vec![
        (Role::Text, format!(" {}", text::column(key, label))),
        (Role::Title, text::fit(change, columns.saturating_sub(label + 2))),
    ]
}

/// The parameters that differ from their defaults: the key, then the default and the value.
fn changed(look: &Look) -> Vec<(String, String)> {
    let infos = look.model.planner().map_or(&[][..], |info| info.parameters.as_slice());
    infos
        .iter()
        .filter_map(|info| {
            let (unset, now) =
                (parameter::default(&info.kind), parameter::value(look.run.planning.choice.as_ref(), info));
            let unit = if info.unit.is_empty() { String::new() } else { format!(" {}", info.unit) };
            (now != unset).then(|| (info.key.clone(), format!("{unset} → {now}{unit}")))
        })
        .collect()
}
