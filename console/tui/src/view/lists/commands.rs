//! The list of commands; as help it shows every key.

use super::list::{List, hint, paragraph};
use crate::actions::{self, ActionId, find};
use crate::theme::Role;
use crate::update::offered;
use crate::view::look::{Look, Parts as Row};
use crate::view::text;

/// Columns of the keys of a command.
const KEYS: usize = 10;

pub(super) fn list(look: &Look, help: bool, filter: &str, selected: usize, columns: u16) -> List {
    let all = find::listed(look.model, "").len();
    let found = find::listed(look.model, filter);
    // Name and description where there is room, else the description, else the name.
    let (name, about) = match columns {
        74.. => (16, usize::from(columns) - 2 - 1 - 16 - KEYS - 6),
        58.. => (0, usize::from(columns) - 2 - 1 - KEYS - 6),
        _ => (16, 0),
    };
    let rows = found.iter().map(|action| {
        let now = offered(look.model, action.id).is_ok();
        let role = if now { Role::Text } else { Role::Dim };
        let risk = if now { action.risk.word() } else { "-" };
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
        vec![hint(" Enter: run  Esc: close  -: not available")]
    };
    List {
        title: if help { "Keys and commands" } else { "Commands" }.into(),
        note: "type to filter",
        above: vec![vec![
            (Role::Title, format!(" > {filter}_")),
            (Role::Dim, format!("   {} of {all}", found.len())),
        ]],
        rows: rows.collect(),
        selected,
        below,
        ..List::default()
    }
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
    let lists = format!("{up} {down}: select, {accept}: run, Esc: close, -: not available.");
    [
        lists.as_str(),
        "HOLD never asks first; commands marked MOVES or ENDS do.",
        "Alarms: C crit, W warn, w watch, * not acknowledged.",
    ]
    .into_iter()
    .flat_map(|rule| paragraph(Role::Dim, rule, columns))
    .collect()
}
