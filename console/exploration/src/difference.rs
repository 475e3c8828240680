//! The difference between a map and a drawing.

use crate::{bodies::Column, cells::CellState, map::SurveyMap};
use geometry::{Point, Shape, Vector};

/// Maximum distance between the centres of a drawn column and of the column on the map that is the same, metres. Columns
/// of a tank are farther apart.
const SAME_M: f64 = 0.5;
/// Share of the seen cells inside a drawn object from which it is there.
const SOLID: f64 = 0.2;

/// Distance from a drawn object within which a cell of the map belongs to it, and distance between two outlines of one
/// object, metres.
const NEAR_M: f64 = 0.15;

/// What a map shows of a drawn object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fate {
    /// A column, which is on the map.
    Column {
        /// Index of the column on the map.
        found: usize,
        /// From the drawn centre to the centre on the map, metres.
        moved: Vector,
        /// Radius on the map minus the drawn radius, metres.
        grown_m: f64,
    },
    /// The object is there, but not as a column.
    There,
    /// The place of the object is free floor.
    NotThere,
    /// The place of the object has not been seen.
    NotSeen,
}

impl SurveyMap {
    /// What the map shows of each drawn object. Each column on the map is the same as at most one drawn column, the
    /// nearest. `None` if the text of the cells is damaged.
    pub fn fates(&self, drawn: &[Shape]) -> Option<Vec<Fate>> {
        let states = self.states()?;
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        for (index, shape) in drawn.iter().enumerate() {
            let Shape::Disc { center, .. } = shape else { continue };
            let away_m = |column: &Column| (column.center - center).norm();
            let near = self.columns.iter().enumerate().map(|(found, column)| (away_m(column), index, found));
            pairs.extend(near.filter(|(away_m, ..)| *away_m <= SAME_M));
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let mut same: Vec<(usize, usize)> = Vec::new();
        for (_, index, found) in pairs {
            if same.iter().all(|(other, taken)| *other != index && *taken != found) {
                same.push((index, found));
            }
        }
        let fate = |(index, shape): (usize, &Shape)| {
            let found = same.iter().find(|(other, _)| *other == index).map(|(_, found)| *found);
            match (found, shape) {
                (Some(found), Shape::Disc { center, radius_m }) => {
                    let column = &self.columns[found];
                    Fate::Column { found, moved: column.center - center, grown_m: column.radius_m - radius_m }
                }
                _ => self.shown_at(&states, shape),
            }
        };
        Some(drawn.iter().enumerate().map(fate).collect())
    }

    /// The objects on the map that are neither columns nor drawn: the south-west and the north-east corner of each. The
    /// outlines of one long object are one.
    pub fn not_drawn(&self, drawn: &[Shape]) -> Vec<[Point; 2]> {
        let is_near = |at: Point, shapes: &[Shape]| shapes.iter().any(|shape| shape.distance_m(at) <= NEAR_M);
        let mut objects: Vec<Vec<Shape>> = Vec::new();
        for outline in &self.others {
            let cells: Vec<Point> = self.cells_of(outline).map(|cell| self.grid.center(cell)).collect();
            let off = cells.iter().filter(|at| !is_near(**at, drawn)).count();
            if 2 * off <= cells.len() {
                continue;
            }
            let (touching, apart): (Vec<_>, Vec<_>) =
                objects.into_iter().partition(|object| cells.iter().any(|at| is_near(*at, object)));
            objects = apart;
            objects.push(touching.into_iter().flatten().chain([outline.clone()]).collect());
        }
        let bounds = |object: &Vec<Shape>| {
            let corners = object.iter().map(Shape::bounds).map(|(low, high)| [low, high]);
            corners.reduce(|[low, high], [l, h]| [low.inf(&l), high.sup(&h)])
        };
        objects.iter().filter_map(bounds).collect()
    }

    /// The cells that a shape covers.
    fn cells_of(&self, shape: &Shape) -> impl Iterator<Item = usize> {
        let (low, high) = shape.bounds();
        // A thin object may have no centre of a cell inside it.
        let reach_m = 0.5 * self.grid.cell_m;
        let reach = Vector::repeat(reach_m);
        let cells = self.grid.within(low - reach, high + reach);
        cells.filter(move |cell| shape.distance_m(self.grid.center(*cell)) <= reach_m)
    }

    /// What the cells show at the place of an object.
    fn shown_at(&self, states: &[CellState], shape: &Shape) -> Fate {
        let (mut seen, mut solid) = (0.0, 0.0);
        for cell in self.cells_of(shape) {
            seen += f64::from(u8::from(states[cell] != CellState::Unseen));
            solid += f64::from(u8::from(states[cell] == CellState::Solid));
        }
        match () {
            () if seen == 0.0 => Fate::NotSeen,
            () if solid >= SOLID * seen => Fate::There,
            () => Fate::NotThere,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{cells, grid::Grid};
    use geometry::{Boundary, Point, shape};

    /// A map of a round tank whose eastern half was seen, with a wide wall and two columns in it.
    fn map() -> SurveyMap {
        let grid = Grid::of(&Boundary::Circle { radius_m: 5.0 });
        let column = |x: f64, y: f64, radius_m: f64| Column {
            center: Point::new(x, y),
            radius_m,
            center_sigma_m: 0.01,
            radius_sigma_m: 0.01,
        };
        let columns = vec![column(2.1, 1.0, 0.22), column(2.0, -2.0, 0.3)];
        let wall = shape::rectangle(Point::new(3.0, 2.0), Point::new(3.2, 3.0));
        let wall = Shape::Polygon { vertices: wall };
        let state = |cell: usize| {
            let at = grid.center(cell);
            let is_column = columns.iter().any(|column| column.shape().distance_m(at) <= 0.0);
            match () {
                () if at.x < 0.0 => CellState::Unseen,
                () if is_column || wall.distance_m(at) <= 0.0 => CellState::Solid,
                () => CellState::Free,
            }
        };
        let states: Vec<CellState> = (0..grid.len()).map(state).collect();
        SurveyMap { cells: cells::text(&states), grid, columns, others: vec![wall], explored: 0.5 }
    }

    #[test]
    fn every_drawn_object_has_its_fate() {
        let disc = |x: f64, y: f64, radius_m: f64| Shape::Disc { center: Point::new(x, y), radius_m };
        let line =
            Shape::Polyline { points: vec![Point::new(3.1, 2.1), Point::new(3.1, 2.9)], half_width_m: 0.01 };
        let drawn = [
            disc(2.0, 1.0, 0.2),
            // A second drawn column near the same column on the map, but farther away.
            disc(2.4, 1.2, 0.2),
            disc(1.0, 0.0, 0.2),
            disc(-2.0, 0.0, 0.2),
            line,
        ];
        let fates = map().fates(&drawn).unwrap_or_default();
        let [Fate::Column { found: 0, moved, grown_m }, rest @ ..] = &fates[..] else { panic!("{fates:?}") };
        assert!((moved - Vector::new(0.1, 0.0)).norm() < 1e-9 && (grown_m - 0.02).abs() < 1e-9);
        assert_eq!(rest, [Fate::NotThere, Fate::NotThere, Fate::NotSeen, Fate::There]);
        let damaged = SurveyMap { cells: "1x".into(), ..map() };
        assert_eq!(damaged.fates(&drawn), None);
    }

    #[test]
    fn an_object_that_is_not_drawn_is_one_object_and_a_drawn_one_is_none() {
        let piece = |x: f64, to_x: f64| Shape::Polygon {
            vertices: shape::rectangle(Point::new(x, -1.0), Point::new(to_x, -0.8)),
        };
        let map = map();
        let wall = map.others[0].clone();
        let map = SurveyMap {
            others: vec![piece(0.5, 1.5), wall.clone(), piece(2.5, 3.5), piece(1.5, 2.5)],
            ..map
        };
        let [[low, high]] = &map.not_drawn(std::slice::from_ref(&wall))[..] else { panic!("one object") };
        assert_eq!((*low, *high), (Point::new(0.5, -1.0), Point::new(3.5, -0.8)));
        assert_eq!(map.not_drawn(&[]).len(), 2);
        let pipe =
            Shape::Polyline { points: vec![Point::new(0.5, -0.9), Point::new(3.5, -0.9)], half_width_m: 0.1 };
        assert!(map.not_drawn(&[wall, pipe]).is_empty());
    }
}
