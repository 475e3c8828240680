//! What the coverage planners share: reading the task, writing the plan, reporting what cannot be scanned.

use crate::{
    floor::FloorGrid,
    ground::{Ground, direction},
    scan::{Order, Scan},
};
use planner_api::{
    Code, Ctx, Leg, LegTag, LogLevel, Plan, PlanRequest, PlannerError, Result, Site, Task, TetherLimits,
};
use std::{f64::consts::TAU, sync::Arc};
use world::{
    ObstacleMap, Point, Shape, polyline,
    tether::{self, Cable},
};

/// Floor out of reach below this is not worth a line, square metres.
const LEAST_M2: f64 = 0.05;
/// Places listed one by one.
const MOST_PLACES: usize = 8;

/// Bearings in which floor in reach is looked for beside floor at the wall.
const MARGIN_BEARINGS: u32 = 24;
/// Why floor is not scanned.
const NARROW_GAPS: &str = "cannot be reached: gaps are narrower than hull and clearance need";

/// A task to cover.
#[derive(Debug, Clone, Copy)]
pub struct Cover<'a> {
    /// Where the tether comes in.
    pub anchor: Point,
    /// What is still to scan.
    pub regions: &'a [&'a [Point]],
    /// Limits of the tether.
    pub tether: Option<TetherLimits>,
    /// Distance at which the robot is back, metres.
    pub tolerance_m: f64,
}

/// The task of a request, if it is to cover the floor.
///
/// # Errors
/// Another task, or a start that is no number.
pub fn cover<'a>(request: &PlanRequest<'a>, id: &str) -> Result<Cover<'a>> {
    let start = request.start.position;
    if !(start.x.is_finite() && start.y.is_finite()) {
        return Err(PlannerError::new(Code::Invalid, "the start is not a number"));
    }
    match request.task {
        Task::Cover { anchor, regions, tether, tolerance_m } => {
            Ok(Cover { anchor, regions, tether, tolerance_m })
        }
        _ => Err(PlannerError::new(
            Code::Unsupported,
            format!("{id} covers floors; for this mission choose a planner for goals or preset paths"),
        )),
    }
}

/// The refusal where the robot has no room.
pub fn no_room(ground: &Ground) -> PlannerError {
    PlannerError::new(
        Code::StartOccupied,
        format!(
            "there is no room for hull and clearance ({:.2} m) within 2 m of the anchor ({:.2}, {:.2})",
            ground.keep_m, ground.anchor.x, ground.anchor.y
        ),
    )
}

/// Path, legs and cuts of a scan, from where the robot is, after a way on which the cable is taken in.
pub fn plan_of(scan: &Scan, start: Point, retract: &[Point]) -> Plan {
    let mut plan = Plan { path: vec![start], complete: true, ..Plan::default() };
    add_leg(&mut plan, LegTag::Retract, retract);
    let last = scan.pieces.len().saturating_sub(1);
    for (k, piece) in scan.pieces.iter().enumerate() {
        let tag = match (piece.is_lane, k == 0 || k == last) {
            (true, _) => LegTag::Swath,
            (false, true) => LegTag::Travel,
            (false, false) => LegTag::Connector,
        };
        add_leg(&mut plan, tag, &piece.points);
    }
    plan.cost = polyline::length_m(&plan.path);
    plan.cuts = scan.cut_lines();
    plan
}

fn add_leg(plan: &mut Plan, tag: LegTag, points: &[Point]) {
    let first = plan.path.len() - 1;
    for point in points {
        if (point - plan.path[plan.path.len() - 1]).norm() > 1e-6 {
            plan.path.push(*point);
        }
    }
    let last = plan.path.len() - 1;
    if last > first {
        plan.legs.push(Leg { tag, first, last });
    }
}

/// Back along the cable, if the hull has room there.
pub fn return_path(ground: &Ground, site: &Site<'_>, cable: &Cable) -> Option<Vec<Point>> {
    let obstacles = crate::candidate::solids(site);
    let shapes: Vec<Shape> = obstacles.iter().map(|o| o.shape.clone()).collect();
    let roomy = Arc::new(tether::Ground::grown(&ground.wall, &shapes, ground.keep_m));
    let map = ObstacleMap::new(&ground.wall, &obstacles);
    cable.return_path(&roomy, &map, ground.keep_m)
}

/// Logs which floor cannot be scanned, and why.
pub fn report_unreachable(ground: &Ground, scan: &Scan, order: &Order<'_>, ctx: &Ctx<'_>) {
    let grid = &scan.grid;
    let cell_m2 = grid.cell_m * grid.cell_m;
    let margin = format!(
        "along the shell is beyond lanes of {:.2} m, the swath less the overlap, from where the hull fits",
        ground.swath_m
    );
    for (is_margin, why) in [(true, margin.as_str()), (false, NARROW_GAPS)] {
        let mut closed = grid.clone();
        for cell in 0..closed.reachable.len() {
            let at = grid.center(cell);
            closed.reachable[cell] = !grid.reachable[cell]
                && order.regions.is_empty()
                && ground.is_floor(at)
                && is_shell_margin(ground, grid, at) == is_margin;
        }
        closed.swept.fill(0);
        log_places(&closed, cell_m2, why, ground, ctx);
    }
    if order.reel_length_m.is_finite() {
        let mut far = grid.clone();
        let home = ground.home();
        for cell in 0..far.reachable.len() {
            far.reachable[cell] = grid.reachable[cell] && grid.swept[cell] == 0 && {
                let way_m = scan.slit.way_m(home, grid.center(cell));
                way_m.is_none_or(|way_m| way_m > order.reel_length_m - ground.swath_m)
            };
        }
        far.swept.fill(0);
        log_places(
            &far,
            cell_m2,
            &format!("is beyond the reel of {:.1} m", order.reel_length_m),
            ground,
            ctx,
        );
    }
}

/// Whether floor that is not in reach lies along the wall, beside floor that is, with no gap between wall and obstacle.
fn is_shell_margin(ground: &Ground, grid: &FloorGrid, at: Point) -> bool {
    let edge_m = ground.wall.wall_distance_m(at);
    let is_gap = || ground.parts.iter().any(|part| part.distance(at).0 + edge_m < 2.0 * ground.keep_m);
    let is_beside = || {
        (0..MARGIN_BEARINGS).any(|k| {
            let toward = direction(TAU * f64::from(k) / f64::from(MARGIN_BEARINGS));
            grid.has_reachable_near(at + toward * ground.keep_m)
        })
    };
    edge_m < ground.keep_m + ground.swath_m / 2.0 && !is_gap() && is_beside()
}

fn log_places(grid: &FloorGrid, cell_m2: f64, why: &str, ground: &Ground, ctx: &Ctx<'_>) {
    let groups = grid.missed();
    let worth: Vec<&Vec<usize>> = groups.iter().filter(|g| g.len() as f64 * cell_m2 > LEAST_M2).collect();
    for group in worth.iter().take(MOST_PLACES) {
        let middle = grid.center(group[group.len() / 2]);
        ctx.log(
            LogLevel::Warn,
            &format!(
                "{:.2} m2 of floor about ({:.1}, {:.1}) {why} (hull and clearance {:.2} m)",
                group.len() as f64 * cell_m2,
                middle.x,
                middle.y,
                ground.keep_m
            ),
        );
    }
    if worth.len() > MOST_PLACES {
        let rest: usize = worth[MOST_PLACES..].iter().map(|g| g.len()).sum();
        let places = match worth.len() - MOST_PLACES {
            1 => "1 more place".to_owned(),
            count => format!("{count} more places"),
        };
        ctx.log(LogLevel::Warn, &format!("{places}, {:.2} m2 together, {why}", rest as f64 * cell_m2));
    }
}
