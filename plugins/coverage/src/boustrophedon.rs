//! The traditional way: parallel lanes over the whole floor in order, as if there were no tether.

use crate::{
    answer::{self, plan_of},
    floor::FloorGrid,
    follow::Follow,
    ground::Ground,
    lanes::{Lane, Pattern, Reach, lanes},
    roam::Roam,
    scan::{Order, Piece, Scan},
    slit::Slit,
    stages::{Part, Stages},
};
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

/// What stages take of the time that is left, about: lanes, and the ways between them.
const LANES: f64 = 0.5;
const WAYS: f64 = 0.25;

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
        let task = answer::cover(request, Self::ID)?;
        let ground = Ground::new(request.site, task.anchor)?;
        let home = ground.home();
        let mut stages = Stages::new(ctx);
        stages.next(LANES, "lanes").begin();
        let slit = Slit::new(&ground, &[], home).ok_or_else(|| answer::no_room(&ground))?;
        let grid = FloorGrid::new(&ground, &slit, self.cell_m);
        let (shift_m, spacing_m) = crate::candidate::even_rows(&ground, self.direction_rad);
        let pattern = Pattern::Straight { angle_rad: self.direction_rad, shift_m, spacing_m, laps: 0 };
        let reach = Reach { cut_m: 0.0, lap_share: 0.0, least_m: ground.swath_m / 12.0 };
        let made = lanes(&ground, &slit, &[], &pattern, &reach);
        let wanted: Vec<Lane> = if task.regions.is_empty() {
            made
        } else {
            let mut within = grid.clone();
            within.keep_within(task.regions);
            made.iter().flat_map(|lane| lane.kept(&|at| within.has_reachable_near(at))).collect()
        };
        if wanted.is_empty() {
            return Err(PlannerError::new(
                Code::NoPath,
                format!(
                    "no lane fits between the walls and obstacles; hull and clearance need {:.2} m",
                    ground.keep_m
                ),
            ));
        }
        let start = if slit.contains(request.start.position) { request.start.position } else { home };
        let roam = Roam::new(&ground, ctx)?;
        let part = stages.next(WAYS, "ways between lanes");
        let pieces = in_order(&roam, &wanted, self.direction_rad, start, home, &part)?;
        stages.next(1.0, "floor out of reach").begin();
        let mut scan = Scan { pieces, cuts: Vec::new(), slit, grid };
        scan.grid.sweep(&scan.path());
        let order = Order { start, regions: task.regions, reel_length_m: f64::INFINITY, cell_m: self.cell_m };
        answer::report_unreachable(&ground, &scan, &order, ctx);
        let plan = plan_of(&scan, request.start.position, &[]);
        self.follow.take(&plan);
        Ok(plan)
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        self.follow.step(sensed, ctx)
    }
}

/// The lanes row by row, every other row backward, with the shortest ways between.
fn in_order(
    roam: &Roam,
    lanes: &[Lane],
    direction_rad: f64,
    start: Point,
    home: Point,
    part: &Part<'_>,
) -> Result<Vec<Piece>> {
    let ahead = crate::ground::direction(direction_rad);
    let row = |lane: &Lane| (ahead.perp(&lane.points[0].coords) * 1e3).round() as i64;
    let along = |lane: &Lane| lane.points[0].coords.dot(&ahead);
    let mut sorted: Vec<&Lane> = lanes.iter().collect();
    sorted.sort_by(|a, b| row(a).cmp(&row(b)).then(along(a).total_cmp(&along(b))));
    let rows: Vec<&[&Lane]> = sorted.chunk_by(|a, b| (row(a) - row(b)).abs() < 5).collect();
    let mut pieces = Vec::new();
    let mut at = start;
    for (k, row) in rows.iter().enumerate() {
        part.ctx.check()?;
        part.reached(k as f64 / rows.len() as f64);
        let mut row: Vec<Lane> = row.iter().map(|lane| (*lane).clone()).collect();
        if k % 2 == 1 {
            row.reverse();
            for lane in &mut row {
                lane.points.reverse();
            }
        }
        for lane in row {
            pieces.push(Piece { points: roam.way(at, lane.points[0]), is_lane: false });
            at = lane.points[lane.points.len() - 1];
            pieces.push(Piece { points: lane.points, is_lane: true });
        }
    }
    pieces.push(Piece { points: roam.way(at, home), is_lane: false });
    Ok(pieces)
}

#[cfg(test)]
mod tests;
