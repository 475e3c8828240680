//! The plates that a tank floor is made of.
//!
//! A ring of annular plates lies along the shell; the rest is covered by rows of rectangular plates from south to north,
//! every second row shifted by half a plate. The rest of a rectangle that the ring cuts is a sketch plate.

use crate::coverage::Floor;
use geometry::{Boundary, Point, Vector, shape::rectangle, wrap_angle_rad};
use serde::{Deserialize, Serialize};
use std::{collections::BTreeMap, f64::consts::TAU};

/// The layout of the plates of a floor.
///
/// ```
/// use world::PlateLayout;
/// let layout = PlateLayout { annular_m: 0.75, n_annular: 12, length_m: 6.0, width_m: 1.8 };
/// assert!((layout.length_m * layout.width_m - 10.8).abs() < 1e-9);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PlateLayout {
    /// Width of the annular ring from the shell inwards, metres; 0 without one.
    pub annular_m: f64,
    /// Number of plates in the ring; the first one begins due east.
    pub n_annular: u32,
    /// Length of a rectangular plate from west to east, metres.
    pub length_m: f64,
    /// Width of a rectangular plate from south to north, metres.
    pub width_m: f64,
}

/// Kind of a plate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PlateKind {
    /// In the ring along the shell.
    Annular,
    /// Cut by the ring or the shell.
    Sketch,
    /// Whole.
    Rectangular,
}

/// One plate.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Plate {
    /// Its kind.
    pub kind: PlateKind,
    /// `A-07`: the seventh annular plate, counter-clockwise from east; `R-03-05`, `S-03-01`: a rectangular or sketch plate
    /// of the third row from the south, fifth or first from the west.
    pub name: String,
}

/// The plate of every cell of a floor.
#[derive(Debug, Clone, PartialEq)]
pub struct PlateMap {
    /// The plates that have floor, in order of kind and name.
    pub plates: Vec<Plate>,
    /// For every cell the index of its plate; `None` where there is no floor.
    of_cell: Vec<Option<u32>>,
}

/// Where a plate lies: its kind, its row from 1 (0 in the ring), its number from 1.
type Place = (PlateKind, i64, i64);

impl PlateLayout {
    /// The plate under a point of the floor.
    fn place_of(&self, boundary: &Boundary, point: Point) -> Place {
        if boundary.wall_distance_m(point) < self.annular_m {
            let share = wrap_angle_rad(point.y.atan2(point.x)).rem_euclid(TAU) / TAU;
            let last = f64::from(self.n_annular.max(1)) - 1.0;
            return (PlateKind::Annular, 0, (share * f64::from(self.n_annular.max(1))).min(last) as i64 + 1);
        }
        let (low, high) = boundary.bounds();
        let middle = nalgebra::center(&low, &high);
        // The rows lie symmetrically about the middle.
        let n_rows = ((high.y - low.y) / self.width_m).ceil();
        let south_m = middle.y - n_rows * self.width_m / 2.0;
        let row = ((point.y - south_m) / self.width_m).floor();
        let shift_m = if row as i64 % 2 == 0 { 0.0 } else { self.length_m / 2.0 };
        let n_plates = ((high.x - low.x) / self.length_m).ceil() + 1.0;
        let west_m = middle.x - n_plates * self.length_m / 2.0 - shift_m;
        let number = ((point.x - west_m) / self.length_m).floor();
        let corner = Point::new(west_m + number * self.length_m, south_m + row * self.width_m);
        let kind = if self.is_whole(boundary, corner) { PlateKind::Rectangular } else { PlateKind::Sketch };
        (kind, row as i64 + 1, number as i64 + 1)
    }

    /// Whether all of a rectangle, given by its south-west corner, lies within the ring.
    fn is_whole(&self, boundary: &Boundary, corner: Point) -> bool {
        let corners = rectangle(corner, corner + Vector::new(self.length_m, self.width_m));
        corners.iter().all(|corner| boundary.wall_distance_m(*corner) >= self.annular_m)
    }

    /// The plates of a floor, and the plate of each of its cells.
    ///
    /// ```
    /// use world::{Boundary, Floor, PlateLayout, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 10.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// let floor = Floor::new(&tank, 0.2, 0.3, 0.6, Point::origin());
    /// let layout = PlateLayout { annular_m: 0.75, n_annular: 12, length_m: 6.0, width_m: 1.8 };
    /// assert_eq!(layout.map(&tank.boundary, &floor).plates[0].name, "A-01");
    /// ```
    pub fn map(&self, boundary: &Boundary, floor: &Floor) -> PlateMap {
        let places: Vec<Option<Place>> = (0..floor.len())
            .map(|index| floor.is_floor(index).then(|| self.place_of(boundary, floor.center(index))))
            .collect();
        let mut order: BTreeMap<Place, u32> = places.iter().flatten().map(|place| (*place, 0)).collect();
        // Plates are counted from the first one of their row that has floor.
        let mut firsts: BTreeMap<i64, i64> = BTreeMap::new();
        for (_, row, number) in order.keys() {
            let first = firsts.entry(*row).or_insert(*number);
            *first = (*first).min(*number);
        }
        order.values_mut().zip(0..).for_each(|(index, next)| *index = next);
        let plates = order.keys().map(|(kind, row, number)| Plate {
            kind: *kind,
            name: match kind {
                PlateKind::Annular => format!("A-{number:02}"),
                PlateKind::Sketch => format!("S-{row:02}-{:02}", number - firsts[row] + 1),
                PlateKind::Rectangular => format!("R-{row:02}-{:02}", number - firsts[row] + 1),
            },
        });
        PlateMap {
            plates: plates.collect(),
            of_cell: places.iter().map(|place| place.map(|place| order[&place])).collect(),
        }
    }
}

impl PlateMap {
    /// Index of a cell's plate; `None` where there is no floor.
    ///
    /// ```
    /// use world::{Boundary, Floor, PlateLayout, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 10.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// let floor = Floor::new(&tank, 0.2, 0.3, 0.6, Point::origin());
    /// let layout = PlateLayout { annular_m: 0.75, n_annular: 12, length_m: 6.0, width_m: 1.8 };
    /// let east = floor.cell_at(Point::new(9.5, 0.1)).unwrap();
    /// assert_eq!(layout.map(&tank.boundary, &floor).plate_of(east), Some(0));
    /// ```
    pub fn plate_of(&self, cell: usize) -> Option<usize> {
        self.of_cell.get(cell).copied().flatten().map(|index| index as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::World;

    fn layout() -> PlateLayout {
        PlateLayout { annular_m: 0.75, n_annular: 12, length_m: 6.0, width_m: 1.8 }
    }

    fn plates(boundary: &Boundary, layout: PlateLayout) -> (Floor, PlateMap) {
        let world = World { boundary: boundary.clone(), obstacles: vec![], stations: vec![], zones: vec![] };
        let floor = Floor::new(&world, 0.1, 0.3, 0.6, Point::origin());
        let map = layout.map(boundary, &floor);
        (floor, map)
    }

    #[test]
    fn every_cell_of_floor_belongs_to_one_plate_and_plates_have_their_area() {
        let boundary = Boundary::Circle { radius_m: 10.0 };
        let (floor, map) = plates(&boundary, layout());
        let mut cells = vec![0_usize; map.plates.len()];
        for index in 0..floor.len() {
            assert_eq!(map.plate_of(index).is_some(), floor.is_floor(index));
            if let Some(plate) = map.plate_of(index) {
                cells[plate] += 1;
            }
        }
        for (plate, count) in map.plates.iter().zip(cells) {
            let area_m2 = count as f64 * floor.cell_m2();
            match plate.kind {
                PlateKind::Annular => assert!((area_m2 - 3.78).abs() < 0.15, "{plate:?} {area_m2}"),
                PlateKind::Rectangular => assert!((area_m2 - 10.8).abs() < 0.3, "{plate:?} {area_m2}"),
                PlateKind::Sketch => assert!(area_m2 > 0.0 && area_m2 < 10.8, "{plate:?} {area_m2}"),
            }
        }
        assert_eq!(map.plates.iter().filter(|plate| plate.kind == PlateKind::Annular).count(), 12);
        let names: std::collections::BTreeSet<&str> = map.plates.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(names.len(), map.plates.len(), "names are given once");
        assert!(names.contains("A-01") && names.iter().any(|name| name.starts_with("S-01-01")));
    }

    #[test]
    fn a_tank_with_straight_walls_and_no_ring_has_whole_plates_too() {
        let corners = [(-6.0, -1.8), (6.0, -1.8), (6.0, 1.8), (-6.0, 1.8)];
        let boundary = Boundary::Polygon { vertices: corners.map(|(x, y)| Point::new(x, y)).to_vec() };
        let (_, map) = plates(&boundary, PlateLayout { annular_m: 0.0, ..layout() });
        assert!(map.plates.iter().any(|plate| plate.kind == PlateKind::Rectangular), "{:?}", map.plates);
        assert!(map.plates.iter().all(|plate| plate.kind != PlateKind::Annular));
    }
}
