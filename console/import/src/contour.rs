//! The connected free floor of a map, and its outlines.

use crate::OccupancyMap;
use std::collections::VecDeque;

/// A lattice point.
pub(crate) type Node = [i32; 2];

/// Free cells that are connected through shared edges; all other cells are solid.
pub(crate) struct Component {
    columns: usize,
    is_free: Vec<bool>,
    /// The number of free cells.
    pub n_cells: usize,
    /// The first column and row with a free cell.
    pub low: Node,
    /// One more than the last column and row with a free cell.
    pub high: Node,
}

impl Component {
    /// The component that contains a cell; if none is given, or the cell is solid, the largest component.
    pub(crate) fn new(map: &OccupancyMap, start: Option<(usize, usize)>) -> Option<Self> {
        let at_start = start.map(|(x, y)| y * map.columns + x).filter(|cell| map.is_free[*cell]);
        let mut seen = vec![false; map.is_free.len()];
        let cells = match at_start {
            Some(cell) => flood(map, cell, &mut seen),
            None => (0..map.is_free.len()).fold(Vec::new(), |largest, cell| {
                let is_new = map.is_free[cell] && !seen[cell];
                let found = if is_new { flood(map, cell, &mut seen) } else { Vec::new() };
                if found.len() > largest.len() { found } else { largest }
            }),
        };
        let mut is_free = vec![false; map.is_free.len()];
        let (mut low, mut high) = ([i32::MAX; 2], [0; 2]);
        for cell in &cells {
            is_free[*cell] = true;
            let at = [(cell % map.columns) as i32, (cell / map.columns) as i32];
            for axis in 0..2 {
                low[axis] = low[axis].min(at[axis]);
                high[axis] = high[axis].max(at[axis] + 1);
            }
        }
        (!cells.is_empty()).then_some(Self { columns: map.columns, is_free, n_cells: cells.len(), low, high })
    }

    /// Whether each cell of the map belongs to the component.
    pub(crate) fn into_cells(self) -> Vec<bool> {
        self.is_free
    }

    /// Whether a cell is free; cells outside the map are not.
    pub(crate) fn is_free(&self, [x, y]: Node) -> bool {
        x >= 0
            && y >= 0
            && (x as usize) < self.columns
            && self.is_free.get(y as usize * self.columns + x as usize).is_some_and(|free| *free)
    }

    /// The outlines as closed chains of corners with the floor to the left: the outer outline counter-clockwise, the
    /// outlines of inner solids clockwise.
    ///
    /// Where two free cells share only a corner, the outline separates them.
    pub(crate) fn rings(&self) -> Vec<Vec<Node>> {
        // One bit for the direction (east, north, west, south) of each edge that leaves a lattice point.
        let wide = self.columns + 1;
        let mut edges = vec![0_u8; wide * (self.is_free.len() / self.columns + 1)];
        let index = |[x, y]: Node| y as usize * wide + x as usize;
        for (cell, _) in self.is_free.iter().enumerate().filter(|(_, free)| **free) {
            let (x, y) = ((cell % self.columns) as i32, (cell / self.columns) as i32);
            let sides = [
                ([x, y - 1], [x, y]),
                ([x + 1, y], [x + 1, y]),
                ([x, y + 1], [x + 1, y + 1]),
                ([x - 1, y], [x, y + 1]),
            ];
            for (direction, (beside, from)) in sides.into_iter().enumerate() {
                if !self.is_free(beside) {
                    edges[index(from)] |= 1 << direction;
                }
            }
        }
        let mut rings = Vec::new();
        for first in 0..edges.len() {
            while edges[first] != 0 {
                let from = [(first % wide) as i32, (first / wide) as i32];
                rings.push(trace(from, &mut edges, index));
            }
        }
        rings
    }
}

/// Follows edges from a point until they return to it, keeping left where there is a choice; returns the corners.
fn trace(first: Node, edges: &mut [u8], index: impl Fn(Node) -> usize) -> Vec<Node> {
    const STEPS: [Node; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];
    let start = edges[index(first)].trailing_zeros() as usize;
    let (mut at, mut direction) = (first, start);
    let mut corners = Vec::new();
    loop {
        at = [at[0] + STEPS[direction][0], at[1] + STEPS[direction][1]];
        let leaving = [1, 0, 3].map(|turn| (direction + turn) % 4);
        let next = leaving.into_iter().find(|next| edges[index(at)] & (1 << next) != 0);
        let next = next.expect("every point has as many outgoing as incoming edges");
        if next != direction {
            corners.push(at);
        }
        edges[index(at)] &= !(1 << next);
        if (at, next) == (first, start) {
            return corners;
        }
        direction = next;
    }
}

fn flood(map: &OccupancyMap, first: usize, seen: &mut [bool]) -> Vec<usize> {
    let (columns, rows) = (map.columns, map.rows());
    seen[first] = true;
    let mut found = vec![first];
    let mut open = VecDeque::from([first]);
    while let Some(cell) = open.pop_front() {
        let (x, y) = (cell % columns, cell / columns);
        let beside = [
            (x > 0).then(|| cell - 1),
            (x + 1 < columns).then_some(cell + 1),
            (y > 0).then(|| cell - columns),
            (y + 1 < rows).then_some(cell + columns),
        ];
        for next in beside.into_iter().flatten() {
            if map.is_free[next] && !seen[next] {
                seen[next] = true;
                found.push(next);
                open.push_back(next);
            }
        }
    }
    found
}
