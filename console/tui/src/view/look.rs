//! What every part of the view needs: the model, and how the terminal shows it.

use crate::caps::{Caps, Colours, Glyphs};
use crate::model::{Model, Pane, Run};
use crate::theme::{Role, Theme};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph};
use std::borrow::Cow;

/// What every part of the view needs.
#[derive(Clone, Copy)]
pub(super) struct Look<'a> {
    pub model: &'a Model,
    /// The run that the panes show.
    pub run: &'a Run,
    pub caps: Caps,
    pub theme: &'a Theme,
}

/// Pieces of a line, each with what it stands for.
pub(super) type Parts = Vec<(Role, String)>;

impl Look<'_> {
    /// Whether letters stand for what colours and half characters show elsewhere.
    pub(super) fn is_plain(&self) -> bool {
        self.caps.colours == Colours::None || self.caps.glyphs == Glyphs::Ascii
    }

    pub(super) fn span<'t>(&self, role: Role, text: impl Into<Cow<'t, str>>) -> Span<'t> {
        Span::styled(text, self.theme.style(role))
    }

    pub(super) fn line<'t>(&self, parts: impl IntoIterator<Item = (Role, String)>) -> Line<'t> {
        Line::from(parts.into_iter().map(|(role, text)| self.span(role, text)).collect::<Vec<_>>())
    }

    pub(super) fn pane<'t>(&self, pane: Pane, title: &str, note: &str) -> Block<'t> {
        let focus = self.model.ui.pane == pane && self.model.ui.panes().contains(&pane);
        let border = if focus { Role::Focus } else { Role::Border };
        self.block(border, title, note)
    }

    pub(super) fn block<'t>(&self, border: Role, title: &str, note: &str) -> Block<'t> {
        let block = Block::bordered()
            .border_style(self.theme.style(border))
            .title_top(Line::from(vec![Span::raw("─"), self.span(Role::Title, format!(" {title} "))]));
        if note.is_empty() {
            block
        } else {
            block.title_top(
                Line::from(vec![self.span(Role::Dim, format!(" {note} ")), Span::raw("─")]).right_aligned(),
            )
        }
    }
}

/// Lines in a pane, cut where it ends.
pub(super) fn fill(frame: &mut Frame, area: Rect, block: Block<'_>, lines: Vec<Line<'_>>) {
    frame.render_widget(Paragraph::new(lines).block(block), area);
}
