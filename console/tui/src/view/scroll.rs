//! The pane with the details of the selected row of a list. If it does not show all of its rows, the operator turns to
//! it and scrolls.

use super::look::{Look, fill};
use super::{table, text};
use crate::model::Pane;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::Block;
use std::ops::Range;

/// Columns of the frame around a title and its note.
const FRAME: usize = 11;

/// How much of a text is visible, rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Extent {
    /// The rows of the area in which the text is drawn.
    pub shown: usize,
    /// The rows of the text.
    pub len: usize,
}

impl Extent {
    /// How many rows the text can be scrolled at most.
    pub(crate) fn most(self) -> usize {
        self.len.saturating_sub(self.shown)
    }

    fn is_cut(self) -> bool {
        self.len > self.shown
    }
}

/// The visible rows: while the arrow keys apply to the list, the first ones.
fn visible(look: &Look, extent: Extent) -> Range<usize> {
    let ui = &look.model.ui;
    let first = if ui.focus() == Pane::Detail { ui.scrolled.min(extent.most()) } else { 0 };
    first..(first + extent.shown).min(extent.len)
}

/// The frame of the pane in a width. If the text is cut, the title states which rows are visible, and how to see the
/// others.
pub(super) fn block<'t>(
    look: &Look,
    (title, note): (&str, &str),
    (columns, extent): (u16, Extent),
) -> Block<'t> {
    let taken = text::width(title) + text::width(&look.pane_key(Pane::Detail)) + FRAME;
    let room = usize::from(columns).saturating_sub(taken);
    let notes = if extent.is_cut() {
        let place = table::counted(&visible(look, extent), extent.len);
        let is_focused = look.model.ui.focus() == Pane::Detail;
        let keys = look.keys(if is_focused { "<down> <up> scroll" } else { "<next-pane> pane" });
        let all = format!("{note}  {place}  {keys}");
        [all.trim_start().to_owned(), format!("{place}  {keys}"), place]
    } else {
        [note.to_owned(), String::new(), String::new()]
    };
    let fitting = notes.into_iter().find(|note| text::width(note) <= room).unwrap_or_default();
    look.pane(Pane::Detail, title, &fitting)
}

/// Draws the visible lines.
pub(super) fn lines(look: &Look, frame: &mut Frame, area: Rect, lines: Vec<Line<'_>>) {
    let extent = Extent { shown: usize::from(area.height), len: lines.len() };
    let range = visible(look, extent);
    let shown = lines.into_iter().skip(range.start).take(range.len()).collect();
    fill(frame, area, Block::new(), shown);
}

/// Draws the whole pane: the frame, the visible lines and the bar.
pub(super) fn draw(
    look: &Look,
    frame: &mut Frame,
    area: Rect,
    (title, note): (&str, &str),
    lines: Vec<Line<'_>>,
) {
    let extent = extent(area, lines.len());
    let block = block(look, (title, note), (area.width, extent));
    let inner = block.inner(area);
    frame.render_widget(block, area);
    self::lines(look, frame, inner, lines);
    table::bar(look, frame, inner, &visible(look, extent), extent.len);
}

/// How much of a text is visible in a pane with a frame.
pub(super) fn extent(area: Rect, len: usize) -> Extent {
    Extent { shown: usize::from(area.height.saturating_sub(2)), len }
}
