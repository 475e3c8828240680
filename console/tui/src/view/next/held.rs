//! The reason, the place and the end of a hold.

use crate::model::{Model, Run};
use crate::view::text;
use mission::{Hold, HoldReason, Phase, PositionTrust, Resumes};
use vehicle::port::{LinkSeen, LinkState};

/// The reason for the hold, then its end.
pub(super) fn clauses(model: &Model, Hold { by, resumes }: &Hold) -> Vec<String> {
    let run = &model.live.run;
    let head = head(run);
    let position = run.standing.standing().position;
    let fault = run.planning.fault.as_ref().filter(|_| resumes.is_never() && !by.blames_planner());
    let undrivable = run.vehicle.as_ref().and_then(|vehicle| undrivable(head, by, &vehicle.link));
    let is_drivable = undrivable.is_none();
    let mut clauses = undrivable.unwrap_or_else(|| match (trouble(position), fault) {
        _ if !resumes.is_never() => {
            let mut clauses = held_for_now(head, by, *resumes);
            let ends_t_s = run.vehicle.as_ref().and_then(|vehicle| vehicle.waits_until_s);
            // The key for HOLD is among the keys, too.
            clauses.splice(
                2..2,
                ends_t_s.map(|t_s| format!("Otherwise, it ends at T+{}.", mission::clock(t_s))),
            );
            clauses
        }
        (Some(trouble), _) => held_without_position(head, by, trouble),
        (None, Some(fault)) => held_without_planner(head, by, &fault.message),
        (None, None) if run.is_in_zone() => held_in_zone(head, by),
        (None, None) if run.is_tether_broken() => held_by_break(head, by),
        (None, None) => held_for_good(head, by),
    });
    if run.position.pulses_until_s.is_some() {
        clauses.insert(1, "Task done; only the last pulse test is missing.".into());
    }
    if head == Head::NotConfirmed {
        clauses.insert(1, if is_drivable { MAY_MOVE } else { MAY_MOVE_SHORT }.into());
    }
    // After a search without a way back, the state line does not offer the drive back.
    let has_no_way = matches!(model.live.way_back, Some(Err(_)));
    clauses.retain(|clause| !(has_no_way && clause.starts_with("<return>")));
    clauses.into_iter().chain(message(by).filter(|_| is_drivable)).collect()
}

/// Advice for a robot whose stop is not confirmed.
const MAY_MOVE: &str = "The robot may move: use its emergency stop.";
/// The same after a state that names the vehicle, so that the condition for resuming fits beside it.
const MAY_MOVE_SHORT: &str = "It may move: use its emergency stop.";

/// The number of clauses before which nothing else is shown: the state, the advice if the robot may move, and the warning
/// that it will move automatically.
pub(super) fn leading(model: &Model, hold: &Hold) -> usize {
    1 + usize::from(head(&model.live.run) == Head::NotConfirmed) + usize::from(!hold.resumes.is_never())
}

/// The first word of the state: whether the robot stands still.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Head {
    /// The robot stands still; in a live run, odometry has confirmed this.
    Held,
    /// The robot has been commanded to stop.
    Stopping,
    /// The robot should stand still, but odometry does not show that it does.
    NotConfirmed,
}

pub(super) fn head(run: &Run) -> Head {
    match run.vehicle.as_ref().map(|vehicle| vehicle.stands) {
        _ if !run.is_live() => Head::Held,
        Some(Some(true)) => Head::Held,
        Some(Some(false)) => Head::NotConfirmed,
        Some(None) | None => Head::Stopping,
    }
}

impl Head {
    /// The state with the reason for the hold, without a full stop.
    fn with(self, reason: &str) -> String {
        let word = match self {
            Self::Held => "HELD",
            Self::Stopping => "STOPPING",
            Self::NotConfirmed => "STOP NOT CONFIRMED",
        };
        format!("{word}{reason}")
    }
}

/// The state line for a vehicle that cannot be driven now, whatever the reason for the hold; `None` if the vehicle can
/// be driven.
fn undrivable(head: Head, by: &HoldReason, link: &LinkSeen) -> Option<Vec<String>> {
    let (what, needs) = match link.state {
        LinkState::Up => return None,
        LinkState::Lost => ("link to vehicle lost", "Cannot resume until the link is back."),
        LinkState::Closed => ("link to vehicle closed", "No resume: only a new run connects."),
        LinkState::Faulty => ("vehicle sends faulty messages", "Cannot resume until they are correct."),
        LinkState::Restarted => ("vehicle has restarted", "Cannot resume yet."),
        LinkState::OtherVehicle => ("another vehicle answers", "No resume: only a new run drives it."),
        LinkState::ConsoleStopped => ("console was stopped", "Cannot resume yet."),
        LinkState::Manual => ("vehicle is being driven by hand", "Cannot resume until it is released."),
        LinkState::EmergencyStop => ("emergency stop is pressed", "Cannot resume until it is released."),
        LinkState::OtherCommander => {
            ("vehicle obeys another console", "Cannot resume until that one has ended.")
        }
        LinkState::VehicleFault => ("vehicle reports a fault", "Cannot resume until the fault is gone."),
    };
    let state = match by {
        HoldReason::Vehicle { .. } => head.with(&format!(": {what}.")),
        by => head.with(&format!("{}; {what}.", reason(by))),
    };
    let why = (!link.why.is_empty()).then(|| format!("{}.", text::capitalized(&link.why)));
    Some([state, needs.into(), "<end>: end mission.".into()].into_iter().chain(why).collect())
}

/// A hold during which the planner has ended, too.
fn held_without_planner(head: Head, by: &HoldReason, fault: &str) -> Vec<String> {
    // The state and one key fit into 60 columns.
    let state = match by {
        HoldReason::PlannerReplaced => head.with(": new planner has failed."),
        HoldReason::Stepped => head.with(" after a step; planner has failed."),
        by => head.with(&format!("{}; planner has failed.", reason(by))),
    };
    vec![
        state,
        "<resume>: restart it and resume.".into(),
        "<planner>: change planner.".into(),
        format!("{}.", text::capitalized(fault)),
    ]
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
fn held_for_now(head: Head, by: &HoldReason, resumes: Resumes) -> Vec<String> {
    let when = match (resumes, by) {
        (Resumes::ByFallback, _) => "Resumes with fallback planner.",
        (_, HoldReason::PositionLost) => "Resumes automatically when recovered.",
        (_, HoldReason::Tether { .. }) => "Resumes automatically when clear.",
        (_, HoldReason::PlannerSilent { .. }) => "Resumes automatically on answer.",
        _ => "Resumes automatically.",
    };
    let reason = match by {
        HoldReason::Tether { message } => {
            let what = tether(message).0;
            format!(": {}", if text::width(what) <= TETHER_FOR_NOW { what } else { "tether alarm" })
        }
        by => reason(by),
    };
    vec![head.with(&format!("{reason}.")), when.into(), "<hold>: HOLD (stay held).".into()]
}

/// A hold that only an order can end, while the mission accepts no order that moves the robot.
fn held_without_position(head: Head, by: &HoldReason, (trouble, needs): (&str, &str)) -> Vec<String> {
    let state = match by {
        HoldReason::PositionLost | HoldReason::RangesInconsistent => head.with(&format!(": {trouble}.")),
        by => head.with(&format!("{}; {trouble}.", reason(by))),
    };
    let planner = by.blames_planner().then(|| "<planner>: change planner.".to_owned());
    [state, needs.into()].into_iter().chain(planner).collect()
}

/// A hold while the hull is in a no-go zone. A planner may find no way out, so the remedy is the drive back.
fn held_in_zone(head: Head, by: &HoldReason) -> Vec<String> {
    let state = match by {
        HoldReason::ZoneBreached { .. } => head.with(": hull in a no-go zone."),
        by => head.with(&format!("{}; hull in a no-go zone.", reason(by))),
    };
    vec![state, "<return>: drive back.".into(), "<end>: end mission.".into()]
}

/// A hold of a robot whose tether is torn, whatever the reason for the hold.
fn held_by_break(head: Head, by: &HoldReason) -> Vec<String> {
    let state = match by {
        HoldReason::Tether { message } if message.starts_with("tether broken") => {
            head.with(": tether broken.")
        }
        by => head.with(&format!("{}; tether broken.", reason(by))),
    };
    vec![state, "<end>: end mission.".into(), "<resume>: resume.".into(), "<return>: drive back.".into()]
}

/// A hold that only an order can end.
fn held_for_good(head: Head, by: &HoldReason) -> Vec<String> {
    const RESUME: &str = "<resume>: resume.";
    const RETRY: &str = "<resume>: retry.";
    const RETURN: &str = "<return>: drive back.";
    const PLANNER: &str = "<planner>: change planner.";
    let (reason, remedies): (String, &[&str]) = match by {
        // The reason for the hold is gone.
        HoldReason::PositionLost => (": position recovered".into(), &[RESUME]),
        HoldReason::RangesInconsistent => (": ranges agree again".into(), &[RESUME]),
        HoldReason::Vehicle { .. } => (": vehicle is ready again".into(), &[RESUME, "<end>: end mission."]),
        HoldReason::Stepped => (reason(by), &[RESUME]),
        HoldReason::Operator | HoldReason::PlannerReplaced | HoldReason::PlannerSilent { .. } => {
            (reason(by), &[RESUME, PLANNER])
        }
        HoldReason::ZoneBreached { .. } => {
            (": hull has left the zone".into(), &[RESUME, "<end>: end mission."])
        }
        HoldReason::Tether { message } if is_helped_by_return(message) => {
            (reason(by), &[RESUME, RETURN, "<end>: end mission."])
        }
        HoldReason::Tether { .. } | HoldReason::Guard { .. } => {
            (reason(by), &[RESUME, "<end>: end mission."])
        }
        HoldReason::PlanRefused { .. } => (reason(by), &[PLANNER, "<run-uncertified>: run it."]),
        HoldReason::PlannerFault { .. } | HoldReason::Stuck { .. } => (reason(by), &[PLANNER, RETRY]),
    };
    std::iter::once(head.with(&format!("{reason}.")))
        .chain(remedies.iter().map(|remedy| (*remedy).to_owned()))
        .collect()
}

/// Whether the drive back is a remedy for a hold by the tether: the tether is slack or caught, or lies in the way.
fn is_helped_by_return(message: &str) -> bool {
    const REASONS: [&str; 5] = [
        "reel does not take",
        "tether snagged",
        "hull about to reach",
        "the reel takes the tether up again",
        "more tether comes off",
    ];
    REASONS.iter().any(|reason| message.starts_with(reason))
}

/// Maximum width of the reason for a tether alarm, columns: with the word HELD and one key, it fits into 60 columns.
const TETHER: usize = 38;
/// The same for a hold that ends automatically, beside the sentence that says so.
const TETHER_FOR_NOW: usize = 16;

/// The alarm of a tether: what happened and where, then the figures.
fn tether(message: &str) -> (&str, Option<&str>) {
    let divided = message.split_once([',', ':', ';']);
    let (what, figures) = divided.map_or((message, None), |(what, rest)| (what, Some(rest.trim_start())));
    // An object that is not on the map has no name; the place of the robot says more.
    (what.strip_suffix(" on an unmapped object").unwrap_or(what), figures)
}

/// The reason for the hold, as it follows the word HELD, without a full stop.
fn reason(by: &HoldReason) -> String {
    let words = match by {
        HoldReason::Tether { message } => return format!(": {}", text::fit(tether(message).0, TETHER)),
        HoldReason::Operator => " by operator",
        HoldReason::Stepped => " after single step",
        HoldReason::PlannerReplaced => ": planner replaced",
        HoldReason::RangesInconsistent => ": ranges contradict each other",
        HoldReason::PositionLost => ": position lost",
        HoldReason::Stuck { .. } => ": robot stuck",
        HoldReason::PlanRefused { .. } => ": plan refused",
        HoldReason::ZoneBreached { .. } => ": hull in a no-go zone",
        HoldReason::Vehicle { .. } => ": vehicle cannot be driven",
        HoldReason::Guard { .. } => " by the guard",
        HoldReason::PlannerSilent { .. } => ": planner silent",
        HoldReason::PlannerFault { .. } => ": planner failed",
    };
    words.to_owned()
}

/// More about the hold, shown if there is space.
fn message(by: &HoldReason) -> Option<String> {
    match by {
        HoldReason::PlannerFault { message }
        | HoldReason::PlannerSilent { message }
        | HoldReason::Stuck { message }
        | HoldReason::PlanRefused { message }
        | HoldReason::Guard { message } => Some(format!("{}.", text::capitalized(message))),
        HoldReason::Tether { message } => {
            tether(message).1.map(|figures| format!("{}.", text::capitalized(figures)))
        }
        // What follows the semicolon was true only while the link was lost.
        HoldReason::Vehicle { message } => {
            Some(format!("It was held because {}.", message.split(';').next().unwrap_or(message)))
        }
        _ => None,
    }
}

/// Where a held robot is and how far its mission has come, from the longest wording to the shortest; they follow the
/// clause of the state.
pub(super) fn whereabouts(model: &Model, state: &str) -> Vec<String> {
    let run = &model.live.run;
    let Phase::Held(hold) = run.phase() else { return Vec::new() };
    if model.live.asked.is_some() || model.live.is_cut_off {
        return Vec::new();
    }
    let Some(pose) = run.position.pose else { return Vec::new() };
    // Only some reasons happen at the place of the robot. Behind a second clause, the place would seem to be that of the
    // clause.
    let is_here = !state.contains(';')
        && matches!(
            hold.by,
            HoldReason::Operator | HoldReason::Stepped | HoldReason::Stuck { .. } | HoldReason::Guard { .. }
        );
    let at = format!("{} {}", if is_here { " at" } else { "; robot at" }, text::place(pose.position));
    let done =
        run.progress.as_ref().map(|progress| format!(", {} % done", text::number(100.0 * progress.done, 0)));
    match done {
        // The place of a tether alarm matters more than the progress.
        Some(done) if matches!(hold.by, HoldReason::Tether { .. }) || run.is_tether_broken() => {
            vec![format!("{at}{done}"), at]
        }
        Some(done) => vec![format!("{at}{done}"), done],
        None => vec![at],
    }
}
