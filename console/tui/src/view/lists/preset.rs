//! The changes made by a preset, each with a tick box, and their estimated effect.

use super::list::{List, hint, paragraph};
use crate::model::{parameter, preset};
use crate::theme::Role;
use crate::view::look::{Look, Parts};
use crate::view::{setting, text};
use mission::PlannerChoice;
use std::collections::BTreeSet;

/// Width of a tick box, columns.
const BOX: usize = 4;

/// The changes, the selected line and the parameters whose values are left.
pub(super) fn list(
    look: &Look,
    (name, choice): (&str, &PlannerChoice),
    (selected, left): (usize, &BTreeSet<String>),
    columns: u16,
) -> List {
    let Some(info) = look.model.info_of(&choice.id) else { return List::default() };
    let now = look.run.planning.choice.as_ref();
    let differences = preset::differences(now, choice, info);
    let room = usize::from(columns).saturating_sub(3);
    let width = room.saturating_sub(BOX) / 4;
    let rows = differences.iter().map(|difference| {
        let is_taken = !left.contains(&difference.info.key);
        vec![
            (Role::Key, if is_taken { "[x] " } else { "[ ] " }.into()),
            (Role::Text, text::column(&difference.info.key, width)),
            (Role::Dim, text::column(&difference.now.to_string(), width)),
            (
                if is_taken { Role::Title } else { Role::Dim },
                text::column(&difference.then.to_string(), width),
            ),
            (Role::Dim, text::fit(parameter::unit(difference.info), width)),
        ]
    });
    let head = ["name", "now", "preset", "unit"].map(|name| text::column(name, width));
    let taken = differences.len() - left.len().min(differences.len());
    let counted = match differences.len() {
        0 => "All parameters keep their defaults".to_owned(),
        n => format!("{taken} of {n} changes taken; {} parameters in all", info.parameters.len()),
    };
    let has_effect = taken > 0 || differences.is_empty();
    let enter = match now {
        Some(now) if now.id == choice.id => {
            format!("{counted}. <accept>: apply them, <tick-value>: take or leave.")
        }
        _ => format!("{counted}. <accept>: change planner to {}, <tick-value>: take or leave.", choice.id),
    };
    let picked = preset::picked(now, choice, info, left);
    let effect = if has_effect { setting::effect(look.model, &picked, true) } else { Vec::new() };
    let effect = effect.iter().filter(|clause| !clause.contains('<')).map(String::as_str).collect::<Vec<_>>();
    let computing = effect.is_empty().then_some("Computing the effect...").filter(|_| has_effect);
    let effect = computing.map_or_else(|| effect.join(" "), str::to_owned);
    let mut below: Vec<Parts> = paragraph(Role::Text, &effect, room).collect();
    below.extend(paragraph(Role::Dim, &look.keys(&enter), room));
    below.extend(paragraph(Role::Dim, "Nothing moves: the planner replans with the new values.", room));
    List {
        title: format!("Preset {name} ({})", choice.id),
        above: vec![hint(&format!(" {}{}", " ".repeat(BOX), head.concat()))],
        rows: rows.collect(),
        selected,
        needed_below: below.len(),
        below,
        ..List::default()
    }
}
