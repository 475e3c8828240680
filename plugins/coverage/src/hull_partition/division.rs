//! The floor divided into cells, and the domain in which the robot moves between them: through the gates of a tree.

use crate::hull_partition::borders::{Border, ON_LINE_M, borders};
use crate::hull_partition::cells::{Cell, Column, cells};
use crate::slit_domain::SlitDomain;
use crate::tuning::hull_partition::{CONVEX_ENOUGH, DEEP_M, SEALED_M2, SEAM_M, SMALL_SWATHS};
use crate::workspace::Workspace;
use world::{Point, polyline};

/// The cells, and the domain between them.
pub(super) struct Division<'a> {
    pub cells: Vec<Cell>,
    /// The cell that contains home.
    pub first: usize,
    pub domain: SlitDomain<'a>,
}

impl<'a> Division<'a> {
    /// Divides the floor into merged cells, or into unmerged ones if merging leaves a path around a column, which the
    /// paper's rule does not prevent. With `is_tree`, all borders except the gates of the tree become cuts; otherwise,
    /// none do.
    pub(super) fn new(workspace: &'a Workspace, is_tree: bool) -> Option<Self> {
        let columns = Column::all(workspace);
        let cells = cells(workspace, &columns);
        let merged = Self::of(merged(cells.clone(), workspace, &columns), workspace, &columns, is_tree)?;
        let is_good = !is_tree || merged.domain.is_simple;
        if is_good { Some(merged) } else { Self::of(cells, workspace, &columns, is_tree) }
    }

    fn of(cells: Vec<Cell>, workspace: &'a Workspace, columns: &[Column], is_tree: bool) -> Option<Self> {
        let first = cells.iter().position(|cell| cell.contains(workspace.home)).unwrap_or(0);
        if !is_tree {
            return Some(Self { cells, first, domain: SlitDomain::new(workspace, Vec::new())? });
        }
        let borders = borders(&cells, workspace, columns);
        let mut gates = tree(&cells, &borders, first);
        let mut domain = SlitDomain::new(workspace, cuts(&borders, &gates))?;
        while domain.sealed.area_m2 > SEALED_M2 {
            let Some(opened) = one_more_gate(&borders, &gates, &domain) else { break };
            (gates, domain) = opened;
        }
        Some(Self { cells, first, domain })
    }
}

/// The gates used by the tree of shortest paths from the first cell. Paths run from centre through gate to centre
/// (Dijkstra 1959).
fn tree(cells: &[Cell], borders: &[Border], first: usize) -> Vec<usize> {
    let mut far_m = vec![f64::INFINITY; cells.len()];
    let mut gate: Vec<Option<usize>> = vec![None; cells.len()];
    let mut open: Vec<usize> = (0..cells.len()).collect();
    far_m[first] = 0.0;
    while let Some(place) = (0..open.len()).min_by(|a, b| far_m[open[*a]].total_cmp(&far_m[open[*b]])) {
        let cell = open.swap_remove(place);
        for (k, border) in borders.iter().enumerate().filter(|(_, border)| border.is_gate) {
            let Some(next) = border.beyond(cell) else { continue };
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

/// Adds one gate if discs divide a cell and the tree leaves a part of that cell without a gate.
///
/// The gate is the widest border along the sealed floor through which the robot can enter. It joins parts that were
/// separate, so it opens no path around a column.
fn one_more_gate<'a>(
    borders: &[Border],
    gates: &[usize],
    domain: &SlitDomain<'a>,
) -> Option<(Vec<usize>, SlitDomain<'a>)> {
    let is_at_rim = |border: &Border| {
        let line = [border.ends.0, border.ends.1];
        domain.sealed.rim.iter().any(|at| polyline::distance_m(&line, *at) < 0.01)
    };
    let length_m = |k: &usize| borders[*k].length_m();
    let mut closed: Vec<usize> = (0..borders.len())
        .filter(|k| borders[*k].is_open && !gates.contains(k) && is_at_rim(&borders[*k]))
        .filter(|k| length_m(k) > 3.0 * SEAM_M)
        .collect();
    closed.sort_by(|a, b| length_m(b).total_cmp(&length_m(a)));
    closed.into_iter().find_map(|gate| {
        let gates = [gates, &[gate]].concat();
        let opened = SlitDomain::new(domain.workspace, cuts(borders, &gates))?;
        let is_gain = opened.sealed.area_m2 < domain.sealed.area_m2 - SEALED_M2 / 2.0
            && opened.is_simple == domain.is_simple;
        is_gain.then_some((gates, opened))
    })
}

/// Turns every border that is not a gate into a cut. Pieces under the discs need no cut.
fn cuts(borders: &[Border], gates: &[usize]) -> Vec<Vec<Point>> {
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
        // Each cut is slightly longer than its border, so that cuts that meet leave no slit between them.
        let more = (b - a).normalize() * SEAM_M;
        vec![a - more, b + more]
    };
    lines.into_iter().map(cut).collect()
}

/// Joins two touching segments on one line.
fn united(a: (Point, Point), b: (Point, Point)) -> Option<(Point, Point)> {
    let ahead = (a.1 - a.0).normalize();
    let place = |p: Point| (p - a.0).dot(&ahead);
    let is_on_line = |p: Point| ahead.perp(&(p - a.0)).abs() < ON_LINE_M;
    let (low, high) = (place(b.0).min(place(b.1)), place(b.0).max(place(b.1)));
    let touches = low <= place(a.1) + 1e-4 && high >= -1e-4;
    let ends = (low.min(0.0), high.max(place(a.1)));
    (is_on_line(b.0) && is_on_line(b.1) && touches).then_some((a.0 + ahead * ends.0, a.0 + ahead * ends.1))
}

/// Shortens a cut at both ends, so that paths bending around an end do not count as crossing it.
pub(super) fn trim(cut: &mut [Point]) {
    if let [a, b] = cut {
        let less = (*b - *a) * (1.5 * SEAM_M / (*b - *a).norm().max(1e-9)).min(0.3);
        (*a, *b) = (*a + less, *b - less);
    }
}

/// Merges each cell that is too small with the neighbour that gives the most convex result.
pub(super) fn merged(mut cells: Vec<Cell>, workspace: &Workspace, columns: &[Column]) -> Vec<Cell> {
    let min_area_m2 = (SMALL_SWATHS * workspace.swath_m).powi(2);
    let mut left_alone: Vec<Point> = Vec::new();
    loop {
        let is_small = |cell: &Cell| cell.area_m2() < min_area_m2 && !left_alone.contains(&cell.center());
        let Some(small) = cells.iter().position(is_small) else { return cells };
        let borders = borders(&cells, workspace, columns);
        let whole =
            |k: usize| Cell { polygons: [&cells[small].polygons[..], &cells[k].polygons[..]].concat() };
        let others =
            (0..cells.len()).filter(|k| neighbours(&borders, small).any(|neighbour| neighbour == *k));
        let best = others
            .map(|k| (whole(k).convexity(), k))
            .filter(|(share, k)| {
                *share >= CONVEX_ENOUGH && is_sound(&borders, &whole(*k), (small, *k), columns)
            })
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, with)) = best else {
            left_alone.push(cells[small].center());
            continue;
        };
        let cell = whole(with);
        cells.remove(small.max(with));
        cells[small.min(with)] = cell;
    }
}

/// The cells that gates connect to a cell.
fn neighbours(borders: &[Border], cell: usize) -> impl Iterator<Item = usize> {
    borders.iter().filter(|border| border.is_gate).filter_map(move |border| border.beyond(cell))
}

/// Whether two cells may be merged: no column may be inside the result, and no third cell may have gates to both,
/// because a column would then stand between them.
fn is_sound(borders: &[Border], whole: &Cell, (a, b): (usize, usize), columns: &[Column]) -> bool {
    let ring = whole.hull();
    let depth_m = |(p, q): (Point, Point), at: Point| (q - p).perp(&(at - p)) / (q - p).norm();
    let is_deep = |column: &Column| polyline::edges(&ring).all(|edge| depth_m(edge, column.center) > DEEP_M);
    let is_shared = |other: usize| other != b && neighbours(borders, b).any(|twin| twin == other);
    !neighbours(borders, a).any(is_shared) && !columns.iter().any(is_deep)
}
