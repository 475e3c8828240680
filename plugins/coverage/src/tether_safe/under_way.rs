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
        let is_good = worth.certificate.certified
            && (worth.meets(&lenient) || !current.is_preferred)
            && worth.coverage >= repaired.enough.min(COMPLETE)
            && worth.length_m <= most_m;
        // A robot that cannot go on must not be asked to go on.
        let is_stuck = *reason == Reason::Blocked && goes_on(current, &repaired.scan.path());
        Ok((is_good && !is_stuck).then_some((worth, repaired)))
    })?;
    let better = |a: (Worth, Repaired<'a>), b: (Worth, Repaired<'a>)| {
        if b.0.is_before(&a.0, preferences) { b } else { a }
    };
    let best = tried.into_iter().flatten().reduce(better);
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
