//! The line above the keys: a question if one is open, else what comes next.

use super::look::Look;
use super::next::{self, Clauses};
use super::{coverage, text};
use crate::guide;
use crate::model::ui::{Ask, Shelving};
use crate::model::{Model, Overlay, Screen};
use crate::theme::Role;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let (role, clauses) = clauses(look.model);
    let columns = usize::from(area.width).saturating_sub(1);
    let text = next::joined(&clauses, columns.saturating_sub(1));
    let text = if role == Role::Confirm { text::column(&text, columns) } else { text };
    frame.render_widget(Line::from(vec![look.span(Role::Text, " "), look.span(role, text)]), area);
}

/// The question that is open, or what comes next.
pub(super) fn clauses(model: &Model) -> Clauses {
    question(model).map_or_else(|| next::clauses(model), |clauses| (Role::Confirm, clauses))
}

/// What is asked and which keys answer come in the first clause: they are never left out.
fn question(model: &Model) -> Option<Vec<String>> {
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
        Overlay::Filter if model.ui.screen == Screen::Events => filtering(model),
        Overlay::Shelve(shelving) => shelve(model, shelving),
        Overlay::Filter => {
            let typed = text::fit(&model.ui.needle, 20);
            vec![format!("Filter events: {typed}_"), " Enter: keep, Esc: clear.".into()]
        }
        _ => return None,
    };
    Some(clauses)
}

/// What is wrong with the filter that is being typed, or what can be typed; the text itself is in the pane.
fn filtering(model: &Model) -> Vec<String> {
    let keys = "Enter: keep, Esc: clear.".to_owned();
    let separates = if model.live.may_move() { "; separates terms (space: HOLD)." } else { "" };
    match model.ui.events.matches.filter().problems.first() {
        Some(problem) => vec![format!("Filter: {}.", problem.why), keys],
        None => vec![
            keys,
            separates.into(),
            "Terms: sev>=watch source=ae station=C t>00:05 \"text\" -text".into(),
        ],
    }
}

fn shelve(model: &Model, shelving: &Shelving) -> Vec<String> {
    let name = guide::name(&shelving.cause, &model.live.run);
    let typed = format!("Shelve for minutes, reason: {}_", shelving.text);
    match &shelving.refusal {
        Some(why) => vec![format!("{typed} REFUSED: {why}"), "Esc: cancel.".into()],
        None => vec![typed, "Enter: shelve, Esc: cancel.".into(), format!("({name})")],
    }
}

fn quit(model: &Model) -> Vec<String> {
    if !model.live.is_under_way() {
        return vec!["Quit console? Enter: quit, Esc: stay.".into(), "No mission in progress.".into()];
    }
    let question = "Quit and abort mission? Enter: quit, Esc: stay held.".to_owned();
    let planning = model.live.busy.as_ref().map(|_| "Planning will be cancelled.".to_owned());
    std::iter::once(question).chain(planning).collect()
}
