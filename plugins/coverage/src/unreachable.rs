//! Reports the floor that cannot be scanned, and why.

use crate::floor::ReachableFloor;
use crate::plane::direction;
use crate::polish::shell::{before_shell, open_stretches};
use crate::scan::Scan;
use crate::scope::Scope;
use crate::workspace::Workspace;
use planner_api::{Ctx, LogLevel};
use std::f64::consts::TAU;
use world::{
    Point, polyline,
    shape::{mean_of, ring_area_m2},
};

/// Smallest unreachable area that is reported, square metres.
const LEAST_M2: f64 = 0.05;
/// Smallest width of an unreachable rim along the shell, and shortest open stretch of the shell, that is reported,
/// metres.
const LEAST_RIM_M: f64 = 0.005;
const LEAST_OPEN_M: f64 = 0.1;
/// Maximum number of areas listed individually.
const MOST_PLACES: usize = 8;

/// Logs which floor cannot be scanned, and why. Returns whether all requested regions contain reachable floor.
pub(crate) fn report(scan: &Scan<'_>, scope: &Scope<'_>, ctx: &Ctx<'_>) -> bool {
    let Workspace { swath_m, keep_m, .. } = *scan.domain.workspace;
    let raster = scan.swept.raster();
    let log = |why: &str, is_meant: &dyn Fn(usize) -> bool| {
        let groups = raster.groups(is_meant);
        let area_m2 = |group: &Vec<usize>| group.len() as f64 * raster.cell_m2();
        let worth: Vec<&Vec<usize>> = groups.iter().filter(|group| area_m2(group) > LEAST_M2).collect();
        for group in worth.iter().take(MOST_PLACES) {
            let (area_m2, at) = (area_m2(group), raster.center(group[group.len() / 2]));
            let place = format!("{area_m2:.2} m² of floor around ({:.1}, {:.1})", at.x, at.y);
            ctx.log(LogLevel::Warn, &format!("{place} {why} (hull and clearance {keep_m:.2} m)"));
        }
        if let Some(rest @ [_, ..]) = worth.get(MOST_PLACES..) {
            let places =
                if rest.len() == 1 { "1 more place" } else { &format!("{} more places", rest.len()) };
            let area_m2 = rest.iter().map(|group| group.len()).sum::<usize>() as f64 * raster.cell_m2();
            ctx.log(LogLevel::Warn, &format!("{places}, {area_m2:.2} m² together, {why}"));
        }
    };
    let is_closed = |cell: usize| {
        !scan.swept.floor.cells[cell]
            && scope.regions.is_empty()
            && scan.domain.workspace.is_floor(raster.center(cell))
    };
    let is_margin = |cell: usize| is_shell_margin(scan, raster.center(cell));
    let margin = format!("along the shell is out of reach of lanes {swath_m:.2} m wide");
    log(&margin, &|cell| is_closed(cell) && is_margin(cell));
    for line in shell_left(scan, scope) {
        ctx.log(LogLevel::Warn, &line);
    }
    let gaps = "cannot be reached: the gaps are too narrow for hull and clearance";
    log(gaps, &|cell| is_closed(cell) && !is_margin(cell));
    if scope.reel_length_m.is_finite() {
        let is_far =
            |at: Point| scan.domain.way_home_m(at).is_none_or(|way_m| way_m > scope.reel_length_m - swath_m);
        let why = format!("is out of reach of the reel ({:.1} m)", scope.reel_length_m);
        log(&why, &|cell| scan.swept.is_missed(cell) && is_far(raster.center(cell)));
    }
    let whole = ReachableFloor::new(&scan.domain, scope.cell_m);
    // During a mission, the remaining floor is given as blocks of cells. Some are slivers that only the full width of
    // the tool reaches.
    let least_m2 = if scope.whole > 1.0 { LEAST_M2 } else { 0.0 };
    let closed: Vec<Point> = scope
        .regions
        .iter()
        .filter(|ring| ring_area_m2(ring).abs() >= least_m2 && whole.cells_in(ring).is_empty())
        .map(|ring| mean_of(ring))
        .collect();
    for at in closed.iter().take(MOST_PLACES) {
        let place = format!("area at {:.1}, {:.1} m", at.x, at.y);
        ctx.log(LogLevel::Warn, &format!("{place} left out: out of the tool's reach"));
    }
    if let Some(n) = closed.len().checked_sub(MOST_PLACES + 1) {
        ctx.log(LogLevel::Warn, &format!("left out for the same reason: {} more", n + 1));
    }
    closed.is_empty()
}

/// The floor that a pass along the shell does not scan, with the reasons: the rim that the tool cannot reach from
/// anywhere, and stretches where the path is farther from the shell than hull and clearance require.
fn shell_left(scan: &Scan<'_>, scope: &Scope<'_>) -> Vec<String> {
    let workspace = scan.domain.workspace;
    let Workspace { hull_m, keep_m, swath_m, .. } = *workspace;
    let mut lines = Vec::new();
    let rim_m = keep_m - swath_m / 2.0;
    if rim_m > LEAST_RIM_M {
        lines.push(format!(
            "shell: a rim of {rim_m:.2} m along it cannot be reached: hull radius {hull_m:.2} m + \
             clearance {:.2} m - half the lane width of {swath_m:.2} m (swath less overlap)",
            keep_m - hull_m
        ));
    }
    if !scope.regions.is_empty() {
        return lines;
    }
    let (mut no_room_m, mut cut_m, mut left_m) = (0.0, 0.0, 0.0);
    for stretch in open_stretches(workspace, &scan.path()) {
        let at = before_shell(workspace, stretch.at);
        let is_cut = || scan.domain.cuts.iter().any(|cut| polyline::distance_m(cut, at) < swath_m / 2.0);
        let sum_m = match () {
            () if !workspace.is_free(at) => &mut no_room_m,
            () if is_cut() => &mut cut_m,
            () => &mut left_m,
        };
        *sum_m += stretch.length_m;
    }
    let causes = [
        (no_room_m, "where hull and clearance do not fit"),
        (cut_m, "at cuts, which the tether must not cross"),
        (left_m, "where no lane runs along it"),
    ];
    let open_m: f64 = causes.iter().map(|(length_m, _)| length_m).sum();
    if open_m > LEAST_OPEN_M {
        let causes = causes.iter().filter(|(length_m, _)| *length_m >= 0.05);
        let causes: Vec<String> = causes.map(|(length_m, why)| format!("{length_m:.1} m {why}")).collect();
        lines.push(format!(
            "shell: along {open_m:.1} m of it, the scan is not as close to the wall as usual: {}",
            causes.join(", ")
        ));
    }
    lines
}

/// Whether a position of unreachable floor lies along the wall, next to reachable floor, and not in a gap between wall
/// and obstacle.
fn is_shell_margin(scan: &Scan<'_>, at: Point) -> bool {
    let Workspace { wall, parts, keep_m, swath_m, .. } = scan.domain.workspace;
    let edge_m = wall.wall_distance_m(at);
    let is_gap = || parts.iter().any(|part| part.distance(at).0 + edge_m < 2.0 * keep_m);
    let toward = |k: u32| direction(TAU * f64::from(k) / 24.0);
    let is_beside = || (0..24).any(|k| scan.swept.floor.is_near(at + toward(k) * *keep_m));
    edge_m < keep_m + swath_m / 2.0 && !is_gap() && is_beside()
}
