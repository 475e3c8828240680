//! The lines about planners: the active one, better plans, and the one in shadow.

use super::{LogLine, line, tether::of_tether};
use crate::event::{EventKind, OfferStage, PlanDropped, PlanMade, PlanTaken, severity::Severity};
use planner_api::LogLevel;

pub(super) fn of_planner(kind: &EventKind) -> Option<LogLine> {
    Some(match kind {
        EventKind::PlannerChosen { choice, info, from, .. } => {
            let before = match from {
                Some(id) if *id == choice.id => ", restarted".to_owned(),
                Some(id) => format!(", took over from {id}"),
                None => String::new(),
            };
            line(Severity::Info, "plan", format!("planner {} {} active{before}", choice.id, info.version))
        }
        EventKind::ParametersChanged { choice, .. } => {
            line(Severity::Info, "plan", format!("parameters of {} changed", choice.id))
        }
        EventKind::Planned { planner, length_m, complete, .. } => {
            let part = if *complete { "" } else { " (partial)" };
            line(Severity::Info, "plan", format!("{planner} planned {length_m:.1} m{part}"))
        }
        EventKind::PlannerLogged { planner, level, message } => match level {
            LogLevel::Debug => line(Severity::Debug, "plan", format!("{planner}: {message}")),
            LogLevel::Info => line(Severity::Info, "plan", format!("{planner}: {message}")),
            LogLevel::Warn => line(Severity::Watch, "plan", format!("{planner}: {message}")),
        },
        EventKind::PlannerPrepared { choice, info, .. } => {
            line(Severity::Info, "plan", format!("preparing planner {} {}", choice.id, info.version))
        }
        EventKind::PlannerRejected { planner, why } => {
            line(Severity::Warn, "plan", format!("planner {planner} will not take over: {why}"))
        }
        EventKind::PlannerLate { planner, ticks } => {
            line(Severity::Watch, "plan", late_text(planner, *ticks))
        }
        EventKind::PlannerFailed { fault, .. } => line(fault.severity(), "plan", fault.message.clone()),
        _ => return None,
    })
}

pub(super) fn of_better_plan(kind: &EventKind) -> Option<LogLine> {
    Some(match kind {
        EventKind::BetterPlanned(PlanMade { planner, flown, better, objection: None, .. }) => {
            let text = format!("better plan of {planner}: {}", better.saving(flown));
            line(Severity::Watch, "plan", text)
        }
        EventKind::BetterPlanned(PlanMade { planner, objection: Some(why), .. }) => {
            line(Severity::Info, "plan", format!("{planner} replanned: {why}; the current plan is kept"))
        }
        EventKind::BetterPlanTaken(PlanTaken { planner, flown, better }) => {
            let text = format!("better plan of {planner} taken: {}", better.saving(flown));
            line(Severity::Info, "plan", text)
        }
        EventKind::BetterPlanDropped(PlanDropped { planner, why, stage, .. }) => match stage {
            None => line(Severity::Info, "plan", format!("better plan of {planner} dropped: {why}")),
            Some(OfferStage::Offered) => line(Severity::Info, "plan", format!("offer ended: {why}")),
            Some(OfferStage::Accepted) => {
                line(Severity::Watch, "plan", format!("accepted better plan dropped: {why}"))
            }
        },
        _ => return None,
    })
}

pub(super) fn of_shadow(kind: &EventKind) -> Option<LogLine> {
    Some(match kind {
        EventKind::ShadowBegan { choice, info, .. } => {
            line(Severity::Info, "plan", format!("planner {} {} runs in shadow", choice.id, info.version))
        }
        // Faults in shadow require no action by the operator, because a different planner is active.
        EventKind::Shadowed { of } => {
            let LogLine { severity, source, text } = match &**of {
                EventKind::Certified { .. } => of_tether(of)?,
                other => of_planner(other)?,
            };
            line(severity.min(Severity::Watch), source, format!("shadow: {text}"))
        }
        EventKind::ShadowMissed { ticks, .. } => {
            line(Severity::Info, "plan", format!("shadow: {} missed", ticks_text(*ticks)))
        }
        EventKind::PromotionRefused { planner, why } => {
            line(Severity::Warn, "plan", format!("planner {planner} stays in shadow: {why}"))
        }
        EventKind::Promoted { planner, tally } => {
            let (answered, missed) = (tally.answered, ticks_text(tally.missed));
            let text =
                format!("planner {planner} promoted from shadow: {answered} steps answered, {missed} missed");
            line(Severity::Info, "plan", text)
        }
        EventKind::ShadowEnded { planner, why } => {
            line(Severity::Watch, "plan", format!("planner {planner} no longer runs in shadow: {why}"))
        }
        _ => return None,
    })
}

/// How late a planner answered, as a phrase without a full stop.
pub fn late_text(planner: &str, ticks: u64) -> String {
    format!("planner {planner} was late; the robot waited {}", ticks_text(ticks))
}

fn ticks_text(ticks: u64) -> String {
    if ticks == 1 { "1 tick".into() } else { format!("{ticks} ticks") }
}
