//! The context needed by every part of the view: the model, and how the terminal shows it.

use super::cache::Cache;
use super::text;
use crate::actions::{ActionId, find};
use crate::caps::{Caps, Colours, Glyphs};
use crate::model::{Model, Pane, Run, ui::Arrangement};
use crate::theme::{Role, Theme};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph};
use std::borrow::Cow;
use std::cell::RefCell;

/// The context needed by every part of the view.
#[derive(Clone, Copy)]
pub(crate) struct Look<'a> {
    pub model: &'a Model,
    /// The run shown in the panes.
    pub run: &'a Run,
    pub caps: Caps,
    pub theme: &'a Theme,
    pub cache: &'a RefCell<Cache>,
}

/// Columns of the frame around a title and its note.
const TITLE_FRAME: usize = 10;

/// The pieces of a line, with their roles.
pub(crate) type Parts = Vec<(Role, String)>;

impl Look<'_> {
    /// Whether letters replace the colours and half-block characters used elsewhere.
    pub(crate) fn is_plain(&self) -> bool {
        self.caps.colours == Colours::None || self.caps.glyphs == Glyphs::Ascii
    }

    /// Whether a value that arrives with every tick has been missing for two ticks, or the mission has gone silent.
    pub(crate) fn is_stale(&self, t_s: Option<f64>) -> bool {
        t_s.is_some_and(|t_s| self.model.silent_s().is_some() || self.run.is_overdue(t_s))
    }

    /// Whether the estimated pose is stale.
    pub(crate) fn is_pose_stale(&self) -> bool {
        self.is_stale(self.run.position.pose.map(|_| self.run.position.pose_t_s))
    }

    pub(crate) fn span<'t>(&self, role: Role, text: impl Into<Cow<'t, str>>) -> Span<'t> {
        Span::styled(text, self.theme.style(role))
    }

    pub(crate) fn line<'t>(&self, parts: impl IntoIterator<Item = (Role, String)>) -> Line<'t> {
        Line::from(parts.into_iter().map(|(role, text)| self.span(role, text)).collect::<Vec<_>>())
    }

    /// A sentence in which the `<end>`-style placeholders are replaced by the operator's keys.
    pub(crate) fn keys(&self, sentence: &str) -> String {
        self.model.console.keys.spelled(sentence)
    }

    /// The frame of a pane. On a large screen, the title shows the key of the pane; a mark before the title shows that
    /// the arrow keys apply to the pane.
    pub(crate) fn pane<'t>(&self, pane: Pane, title: &str, note: &str) -> Block<'t> {
        let panes = self.model.ui.panes();
        let focus = self.model.ui.focus() == pane && panes.contains(&pane);
        let title = &format!("{}{title}", self.pane_key(pane));
        match (focus, panes.len()) {
            (true, _) => self.block(Role::Focus, title, note),
            // With one pane, or none that could have the focus, every title is bold.
            (false, 0 | 1) => self.frame(Role::Border, (Role::Title, " ", title), note),
            (false, _) => self.frame(Role::Border, (Role::Text, " ", title), note),
        }
    }

    /// The key of a pane that has one, for its title.
    pub(crate) fn pane_key(&self, pane: Pane) -> String {
        let index = self.model.ui.numbered_panes().iter().position(|other| *other == pane);
        index.map_or_else(String::new, |index| self.nth_key(index))
    }

    /// The key of the pane or list with an index, from 0, for its title.
    pub(crate) fn nth_key(&self, index: usize) -> String {
        let action = find::row(ActionId::Pane(index as u8 + 1));
        let key = action.and_then(|action| self.model.console.keys.of(action).first());
        key.map_or_else(String::new, |key| format!("{key} "))
    }

    /// A frame with a title; a mark before the title shows that the arrow keys apply here.
    pub(crate) fn block<'t>(&self, border: Role, title: &str, note: &str) -> Block<'t> {
        if border == Role::Focus {
            return self.focused(border, title, note);
        }
        self.frame(border, (Role::Title, " ", title), note)
    }

    /// A frame with its own border around the pane to which the arrow keys apply.
    pub(crate) fn focused<'t>(&self, border: Role, title: &str, note: &str) -> Block<'t> {
        self.frame(border, (Role::Title, "▸ ", title), note)
    }

    /// A frame around a list that lies over the screen.
    pub(crate) fn list_block<'t>(&self, title: &str, note: &str) -> Block<'t> {
        self.bordered(Role::Focus, (Role::Title, format!(" {title} ")), note)
    }

    /// A frame around a pane; on a small screen, the first title names the screen.
    fn frame<'t>(&self, border: Role, (role, mark, title): (Role, &str, &str), note: &str) -> Block<'t> {
        let named = self.named(title);
        let columns = usize::from(self.model.ui.width);
        let is_tight = named.is_some()
            && text::width(named.as_deref().unwrap_or(title)) + text::width(note) + TITLE_FRAME > columns;
        let title = format!("{mark}{} ", named.as_deref().unwrap_or(title));
        self.bordered(border, (role, title), if is_tight { "" } else { note })
    }

    /// The first title of a small screen with the digit and the name of the screen; `None` for any other title.
    fn named(&self, title: &str) -> Option<String> {
        let ui = &self.model.ui;
        if title.is_empty()
            || ui.arrangement() != Arrangement::Paged
            || !self.cache.borrow_mut().is_first_title()
        {
            return None;
        }
        let (digit, name) = (ui.screen.digit(), ui.screen.name());
        Some(if title.starts_with(name) {
            format!("{digit} {title}")
        } else {
            format!("{digit} {name}: {title}")
        })
    }

    fn bordered<'t>(&self, border: Role, (role, title): (Role, String), note: &str) -> Block<'t> {
        let block = Block::bordered()
            .border_style(self.theme.style(border))
            .title_top(Line::from(vec![Span::raw("─"), self.span(role, title)]));
        if note.is_empty() {
            block
        } else {
            block.title_top(
                Line::from(vec![self.span(Role::Dim, format!(" {note} ")), Span::raw("─")]).right_aligned(),
            )
        }
    }
}

/// The highest-ranked lines (lowest numbers) that fit into a number of rows, in their original order.
pub(crate) fn ranked(lines: Vec<(u8, Line<'_>)>, rows: usize) -> Vec<Line<'_>> {
    let mut ranks: Vec<u8> = lines.iter().map(|(rank, _)| *rank).collect();
    ranks.sort_unstable();
    let last = ranks.get(rows).map_or(u8::MAX, |rank| rank.saturating_sub(1));
    lines.into_iter().filter(|(rank, _)| *rank <= last).map(|(_, line)| line).collect()
}

/// Marks a value as stale if it is.
pub(crate) fn marked(is_stale: bool, (role, value): (Role, String)) -> (Role, String) {
    match (is_stale, role) {
        (false, _) => (role, value),
        // An alarm colour takes precedence over the stale mark.
        (true, Role::Crit) => (role, format!("◌{value}")),
        (true, _) => (Role::Stale, format!("◌{value}")),
    }
}

/// Draws lines in a pane; lines that are too long end in an ellipsis.
pub(crate) fn fill(frame: &mut Frame, area: Rect, block: Block<'_>, lines: Vec<Line<'_>>) {
    let columns = usize::from(block.inner(area).width);
    let lines: Vec<Line> = lines.into_iter().map(|line| cut(line, columns)).collect();
    frame.render_widget(Paragraph::new(lines).block(block), area);
}

fn cut(line: Line<'_>, columns: usize) -> Line<'_> {
    if line.width() <= columns {
        return line;
    }
    let mut room = columns;
    let spans = line.spans.into_iter().map(|span| {
        let words = text::fit(&span.content, room);
        room = room.saturating_sub(text::width(&words));
        Span::styled(words, span.style)
    });
    Line::from(spans.collect::<Vec<_>>())
}
