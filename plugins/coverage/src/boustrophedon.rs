//! The traditional planner: parallel lanes over the whole floor in order, as if there were no tether.

use crate::floor::ReachableFloor;
use crate::follow::Follow;
use crate::lanes::{Lane, lanes, wanted_pieces};
use crate::pattern::{Pattern, Rows};
use crate::plane::direction;
use crate::scan::{Piece, Scan};
use crate::scope::Scope;
use crate::slit_domain::SlitDomain;
use crate::stages::{Stage, Stages};
use crate::tuning::lanes::LEAST_TO_AND_FRO_IN_SWATH;
use crate::unreachable;
use crate::untethered_paths::UntetheredPaths;
use crate::workspace::Workspace;
use planner_api::{
    Caps, Code, Command, Config, Ctx, ParamSpec, Plan, PlanRequest, Planner, PlannerError, Result, Sensed,
    Site, float,
};
use steering::params as p;
use world::Point;

const DIRECTION: ParamSpec = float("direction_deg", "Direction of lanes", "deg", -180.0, 180.0, 0.0)
    .help("Direction of the lanes, counter-clockwise from east.")
    .group("Plan");
const CELL: ParamSpec = float("cell_m", "Cell", "m", 0.01, 0.5, 0.05)
    .help("Edge of the cells in which floor is counted, to report what cannot be reached.")
    .group("Plan");

/// Lanes to and fro.
pub struct Boustrophedon {
    direction_rad: f64,
    cell_m: f64,
    follow: Follow,
}

impl Planner for Boustrophedon {
    const ID: &'static str = "boustrophedon";
    const NAME: &'static str = "Boustrophedon";
    const ABOUT: &'static str = "Traditional: parallel lanes over the whole floor in order, round columns by the shorter \
                                 side; it knows nothing of a tether.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::COVERAGE);
    const PARAMS: &'static [ParamSpec] =
        &[DIRECTION, CELL, p::GUARD, p::GUARD_SIGMAS, p::SLOW, p::MIN_SHARE, p::STUCK];

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        Ok(Self {
            direction_rad: config.float("direction_deg").to_radians(),
            cell_m: config.float("cell_m"),
            follow: Follow::new(config, site),
        })
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        let scope = Scope::of(request, Self::ID, self.cell_m)?;
        let workspace = Workspace::new(request.site, scope.anchor)?;
        let mut stages = Stages::new(ctx);
        stages.next(0.5, "lanes").begin();
        let domain = SlitDomain::new(&workspace, Vec::new()).ok_or_else(|| workspace.no_room())?;
        let floor = ReachableFloor::new(&domain, scope.cell_m);
        let lanes = self.lanes(&domain, &floor, scope.regions)?;
        let ways = UntetheredPaths::new(&workspace, ctx)?;
        let ends = (domain.start(scope.start), workspace.home);
        let pieces = self.in_order(&lanes, &ways, ends, &stages.next(0.25, "ways between lanes"))?;
        stages.next(1.0, "floor out of reach").begin();
        let scan = Scan::new(pieces, domain, floor);
        unreachable::report(&scan, &scope, ctx);
        let plan = scan.plan(scope.start, &[]);
        self.follow.take(&plan);
        Ok(plan)
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        self.follow.step(sensed, ctx)
    }
}

impl Boustrophedon {
    /// The lanes over the floor that is asked for.
    fn lanes(
        &self,
        domain: &SlitDomain<'_>,
        floor: &ReachableFloor,
        regions: &[&[Point]],
    ) -> Result<Vec<Lane>> {
        let workspace = domain.workspace;
        let pattern = Pattern::Straight { rows: Rows::even(workspace, self.direction_rad), laps: 0 };
        let mut lanes = lanes(domain, &pattern, workspace.swath_m / LEAST_TO_AND_FRO_IN_SWATH);
        if !regions.is_empty() {
            let within = floor.clone().within(regions);
            lanes = lanes.iter().flat_map(|lane| wanted_pieces(lane, |at| within.is_near(at))).collect();
        }
        if lanes.is_empty() {
            let keep_m = workspace.keep_m;
            return Err(PlannerError::new(
                Code::NoPath,
                format!(
                    "no lane fits between the walls and obstacles; hull and clearance need {keep_m:.2} m"
                ),
            ));
        }
        Ok(lanes)
    }

    /// The lanes row by row, every other row backward, with ways between and home.
    fn in_order(
        &self,
        lanes: &[Lane],
        ways: &UntetheredPaths,
        (start, home): (Point, Point),
        stage: &Stage<'_>,
    ) -> Result<Vec<Piece>> {
        let ahead = direction(self.direction_rad);
        // Lanes within five millimetres of each other across their direction are in one row.
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
        pieces.push(Piece { points: ways.path(at, home), is_lane: false });
        Ok(pieces)
    }
}

#[cfg(test)]
mod tests;
