//! A plan under way: repaired where that will do.

#[cfg(test)]
mod tests;

use crate::jobs::run_all;
use crate::repair::{CurrentPlan, Repair, Repaired};
use crate::stages::Stages;
use crate::tether_safe::candidate::Worth;
use crate::tether_safe::pipeline::Pipeline;
use crate::tuning::choice::COMPLETE;
use crate::tuning::repair::{AHEAD_M, AS_BEFORE_M, LONGER, LONGER_CABLE, LONGER_M, MORE_WRAP};
use planner_api::{LogLevel, Reason, Result};
use world::{Point, polyline};

/// The plan under way, changed only round what was found; `None` where a new plan is needed.
pub(super) fn repaired<'a>(
    pipeline: &Pipeline<'a>,
    current: Option<&CurrentPlan>,
    reason: &Reason,
    stages: &mut Stages<'_>,
) -> Result<Option<(Worth, Repaired<'a>)>> {
    let is_change = matches!(reason, Reason::MapChanged | Reason::Blocked);
    let (Some(current), Some(cable), true) = (current, pipeline.cable, is_change) else { return Ok(None) };
    let Pipeline { workspace, preferences, scope, site, .. } = *pipeline;
    let repair = Repair { workspace, scope, effort: preferences.effort, current, tether: cable.taut_line() };
    let lenient = preferences.with_leeway(LONGER_CABLE, MORE_WRAP);
    let most_m = current.left_m() * (1.0 + LONGER) + LONGER_M;
    stages.end = stages.toward(1.0, 0.3);
    let tried = run_all(repair.domains(), &stages.next(1.0, "repair"), |domain, job| {
        let Some(repaired) = repair.scan(domain, job)? else { return Ok(None) };
        let worth = Worth::of(site, preferences, &repaired.scan, Some(cable));
        let objection = if !worth.certificate.certified {
            Some(worth.certificate.reasons.join("; "))
        } else if current.is_preferred && !worth.meets(&lenient) {
            Some("the cable would be too long or wind too much".to_owned())
        } else if worth.coverage < repaired.enough.min(COMPLETE) {
            Some(format!("it should scan {:.2} %", 100.0 * repaired.enough.min(COMPLETE)))
        } else if worth.length_m > most_m {
            Some(format!("it should be no longer than {most_m:.0} m"))
        } else {
            // A robot that cannot go on must not be asked to go on.
            let is_stuck = *reason == Reason::Blocked && goes_on(current, &repaired.scan.path());
            is_stuck.then(|| "it leads on where the robot was blocked".to_owned())
        };
        Ok(Some((worth, repaired, objection)))
    })?;
    let (good, refused): (Vec<_>, Vec<_>) = tried.into_iter().flatten().partition(|tried| tried.2.is_none());
    if good.is_empty() {
        let why = refused.first().and_then(|(worth, _, why)| Some((worth.summary("repair"), why.as_ref()?)));
        let why = why.map_or("the cuts leave no way".to_owned(), |(what, why)| format!("{what}; {why}"));
        stages.ctx.log(LogLevel::Info, &format!("a new plan instead of a repair: {why}"));
    }
    let better = |a: (Worth, Repaired<'a>), b: (Worth, Repaired<'a>)| {
        if b.0.is_before(&a.0, preferences) { b } else { a }
    };
    let best = good.into_iter().map(|(worth, repaired, _)| (worth, repaired)).reduce(better);
    if let Some((worth, _)) = &best {
        stages.ctx.log(LogLevel::Info, &worth.summary("plan under way, repaired"));
    }
    Ok(best)
}

/// Whether a path begins as the plan under way goes on.
fn goes_on(current: &CurrentPlan, path: &[Point]) -> bool {
    let first = |path: &[Point], far_m: f64| {
        let fine = polyline::resampled(path, 0.1);
        let n = polyline::stations_m(&fine).partition_point(|station_m| *station_m <= far_m);
        fine[..n].to_vec()
    };
    let begin = first(path, AHEAD_M + AS_BEFORE_M);
    first(&current.path_left(), AHEAD_M).iter().all(|p| polyline::distance_m(&begin, *p) < AS_BEFORE_M)
}
