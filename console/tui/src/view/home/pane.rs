//! A list of the home screen: a heading, rows, and below them a text about the selected row.

use crate::theme::Role;
use crate::update::Rows;
use crate::view::look::{Look, Parts, fill};
use crate::view::{table, text};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// Rows of the text about a selected scenario or run, without its title.
pub(super) const ABOUT: u16 = 2;
/// The minimum rows of a pane at which it has a text about the selected row.
pub(super) const LEAST: u16 = 8;

/// The contents of a list.
pub(super) struct Pane<'a> {
    pub border: Role,
    pub title: &'a str,
    pub note: String,
    /// The column headings; `None` for a list without columns.
    pub heads: Option<String>,
    pub rows: Vec<Parts>,
    /// The selected row; `None` if the list does not respond to the arrow keys.
    pub selected: Option<usize>,
    pub list: Rows,
    /// The text of a list without rows.
    pub empty: String,
    /// The title and the lines about the selected row.
    pub about: Option<(String, Vec<Parts>)>,
}

impl Pane<'_> {
    pub(super) fn draw(self, look: &Look, frame: &mut Frame, area: Rect) {
        let about = self.about.filter(|(_, lines)| area.height >= LEAST && !lines.is_empty());
        let below = about.as_ref().map_or(0, |(_, lines)| lines.len() as u16 + 1);
        let inner = look.block(self.border, "", "").inner(area);
        let heads = u16::from(self.heads.is_some());
        // The list keeps two rows, if it has them.
        let kept = heads + self.rows.len().clamp(1, 2) as u16;
        let below = below.min(inner.height.saturating_sub(kept));
        let (columns, height) =
            (usize::from(inner.width), usize::from(inner.height.saturating_sub(heads + below)));
        let shown = table::window(self.selected.unwrap_or(0), self.rows.len(), height);
        let key = super::key(look, self.list);
        let title = format!("{key}{}  {}", self.title, table::counted(&shown, self.rows.len()));
        let block = look.block(self.border, &title, &self.note);
        let place = Rect { y: inner.y + heads, height: height as u16, ..inner };
        table::place(look, place, self.list, shown.clone());
        let mut lines: Vec<Line> = self
            .heads
            .into_iter()
            .map(|heads| look.line([(Role::Dim, text::fit(&heads, columns))]))
            .collect();
        if self.rows.is_empty() {
            lines.push(look.line([(Role::Dim, text::fit(&self.empty, columns))]));
        }
        let len = self.rows.len();
        lines.extend(table::rows(look, self.rows, self.selected, (columns, height)));
        fill(frame, area, block, lines);
        table::bar(look, frame, place, &shown, len);
        if let Some((title, lines)) = about {
            let y = inner.bottom().saturating_sub(below);
            divide(look, frame, Rect { y, height: 1, ..area }, (self.border, &title));
            let place = Rect { y: y + 1, height: below.saturating_sub(1), ..inner };
            let is_cut = lines.len() > usize::from(place.height);
            let mut lines: Vec<Line> = lines.into_iter().map(|parts| look.line(parts)).collect();
            if let Some(last) = usize::from(place.height).checked_sub(1).filter(|_| is_cut) {
                lines.truncate(last);
                lines.push(
                    look.line(
                        [(Role::Dim, " … (a larger terminal shows the rest)")]
                            .map(|(role, words)| (role, words.to_owned())),
                    ),
                );
            }
            fill(frame, place, ratatui::widgets::Block::new(), lines);
        }
    }
}

/// Draws a line with a title across a pane.
fn divide(look: &Look, frame: &mut Frame, area: Rect, (border, title): (Role, &str)) {
    let room = usize::from(area.width).saturating_sub(6);
    let title = text::fit(title, room);
    let rest = "─".repeat(room.saturating_sub(text::width(&title)));
    let parts = [(border, "├─ ".to_owned()), (Role::Title, title), (border, format!(" {rest}─┤"))];
    frame.render_widget(look.line(parts), area);
}

/// The first lines of a sentence about the selected row, for the space below a list.
pub(super) fn sentence(role: Role, words: &str, columns: usize) -> Vec<Parts> {
    let columns = columns.saturating_sub(2);
    let lines = text::first_lines(text::wrap(words, columns), usize::from(ABOUT), columns);
    lines.into_iter().map(|line| vec![(role, format!(" {line}"))]).collect()
}
