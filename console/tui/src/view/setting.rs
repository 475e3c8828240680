//! The question before a parameter is changed: the change, and its estimated effect.

use super::text;
use crate::model::setting::{Effect, Figures};
use crate::model::{Model, log::clock, parameter};
use mission::{ParamValue, Phase, PlannerChoice};

/// What follows from a change before the start.
const NEW_PLAN: &str = "The planner makes a new plan";

/// The clauses of the question, the most important first. The first one contains the question and its keys; the second
/// one is the effect that matters most. The progress of the estimate is left out on request.
pub(super) fn clauses(model: &Model, key: &str, value: &ParamValue, has_progress: bool) -> Vec<String> {
    let planner = model.planner();
    let change = parameter::change(planner, model.live.run.planning.choice.as_ref(), key, value);
    let default = parameter::find(planner, key)
        .map_or_else(String::new, |info| format!(" (default {})", parameter::default(&info.kind)));
    let changed = model.live.with_parameter(key, value);
    let mut clauses = changed.map_or_else(Vec::new, |changed| effect(model, &changed, has_progress));
    let when = match model.live.run.phase() {
        Phase::Running(_) => "It takes effect now.".into(),
        Phase::Held(_) => "No motion yet.".into(),
        Phase::Waiting | Phase::Ended(_) => format!("{NEW_PLAN}."),
    };
    // The effect on the plan already says that there will be a new one.
    if !clauses.first().is_some_and(|first| first.starts_with(NEW_PLAN)) {
        clauses.insert(1.min(clauses.len()), when);
    }
    clauses.insert(0, format!("Set {change}{default}? <accept>: set, <cancel>: cancel."));
    clauses
}

/// The estimated effect of running a planner with changed parameters, as sentences, the most important first. The progress
/// of the estimate is left out on request.
pub(super) fn effect(model: &Model, changed: &PlannerChoice, has_progress: bool) -> Vec<String> {
    let effect = match model.live.effect_of(changed) {
        Effect::Computing(_) if !has_progress => Effect::Computing(None),
        effect => effect,
    };
    let required_m = model.live.run.about.as_ref().map(|about| about.mission.clearance_m);
    let active = model.live.run.planner_id().filter(|id| *id != changed.id);
    let whose = active.map_or_else(|| "now ".to_owned(), |id| format!("{id}: "));
    effect_of(&effect, model.live.waits(), (required_m, &whose))
}

/// The estimated effect, as sentences; before the start, the effect on the plan. `required_m` is the clearance that the
/// scenario requires, metres; `whose` is put before the figures without the change.
fn effect_of(effect: &Effect, is_plan: bool, (required_m, whose): (Option<f64>, &str)) -> Vec<String> {
    let basis = if is_plan { NEW_PLAN } else { "Forecast from here" };
    match effect {
        Effect::Computing(share) => {
            let share = share.map_or_else(String::new, |share| {
                format!(" {} %", text::number((100.0 * share).floor().clamp(0.0, 99.0), 0))
            });
            vec![format!("Computing the effect{share}... <accept> does not wait for it.")]
        }
        Effect::Unknown(why) => vec![format!("Effect not known: {why}.")],
        Effect::Known { now, then, remark } => {
            let now = now.as_ref().map(|now| (whose, now));
            let clearance = clearance(now, then, required_m);
            let mut first = remark.iter().cloned().chain(loss(now, then)).chain([clearance]);
            let most = format!("{basis}: {}.", first.next().unwrap_or_default());
            let rest = first.chain(figures(now, then));
            std::iter::once(most).chain(rest.map(|words| format!("{}.", text::capitalized(&words)))).collect()
        }
    }
}

/// The figures without the change, and the text before them.
type Now<'a> = Option<(&'a str, &'a Figures)>;

/// A figure with the change, and the one without it.
fn beside(now: Now, then: &Figures, figure: &dyn Fn(&Figures) -> String) -> String {
    match now {
        Some((whose, now)) => format!("{} ({whose}{})", figure(then), figure(now)),
        None => figure(then),
    }
}

/// The clearance, with a warning if it is below the required one.
fn clearance(now: Now, then: &Figures, required_m: Option<f64>) -> String {
    let metres = |figures: &Figures| {
        figures.clearance_m.map_or_else(|| "unknown".into(), |m| format!("{} m", text::number(m, 2)))
    };
    // Values that print the same are treated as equal.
    let shown = |m: f64| (100.0 * m).round();
    let short =
        required_m.filter(|required_m| then.clearance_m.is_some_and(|m| shown(m) < shown(*required_m)));
    let warning =
        short.map_or_else(String::new, |m| format!(", BELOW the required {} m", text::number(m, 2)));
    format!("clearance {}{warning}", beside(now, then, &metres))
}

/// The floor that the change loses: what it scans, and what is scanned without it; `None` if it scans no less.
fn loss(now: Now, then: &Figures) -> Option<String> {
    let [now, then] = [now?.1.scanned?, then.scanned?].map(text::percent);
    let is_less = now.parse::<f64>().ok()? > then.parse::<f64>().ok()?;
    is_less.then(|| format!("scans LESS, {then} % of the reachable floor instead of {now} %"))
}

/// The other figures, most important first. The tether's are named only if the change affects them.
fn figures(now: Now, then: &Figures) -> Vec<String> {
    let beside = |figure: &dyn Fn(&Figures) -> String| beside(now, then, figure);
    let or_dash = |words: Option<String>| words.unwrap_or_else(|| "-".into());
    let tether = |figures: &Figures| or_dash(figures.tether_m.map(|m| format!("{} m", text::number(m, 1))));
    let wrap = |figures: &Figures| {
        or_dash(figures.wrap_rad.map(|wrap_rad| format!("{}°", text::number(wrap_rad.to_degrees(), 0))))
    };
    let changed = |name: &str, figure: &dyn Fn(&Figures) -> String| {
        let is_changed = now.is_none_or(|(_, now)| figure(now) != figure(then));
        is_changed.then(|| format!("{name} {}", beside(figure)))
    };
    let time = beside(&|figures| clock(figures.time_s));
    let length = beside(&|figures| format!("{} m", text::number(figures.length_m, 1)));
    let scanned = then.scanned.filter(|_| now.is_none_or(|now| loss(Some(now), then).is_none())).map(|_| {
        let share =
            |figures: &Figures| or_dash(figures.scanned.map(|share| format!("{} %", text::percent(share))));
        format!("scanned {}", beside(&share))
    });
    let tether = then.tether_m.and_then(|_| changed("tether out", &tether));
    let wrap = then.wrap_rad.and_then(|_| changed("wrap", &wrap));
    [Some(format!("time {time}, path {length}")), scanned, tether, wrap].into_iter().flatten().collect()
}
