//! An overlay list.

use crate::theme::Role;
use crate::view::look::{Look, Parts as Row};
use crate::view::{table, text};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::{Clear, Paragraph};

/// A list, with lines above and below it.
#[derive(Default)]
pub(in crate::view) struct List {
    pub title: String,
    pub note: String,
    pub above: Vec<Row>,
    pub rows: Vec<Row>,
    /// The indices of the rows that are headings; they are not counted.
    pub headings: Vec<usize>,
    pub selected: usize,
    /// The number of rows that the selected entry takes; 0 counts as one.
    pub selected_rows: usize,
    pub below: Vec<Row>,
    /// How many of the lines below the list take precedence over the list's last lines.
    pub needed_below: usize,
    /// The position of the cursor: its line, counted from the lines above the list on to those below it, and its
    /// column.
    pub cursor: Option<(usize, usize)>,
}

impl List {
    pub(super) fn draw(self, look: &Look, frame: &mut Frame, area: Rect) {
        let inner = look.list_block("", "").inner(area);
        let room = usize::from(inner.height).saturating_sub(self.above.len());
        // The selected line takes precedence over anything below the list, and most of a list over the last lines
        // there.
        let spare = room
            .saturating_sub(self.rows.len())
            .max(room / 4)
            .min(room.saturating_sub(self.rows.len().min(3)));
        let below = self.below.len().min(spare.max(self.needed_below));
        let below = below.min(room.saturating_sub(self.rows.len().min(1)));
        let chosen = self.selected..self.selected + self.selected_rows.max(1);
        let shown = table::window(chosen.end - 1, self.rows.len(), room - below);
        // If only a part of the list is visible, the title states which part.
        let place = if shown.len() < self.rows.len() {
            let entries = |rows: usize| rows - self.headings.iter().filter(|row| **row < rows).count();
            let range = entries(shown.start)..entries(shown.end);
            format!("  {}", table::counted(&range, entries(self.rows.len())))
        } else {
            String::new()
        };
        let block = look.list_block(&format!("{}{place}", self.title), &self.note);
        let above = self.above.len();
        let mut lines: Vec<Line> = self.above.into_iter().map(|row| look.line(row)).collect();
        for (index, row) in self.rows.into_iter().enumerate() {
            if shown.contains(&index) {
                lines.push(table::row(look, row, chosen.contains(&index), usize::from(inner.width)));
            }
        }
        if let Some((line, column)) = self.cursor {
            let row = if line < above { line } else { line - above + lines.len() };
            place_cursor(frame, inner, (column, row));
        }
        lines.extend(
            shortened(self.below, below, usize::from(inner.width)).into_iter().map(|row| look.line(row)),
        );
        frame.render_widget(Clear, area);
        frame.render_widget(Paragraph::new(lines).block(block), area);
    }
}

/// The first rows of a text; if there are more, the last one ends in an ellipsis.
fn shortened(mut rows: Vec<Row>, most: usize, columns: usize) -> Vec<Row> {
    let is_cut = rows.len() > most;
    rows.truncate(most);
    if let Some((_, words)) = rows.last_mut().filter(|_| is_cut).and_then(|row| row.last_mut()) {
        let lines = text::first_lines(vec![std::mem::take(words), String::new()], 1, columns);
        *words = lines.concat();
    }
    rows
}

/// Shows the terminal's cursor at a column and row in an area, if the position is within the area.
pub(in crate::view) fn place_cursor(frame: &mut Frame, area: Rect, (column, row): (usize, usize)) {
    if column < usize::from(area.width) && row < usize::from(area.height) {
        frame.set_cursor_position((area.x + column as u16, area.y + row as u16));
    }
}

/// A sentence, wrapped into lines.
pub(in crate::view) fn paragraph(
    role: Role,
    sentence: &str,
    columns: usize,
) -> impl Iterator<Item = Row> + use<> {
    text::wrap(sentence, columns).into_iter().map(move |line| vec![(role, format!(" {line}"))])
}

/// A dimmed line.
pub(super) fn hint(text: &str) -> Row {
    vec![(Role::Dim, text.to_owned())]
}
