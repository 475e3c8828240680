//! The tether-safe planner: its lanes lie in a slit domain, so that the cable can be reeled in whatever the order of
//! the lanes, and each plan has a certificate.

mod candidate;
mod parameters;
mod pipeline;
#[cfg(test)]
mod tests;
mod under_way;

use crate::cuts::domain_between_walls;
use crate::follow::Follow;
use crate::repair::{CurrentPlan, Repaired};
use crate::scope::Scope;
use crate::stages::Stages;
use crate::tether::{laid_cable, least_cable_m, return_path};
use crate::tuning::choice::{BY_REEL, COMPLETE, FAR, MOST_CELLS};
use crate::tuning::rooms;
use crate::unreachable;
use crate::workspace::Workspace;
use candidate::Worth;
use parameters::Preferences;
use pipeline::{Pipeline, Tried};
use planner_api::{
    Caps, Code, Command, Config, Ctx, Layer, LogLevel, ParamSpec, Plan, PlanRequest, Planner, PlannerError,
    Result, Sensed, Site,
};
use world::{Point, coverage::percent_text, tether::Strain};

/// The tether-safe planner; it plans in the slit domain.
pub struct TetherSafe {
    preferences: Preferences,
    follow: Follow,
    /// Whether the last plan returned met the preferences for the tether's length and wrap.
    is_preferred: bool,
}

impl Planner for TetherSafe {
    const ID: &'static str = "tether-safe";
    const NAME: &'static str = "Tether-safe coverage";
    const ABOUT: &'static str = "Scans all reachable floor and never crosses a cut, so the tether can \
                                 always be reeled in. Orders the lanes of a simply connected domain by \
                                 local search and certifies the plan. Treats moving obstacles as \
                                 stationary.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::COVERAGE).and(Caps::LIVE_PARAMS);
    const PARAMS: &'static [ParamSpec] = parameters::ALL;

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        let preferences = Preferences::of(config, site);
        Ok(Self { preferences, follow: Follow::new(config, site), is_preferred: true })
    }

    fn reconfigure(&mut self, config: &Config<'_>, _: &Ctx<'_>) -> Result<()> {
        self.follow.set(config);
        Ok(())
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        let scope = Scope::of(request, Self::ID, self.preferences.cell_m)?;
        let workspace = Workspace::new(request.site, scope.anchor)?;
        let preferences = self.preferences.under(scope.tether);
        let preferences = if workspace.is_room { preferences.between_walls() } else { preferences };
        if let Some(why) = no_lane(&workspace, preferences.limits.reel_length_m) {
            return Err(PlannerError::new(Code::Config, why));
        }
        let scope = limited(scope, &workspace, &preferences).after(request.previous, &workspace);
        let scope = Scope { enough: scope.of_rest(preferences.enough), ..scope };
        let cable = laid_cable(&workspace, request);
        let (site, workspace, preferences, cable) = (request.site, &workspace, &preferences, cable.as_ref());
        let pipeline = Pipeline { site, workspace, preferences, scope, cable, must_come_in: false };
        let mut stages = Stages::new(ctx);
        let current = request.under_way.map(|plan| CurrentPlan::new(plan, self.is_preferred));
        let repaired = under_way::repaired(&pipeline, current.as_ref(), request.reason, &mut stages)?;
        let (worth, scan, lead_in, enough) = match repaired {
            under_way::Outcome::Repaired((worth, Repaired { scan, enough })) => {
                (worth, scan, Vec::new(), enough)
            }
            other => {
                let (tried, lead_in) = tried_from_here_or_home(&pipeline, &mut stages)?;
                let (worth, scan) = tried.chosen(ctx).ok_or_else(|| workspace.no_room())?;
                match other.if_shorter_than(&worth, &lead_in) {
                    Some((worth, Repaired { scan, enough })) => {
                        ctx.log(
                            LogLevel::Debug,
                            &worth.summary("the new plan is longer, so the repair is used after all"),
                        );
                        (worth, scan, Vec::new(), enough)
                    }
                    None => (worth, scan, lead_in, scope.enough),
                }
            }
        };
        stages.end = 1.0;
        stages.next(1.0, "unreachable floor").begin();
        let is_all_in_reach = unreachable::report(&scan, &scope, ctx);
        if ctx.wants_drawing() {
            scan.domain.cuts.iter().for_each(|cut| ctx.polyline(Layer::Tether, cut));
        }
        let mut plan = scan.plan(scope.start, &lead_in);
        // A reel of barely the minimum length may still reach all floor.
        let complete = if workspace.is_room { rooms::COMPLETE } else { COMPLETE };
        let least = if scope.reel_length_m.is_finite() { enough - BY_REEL } else { scope.of_rest(complete) };
        let scans_enough = worth.coverage >= enough.min(least) && is_all_in_reach;
        warn(&worth, preferences, &scope, scans_enough, ctx);
        plan.complete = scans_enough && worth.is_safe(scope.tether.is_some());
        if workspace.is_room && scope.tether.is_none() {
            // Without a cable, a robot slightly off its path need not return to the correct side of a cut.
            plan.cuts.clear();
        }
        self.follow.take(&plan, workspace);
        self.is_preferred = worth.meets(preferences);
        Ok(plan)
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        self.follow.step(sensed, ctx)
    }
}

/// The scope limited by the reel, with cells no smaller than allowed for a large tank.
fn limited<'a>(scope: Scope<'a>, workspace: &Workspace, preferences: &Preferences) -> Scope<'a> {
    let (low, high) = workspace.wall.bounds();
    let least_cell_m = ((high.x - low.x) * (high.y - low.y) / MOST_CELLS).sqrt();
    let reel_length_m = preferences.limits.reel_length_m;
    let is_long = if workspace.is_room {
        domain_between_walls(workspace).is_some_and(|domain| domain.is_all_within(reel_length_m))
    } else {
        reel_length_m > least_cable_m(workspace) * preferences.cable_share
    };
    let reel_length_m = if is_long { f64::INFINITY } else { reel_length_m };
    Scope { reel_length_m, cell_m: scope.cell_m.max(least_cell_m), ..scope }
}

/// The candidates from the robot's position. If the cable's current position rules all of them out, the candidates from
/// home after a return along the cable.
fn tried_from_here_or_home<'a>(
    pipeline: &Pipeline<'a>,
    stages: &mut Stages<'_>,
) -> Result<(Tried<'a>, Vec<Point>)> {
    let Pipeline { site, workspace, scope, cable, .. } = *pipeline;
    let away_m = (scope.start - workspace.home).norm();
    let is_away = away_m > scope.tolerance_m;
    // During a mission, the cable may cross the cuts of any plan that could be made; in that case it is reeled in
    // first.
    let way = cable.filter(|_| is_away).and_then(|cable| return_path(workspace, site, cable));
    // If the robot is far from home, its cable may have to be reeled in, and then everything is computed again.
    let is_far_out = cable.is_some() && away_m > FAR * workspace.swath_m;
    stages.end = if is_far_out { 0.49 } else { 0.98 };
    let tried = Pipeline { must_come_in: way.is_some(), ..*pipeline }.run(stages)?;
    let Some(way) = way.filter(|_| !tried.is_certified()) else { return Ok((tried, Vec::new())) };
    stages.ctx.log(
        LogLevel::Warn,
        "the tether lies across a cut of the new plan: the robot first returns along \
                              the tether",
    );
    stages.end = 0.98;
    let from_home = Scope { start: workspace.home, ..scope };
    let tried = Pipeline { scope: from_home, cable: None, ..*pipeline }.run(stages)?;
    Ok((tried, way))
}

/// The reason why not even one lane can be planned: the swath is wider than the floor, or the reel does not reach a
/// lane. `None` if a lane can be planned.
fn no_lane(workspace: &Workspace, reel_length_m: f64) -> Option<String> {
    let Workspace { swath_m, home, anchor, .. } = *workspace;
    let (low, high) = workspace.wall.bounds();
    let floor_m = (high.x - low.x).min(high.y - low.y);
    if swath_m > floor_m {
        return Some(format!(
            "the swath of {swath_m:.2} m is wider than the floor of {floor_m:.2} m; choose a narrower swath"
        ));
    }
    // The nearest lane that is not at home itself is a swath away from home, and home may be some distance from the
    // anchor.
    let farthest_m = least_cable_m(workspace);
    let needed_m = (home - anchor).norm() + swath_m.min(farthest_m);
    (reel_length_m < needed_m).then(|| {
        format!(
            "the reel holds {reel_length_m:.2} m of cable; even the nearest lanes need {needed_m:.2} m, \
             and the farthest floor is {farthest_m:.1} m from the anchor"
        )
    })
}

/// Warns of deficiencies in a plan. If the plan is not complete, the last warning gives the reason.
fn warn(worth: &Worth, preferences: &Preferences, scope: &Scope<'_>, scans_enough: bool, ctx: &Ctx<'_>) {
    let warn = |message: &str| ctx.log(LogLevel::Warn, message);
    let (share, has_reel) = (percent_text(worth.coverage, 1), scope.reel_length_m.is_finite());
    if !worth.certificate.certified {
        warn(&format!("not certified: {}", worth.certificate.reasons.join("; ")));
    } else if preferences.pull_share(&Strain::from(&worth.certificate)) > 1.0 {
        let why = worth.certificate.warnings.join("; ");
        warn(&format!(
            "no candidate that was tried keeps pull, length and wrap of the cable all within the preferred values: \
             {why}; smaller limits of pull or wrap let the planner try other candidates"
        ));
    } else if has_reel && !worth.meets(preferences) {
        warn("no candidate keeps the cable within the preferred length and wrap");
    }
    // The console counts by the mission's cells; here, a cell counts only if the lanes sweep the whole of it.
    let scanned = format!(
        "the plan scans {share} % of the requested floor, counted in cells that lie whole under its lanes"
    );
    match (scans_enough, has_reel) {
        (true, _) => {}
        (false, true) => {
            warn(&format!("{scanned}: the reel of {:.1} m is too short for all of it", scope.reel_length_m));
        }
        (false, false) => warn(&format!("{scanned}: the rest is left out")),
    }
}
