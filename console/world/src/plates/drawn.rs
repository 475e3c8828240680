//! Plates from a drawing, each with its name and outline.

use super::{NONE, Plate, PlateKind, PlateMap};
use crate::coverage::Floor;
use geometry::{Boundary, Point, shape::bounds_of};
use serde::{Deserialize, Serialize};

/// The name for floor that lies on no plate of the drawing.
pub const NO_PLATE: &str = "no plate";
/// Distance from the shell within which a corner must lie for its plate to lie along the shell, metres.
const AT_SHELL_M: f64 = 0.05;
/// Distance, in cells, within which floor in the gap between plates belongs to the nearest plate.
const GAP_CELLS: isize = 2;

/// A plate of a drawing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DrawnPlate {
    /// The name of the plate, which is unique.
    pub name: String,
    /// Corners of a simple polygon, tank frame, metres.
    pub vertices_m: Vec<Point>,
}

impl DrawnPlate {
    /// Returns the outline as a closed line.
    ///
    /// ```
    /// use world::{DrawnPlate, Point};
    /// let vertices_m = vec![Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(0.0, 1.0)];
    /// assert_eq!(DrawnPlate { name: "P-01".into(), vertices_m }.outline().len(), 4);
    /// ```
    pub fn outline(&self) -> Vec<Point> {
        self.vertices_m.iter().chain(self.vertices_m.first()).copied().collect()
    }

    /// Returns the kind: annular along the shell; elsewhere, rectangular if the plate has four corners, and sketch if
    /// not.
    fn kind(&self, boundary: &Boundary) -> PlateKind {
        if self.vertices_m.iter().any(|at| boundary.wall_distance_m(*at) < AT_SHELL_M) {
            PlateKind::Annular
        } else if self.vertices_m.len() == 4 {
            PlateKind::Rectangular
        } else {
            PlateKind::Sketch
        }
    }

    /// Calls `fill` with the row and the columns of all floor cells whose centres lie in the plate.
    fn fill(&self, floor: &Floor, mut fill: impl FnMut(usize, std::ops::Range<usize>)) {
        let (low, high) = bounds_of(&self.vertices_m);
        // The first cell whose centre is not below a coordinate.
        let first = |at_m: f64, origin_m: f64, n: usize| {
            (((at_m - origin_m) / floor.cell_m - 0.5).ceil().max(0.0) as usize).min(n)
        };
        let rows = first(low.y, floor.origin.y, floor.height)..first(high.y, floor.origin.y, floor.height);
        let mut crossed_m = Vec::new();
        for row in rows {
            let y = floor.origin.y + (row as f64 + 0.5) * floor.cell_m;
            let sides = self.vertices_m.iter().zip(self.vertices_m.iter().cycle().skip(1));
            let crossing = |(a, b): (&Point, &Point)| {
                ((a.y > y) != (b.y > y)).then(|| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y))
            };
            crossed_m.clear();
            crossed_m.extend(sides.filter_map(crossing));
            crossed_m.sort_unstable_by(f64::total_cmp);
            for inside in crossed_m.chunks_exact(2) {
                let column = |x: f64| first(x, floor.origin.x, floor.width);
                fill(row, column(inside[0])..column(inside[1]));
            }
        }
    }
}

/// Returns the plates of a floor, and the plate of each of its cells: the first one in the drawing that contains the
/// centre of the cell.
pub(super) fn map(plates: &[DrawnPlate], boundary: &Boundary, floor: &Floor) -> PlateMap {
    let mut of_cell = vec![NONE; floor.len()];
    // Lap-welded plates overlap. They are filled in reverse order, so that the first plate ends up on top.
    for (index, plate) in plates.iter().enumerate().rev() {
        plate.fill(floor, |row, columns| {
            for cell in columns.map(|column| row * floor.width + column).filter(|cell| floor.is_floor(*cell))
            {
                of_cell[cell] = index as u32;
            }
        });
    }
    let gaps: Vec<usize> =
        (0..floor.len()).filter(|cell| floor.is_floor(*cell) && of_cell[*cell] == NONE).collect();
    let near: Vec<u32> = gaps.iter().map(|cell| nearest(&of_cell, floor, *cell)).collect();
    for (cell, plate) in gaps.into_iter().zip(near) {
        of_cell[cell] = if plate == NONE { plates.len() as u32 } else { plate };
    }
    let kind = |plate: &DrawnPlate| Plate { kind: plate.kind(boundary), name: plate.name.clone() };
    let mut known: Vec<Plate> = plates.iter().map(kind).collect();
    known.push(Plate { kind: PlateKind::Sketch, name: NO_PLATE.into() });
    with_floor(&known, of_cell)
}

/// Keeps the plates that cover any floor, in order of kind and name.
fn with_floor(known: &[Plate], mut of_cell: Vec<u32>) -> PlateMap {
    let mut has_floor = vec![false; known.len()];
    for plate in of_cell.iter().filter(|plate| **plate != NONE) {
        has_floor[*plate as usize] = true;
    }
    let mut order: Vec<usize> = (0..known.len()).filter(|plate| has_floor[*plate]).collect();
    order.sort_by(|a, b| known[*a].cmp(&known[*b]));
    let mut place = vec![NONE; known.len()];
    order.iter().zip(0..).for_each(|(plate, index)| place[*plate] = index);
    for plate in of_cell.iter_mut().filter(|plate| **plate != NONE) {
        *plate = place[*plate as usize];
    }
    PlateMap { plates: order.into_iter().map(|plate| known[plate].clone()).collect(), of_cell }
}

/// Returns the plate of the nearest cell that has a plate; if several cells are equally near, the plate that comes
/// first in the drawing.
fn nearest(of_cell: &[u32], floor: &Floor, cell: usize) -> u32 {
    let (column, row) = ((cell % floor.width) as isize, (cell / floor.width) as isize);
    let around = -GAP_CELLS..=GAP_CELLS;
    let steps = around.clone().flat_map(|dy| around.clone().map(move |dx| (dx, dy)));
    let beside = steps.filter_map(|(dx, dy)| {
        let (x, y) = (usize::try_from(column + dx).ok()?, usize::try_from(row + dy).ok()?);
        let is_there = x < floor.width && y < floor.height;
        let plate = is_there.then(|| of_cell[y * floor.width + x]).filter(|plate| *plate != NONE)?;
        Some((dx * dx + dy * dy, plate))
    });
    beside.min().map_or(NONE, |(_, plate)| plate)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PlateLayout, World};
    use geometry::shape::ring_contains;

    fn plate(name: &str, corners: &[(f64, f64)]) -> DrawnPlate {
        let vertices_m = corners.iter().map(|(x, y)| Point::new(*x, *y)).collect();
        DrawnPlate { name: name.into(), vertices_m }
    }

    fn floor(cell_m: f64) -> (Boundary, Floor) {
        let boundary = Boundary::Circle { radius_m: 5.0 };
        let world = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
        let floor = Floor::new(&world, cell_m, 0.3, 0.6, Point::origin());
        (world.boundary, floor)
    }

    #[test]
    fn a_cell_belongs_to_the_first_plate_that_holds_it_a_gap_to_its_neighbour_and_the_rest_to_no_plate() {
        let plates = vec![
            // An L: the notch at (1, 1) is not part of it.
            plate("L", &[(-2.0, -2.0), (2.0, -2.0), (2.0, 0.0), (0.0, 0.0), (0.0, 2.0), (-2.0, 2.0)]),
            plate("lapped", &[(-1.0, -3.0), (1.0, -3.0), (1.0, -1.0), (-1.0, -1.0)]),
            plate("beyond a gap", &[(2.15, -2.0), (3.0, -2.0), (3.0, 0.0), (2.15, 0.0)]),
        ];
        let (boundary, floor) = floor(0.1);
        let map = PlateLayout::Drawn { plates: plates.clone().into() }.map(&boundary, &floor);
        let name = |x: f64, y: f64| {
            let plate = map.plate_of(floor.cell_at(Point::new(x, y)).unwrap()).unwrap();
            map.plates[plate].name.as_str()
        };
        assert_eq!(name(-0.5, -1.5), "L", "both contain it");
        assert_eq!(name(0.0, -2.5), "lapped");
        assert_eq!((name(2.05, -1.0), name(2.12, -1.0)), ("L", "beyond a gap"));
        assert_eq!((name(1.0, 1.0), name(-4.0, 0.0)), (NO_PLATE, NO_PLATE));
        for cell in 0..floor.len() {
            assert_eq!(map.plate_of(cell).is_some(), floor.is_floor(cell));
            let holds = |plate: &&DrawnPlate| ring_contains(&plate.vertices_m, floor.center(cell));
            if let Some(first) = plates.iter().find(holds).filter(|_| floor.is_floor(cell)) {
                assert_eq!(
                    map.plates[map.plate_of(cell).unwrap()].name,
                    first.name,
                    "{}",
                    floor.center(cell)
                );
            }
        }
    }

    #[test]
    fn a_plate_at_the_shell_is_annular() {
        use PlateKind::{Annular, Rectangular, Sketch};
        let (boundary, floor) = floor(0.1);
        let plates = vec![
            plate("inner", &[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]),
            plate("cut", &[(0.0, 0.0), (-1.0, 0.0), (-1.0, 1.0)]),
            plate("outer", &[(4.0, 0.0), (5.0, 0.0), (4.0, 1.0)]),
            plate("under a column", &[(7.0, 0.0), (8.0, 0.0), (8.0, 1.0)]),
        ];
        let map = PlateLayout::Drawn { plates: plates.into() }.map(&boundary, &floor);
        let kinds: Vec<(&str, PlateKind)> =
            map.plates.iter().map(|plate| (plate.name.as_str(), plate.kind)).collect();
        assert_eq!(kinds, [("outer", Annular), ("cut", Sketch), (NO_PLATE, Sketch), ("inner", Rectangular)]);
    }

    #[test]
    fn both_layouts_are_read_back_as_they_were_written() {
        let drawn =
            PlateLayout::Drawn { plates: vec![plate("P-01", &[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])].into() };
        let text = serde_json::to_string(&drawn).unwrap();
        assert_eq!(serde_json::from_str::<PlateLayout>(&text).unwrap(), drawn);
        let old = r#"{"annular_m":0.75,"n_annular":12,"length_m":6.0,"width_m":1.8}"#;
        let regular = serde_json::from_str::<PlateLayout>(old).unwrap();
        assert_eq!(serde_json::to_string(&regular).unwrap(), old);
    }
}
