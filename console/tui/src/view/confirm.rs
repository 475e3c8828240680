//! The line above the keys: a question if one is open, else what comes next.

use super::{Look, coverage, next, text};
use crate::model::{Model, Overlay, Phase, ui::Ask};
use crate::theme::Role;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let (role, sentence) = line(look.model);
    let columns = usize::from(area.width).saturating_sub(1);
    let text = text::fit(&sentence, columns.saturating_sub(1));
    let text = if role == Role::Confirm { text::column(&text, columns) } else { text };
    frame.render_widget(Line::from(vec![look.span(Role::Text, " "), look.span(role, text)]), area);
}

/// The question that is open, or what comes next.
pub(super) fn line(model: &Model) -> (Role, String) {
    match question(model) {
        Some(question) => (Role::Confirm, question),
        None => next::sentence(model),
    }
}

fn question(model: &Model) -> Option<String> {
    let planner = model.planner_id().unwrap_or("the planner");
    match &model.ui.overlay {
        Overlay::Confirm(Ask::Start) => {
            Some(format!("START? The robot moves, driven by {planner}. Enter starts, Esc does not."))
        }
        Overlay::Confirm(Ask::Resume) => {
            Some(format!("RESUME? The robot moves again, driven by {planner}. Enter resumes, Esc stays."))
        }
        Overlay::Confirm(Ask::Abort) => {
            let scanned = coverage::shares(model).0;
            Some(format!(
                "END here, {scanned} % of reachable floor scanned? Enter ends it for good, Esc not."
            ))
        }
        Overlay::Confirm(Ask::Swap(choice)) => Some(format!(
            "CHANGE PLANNER? {} instead of {planner}; nothing moves yet. Enter / Esc",
            choice.id
        )),
        Overlay::Stepping => {
            let tick_s = model.run.as_ref().map_or(0.0, |run| run.mission.tick_s);
            let tick = text::number(tick_s, 2);
            Some(format!("STEP? Enter or . moves for one tick of {tick} s, again and again. Esc ends."))
        }
        Overlay::Quit => Some(match model.phase {
            Phase::Idle | Phase::Ended { .. } => {
                "LEAVE? Nothing is under way. Enter leaves, Esc stays.".into()
            }
            _ => "LEAVE? It ends the mission here as aborted. Enter leaves, Esc stays, held.".into(),
        }),
        Overlay::Filter => {
            Some(format!("EVENTS WITH: {}_  Enter keeps the filter, Esc clears it.", model.ui.needle))
        }
        _ => None,
    }
}
