//! The line that says what comes next and whether anybody is needed.

use super::{events, text};
use crate::model::{Model, Phase};
use crate::theme::Role;
use mission::{Order, Outcome, Severity, event::HoldReason};

/// What comes next, and how the line looks.
pub(super) fn sentence(model: &Model) -> (Role, String) {
    if let Some(notice) = model.notice() {
        let role =
            if notice.severity == Severity::Info { Role::Title } else { events::role(notice.severity) };
        return (role, notice.text.clone());
    }
    if let Some(silent_s) = model.silent_s().filter(|_| model.console.busy.is_none()) {
        let text = format!(
            "◌ No news from the mission for {} s: values are old. space asks for HOLD.",
            silent_s as u64
        );
        return (Role::Stale, text);
    }
    if model.console.hold_asked {
        return (Role::Hold, "HOLD is on its way.".into());
    }
    if let Some(work) = &model.console.busy {
        return (Role::Watch, format!("BUSY: {work}. space holds as soon as it is done."));
    }
    match (&model.console.asked, &model.phase) {
        (Some(Order::Start), _) => (Role::Title, "The start is on its way.".into()),
        (Some(_), _) => (Role::Title, "The order is on its way.".into()),
        (None, Phase::Idle) => idle(model),
        (None, Phase::Running) => running(model),
        (None, Phase::Held(by)) => held(model, by),
        (None, Phase::Ended { outcome: Outcome::Complete, reason }) => {
            (Role::Good, format!("DONE: {reason}. Nothing moves any more. q leaves."))
        }
        (None, Phase::Ended { outcome, reason }) => {
            (Role::Warn, format!("ENDED {}: {reason}. q leaves.", outcome.word()))
        }
    }
}

fn idle(model: &Model) -> (Role, String) {
    match (&model.run, model.planner_id()) {
        (None, _) => (Role::Title, "NEXT: the scenario is being read.".into()),
        (Some(_), id) => {
            let who = id.unwrap_or("the planner");
            (Role::Title, format!("NEXT: S asks to start with {who}. Nothing moves before you agree."))
        }
    }
}

fn running(model: &Model) -> (Role, String) {
    if model.position.lost {
        let hold_s = model.run.as_ref().map_or(0.0, |run| run.mission.lost_hold_s);
        let text =
            format!("POSITION LOST: the robot holds by itself after {} s of it.", text::number(hold_s, 1));
        return (Role::Crit, text);
    }
    if let Some(alarm) =
        model.alarms.worst().filter(|alarm| !alarm.acknowledged && alarm.severity >= Severity::Warn)
    {
        return (events::role(alarm.severity), format!("a acknowledges: {}", alarm.text));
    }
    let Some(progress) = &model.progress else {
        return (Role::Title, "NEXT: the first step. Nothing needs you now.".into());
    };
    let at = format!("{}, {} m", text::number(progress.target.x, 2), text::number(progress.target.y, 2));
    let done = text::percent(progress.done);
    (Role::Title, format!("NEXT: to {at}; {done} % of the task done. Nothing needs you now."))
}

fn held(model: &Model, by: &HoldReason) -> (Role, String) {
    let text = match by {
        HoldReason::Operator | HoldReason::Stepped if model.position.lost => {
            "HELD by you; the position is lost. Going on needs a fix first.".into()
        }
        HoldReason::Operator => "HELD by you. space asks to go on, P changes the planner.".into(),
        HoldReason::Stepped => "HELD after a step. space asks to go on.".into(),
        HoldReason::PositionLost => {
            "HELD, position lost. Goes on by itself when regained; space keeps it held.".into()
        }
        HoldReason::Stuck { message } => {
            format!("HELD, stuck. P changes the planner, space tries again. {message}")
        }
        HoldReason::PlannerFault { message } if model.has_fallback() => {
            format!("HELD, planner failed. The fallback takes over if it can. {message}")
        }
        HoldReason::PlannerFault { message } => {
            format!("HELD, planner failed. P chooses another, space tries again. {message}")
        }
    };
    (Role::Hold, text)
}
