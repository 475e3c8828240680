//! The changes made by a preset.

use super::list::{List, hint};
use crate::model::{parameter, preset};
use crate::theme::Role;
use crate::view::look::Look;
use crate::view::text;
use mission::PlannerChoice;

pub(super) fn list(look: &Look, name: &str, choice: &PlannerChoice, selected: usize, columns: u16) -> List {
    let Some(info) = look.model.info_of(&choice.id) else { return List::default() };
    let now = look.run.planning.choice.as_ref();
    let differences = preset::differences(now, choice, info);
    let width = usize::from(columns).saturating_sub(3) / 4;
    let rows = differences.iter().map(|difference| {
        vec![
            (Role::Text, text::column(&difference.info.key, width)),
            (Role::Dim, text::column(&difference.now.to_string(), width)),
            (Role::Title, text::column(&difference.then.to_string(), width)),
            (Role::Dim, text::fit(parameter::unit(difference.info), width)),
        ]
    });
    let head = ["name", "now", "preset", "unit"].map(|name| text::column(name, width));
    let changed = format!("{} of {} parameters change", differences.len(), info.parameters.len());
    let enter = match now {
        Some(now) if now.id == choice.id => format!(" {changed}. <accept>: apply them."),
        _ => format!(" {changed} from their defaults. <accept>: change planner to {}.", choice.id),
    };
    List {
        title: format!("Preset {name} ({})", choice.id),
        above: vec![hint(&format!(" {}", head.concat()))],
        rows: rows.collect(),
        selected,
        below: vec![
            hint(&look.keys(&enter)),
            hint(" Nothing moves: the planner replans with the new values."),
        ],
        needed_below: 2,
        ..List::default()
    }
}
