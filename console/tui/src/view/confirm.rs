//! The line above the keys: the open question, otherwise what comes next.

use super::field::field;
use super::lists::place_cursor;
use super::look::Look;
use super::next::{self, Clauses};
use super::{coverage, text};
use crate::guide;
use crate::model::ui::{Ask, Shelving};
use crate::model::{LineEdit, Model, Overlay, log::clock};
use crate::theme::Role;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

/// Maximum rows of the question before the start.
const MOST_ROWS: usize = 3;

/// The rows of the line: more than one only for what must not be overlooked before the robot first moves.
pub(super) fn rows(look: &Look, columns: u16) -> u16 {
    whole_question(look.model, columns).map_or(1, |lines| lines.len() as u16)
}

/// The full question before the start, in as many lines as it needs.
fn whole_question(model: &Model, columns: u16) -> Option<Vec<String>> {
    let is_start = matches!(model.ui.overlay, Overlay::Confirm(Ask::Start(_)));
    let clauses = asked(model).filter(|_| is_start)?;
    let mut lines = text::wrap(&clauses.join(" "), usize::from(columns).saturating_sub(2));
    lines.truncate(MOST_ROWS);
    Some(lines)
}

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    if let Some(lines) = whole_question(look.model, area.width).filter(|_| area.height > 1) {
        let columns = usize::from(area.width).saturating_sub(1);
        let asked = |line: String| text::column(&line, columns);
        let lines =
            lines.into_iter().map(|line| look.line([(Role::Text, " ".into()), (Role::Confirm, asked(line))]));
        return frame.render_widget(Paragraph::new(lines.collect::<Vec<Line>>()), area);
    }
    if let Overlay::Filter(line) = &look.model.ui.overlay {
        return filter(look, frame, area, line);
    }
    if let Overlay::Shelve(shelving) = &look.model.ui.overlay {
        return typed(
            look,
            frame,
            area,
            (" Shelve (minutes, reason): ", &shelving.line),
            &shelve(look.model, shelving),
        );
    }
    if let Overlay::Bookmark(line) = &look.model.ui.overlay {
        return typed(
            look,
            frame,
            area,
            (" Bookmark: ", line),
            &look.keys("  <accept>: set, <cancel>: cancel."),
        );
    }
    let (role, clauses) = clauses(look.model);
    let columns = usize::from(area.width).saturating_sub(1);
    let text = next::joined(&clauses, columns.saturating_sub(1));
    let text = if role == Role::Confirm { text::column(&text, columns) } else { text };
    frame.render_widget(Line::from(vec![look.span(Role::Text, " "), look.span(role, text)]), area);
}

/// Draws the filter input line with its error and the keys that close it.
fn filter(look: &Look, frame: &mut Frame, area: Rect, line: &LineEdit) {
    let problem = look.model.ui.events.matches.filter().problems.first();
    let problem = problem
        .filter(|_| look.model.ui.screen.row().filter.is_none())
        .map(|problem| format!("  {}.", problem.why));
    typed(
        look,
        frame,
        area,
        (" Filter: ", line),
        &(problem.unwrap_or_default() + &look.keys("  <accept>: keep, <cancel>: clear.")),
    );
}

/// Draws an input line with its cursor between a prompt and a note.
fn typed(look: &Look, frame: &mut Frame, area: Rect, (prompt, line): (&str, &LineEdit), after: &str) {
    let columns = usize::from(area.width).saturating_sub(1);
    let room = columns.saturating_sub(text::width(prompt) + text::width(after)).max(columns / 3);
    let shown = field(line, room);
    let typed = text::column(&format!("{prompt}{}{after}", shown.text), columns);
    frame.render_widget(Line::from(vec![look.span(Role::Text, " "), look.span(Role::Confirm, typed)]), area);
    place_cursor(frame, area, (1 + text::width(prompt) + shown.cursor, 0));
}

/// The open question, otherwise what comes next.
pub(super) fn clauses(model: &Model) -> Clauses {
    asked(model).map_or_else(|| next::clauses(model), |clauses| (Role::Confirm, clauses))
}

/// The open question, with the keys that answer it.
pub(crate) fn question(model: &Model) -> Option<String> {
    asked(model).map(|clauses| clauses.join(" "))
}

/// The clauses of the open question. The first one contains the question and its keys, and is never left out.
fn asked(model: &Model) -> Option<Vec<String>> {
    let moves =
        || format!("The robot will move (planner {}).", model.live.run.planner_id().unwrap_or("unknown"));
    let clauses = match &model.ui.overlay {
        Overlay::Confirm(Ask::Start(_)) => {
            let speed = text::speed(model.live.speed);
            vec![format!("Start ({speed})? <accept>: start, <cancel>: cancel."), promised(model)]
        }
        Overlay::Confirm(Ask::Resume) => {
            vec!["Resume? <accept>: resume, <cancel>: stay held.".into(), moves()]
        }
        Overlay::Confirm(Ask::FlyUncertified) => vec![
            "Run uncertified plan? <accept>: run, <cancel>: stay held.".into(),
            "Tether may stay out after return.".into(),
            "Applies to later plans too, until planning fails.".into(),
        ],
        Overlay::Confirm(Ask::Abort) => {
            let scanned = format!("{} % of reachable floor scanned.", coverage::shares(&model.live.run).0);
            vec!["End the mission? It cannot be resumed. <accept>: end, <cancel>: cancel.".into(), scanned]
        }
        Overlay::Confirm(Ask::Swap(choice)) => {
            let next = text::fit(&choice.id, 18);
            let question = match (choice.parameters.len(), model.live.run.planner_id()) {
                (n @ 1.., Some(id)) if id == choice.id => {
                    format!("Restart {next} with {n} parameters set? <accept>: change, <cancel>: cancel.")
                }
                _ => format!("Change planner to {next}? <accept>: change, <cancel>: cancel."),
            };
            vec![question, "No motion yet.".into()]
        }
        Overlay::Confirm(Ask::Promote) => {
            let shadow = model.live.run.shadow.as_ref();
            let next = text::fit(shadow.map_or("-", |shadow| &shadow.choice.id), 18);
            let driving = model.live.run.planner_id().unwrap_or("-");
            vec![
                format!("Promote {next} from shadow? <accept>: promote, <cancel>: cancel."),
                format!("It takes over from {driving} without a hold."),
            ]
        }
        Overlay::Confirm(Ask::TakePlan) => {
            let offer = model.live.run.planning.offer.as_ref();
            let saves = offer.map_or_else(|| "-".into(), |offer| offer.better.saving(&offer.flown));
            let begins = offer.and_then(|offer| offer.begins).map_or_else(|| "-".into(), text::place);
            vec![
                "Take the better plan? <accept>: take, <cancel>: cancel.".into(),
                format!("It saves {saves}."),
                format!("It begins at {begins}, without a hold."),
            ]
        }
        Overlay::Stepping => {
            let tick_s = model.live.run.about.as_ref().map_or(0.0, |run| run.mission.tick_s);
            vec![
                "Step? <accept> or <step>: one tick, <step-lane>: lane, <step-event>: event, <cancel>: end."
                    .into(),
                format!("{} s per step.", text::number(tick_s, 2)),
            ]
        }
        Overlay::Quit => quit(model),
        _ => return None,
    };
    Some(clauses.iter().map(|clause| model.console.keys.spelled(clause)).collect())
}

/// What starts: the length and the time of the plan, its planner, and whether it is certified for the tether.
fn promised(model: &Model) -> String {
    let time =
        model.live.estimate().map_or_else(|| "time unknown".to_owned(), |estimate| clock(estimate.time_s));
    let way = match &model.live.run.planning.plan {
        Some(plan) if plan.path.is_empty() => "step by step, no path planned".to_owned(),
        Some(plan) => format!("{} m, {time}", text::number(plan.length_m, 1)),
        None => "no plan yet".into(),
    };
    let has_tether = model.live.run.about.as_ref().is_some_and(|about| about.mission.tether.is_some());
    let certificate = match model.live.run.tether.as_ref().and_then(|tether| tether.certified) {
        _ if !has_tether => "no tether",
        Some(true) => "certified",
        Some(false) | None => "NOT certified for the tether",
    };
    let planner = text::fit(model.live.run.planner_id().unwrap_or("unknown"), 18);
    format!("The robot will move: {way} (planner {planner}), {certificate}.")
}

/// The note after the input line in which an alarm is shelved.
fn shelve(model: &Model, shelving: &Shelving) -> String {
    let keys = model.console.keys.spelled("<accept>: shelve, <cancel>: cancel.");
    match &shelving.refusal {
        Some(why) => format!("  REFUSED: {why}"),
        None => format!("  ({}) {keys}", guide::name(&shelving.cause, &model.live.run)),
    }
}

fn quit(model: &Model) -> Vec<String> {
    if !model.live.is_under_way() {
        return vec![
            "Quit console? <accept>: quit, <cancel>: stay.".into(),
            "No mission in progress.".into(),
        ];
    }
    let question = "Quit and abort mission? <accept>: quit, <cancel>: stay held.".to_owned();
    let planning = model.live.busy.as_ref().map(|_| "Planning will be cancelled.".to_owned());
    std::iter::once(question).chain(planning).collect()
}
