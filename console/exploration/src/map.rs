//! The result of a survey.

use crate::{
    bodies::Column,
    cells::{self, CellState},
    grid::Grid,
    survey::Exploration,
};
use geometry::{Point, Shape, Vector};
use serde::{Deserialize, Serialize};

/// Width of the belt around a column or along the wall, metres, in which the fitted outline decides instead of single
/// echoes.
const BELT_M: f64 = 0.15;

/// The map that a survey has made, tank frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SurveyMap {
    /// The lattice.
    pub grid: Grid,
    /// The states of the cells, row by row from the lower left, each run as its length and a letter: `f` free, `s`
    /// solid, `u` not seen.
    pub cells: String,
    /// The columns.
    pub columns: Vec<Column>,
    /// Convex outlines of the other objects; a long object has several.
    pub others: Vec<Shape>,
    /// Share of the floor within the wall that scans have shown, 0 to 1.
    pub explored: f64,
}

/// The numbers of columns, in their order: the number in the name of the found obstacle that a column stands for, such as
/// `found 2`, so that a column has the same number in the log, on the map and in what is made of the map. Other columns get
/// the numbers after the largest one. `found`: the name and the centre of each found obstacle, metres, tank frame.
pub fn column_numbers<'a>(columns: &[Column], found: impl Iterator<Item = (&'a str, Point)>) -> Vec<usize> {
    let number = |name: &str| name.strip_prefix("found ")?.parse::<usize>().ok();
    let found: Vec<(usize, Point)> = found.filter_map(|(name, at)| Some((number(name)?, at))).collect();
    let mut next = found.iter().map(|(number, _)| *number).max().unwrap_or(0);
    let mut taken = Vec::new();
    for column in columns {
        let is_here = |at: &Point| column.shape().distance_m(*at) <= 0.0;
        let mut numbers = found.iter().filter(|(_, at)| is_here(at)).map(|(number, _)| *number);
        let number = numbers.find(|number| !taken.contains(number)).unwrap_or_else(|| {
            next += 1;
            next
        });
        taken.push(number);
    }
    taken
}

impl SurveyMap {
    /// The state of each cell; `None` if the text of the cells is damaged.
    pub fn states(&self) -> Option<Vec<CellState>> {
        let mut states = Vec::with_capacity(self.grid.len());
        for (cells, state) in cells::runs(&self.cells, self.grid.len())? {
            if cells.start != states.len() {
                return None;
            }
            states.extend(std::iter::repeat_n(state, cells.len()));
        }
        (states.len() == self.grid.len()).then_some(states)
    }
}

impl Exploration {
    /// The map according to all scans so far. Beside a column or the wall, the fitted outline decides which cells are
    /// free; elsewhere, the echoes.
    pub fn map(&self) -> SurveyMap {
        let bodies = self.bodies();
        let columns: Vec<Column> = bodies.iter().filter_map(|body| body.column).collect();
        let others =
            bodies.iter().filter(|body| body.column.is_none()).flat_map(crate::Body::shapes).collect();
        let cells = cells::text(&self.states(&columns));
        SurveyMap { grid: self.grid.clone(), cells, columns, others, explored: self.share() }
    }

    /// The state of each cell, row by row from the lower left; `columns` are those of [`Exploration::columns`].
    pub fn states(&self, columns: &[Column]) -> Vec<CellState> {
        let mut states: Vec<CellState> = (0..self.grid.len()).map(|cell| self.state(cell)).collect();
        for column in columns {
            let reach = Vector::repeat(column.radius_m + BELT_M);
            for cell in self.grid.within(column.center - reach, column.center + reach) {
                let off_m = (self.grid.center(cell) - column.center).norm() - column.radius_m;
                if self.is_floor[cell] && off_m <= BELT_M {
                    states[cell] = if off_m <= 0.0 { CellState::Solid } else { CellState::Free };
                }
            }
        }
        states
    }

    /// The state of a cell according to the echoes or, beside the wall, to the wall and the floor before it.
    fn state(&self, cell: usize) -> CellState {
        let at = self.grid.center(cell);
        if self.is_floor[cell] {
            return match self.evidence[cell].odds {
                odds if odds < 0.0 => CellState::Free,
                odds if odds > 0.0 => CellState::Solid,
                _ => CellState::Unseen,
            };
        }
        let wall_m = self.boundary.wall_distance_m(at);
        let is_seen_before = || {
            let reach = (BELT_M / self.grid.cell_m).ceil() as usize + 1;
            self.grid.around(cell, reach).any(|beside| self.is_free(beside))
        };
        match wall_m {
            wall_m if wall_m > 0.0 => {
                if is_seen_before() {
                    CellState::Free
                } else {
                    CellState::Unseen
                }
            }
            wall_m if wall_m > -2.0 * self.grid.cell_m => CellState::Solid,
            _ => CellState::Unseen,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_has_the_number_of_the_obstacle_that_it_stands_for() {
        let column = |x: f64| Column {
            center: Point::new(x, 0.0),
            radius_m: 0.3,
            center_sigma_m: 0.01,
            radius_sigma_m: 0.01,
        };
        let columns = [column(5.0), column(1.0), column(9.0), column(3.0)];
        let found = [
            ("found 2", Point::new(1.05, 0.0)),
            ("found 7", Point::new(5.1, 0.1)),
            ("cart", Point::new(9.0, 0.0)),
        ];
        assert_eq!(column_numbers(&columns, found.into_iter()), [7, 2, 8, 9]);
        assert_eq!(column_numbers(&columns, std::iter::empty()), [1, 2, 3, 4]);
    }
}
