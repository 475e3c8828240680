//! Borders between cells, and which of them are gates.

use crate::hull_partition::cells::{Cell, Column, EPSILON_M};
use crate::tuning::hull_partition::LEAST_GATE_M;
use crate::workspace::Workspace;
use world::{Point, polyline::edges};

/// Distance from a line within which edges count as collinear, metres.
pub(super) const ON_LINE_M: f64 = 1e-5;

/// A piece of the boundary between two cells.
pub(super) struct Border {
    /// The cells on either side, the lower index first.
    cells: (usize, usize),
    /// The ends of the piece.
    pub ends: (Point, Point),
    /// Whether the piece is outside all discs grown by the distance to keep.
    pub is_open: bool,
    /// Whether the piece is open and wide enough to pass.
    pub is_gate: bool,
}

impl Border {
    pub(super) fn middle(&self) -> Point {
        self.ends.0 + (self.ends.1 - self.ends.0) / 2.0
    }

    pub(super) fn length_m(&self) -> f64 {
        (self.ends.1 - self.ends.0).norm()
    }

    /// The cell on the other side.
    pub(super) fn beyond(&self, cell: usize) -> Option<usize> {
        let (a, b) = self.cells;
        if a == cell { Some(b) } else { (b == cell).then_some(a) }
    }
}

/// The boundary that two cells share, in passable and impassable pieces.
pub(super) fn borders(cells: &[Cell], workspace: &Workspace, columns: &[Column]) -> Vec<Border> {
    let mut borders = Vec::new();
    for a in 0..cells.len() {
        for b in 0..a {
            let pairs = cells[a].polygons.iter().flat_map(|p| cells[b].polygons.iter().map(move |q| (p, q)));
            for ends in pairs.flat_map(|(p, q)| shared(p, q)) {
                borders.extend(pieces((b, a), ends, workspace, columns));
            }
        }
    }
    borders
}

/// Segments on the edges of both polygons.
fn shared(p: &[Point], q: &[Point]) -> Vec<(Point, Point)> {
    let mut found = Vec::new();
    for (a, b) in edges(p) {
        let length_m = (b - a).norm();
        if length_m < EPSILON_M {
            continue;
        }
        let along = (b - a) / length_m;
        let is_on_line = |x: Point| along.perp(&(x - a)).abs() < ON_LINE_M;
        for (c, d) in edges(q).filter(|(c, d)| is_on_line(*c) && is_on_line(*d)) {
            let (s, t) = ((c - a).dot(&along), (d - a).dot(&along));
            let (from, to) = (s.min(t).max(0.0), s.max(t).min(length_m));
            if to - from > 1e-3 {
                found.push((a + along * from, a + along * to));
            }
        }
    }
    found
}

/// Divides a border where it enters and leaves discs grown by the distance to keep.
fn pieces(
    cells: (usize, usize),
    ends: (Point, Point),
    workspace: &Workspace,
    columns: &[Column],
) -> Vec<Border> {
    let length_m = (ends.1 - ends.0).norm();
    let along = (ends.1 - ends.0) / length_m;
    let at = |m: f64| ends.0 + along * m;
    let mut marks = vec![0.0, length_m];
    for Column { center, radius_m } in columns {
        let reach_m = radius_m + workspace.keep_m;
        let (middle, aside) = ((center - ends.0).dot(&along), along.perp(&(center - ends.0)));
        if aside.abs() < reach_m {
            let half = (reach_m * reach_m - aside * aside).sqrt();
            marks.extend([middle - half, middle + half].into_iter().filter(|m| *m > 0.0 && *m < length_m));
        }
    }
    marks.sort_by(f64::total_cmp);
    let piece = |w: &[f64]| {
        let ends = (at(w[0]), at(w[1]));
        let is_open = workspace.is_free(at(f64::midpoint(w[0], w[1])));
        Border { cells, ends, is_open, is_gate: is_open && (ends.1 - ends.0).norm() > LEAST_GATE_M }
    };
    marks.windows(2).filter(|w| w[1] - w[0] > EPSILON_M).map(piece).collect()
}
