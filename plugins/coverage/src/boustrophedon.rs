//! The traditional planner: parallel lanes over the whole floor, one after another, ignoring the tether.

use crate::floor::ReachableFloor;
use crate::follow::Follow;
use crate::lanes::{Lane, laps_and_rows, wanted_pieces};
use crate::pattern::{Pattern, Rows};
use crate::plane::direction;
use crate::scan::{Piece, Scan};
use crate::scope::Scope;
use crate::slit_domain::SlitDomain;
use crate::stages::{Stage, Stages};
use crate::tuning::lanes::LEAST_TO_AND_FRO_IN_SWATH;
use crate::untethered_paths::UntetheredPaths;
use crate::workspace::Workspace;
use planner_api::{
    Caps, Code, Command, Config, Ctx, ParamSpec, Plan, PlanRequest, Planner, PlannerError, Result, Sensed,
    Site, flag, float,
};
use steering::params as p;
use world::Point;

const DIRECTION: ParamSpec = float("direction_deg", "Lane direction", "deg", -180.0, 180.0, 0.0)
    .help("Direction of the lanes, counter-clockwise from east.")
    .group("Plan");
const CELL: ParamSpec = float("cell_m", "Cell", "m", 0.01, 0.5, 0.05)
    .help("Edge length of the cells in which scanned and unreachable floor is counted.")
    .group("Plan");
const SHELL_LAP: ParamSpec = flag("shell_lap", "Shell lap", false)
    .help(
        "After the lanes, the robot drives a lap along the shell, as close to it as hull and clearance \
         allow. Floors between inner walls always get one.",
    )
    .group("Plan");

/// Parallel lanes, driven to and fro.
pub struct Boustrophedon {
    direction_rad: f64,
    has_shell_lap: bool,
    cell_m: f64,
    follow: Follow,
}

impl Planner for Boustrophedon {
    const ID: &'static str = "boustrophedon";
    const NAME: &'static str = "Boustrophedon";
    const ABOUT: &'static str = "Traditional: parallel lanes over the whole floor, one after another, \
                                 passing columns on the shorter side. Ignores the tether and treats moving \
                                 obstacles as stationary.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::COVERAGE).and(Caps::LIVE_PARAMS);
    const PARAMS: &'static [ParamSpec] =
        &[DIRECTION, SHELL_LAP, CELL, p::GUARD, p::GUARD_SIGMAS, p::SLOW, p::MIN_SHARE, p::STUCK];

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        Ok(Self {
            direction_rad: config.float("direction_deg").to_radians(),
            has_shell_lap: config.flag("shell_lap"),
            cell_m: config.float("cell_m"),
            follow: Follow::new(config, site),
        })
    }

    fn reconfigure(&mut self, config: &Config<'_>, _: &Ctx<'_>) -> Result<()> {
        self.follow.set(config);
        Ok(())
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        let scope = Scope::of(request, Self::ID, self.cell_m)?;
        let workspace = Workspace::new(request.site, scope.anchor)?;
        let mut stages = Stages::new(ctx);
        stages.next(0.5, "lanes").begin();
        let domain = SlitDomain::new(&workspace, Vec::new()).ok_or_else(|| workspace.no_room())?;
        let floor = ReachableFloor::new(&domain, scope.cell_m);
        let (laps, rows) = self.lanes(&domain, &floor, scope.regions)?;
        let ways = UntetheredPaths::new(&workspace, ctx)?;
        let ends = (domain.start(scope.start), workspace.home);
        let stage = stages.next(0.25, "connectors between lanes");
        let pieces = self.in_order(&rows, laps, &ways, ends, &stage)?;
        stages.next(1.0, "unreachable floor").begin();
        let scan = Scan::new(pieces, domain, floor);
        let mut plan = scan.plan(scope.start, &[]);
        plan.complete = scan.reports_all(&scope, ctx);
        self.follow.take(&plan, &workspace);
        Ok(plan)
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        self.follow.step(sensed, ctx)
    }
}

impl Boustrophedon {
    /// The lanes over the requested floor: laps along the walls, if required, and straight lanes.
    fn lanes(
        &self,
        domain: &SlitDomain<'_>,
        floor: &ReachableFloor,
        regions: &[&[Point]],
    ) -> Result<(Vec<Lane>, Vec<Lane>)> {
        let workspace = domain.workspace;
        let rows = Rows::even(workspace, self.direction_rad);
        let pattern = Pattern::Straight { rows, laps: usize::from(workspace.is_room || self.has_shell_lap) };
        let least_m = workspace.swath_m / LEAST_TO_AND_FRO_IN_SWATH;
        let within = floor.clone().within(regions);
        let wanted = |lanes: Vec<Lane>| -> Vec<Lane> {
            if regions.is_empty() {
                return lanes;
            }
            lanes.iter().flat_map(|lane| wanted_pieces(lane, |at| within.is_near(at))).collect()
        };
        let (laps, rows) = laps_and_rows(domain, &pattern, least_m);
        let (laps, rows) = (wanted(laps), wanted(rows));
        if laps.is_empty() && rows.is_empty() {
            let keep_m = workspace.keep_m;
            return Err(PlannerError::new(
                Code::NoPath,
                format!(
                    "no lane fits between the walls and obstacles; hull and clearance need {keep_m:.2} m"
                ),
            ));
        }
        Ok((laps, rows))
    }

    /// Orders the lanes row by row, every other row backward; the laps follow, always the nearest one next. Adds the
    /// connectors and the path home.
    fn in_order(
        &self,
        lanes: &[Lane],
        mut laps: Vec<Lane>,
        ways: &UntetheredPaths,
        (start, home): (Point, Point),
        stage: &Stage<'_>,
    ) -> Result<Vec<Piece>> {
        let ahead = direction(self.direction_rad);
        // Lanes within five millimetres of each other across their direction belong to the same row.
        let row = |lane: &Lane| (ahead.perp(&lane[0].coords) * 1e3).round() as i64;
        let along = |lane: &Lane| lane[0].coords.dot(&ahead);
        let mut sorted: Vec<&Lane> = lanes.iter().collect();
        sorted.sort_by(|a, b| row(a).cmp(&row(b)).then(along(a).total_cmp(&along(b))));
        let rows: Vec<&[&Lane]> = sorted.chunk_by(|a, b| (row(a) - row(b)).abs() < 5).collect();
        let (mut pieces, mut at) = (Vec::new(), start);
        for (k, row) in rows.iter().enumerate() {
            stage.ctx.check()?;
            stage.reached(k as f64 / rows.len() as f64);
            let row: Vec<Lane> = if k % 2 == 0 {
                row.iter().map(|lane| (*lane).clone()).collect()
            } else {
                row.iter().rev().map(|lane| lane.iter().rev().copied().collect()).collect()
            };
            for lane in row {
                pieces.push(Piece { points: ways.path(at, lane[0]), is_lane: false });
                at = lane[lane.len() - 1];
                pieces.push(Piece { points: lane, is_lane: true });
            }
        }
        let far_m = |lap: &Lane, at: Point| (lap[0] - at).norm().min((lap[lap.len() - 1] - at).norm());
        while let Some((k, _)) =
            laps.iter().enumerate().min_by(|a, b| far_m(a.1, at).total_cmp(&far_m(b.1, at)))
        {
            stage.ctx.check()?;
            let mut lap = laps.swap_remove(k);
            if (lap[0] - at).norm() > (lap[lap.len() - 1] - at).norm() {
                lap.reverse();
            }
            pieces.push(Piece { points: ways.path(at, lap[0]), is_lane: false });
            at = lap[lap.len() - 1];
            pieces.push(Piece { points: lap, is_lane: true });
        }
        pieces.push(Piece { points: ways.path(at, home), is_lane: false });
        Ok(pieces)
    }
}

#[cfg(test)]
mod tests;
