//! Orders, notes and injected faults in words.

use super::station_text;
use crate::{
    order::{Check, CheckOutcome, Injection, Note, Noted, Order, RangeFault},
    phase::StepTo,
};
use world::Station;

pub(super) fn order_text(order: &Order, stations: &[Station]) -> String {
    match order {
        Order::Plan => "plan".into(),
        Order::StepTo(StepTo::LaneEnd) => "step to the end of the lane".into(),
        Order::StepTo(StepTo::Event) => "step to the next event".into(),
        Order::Start => "start".into(),
        Order::StartPlan(plan) => format!("start of plan {}", plan.short()),
        Order::NoteOutlooks(outlooks) => {
            let planners: Vec<&str> = outlooks.iter().map(|outlook| outlook.choice.id.as_str()).collect();
            format!("forecasts compared: {}", planners.join(", "))
        }
        Order::NoteChecks(checks) => checks_text(checks),
        Order::Hold => "hold".into(),
        Order::Resume => "resume".into(),
        Order::Step => "single step".into(),
        Order::FlyUncertified => "run uncertified plan".into(),
        Order::DriveBack => "drive back".into(),
        Order::Abort => "end mission".into(),
        Order::Terminate => "end mission, by a signal to the process".into(),
        Order::CheckPlanner => {
            "check the planners, ordered by the console: the process of one planner has ended".into()
        }
        Order::ChoosePlanner(choice) => format!("change planner to {}", choice.id),
        Order::Shadow(choice) => format!("run planner {} in shadow", choice.id),
        Order::Promote => "promote the planner in shadow".into(),
        Order::DropShadow => "end the shadow".into(),
        Order::TakePlan => "take the better plan".into(),
        Order::SetParameter { key, value } => format!("set {key} = {value}"),
        Order::DrawZone(_) => "draw no-go zone".into(),
        Order::Inject(injection) => injection_text(injection, stations),
        Order::UseStation { station, used, by } => {
            let word = if *used { "include" } else { "exclude" };
            format!("{word} {}{}", station_text(*station, stations), by_text(by.as_ref()))
        }
        Order::Note(note) => note_text(note),
    }
}

fn checks_text(checks: &[Check]) -> String {
    let count = |outcome| checks.iter().filter(|check| check.outcome == outcome).count();
    let parts = [
        (CheckOutcome::Passed, "ok"),
        (CheckOutcome::Ticked, "by hand"),
        (CheckOutcome::Warning, "with a warning"),
        (CheckOutcome::Failed, "failed"),
    ];
    let parts = parts.map(|(outcome, word)| (count(outcome), word));
    let parts = parts.iter().filter(|(n, _)| *n > 0).map(|(n, word)| format!("{n} {word}"));
    format!("pre-flight: {}", parts.collect::<Vec<_>>().join(", "))
}

/// The end of a sentence that names the person who acted: ` by NAME`, or nothing.
fn by_text(by: Option<&String>) -> String {
    by.map_or_else(String::new, |name| format!(" by {name}"))
}

fn note_text(Note { what, by }: &Note) -> String {
    let by = by_text(by.as_ref());
    match what {
        Noted::Acknowledged { text, .. } => format!("alarm acknowledged{by}: {text}"),
        Noted::Shelved { text, for_s, reason, .. } => {
            format!("alarm shelved{by} for {} min ({reason}): {text}", (for_s / 6.0).round() / 10.0)
        }
        Noted::Unshelved { text, .. } => format!("alarm unshelved{by}: {text}"),
        Noted::PresetTaken { preset, planner } => format!("preset {preset} of {planner} taken{by}"),
    }
}

fn injection_text(Injection { station, fault, for_s, by }: &Injection, stations: &[Station]) -> String {
    let fault = match fault {
        RangeFault::Dead => "dead".to_owned(),
        RangeFault::Offset(metres) => format!("ranges {metres} m too long"),
    };
    let by = by_text(by.as_ref());
    format!("fault injected{by}: {} {fault} for {for_s} s", station_text(*station, stations))
}
