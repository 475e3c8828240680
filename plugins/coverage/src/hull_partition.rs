//! The published planner (Pan 2025): convex cells between hull rings, ordered by a genetic algorithm, with
//! backtracking.

mod borders;
mod cells;
mod division;
mod genetic;
#[cfg(test)]
mod tests;

use crate::floor::ReachableFloor;
use crate::follow::Follow;
use crate::lanes::thinned;
use crate::plane::{direction, extent, left_of};
use crate::scan::{Piece, Scan};
use crate::scope::Scope;
use crate::stages::{Stage, Stages};
use crate::tuning::hull_partition::{INSIDE_M, MOST_COLUMNS, SEALED_M2};
use crate::untethered_paths::UntetheredPaths;
use crate::workspace::Workspace;
use cells::{Cell, is_convex};
use division::{Division, trim};
use planner_api::{
    Caps, Code, Command, Config, Ctx, LogLevel, ParamSpec, Plan, PlanRequest, Planner, PlannerError, Result,
    Sensed, Site, choice, float,
};
use steering::params as p;
use world::{Boundary, Point, Vector, polyline};

const BACKTRACKING: ParamSpec = choice("backtracking", "Backtracking", &["tree", "direct"], 0)
    .help(
        "The paper mentions backtracking but gives no algorithm. Tree: back through the same cells that \
         the robot came through. Direct: the shortest path from cell to cell, which winds the tether \
         around columns.",
    )
    .group("Plan");
const ORDER: ParamSpec = choice("order", "Order of cells", &["genetic", "exact"], 0)
    .help("Genetic: found by the published genetic algorithm. Exact: the best order, for up to 13 cells.")
    .group("Plan");
const CELL: ParamSpec = float("cell_m", "Cell", "m", 0.01, 0.5, 0.05)
    .help("Edge length of the cells in which scanned and unreachable floor is counted.")
    .group("Plan");
/// The published planner.
pub struct HullPartition {
    is_tree: bool,
    is_exact: bool,
    cell_m: f64,
    follow: Follow,
}

impl Planner for HullPartition {
    const ID: &'static str = "hull-partition";
    const NAME: &'static str = "Hull partition";
    const ABOUT: &'static str = "Pan 2025: convex cells between the hull rings of the columns, visited \
                                 with backtracking in an order found by a genetic algorithm. Treats moving \
                                 obstacles as stationary.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::COVERAGE).and(Caps::LIVE_PARAMS);
    const PARAMS: &'static [ParamSpec] =
        &[BACKTRACKING, ORDER, CELL, p::GUARD, p::GUARD_SIGMAS, p::SLOW, p::MIN_SHARE, p::STUCK];

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        Ok(Self {
            is_tree: config.choice("backtracking") == "tree",
            is_exact: config.choice("order") == "exact",
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
        if let Some(why) = no_rings(&workspace) {
            return Err(PlannerError::new(Code::Unsupported, why));
        }
        let mut stages = Stages::new(ctx);
        stages.next(0.1, "cells").begin();
        let mut division = Division::new(&workspace, self.is_tree).ok_or_else(|| workspace.no_room())?;
        if self.is_tree && !division.domain.is_simple {
            ctx.log(
                LogLevel::Warn,
                "the method leaves a path open around columns that are too close together; an added cut \
                 closes it",
            );
            division.domain.close_up();
        }
        let floor = ReachableFloor::new(&division.domain, scope.cell_m);
        let pieces = self.pieces(&division, &floor, &scope, &mut stages, request.site.seed)?;
        stages.next(1.0, "unreachable floor").begin();
        let scan = Scan::new(pieces, division.domain, floor);
        let mut plan = scan.plan(scope.start, &[]);
        plan.complete = scan.reports_all(&scope, ctx);
        plan.cuts.iter_mut().for_each(|cut| trim(cut));
        let sealed_m2 = scan.domain.sealed.area_m2;
        if sealed_m2 > SEALED_M2 {
            plan.complete = false;
            ctx.log(
                LogLevel::Warn,
                &format!("no gate leads to {sealed_m2:.2} m² of floor; choose tether-safe"),
            );
        }
        self.follow.take(&plan, &workspace);
        Ok(plan)
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        self.follow.step(sensed, ctx)
    }
}

impl HullPartition {
    /// The lanes cell by cell, and the connectors between them: through the gates, or by the shortest path.
    fn pieces(
        &self,
        Division { cells, first, domain }: &Division<'_>,
        floor: &ReachableFloor,
        scope: &Scope<'_>,
        stages: &mut Stages<'_>,
        seed: u64,
    ) -> Result<Vec<Piece>> {
        let ctx = stages.ctx;
        let untethered =
            if self.is_tree { None } else { Some(UntetheredPaths::new(domain.workspace, &ctx)?) };
        let way = |a: Point, b: Point| match &untethered {
            Some(untethered) => untethered.path(a, b),
            None => domain.path(a, b).unwrap_or_else(|| vec![a, b]),
        };
        let within = floor.clone().within(scope.regions);
        // If a lane ended on a cut, it would be on neither side of the cut.
        let is_off_cuts = |at: Point| domain.cuts.iter().all(|cut| polyline::distance_m(cut, at) > INSIDE_M);
        let is_open = |at: Point| {
            domain.contains(at) && is_off_cuts(at) && (scope.regions.is_empty() || within.is_near(at))
        };
        let order = self.order(cells, *first, seed, &stages.next(0.1, "order of cells"));
        let stage = stages.next(0.88, "lanes in the cells");
        let (mut pieces, mut at) = (Vec::new(), domain.start(scope.start));
        for (k, cell) in order.into_iter().enumerate() {
            ctx.check()?;
            stage.report(k as f64 / cells.len() as f64, k, cells.len());
            let lanes = lanes(&cells[cell], domain.workspace, is_open);
            for lane in lanes.iter().flat_map(|lane| domain.between_cuts(lane)) {
                pieces.push(Piece { points: way(at, lane[0]), is_lane: false });
                at = lane[lane.len() - 1];
                pieces.push(Piece { points: thinned(&lane), is_lane: true });
            }
        }
        pieces.push(Piece { points: way(at, domain.workspace.home), is_lane: false });
        Ok(pieces)
    }

    /// The order of the cells, based on the distances between their centres.
    fn order(&self, cells: &[Cell], first: usize, seed: u64, stage: &Stage<'_>) -> Vec<usize> {
        let names: Vec<usize> =
            std::iter::once(first).chain((0..cells.len()).filter(|k| *k != first)).collect();
        let centers: Vec<Point> = names.iter().map(|k| cells[*k].center()).collect();
        let distance: Vec<Vec<f64>> =
            centers.iter().map(|a| centers.iter().map(|b| (a - b).norm()).collect()).collect();
        let ordered = if self.is_exact { genetic::exact } else { genetic::evolved };
        ordered(&distance, seed, &|share| stage.reached(share)).into_iter().map(|k| names[k]).collect()
    }
}

/// The reason why hull rings are impossible; `None` if they are possible.
fn no_rings(workspace: &Workspace) -> Option<String> {
    let n = workspace.parts.len();
    match &workspace.wall {
        Boundary::Polygon { vertices } if !is_convex(vertices) => {
            Some("hull rings need a convex wall; choose tether-safe".to_owned())
        }
        _ if workspace.is_room && n > MOST_COLUMNS => Some(format!(
            "hull rings are built from columns, but there are {n} convex obstacles between the walls, and \
             at most {MOST_COLUMNS} can be planned: choose tether-safe"
        )),
        _ => None,
    }
}

/// The lanes in a cell, driven to and fro along the long side of the smallest rectangle around the cell. The first lane
/// is on the side of the corner nearest to the centre (as published). Lanes are broken where the floor is not open.
fn lanes(cell: &Cell, workspace: &Workspace, is_open: impl Fn(Point) -> bool) -> Vec<Vec<Point>> {
    let hull = cell.hull();
    let Some((ahead, (low, high))) = smallest_rectangle(&hull) else { return Vec::new() };
    let side = left_of(ahead);
    let (low, high) = (low + INSIDE_M, high - INSIDE_M);
    let n = ((high - low) / workspace.swath_m - 1e-6).ceil().max(1.0) as usize;
    let strip_m = (high - low) / n as f64;
    let center = cell.center();
    let nearest = hull.iter().min_by(|a, b| (*a - center).norm().total_cmp(&(*b - center).norm()));
    let is_high = nearest.is_some_and(|corner| corner.coords.dot(&side) > f64::midpoint(low, high));
    let (from, to) = extent(hull.iter().map(|p| p.coords.dot(&ahead)));
    let is_open = |p: &Point| cell.contains(*p) && workspace.is_free(*p) && is_open(*p);
    let mut lanes = Vec::new();
    for k in 0..n {
        let row = if is_high { n - 1 - k } else { k };
        let foot = side * (low + (row as f64 + 0.5) * strip_m);
        let ends = [Point::from(foot + ahead * from), Point::from(foot + ahead * to)];
        let line = polyline::resampled(&ends, 0.04);
        let mut runs: Vec<Vec<Point>> =
            line.split(|p| !is_open(p)).filter(|run| run.len() > 2).map(<[Point]>::to_vec).collect();
        if k % 2 == 1 {
            runs.reverse();
            for run in &mut runs {
                run.reverse();
            }
        }
        lanes.extend(runs);
    }
    lanes
}

/// The smallest rectangle around a convex polygon: its long direction, and its extent across that direction.
fn smallest_rectangle(hull: &[Point]) -> Option<(Vector, (f64, f64))> {
    let spread = |way: Vector| extent(hull.iter().map(|p| p.coords.dot(&way)));
    let rectangle = |along: Vector| {
        let across = left_of(along);
        let (l, w) = (spread(along), spread(across));
        let area = (l.1 - l.0) * (w.1 - w.0);
        if l.1 - l.0 >= w.1 - w.0 { (area, along, w) } else { (area, across, spread(left_of(across))) }
    };
    let sides = polyline::edges(hull).filter_map(|(a, b)| (b - a).try_normalize(1e-9));
    let smallest = sides.map(rectangle).min_by(|a, b| a.0.total_cmp(&b.0));
    smallest.map(|(_, along, extent)| (direction(along.y.atan2(along.x)), extent))
}
