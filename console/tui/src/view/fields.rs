//! Figures with their names, one below another.

use super::look::{Look, Parts};
use super::text;
use crate::theme::Role;
use ratatui::text::Line;

/// A name and a value, which may take several lines.
pub(super) type Field = (&'static str, String);

/// The lines for some fields; the names take the first `names` columns.
pub(super) fn lines(look: &Look, fields: &[Field], names: usize, columns: usize) -> Vec<Line<'static>> {
    let room = columns.saturating_sub(names + 2).max(8);
    let rows = fields.iter().flat_map(|(name, words)| {
        let wrapped = text::wrap(words, room);
        wrapped.into_iter().enumerate().map(move |(index, line)| -> Parts {
            let name = if index == 0 { name } else { "" };
            vec![(Role::Dim, format!(" {}", text::column(name, names))), (Role::Text, line)]
        })
    });
    rows.map(|parts| look.line(parts)).collect()
}
