//! The lines above the keys: the state with the next steps, which is always visible, and below it the open question or
//! input line.

use super::field::field;
use super::lists::place_cursor;
use super::look::Look;
use super::next::{self, Clauses};
use super::{coverage, setting, survey, text};
use crate::guide;
use crate::model::ui::{Ask, Shelving};
use crate::model::zone_draft::Form;
use crate::model::{LineEdit, Model, Offer, Overlay, Shadow, Speed, log::clock};
use crate::theme::Role;
use crate::update::zones;
use mission::{Hold, HoldReason, Phase, PlannerChoice, WayBack};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;
use ratatui::widgets::Paragraph;
use world::beside_limit;

/// A clearance that is smaller than the required one by less than this counts as kept, metres: lengths on a grid are rounded.
const CLEARANCE_SLACK_M: f64 = 0.005;
/// The rows of the screen that an open question leaves: the top line, a row of the screen, the state and the keys.
const OTHER_ROWS: usize = 4;

/// The rows of the lines: one for the state, and as many as the open question needs.
pub(super) fn rows(model: &Model, columns: u16) -> u16 {
    let is_typed = matches!(model.ui.overlay, Overlay::Filter(_) | Overlay::Shelve(_) | Overlay::Bookmark(_));
    1 + u16::from(is_typed) + question_lines(model, columns).len() as u16
}

/// The open question in as many lines as it needs: an operator who answers a question must be able to read all of it. On a
/// terminal that is too small even for that, the last line ends in an ellipsis.
fn question_lines(model: &Model, columns: u16) -> Vec<String> {
    // The ways to end the mission are in a list.
    let is_list = matches!(model.ui.overlay, Overlay::Finish { .. });
    let Some(clauses) = asked(model).filter(|_| !is_list) else { return Vec::new() };
    let columns = usize::from(columns).saturating_sub(2);
    let most = usize::from(model.ui.height).saturating_sub(OTHER_ROWS).max(1);
    text::first_lines(text::wrap(&clauses.join(" "), columns), most, columns)
}

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let [state, below] = Layout::vertical([Constraint::Length(1), Constraint::Fill(1)]).areas(area);
    let (role, clauses) = next::clauses(look.model);
    let columns = usize::from(area.width).saturating_sub(1);
    let text = next::line(look.model, &clauses, columns.saturating_sub(1));
    frame.render_widget(Line::from(vec![look.span(Role::Text, " "), look.span(role, text)]), state);
    match &look.model.ui.overlay {
        Overlay::Filter(line) => filter(look, frame, below, line),
        Overlay::Shelve(shelving) => {
            let prompt = (" Shelve (minutes, reason): ", &shelving.line);
            typed(look, frame, below, prompt, &shelve(look.model, shelving));
        }
        Overlay::Bookmark(line) => {
            let keys = look.keys("  <accept>: set, <cancel>: cancel.");
            typed(look, frame, below, (" Bookmark: ", line), &keys);
        }
        _ => {
            let asked = |line: String| text::column(&line, columns);
            let lines = question_lines(look.model, area.width).into_iter();
            let lines = lines.map(|line| look.line([(Role::Text, " ".into()), (Role::Confirm, asked(line))]));
            frame.render_widget(Paragraph::new(lines.collect::<Vec<Line>>()), below);
        }
    }
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

/// The clauses of the open question or, if no question is open, of the next steps.
pub(super) fn clauses(model: &Model) -> Clauses {
    asked(model).map_or_else(|| next::clauses(model), |clauses| (Role::Confirm, clauses))
}

/// The open question, with the keys that answer it, but without the progress of its estimate.
pub(crate) fn question(model: &Model) -> Option<String> {
    asked_with(model, false).map(|clauses| clauses.join(" "))
}

/// The clauses of the open question. The first one contains the question and its keys, and is never left out.
fn asked(model: &Model) -> Option<Vec<String>> {
    asked_with(model, true)
}

/// What may happen to a robot that resumes in a no-go zone, and what is safer.
const IN_ZONE: &str = "The HULL IS IN A NO-GO ZONE: the robot drives in the zone and may get stuck there. Safer: <cancel>, then \
                       <return> drives back.";

/// What a resumption leads to if the task is done.
const ONLY_PULSES: &str = "The task is done: the robot stands still until the last pulse test has come.";

/// The warning before a robot with a torn tether moves.
const TETHER_BROKEN: &str = "The TETHER IS BROKEN: its rest lies on the floor, and the robot may drive over it. Safer: <cancel>, \
                             then fetch the robot by hand, or <return> drives back beside the tether.";

/// The warning before a robot with a slack tether takes up its task again.
const TETHER_SLACK: &str = "The TETHER IS SLACK: if its reel does not work, the robot may drive over it. Safer: <cancel>, check \
                            the reel, or <return> drives back beside the tether.";

/// The question whether to run a plan without a certificate, with the reason for which it was refused.
fn uncertified(phase: &Phase) -> Vec<String> {
    let question = "Run uncertified plan? <accept>: run, <cancel>: stay held.".into();
    let refused = match phase {
        Phase::Held(Hold { by: HoldReason::PlanRefused { message }, .. }) => {
            Some(format!("{}.", text::capitalized(message)))
        }
        _ => None,
    };
    [question, "The robot will move.".into()]
        .into_iter()
        .chain(refused)
        .chain(["Applies to later plans too, until planning fails.".into()])
        .collect()
}

/// The question whether to resume, its warnings, and what follows.
fn resumption(model: &Model) -> Vec<String> {
    let question = "Resume? The robot will move. <accept>: resume, <cancel>: cancel.".into();
    let in_zone = model.live.run.is_in_zone().then(|| IN_ZONE.to_owned());
    let torn = model.live.run.is_tether_broken().then(|| TETHER_BROKEN.to_owned());
    let slack = model.live.run.is_tether_slack().then(|| TETHER_SLACK.to_owned());
    let speed = model.live.speed;
    let fast = (speed != Speed::Times(1.0)).then(|| format!("Speed {}.", text::speed(speed)));
    let first = std::iter::once(question).chain(fast).chain(torn.or(slack)).chain(in_zone);
    let is_done = model.live.run.position.pulses_until_s.is_some();
    let goes_on = if is_done { (ONLY_PULSES.into(), None) } else { (moves(model), continues(model)) };
    first.chain([goes_on.0]).chain(goes_on.1).collect()
}

/// The clauses of the open question, with or without the progress of its estimate.
fn asked_with(model: &Model, has_progress: bool) -> Option<Vec<String>> {
    let clauses = match &model.ui.overlay {
        Overlay::Confirm(Ask::Start(_)) => {
            let speed = text::speed(model.live.speed);
            vec![
                format!("Start ({speed})? <accept>: start, <cancel>: cancel."),
                format!("The robot will move: {}.", promised(model)),
            ]
            .into_iter()
            .chain(stands(model))
            .chain(begins(model))
            .collect()
        }
        Overlay::Confirm(Ask::Resume) => resumption(model),
        Overlay::Confirm(Ask::FlyUncertified) => uncertified(model.live.run.phase()),
        Overlay::Confirm(Ask::Swap(choice)) => {
            let next = text::fit(&choice.id, 18);
            let question = match (choice.parameters.len(), model.live.run.planner_id()) {
                (n @ 1.., Some(id)) if id == choice.id => {
                    let set = text::counted(n, "set parameter");
                    format!("Restart {next} with {set}? <accept>: restart, <cancel>: cancel.")
                }
                _ => format!("Change to {next}? <accept>: change, <cancel>: cancel."),
            };
            let effect = effect(model, Some(choice), has_progress);
            [question, "No motion yet.".into()].into_iter().chain(effect).collect()
        }
        Overlay::Finish { selected: 0 } => {
            let done = survey::sentence(model);
            let scanned = done.unwrap_or_else(|| coverage::Bases::of(&model.live).sentence());
            vec!["End the mission here? <accept>: end, <cancel>: stay held.".into(), scanned]
        }
        Overlay::Finish { .. } | Overlay::Confirm(Ask::DriveBack) => {
            let way = match &model.live.way_back {
                Some(Ok(way)) => format!("{}. The mission ends there.", finish_way(model, way)),
                _ => "Looking for a way back...".into(),
            };
            vec![
                "Drive back? <accept>: drive back, <cancel>: stay held.".into(),
                "The robot will move.".into(),
                way,
            ]
        }
        Overlay::Confirm(Ask::DrawZone(_)) => {
            vec!["Close this floor? <accept>: close, <cancel>: cancel.".into(), zone_cost(model)]
        }
        Overlay::ZoneDraft(draft) => {
            let drawn = zones::drawn_words(model).into_iter();
            let by_mouse = model.ui.mouse.then(|| "Mouse: drag.".into());
            std::iter::once(drawing(draft.form)).chain(drawn).chain(by_mouse).collect()
        }
        Overlay::Confirm(Ask::Set { key, value, .. }) => setting::clauses(model, key, value, has_progress),
        Overlay::Confirm(Ask::Promote) => {
            let shadow = model.live.run.shadow.as_ref();
            let next = text::fit(shadow.map_or("-", |shadow| &shadow.choice.id), 18);
            let driving = model.live.run.planner_id().unwrap_or("-");
            vec![
                format!("Promote {next} from shadow? <accept>: promote, <cancel>: cancel."),
                if model.live.run.is_running() {
                    format!("It takes over from {driving} without a hold.")
                } else {
                    format!("It takes over from {driving}; the robot stays held.")
                },
                shadow.map_or_else(String::new, |shadow| shadows_plan(model, shadow)),
            ]
            .into_iter()
            .chain(effect(model, shadow.map(|shadow| &shadow.choice), has_progress))
            .collect()
        }
        Overlay::Confirm(Ask::TakePlan) => {
            let offer = model.live.run.planning.offer.as_ref();
            let saves = offer.map_or_else(|| "-".into(), Offer::sentence);
            let begins = offer.and_then(|offer| offer.begins).map_or_else(|| "-".into(), text::place);
            vec![
                "Take the better plan? <accept>: take, <cancel>: cancel.".into(),
                format!("{saves}. {}", offer.and_then(Offer::scanned).unwrap_or_default())
                    .trim_end()
                    .to_owned(),
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

/// The forecast effect of a change of planner during a mission, as sentences. Before the start, the change itself shows
/// the plan.
fn effect(model: &Model, choice: Option<&PlannerChoice>, has_progress: bool) -> Vec<String> {
    let choice = choice.filter(|_| !model.live.waits());
    choice.map_or_else(Vec::new, |choice| setting::effect(model, choice, has_progress))
}

/// The plan of the planner in shadow, as sentences: its length, and what the tether demands of it.
fn shadows_plan(model: &Model, shadow: &Shadow) -> String {
    let length = match (shadow.path.is_empty(), shadow.complete) {
        (true, _) => "It drives step by step, without a path.".to_owned(),
        (false, true) => {
            format!("Its plan: {} m for the rest of the task.", text::number(shadow.length_m, 1))
        }
        (false, false) => format!("Its plan: {} m, PARTIAL.", text::number(shadow.length_m, 1)),
    };
    let has_tether = model.live.run.about.as_ref().is_some_and(|about| about.mission.tether.is_some());
    let certificate = if has_tether {
        " Its certificate for the tether is made at the promotion; without one, it stays in shadow."
    } else {
        ""
    };
    format!("{length}{certificate}")
}

/// The length and clearance of a way back: `To the anchor, 5.5 m, clearance 0.12 m`. A clearance below the required one says
/// so.
pub(super) fn finish_way(model: &Model, way: &WayBack) -> String {
    let required_m = model.live.run.about.as_ref().map(|about| about.mission.clearance_m);
    let [clearance, required] = beside_limit(way.clearance_m, required_m.unwrap_or(f64::NAN), 2);
    let is_below = required_m.is_some_and(|required_m| way.clearance_m + CLEARANCE_SLACK_M < required_m);
    let clearance = if is_below {
        format!("clearance {clearance} m, BELOW the required {required} m")
    } else {
        format!("clearance {} m", text::number(way.clearance_m, 2))
    };
    let length = text::number(way.length_m, 1);
    let beside = if way.slack_m.is_some() { ", slowly beside the tether on the floor" } else { "" };
    format!("To the {}, {length} m, {clearance}{beside}", way.to.word())
}

/// Where the robot must stand before a re-scan, as a sentence; `None` if it was left there.
fn stands(model: &Model) -> Option<String> {
    Some(format!("The robot {}.", model.must_stand()?))
}

/// Where a plan for a part of the floor begins to scan, and what it scans besides: of a re-scan, for the second time. As a
/// sentence; `None` for a plan for the whole floor.
pub(super) fn begins(model: &Model) -> Option<String> {
    let resumption = model.live.left_out()?.resumption?;
    let (at, again_m2) = (text::place(resumption.at), text::number(resumption.again_m2, 1));
    let after_m = text::number(resumption.after_m, 1);
    let place = if after_m == "0.0" { "the start".to_owned() } else { format!("{at}, after {after_m} m") };
    Some(if model.live.is_rescan() {
        format!("The scan resumes at {place}; {again_m2} m² are scanned a second time.")
    } else {
        format!("The scan begins at {place}; {again_m2} m² that were not requested are scanned, too.")
    })
}

/// Who drives a robot that resumes, and along which plan, as a sentence.
fn moves(model: &Model) -> String {
    let run = &model.live.run;
    if run.is_survey() {
        return "The survey chooses its way again.".into();
    }
    let planning = &run.planning;
    let planner = text::fit(run.planner_id().unwrap_or("unknown"), 18);
    let plan = planning.plan.as_ref();
    let replans = matches!(run.phase(), Phase::Held(hold) if matches!(hold.by, HoldReason::Tether { .. }));
    if planning.candidate.is_some() {
        return format!("{planner} drives on along its plan until the new planner has a plan.");
    }
    let plans_first = replans || planning.fault.is_some() || model.live.busy.is_some();
    match plan.filter(|_| !plans_first) {
        None => format!("{planner} plans first; then the robot moves."),
        Some(plan) if plan.path.is_empty() => format!("{planner} drives step by step, without a path."),
        Some(plan) => {
            let done = run.progress.as_ref().map_or(0.0, |progress| progress.done);
            let at = run.position.pose.map(|pose| pose.position);
            let rest_m = at.map_or(plan.length_m, |at| plan.rest_m(at, done));
            format!("{planner} drives the plan on the map, {} m left.", text::number(rest_m, 1))
        }
    }
}

/// The next target of a held robot, as a sentence.
fn continues(model: &Model) -> Option<String> {
    let progress = model.live.run.progress.as_ref()?;
    Some(format!("Next target {} (×).", text::place(progress.target)))
}

/// What the zone in the question costs, as sentences.
fn zone_cost(model: &Model) -> String {
    let Some(cost) = model.live.zone_cost else { return "Computing its cost...".into() };
    let path = match text::number(cost.path_m, 1) {
        zero if zero == "0.0" => "It blocks none of the plan.".to_owned(),
        path_m => format!("It blocks {path_m} m of the plan; the robot replans."),
    };
    let [closed, lost] = [cost.closed_m2, cost.lost_m2].map(|area_m2| text::number(area_m2, 2));
    let held = if cost.holds { "The hull is in it: HOLD at once, if it still is. " } else { "" };
    let offer = if cost.drops_offer { " The better plan is dropped." } else { "" };
    let back = if cost.blocks_way_back { "It blocks the way back along the tether. " } else { "" };
    format!(
        "{held}{back}{path} It closes {closed} m² of reachable floor, {lost} m² of which is not scanned yet.{offer} \
         The zone stays closed for the rest of the mission."
    )
}

/// The next point of a zone that is being drawn, with the keys.
fn drawing(form: Form) -> String {
    match form {
        Form::Box => "No-go box: opposite corner, then <accept>. <drawn-form>: circle, <cancel>: cancel.",
        Form::Circle => "No-go circle: edge, then <accept>. <drawn-form>: polygon, <cancel>: cancel.",
        Form::Polygon => "No-go polygon: <accept>: set a corner, <drawn-close>: close, <drawn-form>: box, <cancel>: cancel.",
    }
    .into()
}

/// The plan to be started, as the end of a sentence: its length, time and planner, and whether it is certified for the
/// tether.
pub(super) fn promised(model: &Model) -> String {
    if model.live.run.is_survey() {
        return "a survey, which chooses its ways itself; time not known".into();
    }
    let time = model
        .live
        .estimate()
        .map_or_else(|| "time not known yet".to_owned(), |estimate| clock(estimate.time_s));
    let length = match &model.live.run.planning.plan {
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
    format!("{length} (planner {planner}), {certificate}")
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
