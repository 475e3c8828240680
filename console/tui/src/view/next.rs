//! The line that tells what comes next and whether the operator is needed.

use super::{events, text};
use crate::model::{Busy, Model, Replay, Screen};
use crate::theme::Role;
use mission::{Hold, HoldReason, Outcome, Phase, PositionTrust, Readiness, Resumes, Severity};

/// The role of the line, and its clauses, most important first.
pub(super) type Clauses = (Role, Vec<String>);

/// What comes next, with the operator's keys.
pub(super) fn clauses(model: &Model) -> Clauses {
    let (role, mut clauses) = by_phase(model);
    if model.live.is_look_only() {
        clauses.retain(|clause| !clause.contains(['<', '>']));
        clauses.push(match &model.live.replay {
            Some(replay) => played(model, replay),
            None => "VIEW: orders are given on the console that runs the mission.".into(),
        });
    }
    (role, clauses.iter().map(|clause| model.console.keys.spelled(clause)).collect())
}

/// The line for a replay, with the key that plays or pauses.
fn played(model: &Model, replay: &Replay) -> String {
    let next = match (model.live.is_opening, replay.is_playing) {
        (true, _) => "reading the run...",
        (false, true) => "<hold>: pause.",
        (false, false) => "<hold>: play.",
    };
    format!("Past run, no robot connected; {next}")
}

fn by_phase(model: &Model) -> Clauses {
    if let Some(silent_s) = model.silent_s() {
        let news = format!("◌ No data from the mission for {} s: values are stale.", silent_s as u64);
        return (Role::Stale, vec![news, "<hold>: HOLD.".into()]);
    }
    if model.live.hold_asked && model.live.may_move() {
        return (Role::Hold, vec!["HOLD requested...".into()]);
    }
    let work = model.live.busy.as_ref().map(|busy| work(model, busy));
    match (&model.live.asked, model.live.run.phase()) {
        (Some(order), _) if order.is_start() => (Role::Title, vec!["Starting...".into()]),
        (Some(_), _) => (Role::Title, vec!["Order sent...".into()]),
        (None, Phase::Held(hold)) => {
            let mut clauses = held(model, hold);
            // The warning that the robot will move automatically comes before the work of a planner.
            let at = if hold.resumes.is_never() { 1 } else { 2 }.min(clauses.len());
            clauses.splice(at..at, work.into_iter().flatten());
            (Role::Hold, clauses)
        }
        (None, Phase::Waiting) if model.ui.screen == Screen::Home => (
            Role::Title,
            vec!["<accept> opens a scenario and makes its plan.".into(), "The robot does not move.".into()],
        ),
        (None, Phase::Waiting) => {
            let (role, start) = idle(model);
            (role, work.into_iter().flatten().chain(start).collect())
        }
        (None, Phase::Running(_)) => match work {
            Some(work) => {
                let stop = ["<hold>: HOLD.", "<end>: end mission."].map(str::to_owned);
                (Role::Watch, work.into_iter().chain(stop).collect())
            }
            None => running(model),
        },
        (None, Phase::Ended(Outcome::Complete)) => {
            (Role::Good, vec![format!("DONE: {}.", model.live.run.end_reason), more(model)])
        }
        (None, Phase::Ended(outcome)) => (
            Role::Warn,
            vec![format!("ENDED ({}): {}.", outcome.word(), model.live.run.end_reason), more(model)],
        ),
    }
}

/// What comes next, without the figures that keep changing.
pub(crate) fn standing(model: &Model) -> String {
    if let Some(busy) = &model.live.busy {
        return format!("{}.", busy.work);
    }
    if model.live.run.is_running() {
        return "Mission running.".into();
    }
    clauses(model).1.join(" ")
}

/// The keys for what can be done after a mission has ended.
fn more(model: &Model) -> String {
    match model.ui.screen {
        Screen::Result => "<again>: plan again, <rescan>: re-scan, <home>: home.",
        _ => "<result>: result. <home>: home.",
    }
    .into()
}

/// A planner's work: its progress, elapsed time, limit and current activity.
fn work(model: &Model, busy: &Busy) -> Vec<String> {
    let passed_s = (model.console.now.mono_s - busy.since_mono_s).max(0.0) as u64;
    let time = |limit_s: f64| format!(", {passed_s} s (limit {} s)", limit_s as u64);
    let first = format!("{}{}.", busy.how_far(), busy.limit_s.map_or_else(String::new, time));
    let what = busy
        .at
        .iter()
        .filter(|(_, what)| !what.is_empty())
        .map(|(_, what)| format!("{}.", text::capitalized(what)));
    std::iter::once(first).chain(what).collect()
}

/// As many clauses as fit into a given width; the first one is cut if necessary.
pub(super) fn joined(clauses: &[String], columns: usize) -> String {
    let mut line = clauses.first().map_or_else(String::new, |first| text::fit(first, columns));
    for clause in clauses.iter().skip(1) {
        if text::width(&line) + 1 + text::width(clause) <= columns {
            line.push(' ');
            line.push_str(clause);
        }
    }
    line
}

fn idle(model: &Model) -> Clauses {
    if model.live.failure.is_some() {
        return (Role::Warn, vec!["The scenario cannot be opened.".into(), "<home>: choose another.".into()]);
    }
    if model.live.run.about.is_none() {
        return (Role::Title, vec!["Loading scenario...".into()]);
    }
    if model.live.preflight.is_starting {
        return (Role::Title, vec!["Checking before the start...".into()]);
    }
    let is_opened = model.planner().is_some() || model.live.run.planning.fault.is_some();
    let is_preparing = match model.live.run.standing.standing().readiness {
        Readiness::Preparing => true,
        // The plan is requested as soon as the run is open.
        Readiness::NoPlan => !is_opened,
        _ => false,
    };
    if model.live.busy.is_some() || is_preparing {
        return (Role::Title, vec!["Start when the plan is ready.".into()]);
    }
    let preflight = "<preflight>: pre-flight check.";
    // A planner that is still being opened does not block the start yet.
    if let Some(failed) = model.blocking_check().filter(|_| is_opened) {
        let (what, why) =
            (format!("Start blocked: {}.", failed.what), format!("{}.", text::capitalized(&failed.found)));
        return (Role::Warn, vec![what, why, preflight.into()]);
    }
    let who = model.live.run.planner_id().unwrap_or("unknown");
    (Role::Title, vec![format!("Press <start> to start (planner {who})."), preflight.into()])
}

fn running(model: &Model) -> Clauses {
    if model.live.run.position.lost {
        let hold_s = model.live.run.about.as_ref().map_or(0.0, |run| run.mission.position_lost_hold_s);
        let text = format!("POSITION LOST: automatic HOLD after {} s.", text::number(hold_s, 1));
        return (Role::Crit, vec![text]);
    }
    let open = model
        .live
        .run
        .alarms
        .worst()
        .filter(|alarm| alarm.is_unacknowledged() && alarm.severity >= Severity::Warn);
    if let Some(alarm) = open {
        let over = if alarm.is_active() { "" } else { " (cleared)" };
        return (
            events::role(alarm.severity),
            vec![format!("<acknowledge>: acknowledge{over}: {}", alarm.text)],
        );
    }
    let calm = "No action required.".to_owned();
    let Some(progress) = &model.live.run.progress else {
        return (Role::Title, vec!["Waiting for first command.".into(), calm]);
    };
    let (at, done) = (text::place(progress.target), text::percent(progress.done));
    (Role::Title, vec![format!("Next target: {at}; path {done} % done."), calm])
}

/// Why the robot is held, then what ends the hold.
fn held(model: &Model, Hold { by, resumes }: &Hold) -> Vec<String> {
    let position = model.live.run.standing.standing().position;
    let clauses = match trouble(position) {
        _ if !resumes.is_never() => held_for_now(by, *resumes),
        Some(trouble) => held_without_position(by, trouble),
        None => held_for_good(by),
    };
    clauses.into_iter().chain(message(by)).collect()
}

/// What is wrong with the position, and what is needed before the robot may move again.
fn trouble(position: PositionTrust) -> Option<(&'static str, &'static str)> {
    match position {
        PositionTrust::Good => None,
        PositionTrust::Lost { .. } => Some(("position lost", "Cannot resume without a position fix.")),
        PositionTrust::Alarmed => {
            Some(("ranges contradict each other", "Cannot resume without a consistent fix."))
        }
    }
}

/// A hold that ends automatically. The first two clauses fit into 60 columns, so that nobody is surprised by a robot
/// that starts to move.
fn held_for_now(by: &HoldReason, resumes: Resumes) -> Vec<String> {
    let when = match (resumes, by) {
        (Resumes::ByFallback, _) => "Resumes with fallback planner.",
        (_, HoldReason::PositionLost) => "Resumes automatically when recovered.",
        (_, HoldReason::Tether { .. }) => "Resumes automatically when clear.",
        (_, HoldReason::PlannerSilent { .. }) => "Resumes automatically on answer.",
        _ => "Resumes automatically.",
    };
    vec![format!("{}.", state(by)), when.into(), "<hold>: HOLD (stay held).".into()]
}

/// A hold that only an order can end, while the mission accepts no order that moves the robot.
fn held_without_position(by: &HoldReason, (trouble, needs): (&str, &str)) -> Vec<String> {
    let state = match by {
        HoldReason::PositionLost | HoldReason::RangesInconsistent => format!("HELD: {trouble}."),
        by => format!("{}; {trouble}.", state(by)),
    };
    let planner = by.blames_planner().then(|| "<planner>: change planner.".to_owned());
    [state, needs.into()].into_iter().chain(planner).collect()
}

/// A hold that only an order can end.
fn held_for_good(by: &HoldReason) -> Vec<String> {
    const RESUME: &str = "<hold>: resume.";
    const RETRY: &str = "<hold>: retry.";
    const PLANNER: &str = "<planner>: change planner.";
    let (state, remedies): (&str, &[&str]) = match by {
        // The reason for the hold is gone.
        HoldReason::PositionLost => ("HELD: position recovered", &[RESUME]),
        HoldReason::RangesInconsistent => ("HELD: ranges agree again", &[RESUME]),
        HoldReason::Stepped => (state(by), &[RESUME]),
        HoldReason::Operator | HoldReason::PlannerReplaced | HoldReason::PlannerSilent { .. } => {
            (state(by), &[RESUME, PLANNER])
        }
        HoldReason::Tether { .. } | HoldReason::Vehicle { .. } => {
            (state(by), &[RESUME, "<end>: end mission."])
        }
        HoldReason::PlanRefused { .. } => (state(by), &[PLANNER, ":fly-uncertified runs it."]),
        HoldReason::PlannerFault { .. } | HoldReason::Stuck { .. } => (state(by), &[PLANNER, RETRY]),
    };
    std::iter::once(format!("{state}.")).chain(remedies.iter().map(|remedy| (*remedy).to_owned())).collect()
}

/// Why the robot is held, without a closing full stop.
fn state(by: &HoldReason) -> &'static str {
    match by {
        HoldReason::Operator => "HELD by operator",
        HoldReason::Stepped => "HELD after single step",
        HoldReason::PlannerReplaced => "HELD: planner replaced",
        HoldReason::RangesInconsistent => "HELD: ranges contradict each other",
        HoldReason::PositionLost => "HELD: position lost",
        HoldReason::Stuck { .. } => "HELD: robot stuck",
        HoldReason::Tether { .. } => "HELD: tether alarm",
        HoldReason::PlanRefused { .. } => "HELD: plan refused",
        HoldReason::PlannerSilent { .. } => "HELD: planner silent",
        HoldReason::PlannerFault { .. } => "HELD: planner failed",
        HoldReason::Vehicle { .. } => "HELD: vehicle",
    }
}

/// More about the hold, shown if there is space.
fn message(by: &HoldReason) -> Option<String> {
    match by {
        HoldReason::PlannerFault { message }
        | HoldReason::PlannerSilent { message }
        | HoldReason::Stuck { message }
        | HoldReason::Tether { message }
        | HoldReason::PlanRefused { message }
        | HoldReason::Vehicle { message } => Some(format!("{}.", text::capitalized(message))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clauses_that_do_not_fit_are_left_out_whole() {
        let clauses = ["HELD by operator.", "space: resume.", "P."].map(str::to_owned);
        assert_eq!(joined(&clauses, 40), "HELD by operator. space: resume. P.");
        assert_eq!(joined(&clauses, 20), "HELD by operator. P.");
        assert_eq!(joined(&clauses, 8), "HELD by…");
    }
}
