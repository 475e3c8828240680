//! The line above the keys: a question if one is open, else what comes next.

use super::field::field;
use super::lists::place_cursor;
use super::look::Look;
use super::next::{self, Clauses};
use super::{coverage, text};
use crate::model::{LineEdit, Model, Overlay, ui::Ask};
use crate::theme::Role;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    if let Overlay::Filter(line) = &look.model.ui.overlay {
        return filter(look, frame, area, line);
    }
    let (role, clauses) = clauses(look.model);
    let columns = usize::from(area.width).saturating_sub(1);
    let text = next::joined(&clauses, columns.saturating_sub(1));
    let text = if role == Role::Confirm { text::column(&text, columns) } else { text };
    frame.render_widget(Line::from(vec![look.span(Role::Text, " "), look.span(role, text)]), area);
}

/// The line in which a filter is typed, and which keys end it.
fn filter(look: &Look, frame: &mut Frame, area: Rect, line: &LineEdit) {
    const PROMPT: &str = " Filter: ";
    const KEYS: &str = "  Enter: keep, Esc: clear.";
    let columns = usize::from(area.width).saturating_sub(1);
    let shown = field(line, columns.saturating_sub(text::width(PROMPT) + text::width(KEYS)));
    let typed = text::column(&format!("{PROMPT}{}{KEYS}", shown.text), columns);
    frame.render_widget(Line::from(vec![look.span(Role::Text, " "), look.span(Role::Confirm, typed)]), area);
    place_cursor(frame, area, (1 + text::width(PROMPT) + shown.cursor, 0));
}

/// The question that is open, or what comes next.
pub(super) fn clauses(model: &Model) -> Clauses {
    asked(model).map_or_else(|| next::clauses(model), |clauses| (Role::Confirm, clauses))
}

/// The question that is open, with the keys that answer it.
pub(crate) fn question(model: &Model) -> Option<String> {
    asked(model).map(|clauses| clauses.join(" "))
}

/// What is asked and which keys answer come in the first clause: they are never left out.
fn asked(model: &Model) -> Option<Vec<String>> {
    let moves = || format!("Robot will move (planner {}).", model.live.run.planner_id().unwrap_or("unknown"));
    let clauses = match &model.ui.overlay {
        Overlay::Confirm(Ask::Start) => vec!["Start mission? Enter: start, Esc: cancel.".into(), moves()],
        Overlay::Confirm(Ask::Resume) => vec!["Resume? Enter: resume, Esc: stay held.".into(), moves()],
        Overlay::Confirm(Ask::FlyUncertified) => vec![
            "Run uncertified plan? Enter: run, Esc: stay held.".into(),
            "Tether may stay out on return.".into(),
            "Applies to later plans too, until one fails.".into(),
        ],
        Overlay::Confirm(Ask::Abort) => {
            let scanned = format!("{} % of reachable floor scanned.", coverage::shares(&model.live.run).0);
            vec!["End mission for good? Enter: end, Esc: cancel.".into(), scanned]
        }
        Overlay::Confirm(Ask::Swap(choice)) => {
            let next = text::fit(&choice.id, 18);
            let question = format!("Change planner to {next}? Enter: change, Esc: cancel.");
            vec![question, "No motion yet.".into()]
        }
        Overlay::Stepping => {
            let tick_s = model.live.run.about.as_ref().map_or(0.0, |run| run.mission.tick_s);
            vec![
                "Step? Enter or .: one tick, }: lane, ]: event, Esc: end.".into(),
                format!("{} s per step.", text::number(tick_s, 2)),
            ]
        }
        Overlay::Quit => quit(model),
        _ => return None,
    };
    Some(clauses)
}

fn quit(model: &Model) -> Vec<String> {
    if !model.live.is_under_way() {
        return vec!["Quit console? Enter: quit, Esc: stay.".into(), "No mission in progress.".into()];
    }
    let question = "Quit and abort mission? Enter: quit, Esc: stay held.".to_owned();
    let planning = model.live.busy.as_ref().map(|_| "Planning will be cancelled.".to_owned());
    std::iter::once(question).chain(planning).collect()
}
