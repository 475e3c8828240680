//! Floor that a survey has not seen.

use crate::{cells::CellState, map::SurveyMap};
use geometry::{Boundary, Point};

/// A connected part of the floor that no scan has shown, beside floor that is free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unseen {
    /// Its area, square metres.
    pub area_m2: f64,
    /// The middle of its cells, metres; it may lie outside of a part that is curved.
    pub middle: Point,
}

impl SurveyMap {
    /// The parts of the floor within the wall that no scan has shown and that a robot could drive onto, largest first: a
    /// robot whose hull has a radius of `hull_m` metres fits through the border with free floor and onto the part. The
    /// inside of a solid object is not among them, because its border is solid.
    ///
    /// Costs O(cells). A damaged map has no parts.
    pub fn unseen(&self, wall: &Boundary, hull_m: f64) -> Vec<Unseen> {
        let Some(states) = self.states() else { return Vec::new() };
        let is_unseen = |cell: usize| {
            states[cell] == CellState::Unseen && wall.wall_distance_m(self.grid.center(cell)) > 0.0
        };
        let cell_m = self.grid.cell_m;
        let mut is_done = vec![false; states.len()];
        let mut parts = Vec::new();
        for first in 0..states.len() {
            if is_done[first] || !is_unseen(first) {
                continue;
            }
            let (mut part, mut open) = (vec![first], 0_usize);
            is_done[first] = true;
            let mut next = 0;
            while let Some(cell) = part.get(next).copied() {
                next += 1;
                for beside in self.grid.beside(cell) {
                    open += usize::from(states[beside] == CellState::Free);
                    if !is_done[beside] && is_unseen(beside) {
                        is_done[beside] = true;
                        part.push(beside);
                    }
                }
            }
            let area_m2 = part.len() as f64 * cell_m * cell_m;
            if open as f64 * cell_m >= 2.0 * hull_m && area_m2 >= std::f64::consts::PI * hull_m * hull_m {
                let sum = part.iter().map(|cell| self.grid.center(*cell).coords).sum::<geometry::Vector>();
                parts.push(Unseen { area_m2, middle: Point::from(sum / part.len() as f64) });
            }
        }
        parts.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2));
        parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;

    /// A square floor of 4 m with cells of 0.1 m, drawn by a function of the column and the row of a cell.
    fn map(of: impl Fn(usize, usize) -> char) -> (SurveyMap, Boundary) {
        let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
        let wall = Boundary::Polygon { vertices: corners.map(|(x, y)| Point::new(x, y)).to_vec() };
        let grid = Grid { low: Point::origin(), cell_m: 0.1, columns: 40, rows: 40 };
        let cells = (0..1600).flat_map(|cell| ['1', of(cell % 40, cell / 40)]).collect();
        (SurveyMap { grid, cells, columns: vec![], others: vec![], explored: 0.5 }, wall)
    }

    #[test]
    fn floor_that_was_not_seen_counts_unless_it_is_enclosed_or_too_small() {
        let (half, wall) = map(|column, _| if column < 30 { 'f' } else { 'u' });
        let [part] = half.unseen(&wall, 0.25)[..] else { panic!() };
        assert!((part.area_m2 - 4.0).abs() < 1e-9 && (part.middle - Point::new(3.5, 2.0)).norm() < 1e-9);
        let inside = |at: usize| (10..30).contains(&at);
        let edge = |at: usize| at == 10 || at == 29;
        let (object, wall) = map(|column, row| match inside(column) && inside(row) {
            true if edge(column) || edge(row) => 's',
            true => 'u',
            false => 'f',
        });
        assert_eq!(object.unseen(&wall, 0.25), []);
        let (speck, wall) = map(|column, row| if column < 3 && row < 3 { 'u' } else { 'f' });
        assert_eq!((speck.unseen(&wall, 0.25).len(), speck.unseen(&wall, 0.05).len()), (0, 1));
    }
}
