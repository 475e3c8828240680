//! The question before a parameter is changed: the change, and its estimated effect.

use super::text;
use crate::model::setting::{Effect, Figures};
use crate::model::{Model, log::clock, parameter};
use mission::{ParamValue, Phase};

/// The clauses of the question. The first one contains the question and its keys.
pub(super) fn clauses(model: &Model, key: &str, value: &ParamValue) -> Vec<String> {
    let planner = model.planner();
    let change = parameter::change(planner, model.live.run.planning.choice.as_ref(), key, value);
    let default = parameter::find(planner, key)
        .map_or_else(String::new, |info| format!(" (default {})", parameter::default(&info.kind)));
    let when = match model.live.run.phase() {
        Phase::Running(_) => "It takes effect now.",
        Phase::Held(_) => "No motion yet.",
        Phase::Waiting | Phase::Ended(_) => "The planner makes a new plan.",
    };
    let effect = model.live.with_parameter(key, value).map(|changed| model.live.effect_of(&changed));
    let effect = effect.map_or_else(String::new, |effect| effect_of(&effect, model.live.waits()));
    vec![format!("Set {change}{default}? <accept>: set, <cancel>: cancel."), when.into(), effect]
}

/// The estimated effect, as sentences; before the start, the effect on the plan.
fn effect_of(effect: &Effect, is_plan: bool) -> String {
    let basis = if is_plan { "New plan" } else { "Forecast from here" };
    match effect {
        Effect::Computing(share) => {
            let share = share.map_or_else(String::new, |share| {
                format!(" {} %", text::number((100.0 * share).floor().clamp(0.0, 99.0), 0))
            });
            format!("Computing the effect{share}... <accept> sets it without.")
        }
        Effect::Unknown(why) => format!("Effect not known: {why}."),
        Effect::Known { now, then, remark } => {
            let remark = remark.as_ref().map_or_else(String::new, |remark| format!("; {remark}"));
            format!("{basis}: {}{remark}.", figures(now.as_ref(), then))
        }
    }
}

/// The figures with the change, each with the present one beside it.
fn figures(now: Option<&Figures>, then: &Figures) -> String {
    let beside = |figure: &dyn Fn(&Figures) -> String| match now {
        Some(now) => format!("{} (now {})", figure(then), figure(now)),
        None => figure(then),
    };
    let time = beside(&|figures| clock(figures.time_s));
    let length = beside(&|figures| format!("{} m", text::number(figures.length_m, 1)));
    let scanned = then.scanned.map(|_| {
        beside(&|figures| format!("{} %", figures.scanned.map_or_else(|| "-".into(), text::percent)))
    });
    let scanned = scanned.map_or_else(String::new, |scanned| format!(", scanned {scanned}"));
    format!("time {time}, path {length}{scanned}")
}
