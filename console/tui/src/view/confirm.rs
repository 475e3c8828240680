//! The line above the keys: a question if one is open, else what comes next.

use super::next::{self, Clauses};
use super::{Look, coverage, text};
use crate::model::{Model, Overlay, ui::Ask};
use crate::theme::Role;
use mission::Phase;
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
    let planner = model.planner_id().unwrap_or("the planner");
    let clauses = match &model.ui.overlay {
        Overlay::Confirm(Ask::Start) => {
            ["START? Enter starts, Esc does not.".into(), format!("The robot moves, driven by {planner}.")]
        }
        Overlay::Confirm(Ask::Resume) => [
            "RESUME? Enter resumes, Esc stays held.".into(),
            format!("The robot moves, driven by {planner}."),
        ],
        Overlay::Confirm(Ask::FlyUncertified) => [
            "FLY WITHOUT CERTIFICATE? Enter flies, Esc stays held.".into(),
            "The cable may stay out; so fly all later plans.".into(),
        ],
        Overlay::Confirm(Ask::Abort) => {
            let scanned = format!("{} % of reachable floor scanned.", coverage::shares(model).0);
            ["END HERE? Enter ends it for good, Esc does not.".into(), scanned]
        }
        Overlay::Confirm(Ask::Swap(choice)) => {
            let next = text::fit(&choice.id, 18);
            [format!("CHANGE TO {next}? Enter changes, Esc does not."), "Nothing moves yet.".into()]
        }
        Overlay::Stepping => {
            let tick_s = model.run.as_ref().map_or(0.0, |run| run.mission.tick_s);
            [
                "STEP? Enter or . moves, Esc ends.".into(),
                format!("One tick of {} s each time.", text::number(tick_s, 2)),
            ]
        }
        Overlay::Quit => match model.phase() {
            _ if model.console.busy.is_some() => [
                "LEAVE? Enter leaves, Esc stays.".into(),
                "Planning will be cancelled and the mission ended.".into(),
            ],
            Phase::Waiting | Phase::Ended(_) => {
                ["LEAVE? Enter leaves, Esc stays.".into(), "Nothing is under way.".into()]
            }
            _ => ["LEAVE? Enter leaves, Esc stays, held.".into(), "The mission ends here as aborted.".into()],
        },
        Overlay::Filter => {
            let typed = text::fit(&model.ui.needle, 20);
            [format!("EVENTS WITH: {typed}_"), " Enter keeps the filter, Esc clears it.".into()]
        }
        _ => return None,
    };
    Some(clauses.into())
}
