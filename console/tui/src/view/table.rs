//! Tables: as many rows as fit, one of them selected.

use super::look::{Look, Parts};
use super::text;
use crate::theme::Role;
use crate::update::Rows;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use std::ops::Range;

/// The visible part of a list; it always contains the selected line.
pub(crate) fn window(selected: usize, len: usize, rows: usize) -> Range<usize> {
    let first = (selected + 1).saturating_sub(rows).min(len.saturating_sub(rows));
    first..(first + rows).min(len)
}

/// The number of rows and, if not all of them are visible, which ones are: `15`, `1-10 of 15`.
pub(crate) fn counted(shown: &Range<usize>, len: usize) -> String {
    if shown.len() == len { len.to_string() } else { format!("{}-{} of {len}", shown.start + 1, shown.end) }
}

/// A row; the selected one begins with a mark and is shown in reverse up to its end.
pub(crate) fn row(look: &Look, mut parts: Parts, selected: bool, columns: usize) -> Line<'static> {
    parts.insert(0, (Role::Text, if selected { ">" } else { " " }.into()));
    if !selected {
        return look.line(parts);
    }
    let used: usize = parts.iter().map(|(_, text)| text::width(text)).sum();
    parts.push((Role::Text, " ".repeat(columns.saturating_sub(used))));
    let mut line = look.line(parts);
    for span in &mut line.spans {
        span.style = span.style.patch(look.theme.style(Role::Selected));
    }
    line
}

/// The rows of a table that fit, including the selected one; `None` means that the table does not respond to the
/// arrow keys.
pub(crate) fn rows(
    look: &Look,
    all: Vec<Parts>,
    selected: Option<usize>,
    (columns, height): (usize, usize),
) -> Vec<Line<'static>> {
    let shown = window(selected.unwrap_or(0), all.len(), height);
    let numbered = all.into_iter().enumerate().filter(|(index, _)| shown.contains(index));
    numbered.map(|(index, parts)| row(look, parts, selected == Some(index), columns)).collect()
}

/// Records for the mouse where the visible rows are; the first row is at the top of the area.
pub(crate) fn place(look: &Look, area: Rect, list: Rows, shown: Range<usize>) {
    for (y, index) in (area.top()..area.bottom()).zip(shown) {
        look.cache.borrow_mut().place_row(Rect { y, height: 1, ..area }, list, index);
    }
}

/// Marks on the right border which part of a list is visible, if not all of it is. `area`: the rows within the frame.
pub(crate) fn bar(look: &Look, frame: &mut Frame, area: Rect, shown: &Range<usize>, len: usize) {
    let column = Rect { x: area.right(), width: 1, ..area }.intersection(frame.area());
    let Some(thumb) = thumb(usize::from(column.height), shown, len) else { return };
    for y in thumb.map(|row| column.y + row as u16) {
        frame.buffer_mut()[(column.x, y)].set_char('█').set_style(look.theme.style(Role::Dim));
    }
}

/// The rows of the mark; `None` if the whole list is visible.
fn thumb(rows: usize, shown: &Range<usize>, len: usize) -> Option<Range<usize>> {
    if rows == 0 || shown.len() >= len {
        return None;
    }
    let height = (rows * shown.len() / len).clamp(1, rows);
    let (last, room) = (len - shown.len(), rows - height);
    // Rounded, and at an end only if the list is.
    let from = (shown.start * room + last / 2) / last;
    let from = if shown.start > 0 && room > 1 { from.max(1) } else { from };
    let from = if shown.end < len && room > 1 { from.min(room - 1) } else { from };
    Some(from..from + height)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bar_is_at_an_end_only_if_the_list_is() {
        assert_eq!(thumb(10, &(0..10), 10), None, "all is visible");
        assert_eq!(thumb(0, &(0..0), 10), None, "no room");
        for rows in 4..20 {
            for len in rows + 1..60 {
                for start in 0..=len - rows {
                    let bar = thumb(rows, &(start..start + rows), len).expect("a part is visible");
                    assert!(!bar.is_empty() && bar.end <= rows, "{bar:?} of {rows}");
                    if rows - bar.len() > 1 {
                        assert_eq!(bar.start == 0, start == 0, "{bar:?} for {start} of {len} in {rows}");
                        assert_eq!(
                            bar.end == rows,
                            start + rows == len,
                            "{bar:?} for {start} of {len} in {rows}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn the_selected_line_is_always_shown() {
        for len in 0..12 {
            for rows in 1..8 {
                for selected in 0..len {
                    let shown = window(selected, len, rows);
                    assert!(shown.contains(&selected) && shown.len() == rows.min(len));
                }
            }
        }
    }
}
