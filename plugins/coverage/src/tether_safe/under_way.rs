//! A plan under way: repaired where that will do.

#[cfg(test)]
mod tests;

use crate::jobs::run_all;
use crate::repair::{CurrentPlan, Repair, Repaired};
use crate::stages::Stages;
use crate::tether_safe::candidate::Worth;
use crate::tether_safe::parameters::Preferences;
use crate::tether_safe::pipeline::Pipeline;
use crate::tuning::choice::COMPLETE;
use crate::tuning::repair::{AHEAD_M, AS_BEFORE_M, LONGER, LONGER_CABLE, LONGER_M, MORE_WRAP};
use planner_api::{LogLevel, Reason, Result};
use world::{Point, polyline};

/// A plan under way with a repair.
pub(super) type RepairedPlan<'a> = (Worth, Repaired<'a>);

/// What became of a plan under way for which a repair was tried.
pub(super) enum Outcome<'a> {
    /// Changed only round what was found.
    Repaired(RepairedPlan<'a>),
    /// The repair leads a long way round: a new plan may be shorter.
    Long(RepairedPlan<'a>),
    /// A new plan is needed.
    Lost,
}

impl<'a> Outcome<'a> {
    /// A long repair that is still shorter than a new plan and the way back along the tether before it.
    pub(super) fn if_shorter_than(self, new: &Worth, lead_in: &[Point]) -> Option<RepairedPlan<'a>> {
        let Self::Long(repair) = self else { return None };
        let new_m = new.length_m + polyline::length_m(lead_in);
        (repair.0.length_m < new_m || !new.certificate.certified).then_some(repair)
    }
}

/// Repairs the plan under way, if there is one and the reason for planning again is that the map has changed.
pub(super) fn repaired<'a>(
    pipeline: &Pipeline<'a>,
    current: Option<&CurrentPlan>,
    reason: &Reason,
    stages: &mut Stages<'_>,
) -> Result<Outcome<'a>> {
    let is_change = matches!(reason, Reason::MapChanged | Reason::Blocked);
    let (Some(current), Some(cable), true) = (current, pipeline.cable, is_change) else {
        return Ok(Outcome::Lost);
    };
    let Pipeline { workspace, preferences, scope, site, .. } = *pipeline;
    let repair = Repair { workspace, scope, effort: preferences.effort, current, tether: cable.taut_line() };
    let limits = RepairLimits {
        current,
        tether: preferences.with_leeway(LONGER_CABLE, MORE_WRAP),
        is_blocked: *reason == Reason::Blocked,
    };
    stages.end = stages.toward(1.0, 0.3);
    let tried = run_all(repair.domains(), &stages.next(1.0, "repair"), |domain, job| {
        let Some(repaired) = repair.scan(domain, job)? else { return Ok(None) };
        let worth = Worth::of(site, preferences, &repaired.scan, Some(cable));
        Ok(Some(match limits.exceeded(&worth, &repaired) {
            None => Ok((worth, repaired)),
            Some(why) => Err(format!("{}; {why}", worth.summary("repair"))),
        }))
    })?;
    let mut why = "the cuts leave no way".to_owned();
    let good = tried.into_iter().flatten().filter_map(|repair| repair.map_err(|refused| why = refused).ok());
    let best = good.reduce(|best, other| if other.0.is_before(&best.0, preferences) { other } else { best });
    let log = |message: &str| stages.ctx.log(LogLevel::Info, message);
    let longest_m = current.left_m() * (1.0 + LONGER) + LONGER_M;
    Ok(match best {
        None => {
            log(&format!("a new plan instead of a repair: {why}"));
            Outcome::Lost
        }
        Some(best) if best.0.length_m > longest_m => {
            let what = best.0.summary("repair");
            log(&format!("a new plan may be shorter than a repair: {what}; limit {longest_m:.0} m"));
            Outcome::Long(best)
        }
        Some(best) => {
            log(&best.0.summary("plan under way, repaired"));
            Outcome::Repaired(best)
        }
    })
}

/// What a repaired plan must keep to; a new plan takes its place where it does not.
struct RepairLimits<'a> {
    current: &'a CurrentPlan,
    /// What is preferred of the tether, with some leeway.
    tether: Preferences,
    /// Whether the robot cannot go on.
    is_blocked: bool,
}

impl RepairLimits<'_> {
    /// The limit that a repaired plan exceeds.
    fn exceeded(&self, worth: &Worth, repaired: &Repaired<'_>) -> Option<String> {
        let Self { current, tether, is_blocked } = self;
        let least = repaired.enough.min(COMPLETE);
        if !worth.certificate.certified {
            Some(worth.certificate.reasons.join("; "))
        } else if current.is_preferred && !worth.meets(tether) {
            Some("the tether would be too long or wind too much".to_owned())
        } else if worth.coverage < least {
            Some(format!("it should scan {:.2} %", 100.0 * least))
        } else if *is_blocked && goes_on(current, &repaired.scan.path()) {
            // A robot that cannot go on must not be asked to go on.
            Some("it leads on where the robot was blocked".to_owned())
        } else {
            None
        }
    }
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
