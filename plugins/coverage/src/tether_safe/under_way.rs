//! Replanning during a mission: the current plan is repaired if possible.

#[cfg(test)]
mod tests;

use crate::jobs::run_all;
use crate::repair::{CurrentPlan, Laid, Repair, Repaired};
use crate::stages::Stages;
use crate::tether::Tethered;
use crate::tether_safe::candidate::Worth;
use crate::tether_safe::parameters::Preferences;
use crate::tether_safe::pipeline::Pipeline;
use crate::tuning::choice::COMPLETE;
use crate::tuning::repair::{AHEAD_M, AS_BEFORE_M, LONGER, LONGER_CABLE, LONGER_M, MORE_WRAP};
use planner_api::{LogLevel, Reason, Result};
use world::{Point, polyline};

/// A repaired plan, and its value.
pub(super) type RepairedPlan<'a> = (Worth, Repaired<'a>);

/// The outcome of trying to repair the current plan.
pub(super) enum Outcome<'a> {
    /// The plan was changed only around the found obstacles.
    Repaired(RepairedPlan<'a>),
    /// The repair makes a long detour: a new plan may be shorter.
    Long(RepairedPlan<'a>),
    /// A new plan is needed.
    Lost,
}

impl<'a> Outcome<'a> {
    /// Returns a long repair if it is still shorter than a new plan with its return along the tether.
    pub(super) fn if_shorter_than(self, new: &Worth, lead_in: &[Point]) -> Option<RepairedPlan<'a>> {
        let Self::Long(repair) = self else { return None };
        let new_m = new.length_m + polyline::length_m(lead_in);
        is_kept_to(repair.0.length_m, new_m, new.certificate.certified).then_some(repair)
    }
}

/// Whether a long repair is better than a new plan: the new plan is even longer in total, or is not safe for the
/// tether.
fn is_kept_to(repair_m: f64, new_m: f64, is_new_certified: bool) -> bool {
    repair_m < new_m || !is_new_certified
}

/// Repairs the current plan, if there is one.
pub(super) fn repaired<'a>(
    pipeline: &Pipeline<'a>,
    current: Option<&CurrentPlan>,
    reason: &Reason,
    stages: &mut Stages<'_>,
) -> Result<Outcome<'a>> {
    let (Some(current), Some(cable)) = (current, pipeline.cable) else { return Ok(Outcome::Lost) };
    let Pipeline { workspace, preferences, scope, site, .. } = *pipeline;
    let repair = Repair { workspace, scope, effort: preferences.effort, current, tether: cable.taut_line() };
    let limits = RepairLimits {
        current,
        tether: preferences.with_leeway(LONGER_CABLE, MORE_WRAP),
        is_blocked: *reason == Reason::Blocked,
    };
    stages.end = stages.toward(1.0, 0.3);
    let laid =
        run_all(repair.domains(), &stages.next(0.4, "repair"), |domain, job| repair.laid(domain, job))?;
    let laid = likeliest_first(laid.into_iter().flatten(), &limits, pipeline);
    let ctx = stages.ctx;
    let log = |message: &str| ctx.log(LogLevel::Debug, message);
    let mut why = "the cuts leave no path".to_owned();
    for laid in laid {
        let polished = run_all(vec![laid], &stages.next(0.7, "repair"), |laid, job| {
            let repaired = repair.polished(laid, job)?;
            Ok((Worth::of(site, preferences, &repaired.scan, Some(cable)), repaired))
        })?;
        for (worth, repaired) in polished {
            match limits.exceeded(&worth, &repaired) {
                None => return Ok(limits.outcome((worth, repaired), &log)),
                Some(refused) => why = format!("{}; {refused}", worth.summary("repair")),
            }
        }
    }
    log(&format!("a new plan replaces the repair: {why}"));
    Ok(Outcome::Lost)
}

/// Orders repairs for polishing, which ends with the first success. Repairs whose tether will meet the preferences come
/// first, then those that meet the limits; within each group the shortest comes first.
fn likeliest_first<'a>(
    laid: impl Iterator<Item = Laid<'a>>,
    limits: &RepairLimits<'_>,
    pipeline: &Pipeline<'a>,
) -> Vec<Laid<'a>> {
    let Pipeline { site, preferences, cable, .. } = *pipeline;
    let rank = |laid: &Laid<'_>| {
        let path = laid.path();
        let tethered = Tethered { domain: &laid.domain, path: &path, cable };
        let strain = tethered.strain(site, preferences.demands());
        let [is_preferred, is_allowed] = [preferences, &limits.tether]
            .map(|tether| strain.as_ref().is_some_and(|strain| tether.allow(strain)));
        ((!is_allowed, !is_preferred), laid.estimate_m())
    };
    let mut ranked: Vec<_> = laid.map(|laid| (rank(&laid), laid)).collect();
    ranked.sort_by(|((a, a_m), _), ((b, b_m), _)| a.cmp(b).then(a_m.total_cmp(b_m)));
    ranked.into_iter().map(|(_, laid)| laid).collect()
}

/// Limits of a repaired plan. If it exceeds them, a new plan is made.
struct RepairLimits<'a> {
    current: &'a CurrentPlan,
    /// The preferences for the tether, with some leeway.
    tether: Preferences,
    /// Whether the robot cannot continue.
    is_blocked: bool,
}

impl RepairLimits<'_> {
    /// The outcome of a repair that stays within the limits.
    fn outcome<'a>(&self, repair: RepairedPlan<'a>, log: &dyn Fn(&str)) -> Outcome<'a> {
        let longest_m = self.current.length_m() * (1.0 + LONGER) + LONGER_M;
        if repair.0.length_m > longest_m {
            let what = repair.0.summary("repair");
            log(&format!("a new plan may be shorter than the repair: {what}; limit {longest_m:.0} m"));
            return Outcome::Long(repair);
        }
        log(&repair.0.summary("current plan, repaired"));
        Outcome::Repaired(repair)
    }

    /// The limit that a repaired plan exceeds, if any.
    fn exceeded(&self, worth: &Worth, repaired: &Repaired<'_>) -> Option<String> {
        let Self { current, tether, is_blocked } = self;
        let least = repaired.enough.min(COMPLETE);
        if !worth.certificate.certified {
            Some(worth.certificate.reasons.join("; "))
        } else if current.is_preferred && !worth.meets(tether) {
            Some("the tether would be too long or its wrap too large".to_owned())
        } else if worth.coverage < least {
            Some(format!("coverage is below {:.2} %", 100.0 * least))
        } else if *is_blocked && goes_on(current, &repaired.scan.path()) {
            // A robot that cannot continue must not be sent on along the same path.
            Some("it follows the same path on which the robot was blocked".to_owned())
        } else {
            None
        }
    }
}

/// Whether a path begins as the current plan continues.
fn goes_on(current: &CurrentPlan, path: &[Point]) -> bool {
    let first = |path: &[Point], far_m: f64| {
        let fine = polyline::resampled(path, 0.1);
        let n = polyline::stations_m(&fine).partition_point(|station_m| *station_m <= far_m);
        fine[..n].to_vec()
    };
    let begin = first(path, AHEAD_M + AS_BEFORE_M);
    first(&current.path(), AHEAD_M).iter().all(|p| polyline::distance_m(&begin, *p) < AS_BEFORE_M)
}
