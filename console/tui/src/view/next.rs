//! The line that says what comes next and whether anybody is needed.

use super::{events, text};
use crate::model::{Busy, Model, Phase};
use crate::theme::Role;
use mission::{Order, Outcome, Severity, event::HoldReason};

/// How a line looks, and its clauses, the most important one first.
pub(super) type Clauses = (Role, Vec<String>);

/// What comes next.
pub(super) fn clauses(model: &Model) -> Clauses {
    if let Some(notice) = model.notice() {
        let role =
            if notice.severity == Severity::Info { Role::Title } else { events::role(notice.severity) };
        return (role, vec![notice.text.clone()]);
    }
    if let Some(silent_s) = model.silent_s().filter(|_| model.console.busy.is_none()) {
        let news = format!("◌ No news from the mission for {} s: values are old.", silent_s as u64);
        return (Role::Stale, vec![news, "space asks for HOLD.".into()]);
    }
    if model.console.hold_asked {
        let mut told = vec!["HOLD is on its way.".into()];
        told.extend(model.console.busy.iter().flat_map(|busy| waits_for(model, busy)));
        return (Role::Hold, told);
    }
    if let Some(work) = &model.console.busy {
        let mut told = waits_for(model, work);
        told.extend(["space holds when it is done.".into(), "X, q stop it.".into()]);
        return (Role::Watch, told);
    }
    match (&model.console.asked, &model.phase) {
        (Some(Order::Start), _) => (Role::Title, vec!["The start is on its way.".into()]),
        (Some(_), _) => (Role::Title, vec!["The order is on its way.".into()]),
        (None, Phase::Idle) => idle(model),
        (None, Phase::Running) => running(model),
        (None, Phase::Held(by)) => (Role::Hold, held(model, by)),
        (None, Phase::Ended { outcome: Outcome::Complete, reason }) => (
            Role::Good,
            vec![format!("DONE: {reason}."), "Nothing moves any more.".into(), "q leaves.".into()],
        ),
        (None, Phase::Ended { outcome, reason }) => {
            (Role::Warn, vec![format!("ENDED {}: {reason}.", outcome.word()), "q leaves.".into()])
        }
    }
}

/// What the engine is busy with and how far, for how long already and at most, and what it is doing.
fn waits_for(model: &Model, busy: &Busy) -> Vec<String> {
    let passed_s = (model.console.now.mono_s - busy.since_mono_s).max(0.0) as u64;
    // Only the end makes it whole.
    let percent = |share: f64| format!(", {} %", (100.0 * share).floor().clamp(0.0, 99.0));
    let share = busy.at.as_ref().map_or_else(String::new, |(share, _)| percent(*share));
    let time = |within_s: f64| format!(", {passed_s} s of {} s at most", within_s as u64);
    let first = format!("BUSY: {}{share}{}.", busy.work, busy.within_s.map_or_else(String::new, time));
    let what = busy.at.iter().filter(|(_, what)| !what.is_empty()).map(|(_, what)| format!("{what}."));
    std::iter::once(first).chain(what).collect()
}

/// As many clauses as fit into some columns; the first one is cut if need be.
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
    if model.run.is_none() {
        return (Role::Title, vec!["NEXT: the scenario is being read.".into()]);
    }
    let who = model.planner_id().unwrap_or("the planner");
    (
        Role::Title,
        vec![format!("NEXT: S asks to start with {who}."), "Nothing moves before you agree.".into()],
    )
}

fn running(model: &Model) -> Clauses {
    if model.position.lost {
        let hold_s = model.run.as_ref().map_or(0.0, |run| run.mission.lost_hold_s);
        let text = format!("POSITION LOST: the robot holds by itself after {} s.", text::number(hold_s, 1));
        return (Role::Crit, vec![text]);
    }
    let open = model.alarms.worst().filter(|alarm| !alarm.acknowledged && alarm.severity >= Severity::Warn);
    if let Some(alarm) = open {
        let over = if alarm.active { "" } else { " (over by now)" };
        return (events::role(alarm.severity), vec![format!("a acknowledges{over}: {}", alarm.text)]);
    }
    let calm = "Nothing needs you now.".to_owned();
    let Some(progress) = &model.progress else {
        return (Role::Title, vec!["NEXT: the first step.".into(), calm]);
    };
    let at = format!("{}, {} m", text::number(progress.target.x, 2), text::number(progress.target.y, 2));
    let done = text::percent(progress.done);
    (Role::Title, vec![format!("NEXT: to {at}; task {done} % done."), calm])
}

fn held(model: &Model, by: &HoldReason) -> Vec<String> {
    let clauses: &[&str] = match by {
        HoldReason::Operator | HoldReason::Stepped if model.position.lost => {
            &["HELD by you; the position is lost.", "Going on needs a fix first."]
        }
        HoldReason::Operator => &["HELD by you.", "space asks to go on.", "P changes the planner."],
        HoldReason::Stepped => &["HELD after a step.", "space asks to go on."],
        HoldReason::PositionAlarmed => &[
            "HELD, ranges contradict each other.",
            "Goes on by itself when they agree.",
            "space keeps it held.",
        ],
        HoldReason::PositionLost => {
            &["HELD, position lost.", "Goes on by itself when regained.", "space keeps it held."]
        }
        HoldReason::Stuck { message } => {
            &["HELD, stuck.", "P changes the planner.", "space tries again.", message]
        }
        HoldReason::Tether { message } => {
            &["HELD, tether.", "space goes on; a scan eases the cable first.", "X ends here.", message]
        }
        HoldReason::PlanRefused { message } if model.has_fallback() => {
            &["HELD, plan refused.", "The fallback takes over if it can.", message]
        }
        HoldReason::PlanRefused { message } => {
            &["HELD, plan refused.", "P chooses another.", ":fly-uncertified flies it.", message]
        }
        HoldReason::PlannerFault { message } if model.has_fallback() => {
            &["HELD, planner failed.", "The fallback takes over if it can.", message]
        }
        HoldReason::PlannerFault { message } => {
            &["HELD, planner failed.", "P chooses another.", "space tries again.", message]
        }
    };
    clauses.iter().map(|clause| (*clause).to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clauses_that_do_not_fit_are_left_out_whole() {
        let clauses = ["HELD by you.", "space asks to go on.", "P."].map(str::to_owned);
        assert_eq!(joined(&clauses, 40), "HELD by you. space asks to go on. P.");
        assert_eq!(joined(&clauses, 20), "HELD by you. P.");
        assert_eq!(joined(&clauses, 8), "HELD by…");
    }
}
