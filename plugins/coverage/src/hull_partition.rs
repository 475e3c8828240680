//! The published way (Pan 2025): convex cells between hull rings, in an order by a genetic algorithm, with backtracking.

use crate::{
    answer::{self, plan_of},
    cuts::{Cut, between_cuts, close_up},
    floor::FloorGrid,
    follow::Follow,
    genetic,
    ground::{Ground, direction, middle},
    lanes::thinned,
    partition::{Border, Cell, borders, cells, unmerged},
    roam::Roam,
    scan::{Order, Piece, Scan},
    slit::Slit,
    stages::{Part, Stages},
};
use planner_api::{
    Caps, Code, Command, Config, Ctx, LogLevel, ParamSpec, Plan, PlanRequest, Planner, PlannerError, Result,
    Sensed, Site, choice, float,
};
use steering::params as p;
use world::{Boundary, Point, Vector, polyline};

const BACKTRACKING: ParamSpec = choice("backtracking", "Backtracking", &["tree", "direct"], 0)
    .help("The paper names backtracking and gives no algorithm. Tree: back through the cells as they were entered. \
           Direct: the shortest way from cell to cell, which entangles.")
    .group("Plan");
const ORDER: ParamSpec = choice("order", "Order of cells", &["genetic", "exact"], 0)
    .help("The published genetic algorithm, or the exact order for up to 13 cells.")
    .group("Plan");
const CELL: ParamSpec = float("cell_m", "Cell", "m", 0.01, 0.5, 0.05)
    .help("Edge of the cells in which floor is counted, to report what cannot be reached.")
    .group("Plan");
/// What stages take of the time that is left, about: division, order of cells, lanes.
const DIVISION: f64 = 0.1;
const ORDERING: f64 = 0.1;
const LANES: f64 = 0.88;
/// Lanes are looked at this closely, metres.
const STEP_M: f64 = 0.04;

/// Cuts reach this far beyond the corners of cells, metres.
const SEAM_M: f64 = 0.02;
/// The outermost lanes stay this far inside the strips of a cell, for rounding, metres.
const INSIDE_M: f64 = 3e-3;
/// A border is at the rim of sealed floor within this, metres.
const RIM_M: f64 = 0.01;
/// Floor behind closed gates that is worth a word, square metres.
const SEALED_M2: f64 = 0.05;

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
    const ABOUT: &'static str = "Pan 2025: convex cells between the hull rings of the columns, visited in an order by a \
                                 genetic algorithm, with backtracking.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::COVERAGE);
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

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        let task = answer::cover(request, Self::ID)?;
        let ground = Ground::new(request.site, task.anchor)?;
        if !is_convex(&ground.wall) {
            return Err(PlannerError::new(
                Code::Unsupported,
                "hull rings need a convex wall; choose tether-safe",
            ));
        }
        let columns: Vec<(Point, f64)> = ground.parts.iter().map(column).collect();
        let home = ground.home();
        let mut stages = Stages::new(ctx);
        stages.next(DIVISION, "cells").begin();
        let Division { cells, first, mut cuts, mut slit } =
            Division::new(&ground, &columns, self.is_tree, home).ok_or_else(|| answer::no_room(&ground))?;
        if self.is_tree && !slit.is_simple {
            ctx.log(
                LogLevel::Warn,
                "columns too near to each other leave a way round, which the method does not rule out: closed by a cut \
                 of our own",
            );
            close_up(&mut cuts, &mut slit);
        }
        let lines: Vec<Vec<Point>> = cuts.iter().map(|cut| cut.line.clone()).collect();
        let grid = FloorGrid::new(&ground, &slit, self.cell_m);
        let roam = if self.is_tree { None } else { Some(Roam::new(&ground, ctx)?) };
        let way = |a: Point, b: Point| match &roam {
            Some(roam) => roam.way(a, b),
            None => slit.path(a, b).unwrap_or_else(|| vec![a, b]),
        };
        let start = if slit.contains(request.start.position) { request.start.position } else { home };
        let mut within = grid.clone();
        within.keep_within(task.regions);
        // On a cut nobody knows on which side of it a lane ends.
        let is_off_cuts = |at: Point| lines.iter().all(|line| polyline::distance_m(line, at) > INSIDE_M);
        let is_wanted =
            |at: Point| is_off_cuts(at) && (task.regions.is_empty() || within.has_reachable_near(at));
        let mut pieces = Vec::new();
        let mut at = start;
        let cells_in_order =
            self.order(&cells, first, request.site.seed, &stages.next(ORDERING, "order of cells"));
        let part = stages.next(LANES, "lanes of cells");
        for (k, cell) in cells_in_order.into_iter().enumerate() {
            ctx.check()?;
            part.report(k as f64 / cells.len() as f64, k, cells.len());
            let lanes = lanes(&cells[cell], &ground, &slit, &is_wanted);
            for lane in lanes.iter().flat_map(|lane| between_cuts(lane, &cuts)) {
                pieces.push(Piece { points: way(at, lane[0]), is_lane: false });
                at = lane[lane.len() - 1];
                pieces.push(Piece { points: thinned(&lane), is_lane: true });
            }
        }
        pieces.push(Piece { points: way(at, home), is_lane: false });
        let mut scan = Scan { pieces, cuts, slit, grid };
        stages.next(1.0, "floor out of reach").begin();
        scan.grid.sweep(&scan.path());
        let order = Order { start, regions: task.regions, reel_length_m: f64::INFINITY, cell_m: self.cell_m };
        answer::report_unreachable(&ground, &scan, &order, ctx);
        let mut plan = plan_of(&scan, request.start.position, &[]);
        plan.cuts.iter_mut().for_each(|cut| trim(cut));
        if scan.slit.sealed_m2 > SEALED_M2 {
            plan.complete = false;
            let sealed_m2 = scan.slit.sealed_m2;
            ctx.log(
                LogLevel::Warn,
                &format!("the cells leave no gate to {sealed_m2:.2} m2; choose tether-safe"),
            );
        }
        self.follow.take(&plan);
        Ok(plan)
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        self.follow.step(sensed, ctx)
    }
}

/// The floor in cells, and the domain in which the robot moves between them.
struct Division {
    cells: Vec<Cell>,
    first: usize,
    cuts: Vec<Cut>,
    slit: Slit,
}

impl Division {
    /// Merged cells, unless merging leaves a way round a column, which the paper's rule does not rule out.
    fn new(ground: &Ground, columns: &[(Point, f64)], is_tree: bool, home: Point) -> Option<Self> {
        let merged = Self::of(cells(ground, columns), ground, columns, is_tree, home)?;
        if !is_tree || merged.slit.is_simple {
            return Some(merged);
        }
        Self::of(unmerged(ground, columns), ground, columns, is_tree, home)
    }

    fn of(
        cells: Vec<Cell>,
        ground: &Ground,
        columns: &[(Point, f64)],
        is_tree: bool,
        home: Point,
    ) -> Option<Self> {
        let first = (0..cells.len()).find(|k| cells[*k].contains(home)).unwrap_or(0);
        let borders = borders(&cells, ground, columns);
        if !is_tree {
            let slit = Slit::new(ground, &[], home)?;
            return Some(Self { cells, first, cuts: Vec::new(), slit });
        }
        let mut gates = tree(&cells, &borders, first);
        let (mut cuts, mut slit) = slit_by(ground, &borders, &gates, home)?;
        while slit.sealed_m2 > SEALED_M2 {
            let Some(opened) = one_more_gate(ground, &borders, &gates, &slit, home) else { break };
            (gates, cuts, slit) = opened;
        }
        Some(Self { cells, first, cuts, slit })
    }
}

/// The cuts that leave these gates, and what is left of the floor.
fn slit_by(ground: &Ground, borders: &[Border], gates: &[usize], home: Point) -> Option<(Vec<Cut>, Slit)> {
    let cuts = cuts(borders, gates);
    let lines: Vec<Vec<Point>> = cuts.iter().map(|cut| cut.line.clone()).collect();
    let slit = Slit::new(ground, &lines, home)?;
    Some((cuts, slit))
}

/// One gate more, where discs divide a cell so that the tree of cells leaves a part of it without any.
///
/// The widest border at the rim of what is sealed off that lets the robot in: it joins what was apart, so it makes no way
/// round a column.
fn one_more_gate(
    ground: &Ground,
    borders: &[Border],
    gates: &[usize],
    slit: &Slit,
    home: Point,
) -> Option<(Vec<usize>, Vec<Cut>, Slit)> {
    let is_at_rim = |border: &Border| {
        let line = [border.ends.0, border.ends.1];
        slit.sealed_rim.iter().any(|at| polyline::distance_m(&line, *at) < RIM_M)
    };
    let width_m = |k: &usize| (borders[*k].ends.1 - borders[*k].ends.0).norm();
    let mut closed: Vec<usize> = (0..borders.len())
        .filter(|k| borders[*k].is_open && !gates.contains(k) && is_at_rim(&borders[*k]))
        .filter(|k| width_m(k) > 3.0 * SEAM_M)
        .collect();
    closed.sort_by(|a, b| width_m(b).total_cmp(&width_m(a)));
    closed.into_iter().find_map(|gate| {
        let gates: Vec<usize> = gates.iter().copied().chain([gate]).collect();
        let (cuts, opened) = slit_by(ground, borders, &gates, home)?;
        let is_gain =
            opened.sealed_m2 < slit.sealed_m2 - SEALED_M2 / 2.0 && opened.is_simple == slit.is_simple;
        is_gain.then_some((gates, cuts, opened))
    })
}

impl HullPartition {
    fn order(&self, cells: &[Cell], first: usize, seed: u64, part: &Part<'_>) -> Vec<usize> {
        let names: Vec<usize> =
            std::iter::once(first).chain((0..cells.len()).filter(|k| *k != first)).collect();
        let centers: Vec<Point> = names.iter().map(|k| cells[*k].center()).collect();
        let distance: Vec<Vec<f64>> =
            centers.iter().map(|a| centers.iter().map(|b| (a - b).norm()).collect()).collect();
        let report = |share: f64| part.reached(share);
        let order = if self.is_exact {
            genetic::exact(&distance, seed, &report)
        } else {
            genetic::evolved(&distance, seed, &report)
        };
        order.into_iter().map(|k| names[k]).collect()
    }
}

fn column(part: &geometry::convex::Part) -> (Point, f64) {
    let at = middle(part);
    (at, part.corners().iter().map(|c| (c.0 - at).norm() + c.1).fold(0.0, f64::max))
}

fn is_convex(wall: &Boundary) -> bool {
    let Boundary::Polygon { vertices } = wall else { return true };
    let n = vertices.len();
    (0..n).all(|k| {
        let (a, b, c) = (vertices[k], vertices[(k + 1) % n], vertices[(k + 2) % n]);
        (b - a).perp(&(c - b)) >= -1e-9
    })
}

/// Every border that is no gate is a cut.
fn cuts(borders: &[Border], gates: &[usize]) -> Vec<Cut> {
    // Pieces under the discs need no cut.
    let closed = borders.iter().enumerate().filter(|(k, border)| border.is_open && !gates.contains(k));
    let mut lines: Vec<(Point, Point)> = Vec::new();
    for (_, border) in closed {
        let mut line = border.ends;
        while let Some(k) = lines.iter().position(|other| united(line, *other).is_some()) {
            line = united(line, lines.swap_remove(k)).unwrap_or(line);
        }
        lines.push(line);
    }
    let cut = |(a, b): (Point, Point)| {
        // A little longer, so that cuts that meet leave no slit between them.
        let more = (b - a).normalize() * SEAM_M;
        Cut { line: vec![a - more, b + more], from: 0 }
    };
    lines.into_iter().map(cut).collect()
}

/// Takes the seams off the ends of a cut: ways that bend about an end shall not count as crossing it.
fn trim(cut: &mut [Point]) {
    if let [a, b] = cut {
        let less = (*b - *a) * (1.5 * SEAM_M / (*b - *a).norm().max(1e-9)).min(0.3);
        (*a, *b) = (*a + less, *b - less);
    }
}

/// Two segments on one line that touch, as one.
fn united(a: (Point, Point), b: (Point, Point)) -> Option<(Point, Point)> {
    let ahead = (a.1 - a.0).normalize();
    let place = |p: Point| (p - a.0).dot(&ahead);
    let is_on_line = |p: Point| ahead.perp(&(p - a.0)).abs() < 1e-5;
    let (low, high) = (place(b.0).min(place(b.1)), place(b.0).max(place(b.1)));
    let touches = low <= place(a.1) + 1e-4 && high >= -1e-4;
    let ends = (low.min(0.0), high.max(place(a.1)));
    (is_on_line(b.0) && is_on_line(b.1) && touches).then_some((a.0 + ahead * ends.0, a.0 + ahead * ends.1))
}

/// Gates of the tree of shortest ways from the first cell, centre by gate to centre.
fn tree(cells: &[Cell], borders: &[Border], first: usize) -> Vec<usize> {
    let mut far_m = vec![f64::INFINITY; cells.len()];
    let mut gate: Vec<Option<usize>> = vec![None; cells.len()];
    let mut open: Vec<usize> = (0..cells.len()).collect();
    far_m[first] = 0.0;
    while let Some(place) = (0..open.len()).min_by(|a, b| far_m[open[*a]].total_cmp(&far_m[open[*b]])) {
        let cell = open.swap_remove(place);
        for (k, border) in borders.iter().enumerate().filter(|(_, b)| b.is_gate) {
            let (a, b) = border.cells;
            let Some(next) = (if a == cell {
                Some(b)
            } else if b == cell {
                Some(a)
            } else {
                None
            }) else {
                continue;
            };
            let through = border.middle();
            let way_m = far_m[cell]
                + (through - cells[cell].center()).norm()
                + (cells[next].center() - through).norm();
            if way_m < far_m[next] {
                (far_m[next], gate[next]) = (way_m, Some(k));
            }
        }
    }
    gate.into_iter().flatten().collect()
}

/// Lanes of a cell along the long side of its smallest rectangle, to and fro, first on the side of the corner that is
/// nearest to the centre (as published).
fn lanes(cell: &Cell, ground: &Ground, slit: &Slit, is_wanted: &dyn Fn(Point) -> bool) -> Vec<Vec<Point>> {
    let hull = cell.hull();
    let Some((ahead, (low, high))) = smallest_rectangle(&hull) else { return Vec::new() };
    let side = Vector::new(-ahead.y, ahead.x);
    let (low, high) = (low + INSIDE_M, high - INSIDE_M);
    let n = ((high - low) / ground.swath_m - 1e-6).ceil().max(1.0) as usize;
    let strip_m = (high - low) / n as f64;
    let center = cell.center();
    let nearest = hull.iter().min_by(|a, b| (*a - center).norm().total_cmp(&(*b - center).norm()));
    let is_high = nearest.is_some_and(|corner| corner.coords.dot(&side) > f64::midpoint(low, high));
    let along = hull.iter().map(|p| p.coords.dot(&ahead));
    let (from, to) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), s| (l.min(s), h.max(s)));
    let mut lanes = Vec::new();
    for k in 0..n {
        let row = if is_high { n - 1 - k } else { k };
        let foot = side * (low + (row as f64 + 0.5) * strip_m);
        let ends = [Point::from(foot + ahead * from), Point::from(foot + ahead * to)];
        let line = polyline::resampled(&ends, STEP_M);
        let is_open =
            |p: &Point| cell.contains(*p) && ground.is_free(*p) && slit.contains(*p) && is_wanted(*p);
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

/// Long direction and extent across of the smallest rectangle around a convex polygon.
fn smallest_rectangle(hull: &[Point]) -> Option<(Vector, (f64, f64))> {
    let spread = |way: Vector| {
        let places = hull.iter().map(|p| p.coords.dot(&way));
        places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| (low.min(s), high.max(s)))
    };
    let edges = hull.iter().zip(hull.iter().cycle().skip(1)).filter_map(|(a, b)| (b - a).try_normalize(1e-9));
    let rectangle = |along: Vector| {
        let across = Vector::new(-along.y, along.x);
        let (l, w) = (spread(along), spread(across));
        let area = (l.1 - l.0) * (w.1 - w.0);
        if l.1 - l.0 >= w.1 - w.0 {
            (area, along, w)
        } else {
            (area, across, spread(Vector::new(-across.y, across.x)))
        }
    };
    edges.map(rectangle).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, along, extent)| {
        let turn = direction(along.y.atan2(along.x));
        (turn, extent)
    })
}

#[cfg(test)]
mod tests;
