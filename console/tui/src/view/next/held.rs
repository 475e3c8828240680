//! The reason, the place and the end of a hold.

use crate::model::Model;
use crate::view::text;
use mission::{Hold, HoldReason, Phase, PositionTrust, Resumes};

/// The reason for the hold, then its end.
pub(super) fn clauses(model: &Model, Hold { by, resumes }: &Hold) -> Vec<String> {
    let position = model.live.run.standing.standing().position;
    let clauses = match trouble(position) {
        _ if !resumes.is_never() => held_for_now(by, *resumes),
        Some(trouble) => held_without_position(by, trouble),
        None => held_for_good(by),
    };
    clauses.into_iter().chain(message(by)).collect()
}

/// The problem with the position, and the condition for moving again.
fn trouble(position: PositionTrust) -> Option<(&'static str, &'static str)> {
    match position {
        PositionTrust::Good => None,
        PositionTrust::Lost { .. } => Some(("position lost", "Cannot resume without a position fix.")),
        PositionTrust::Alarmed => {
            Some(("ranges contradict each other", "Cannot resume without a consistent fix."))
        }
    }
}

/// A hold that ends automatically. The first two clauses fit into 60 columns, so that no operator is surprised by a robot
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
    const RESUME: &str = "<resume>: resume.";
    const RETRY: &str = "<resume>: retry.";
    const PLANNER: &str = "<planner>: change planner.";
    let (state, remedies): (&str, &[&str]) = match by {
        // The reason for the hold is gone.
        HoldReason::PositionLost => ("HELD: position recovered", &[RESUME]),
        HoldReason::RangesInconsistent => ("HELD: ranges agree again", &[RESUME]),
        HoldReason::Stepped => (state(by), &[RESUME]),
        HoldReason::Operator | HoldReason::PlannerReplaced | HoldReason::PlannerSilent { .. } => {
            (state(by), &[RESUME, PLANNER])
        }
        HoldReason::Tether { .. }
        | HoldReason::ZoneBreached { .. }
        | HoldReason::Vehicle { .. }
        | HoldReason::Guard { .. } => (state(by), &[RESUME, "<end>: end mission."]),
        HoldReason::PlanRefused { .. } => (state(by), &[PLANNER, "<run-uncertified>: run it."]),
        HoldReason::PlannerFault { .. } | HoldReason::Stuck { .. } => (state(by), &[PLANNER, RETRY]),
    };
    std::iter::once(format!("{state}.")).chain(remedies.iter().map(|remedy| (*remedy).to_owned())).collect()
}

/// The reason for the hold, without a full stop.
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
        HoldReason::ZoneBreached { .. } => "HELD: hull in a no-go zone",
        HoldReason::Vehicle { .. } => "HELD: vehicle cannot be driven",
        HoldReason::Guard { .. } => "HELD by the guard",
        HoldReason::PlannerSilent { .. } => "HELD: planner silent",
        HoldReason::PlannerFault { .. } => "HELD: planner failed",
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
        | HoldReason::Vehicle { message }
        | HoldReason::Guard { message } => Some(format!("{}.", text::capitalized(message))),
        _ => None,
    }
}

/// Where a held robot is and how far its mission has come, from the longest wording to the shortest.
pub(super) fn whereabouts(model: &Model) -> Vec<String> {
    let run = &model.live.run;
    if !matches!(run.phase(), Phase::Held(_)) || model.live.asked.is_some() || model.live.is_cut_off {
        return Vec::new();
    }
    let Some(pose) = run.position.pose else { return Vec::new() };
    let at = format!(" at {}", text::place(pose.position));
    let done =
        run.progress.as_ref().map(|progress| format!(", {} % done", text::number(100.0 * progress.done, 0)));
    match done {
        Some(done) => vec![format!("{at}{done}"), done],
        None => vec![at],
    }
}
