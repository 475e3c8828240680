//! The plates that a tank floor is made of.
//!
//! A ring of annular plates lies along the shell. The rest is covered by rows of rectangular plates from south to
//! north, with every second row shifted by half a plate. A rectangle that is cut by the ring becomes a sketch plate.
//! For any other layout, a drawing defines the plates.

mod dead_bands;
mod drawn;

use crate::coverage::Floor;
pub use dead_bands::DeadBands;
pub(crate) use dead_bands::untestable;
pub use drawn::{DrawnPlate, NO_PLATE};
use geometry::{Boundary, Point, Vector, shape::rectangle, wrap_angle_rad};
use serde::{Deserialize, Serialize};
use std::{collections::BTreeMap, f64::consts::TAU, fmt, sync::Arc};

/// The layout of the plates of a floor.
///
/// ```
/// use world::{PlateLayout, RegularPlates};
/// let layout = RegularPlates { annular_m: 0.75, n_annular: 12, length_m: 6.0, width_m: 1.8 };
/// let old = r#"{"annular_m":0.75,"n_annular":12,"length_m":6.0,"width_m":1.8}"#;
/// assert_eq!(serde_json::from_str::<PlateLayout>(old).unwrap(), PlateLayout::Regular(layout));
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum PlateLayout {
    /// A regular layout, given by its dimensions.
    Regular(RegularPlates),
    /// A layout given by the outline of each plate.
    Drawn {
        /// The plates; where they overlap, the first one counts. Shared, because there may be thousands.
        plates: Arc<[DrawnPlate]>,
    },
}

impl PlateLayout {
    /// Returns the plates of a floor, and the plate of each of its cells.
    ///
    /// ```
    /// use world::{Boundary, DrawnPlate, Floor, PlateLayout, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 10.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// let floor = Floor::new(&tank, 0.2, 0.3, 0.6, Point::origin());
    /// let vertices_m = vec![Point::new(0.0, 0.0), Point::new(6.0, 0.0), Point::new(6.0, 1.8), Point::new(0.0, 1.8)];
    /// let layout = PlateLayout::Drawn { plates: vec![DrawnPlate { name: "P-01".into(), vertices_m }].into() };
    /// let map = layout.map(&tank.boundary, &floor);
    /// assert_eq!((&*map.plates[0].name, &*map.plates[1].name), ("no plate", "P-01"));
    /// ```
    pub fn map(&self, boundary: &Boundary, floor: &Floor) -> PlateMap {
        match self {
            Self::Regular(regular) => regular.map(boundary, floor),
            Self::Drawn { plates } => drawn::map(plates, boundary, floor),
        }
    }

    /// Returns the seams between the plates of a floor as lines, tank frame; for drawn plates, their outlines.
    ///
    /// ```
    /// use world::{Boundary, PlateLayout, RegularPlates};
    /// let layout = RegularPlates { annular_m: 0.0, n_annular: 0, length_m: 6.0, width_m: 1.8 };
    /// let seams = PlateLayout::Regular(layout).seams(&Boundary::Circle { radius_m: 1.7 });
    /// assert_eq!(seams[0].len(), 2, "one seam across the middle");
    /// ```
    pub fn seams(&self, boundary: &Boundary) -> Vec<Vec<Point>> {
        match self {
            Self::Regular(regular) => regular.seams(boundary),
            Self::Drawn { plates } => plates.iter().map(DrawnPlate::outline).collect(),
        }
    }
}

/// The dimensions of a regular layout of plates in rows.
///
/// ```
/// use world::RegularPlates;
/// let layout = RegularPlates { annular_m: 0.75, n_annular: 12, length_m: 6.0, width_m: 1.8 };
/// assert!((layout.length_m * layout.width_m - 10.8).abs() < 1e-9);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RegularPlates {
    /// Width of the annular ring, from the shell inwards, metres; 0 if there is no ring.
    pub annular_m: f64,
    /// Number of plates in the ring; the first one begins due east.
    pub n_annular: u32,
    /// Length of a rectangular plate from west to east, metres.
    pub length_m: f64,
    /// Width of a rectangular plate from south to north, metres.
    pub width_m: f64,
}

/// The kind of a plate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(test, derive(strum::EnumCount))]
#[serde(rename_all = "snake_case")]
pub enum PlateKind {
    /// A plate in the ring along the shell.
    Annular,
    /// A plate that is cut by the ring or the shell.
    Sketch,
    /// A whole plate.
    Rectangular,
}

impl fmt::Display for PlateKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Annular => "annular",
            Self::Sketch => "sketch",
            Self::Rectangular => "rectangular",
        })
    }
}

/// A plate.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Plate {
    /// The kind of the plate.
    pub kind: PlateKind,
    /// The name: the one in the drawing, if the plates come from a drawing. Otherwise, `A-07` is the seventh annular
    /// plate, counter-clockwise from east; `R-03-05` and `S-03-01` are the fifth plate (rectangular) and the first
    /// plate (sketch) from the west in the third row from the south.
    pub name: String,
}

/// The plate of every cell of a floor.
#[derive(Debug, Clone, PartialEq)]
pub struct PlateMap {
    /// The plates that cover any floor, in order of kind and name.
    pub plates: Vec<Plate>,
    /// For every cell, the index of its plate; [`NONE`] where there is no floor.
    of_cell: Vec<u32>,
}

/// The plate index of a cell without a plate.
const NONE: u32 = u32::MAX;

/// The position of a plate: its kind, its row, counted from 1 (0 in the ring), and its number in the row, counted from
/// 1.
type Place = (PlateKind, i64, i64);

impl RegularPlates {
    /// Returns the plate under a point of the floor. `last` is the plate of the neighbouring point, which is usually
    /// the same.
    fn place_of(&self, boundary: &Boundary, point: Point, last: Option<Place>) -> Place {
        if boundary.wall_distance_m(point) < self.annular_m {
            let share = wrap_angle_rad(point.y.atan2(point.x)).rem_euclid(TAU) / TAU;
            let last = f64::from(self.n_annular.max(1)) - 1.0;
            return (PlateKind::Annular, 0, (share * f64::from(self.n_annular.max(1))).min(last) as i64 + 1);
        }
        let (low, high) = boundary.bounds();
        let middle = nalgebra::center(&low, &high);
        // The rows are symmetrical about the middle.
        let n_rows = ((high.y - low.y) / self.width_m).ceil();
        let south_m = middle.y - n_rows * self.width_m / 2.0;
        let row = ((point.y - south_m) / self.width_m).floor();
        let shift_m = if row as i64 % 2 == 0 { 0.0 } else { self.length_m / 2.0 };
        let n_plates = ((high.x - low.x) / self.length_m).ceil() + 1.0;
        let west_m = middle.x - n_plates * self.length_m / 2.0 - shift_m;
        let number = ((point.x - west_m) / self.length_m).floor();
        let same = |(kind, a, b): &Place| {
            *kind != PlateKind::Annular && (*a, *b) == (row as i64 + 1, number as i64 + 1)
        };
        if let Some(same) = last.filter(same) {
            return same;
        }
        let corner = Point::new(west_m + number * self.length_m, south_m + row * self.width_m);
        let kind = if self.is_whole(boundary, corner) { PlateKind::Rectangular } else { PlateKind::Sketch };
        (kind, row as i64 + 1, number as i64 + 1)
    }

    /// Whether a rectangle, given by its south-west corner, lies entirely within the ring.
    fn is_whole(&self, boundary: &Boundary, corner: Point) -> bool {
        let corners = rectangle(corner, corner + Vector::new(self.length_m, self.width_m));
        corners.iter().all(|corner| boundary.wall_distance_m(*corner) >= self.annular_m)
    }

    /// Returns the plates of a floor, and the plate of each of its cells.
    fn map(&self, boundary: &Boundary, floor: &Floor) -> PlateMap {
        // Plates are numbered in the order in which they are found. There are millions of cells, and neighbours
        // usually share a plate.
        let mut order: BTreeMap<Place, u32> = BTreeMap::new();
        let mut last: Option<(Place, u32)> = None;
        let mut met = |point: Point| {
            let place = self.place_of(boundary, point, last.map(|(place, _)| place));
            match last {
                Some((same, index)) if same == place => index,
                _ => {
                    let next = order.len() as u32;
                    let index = *order.entry(place).or_insert(next);
                    last = Some((place, index));
                    index
                }
            }
        };
        let mut of_cell: Vec<u32> = (0..floor.len())
            .map(|index| if floor.is_floor(index) { met(floor.center(index)) } else { NONE })
            .collect();
        let mut sorted = vec![NONE; order.len()];
        order.values().zip(0..).for_each(|(met, index)| sorted[*met as usize] = index);
        for index in of_cell.iter_mut().filter(|index| **index != NONE) {
            *index = sorted[*index as usize];
        }
        // Plates are numbered from the first plate in their row that covers any floor.
        let mut firsts: BTreeMap<i64, i64> = BTreeMap::new();
        for (_, row, number) in order.keys() {
            let first = firsts.entry(*row).or_insert(*number);
            *first = (*first).min(*number);
        }
        let plates = order.keys().map(|(kind, row, number)| Plate {
            kind: *kind,
            name: match kind {
                PlateKind::Annular => format!("A-{number:02}"),
                PlateKind::Sketch => format!("S-{row:02}-{:02}", number - firsts[row] + 1),
                PlateKind::Rectangular => format!("R-{row:02}-{:02}", number - firsts[row] + 1),
            },
        });
        PlateMap { plates: plates.collect(), of_cell }
    }
}

/// The length of the steps in which a seam is followed to its end, metres.
const SEAM_STEP_M: f64 = 0.1;

impl RegularPlates {
    /// Returns the seams between the plates of a floor as lines, tank frame.
    fn seams(&self, boundary: &Boundary) -> Vec<Vec<Point>> {
        let (low, high) = boundary.bounds();
        let middle = nalgebra::center(&low, &high);
        let n_rows = ((high.y - low.y) / self.width_m).ceil();
        let south_m = middle.y - n_rows * self.width_m / 2.0;
        let n_plates = ((high.x - low.x) / self.length_m).ceil() + 1.0;
        let mut seams = Vec::new();
        for row in 0..n_rows as usize {
            let y = south_m + row as f64 * self.width_m;
            if row > 0 {
                seams.extend(self.within(boundary, Point::new(low.x, y), Point::new(high.x, y)));
            }
            let shift_m = if row % 2 == 0 { 0.0 } else { self.length_m / 2.0 };
            let west_m = middle.x - n_plates * self.length_m / 2.0 - shift_m;
            for plate in 0..=n_plates as usize + 1 {
                let x = west_m + plate as f64 * self.length_m;
                seams.extend(self.within(boundary, Point::new(x, y), Point::new(x, y + self.width_m)));
            }
        }
        if self.annular_m > 0.0 {
            seams.extend(self.ring(boundary));
        }
        seams
    }

    /// Returns the parts of a line that lie within the ring.
    fn within(&self, boundary: &Boundary, a: Point, b: Point) -> Vec<Vec<Point>> {
        let is_in = |share: f64| {
            let place = a + (b - a) * share;
            boundary.contains(place) && boundary.wall_distance_m(place) >= self.annular_m
        };
        let steps = ((b - a).norm() / SEAM_STEP_M).ceil().max(1.0) as usize;
        let at = |k: usize| k as f64 / steps as f64;
        let (mut parts, mut from) = (Vec::new(), None);
        for k in 0..=steps {
            match (is_in(at(k)), from) {
                (true, None) => from = Some(if k == 0 { 0.0 } else { edge(is_in, at(k), at(k - 1)) }),
                (false, Some(first)) => {
                    parts.push((first, edge(is_in, at(k - 1), at(k))));
                    from = None;
                }
                _ => {}
            }
        }
        parts.extend(from.map(|first| (first, 1.0)));
        parts.into_iter().map(|(first, last)| vec![a + (b - a) * first, a + (b - a) * last]).collect()
    }

    /// Returns the inner edge of the ring, and the seams between its plates.
    fn ring(&self, boundary: &Boundary) -> Vec<Vec<Point>> {
        let n = self.n_annular.max(1);
        let inner = match boundary {
            Boundary::Circle { radius_m } => {
                let inner_m = (radius_m - self.annular_m).max(0.0);
                let at = |k: u32| TAU * f64::from(k) / 360.0;
                (0..=360).map(|k| Point::new(inner_m * at(k).cos(), inner_m * at(k).sin())).collect()
            }
            Boundary::Polygon { vertices } => inset(vertices, self.annular_m),
        };
        let (low, high) = boundary.bounds();
        let far_m = (high - low).norm();
        let seam = |k: u32| {
            let angle = TAU * f64::from(k) / f64::from(n);
            // Plates are numbered by their bearing from the origin.
            let from = |share: f64| Point::new(far_m * share * angle.cos(), far_m * share * angle.sin());
            let is_in = |share: f64| {
                boundary.contains(from(share)) && boundary.wall_distance_m(from(share)) < self.annular_m
            };
            let steps = (far_m / (SEAM_STEP_M / 10.0)).ceil() as usize;
            let at = |k: usize| k as f64 / steps as f64;
            let (first, last) = ((0..=steps).find(|k| is_in(at(*k)))?, (0..=steps).rfind(|k| is_in(at(*k)))?);
            let inner = if first == 0 { at(0) } else { edge(is_in, at(first), at(first - 1)) };
            let outer = if last == steps { at(steps) } else { edge(is_in, at(last), at(last + 1)) };
            Some(vec![from(inner), from(outer)])
        };
        std::iter::once(inner).chain((0..n).filter_map(seam)).collect()
    }
}

/// Returns where a line enters or leaves an area, as a share of the line: between a place inside and a place outside,
/// and accurate to a thousandth of the step from one to the other.
fn edge(is_in: impl Fn(f64) -> bool, mut inside: f64, mut outside: f64) -> f64 {
    for _ in 0..10 {
        let half = f64::midpoint(inside, outside);
        *(if is_in(half) { &mut inside } else { &mut outside }) = half;
    }
    inside
}

/// Moves the edges of a closed outline inwards by `by_m` metres; the outline is counter-clockwise, as walls are.
fn inset(vertices: &[Point], by_m: f64) -> Vec<Point> {
    let n = vertices.len();
    let corner = |k: usize| {
        let (before, at, after) = (vertices[(k + n - 1) % n], vertices[k % n], vertices[(k + 1) % n]);
        let inward = |a: Point, b: Point| {
            let way = (b - a).normalize();
            Vector::new(-way.y, way.x)
        };
        let (one, other) = (inward(before, at), inward(at, after));
        // The intersection of both edges after they have been moved inwards.
        at + (one + other) * (by_m / (1.0 + one.dot(&other)).max(0.1))
    };
    (0..=n).map(corner).collect()
}

impl PlateMap {
    /// Returns the index of a cell's plate; `None` where there is no floor.
    ///
    /// ```
    /// use world::{Boundary, Floor, PlateLayout, Point, RegularPlates, World};
    /// # let boundary = Boundary::Circle { radius_m: 10.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// let floor = Floor::new(&tank, 0.2, 0.3, 0.6, Point::origin());
    /// let sizes = RegularPlates { annular_m: 0.75, n_annular: 12, length_m: 6.0, width_m: 1.8 };
    /// let layout = PlateLayout::Regular(sizes);
    /// let east = floor.cell_at(Point::new(9.5, 0.1)).unwrap();
    /// assert_eq!(layout.map(&tank.boundary, &floor).plate_of(east), Some(0));
    /// ```
    pub fn plate_of(&self, cell: usize) -> Option<usize> {
        self.of_cell.get(cell).filter(|index| **index != NONE).map(|index| *index as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::World;
    use std::collections::BTreeSet;
    use strum::EnumCount;

    fn layout() -> RegularPlates {
        RegularPlates { annular_m: 0.75, n_annular: 12, length_m: 6.0, width_m: 1.8 }
    }

    fn plates(boundary: &Boundary, layout: RegularPlates) -> (Floor, PlateMap) {
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
        let names: BTreeSet<&str> = map.plates.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(names.len(), map.plates.len(), "every name is unique");
        assert!(names.contains("A-01") && names.iter().any(|name| name.starts_with("S-01-01")));
    }

    #[test]
    fn seams_end_at_the_shell_and_at_the_ring() {
        let boundary = Boundary::Circle { radius_m: 5.9985 };
        let seams = layout().seams(&boundary);
        for ends in seams.iter().filter(|seam| seam.len() == 2) {
            for at in ends {
                let off_m = boundary.wall_distance_m(*at);
                let is_inner_end = ends.iter().all(|end| boundary.wall_distance_m(*end) > 0.76);
                assert!(off_m < 1e-4 || (off_m - 0.75).abs() < 1e-3 || is_inner_end, "{at}: {off_m} m");
            }
        }
    }

    #[test]
    fn a_tank_with_straight_walls_and_no_ring_has_whole_plates_too() {
        let corners = [(-6.0, -1.8), (6.0, -1.8), (6.0, 1.8), (-6.0, 1.8)];
        let boundary = Boundary::Polygon { vertices: corners.map(|(x, y)| Point::new(x, y)).to_vec() };
        let (_, map) = plates(&boundary, RegularPlates { annular_m: 0.0, ..layout() });
        assert!(map.plates.iter().any(|plate| plate.kind == PlateKind::Rectangular), "{:?}", map.plates);
        assert!(map.plates.iter().all(|plate| plate.kind != PlateKind::Annular));
    }

    #[test]
    fn every_kind_has_a_word_of_its_own() {
        let all: [PlateKind; PlateKind::COUNT] =
            [PlateKind::Annular, PlateKind::Sketch, PlateKind::Rectangular];
        let words: BTreeSet<String> = all.iter().map(ToString::to_string).collect();
        assert_eq!(words.len(), all.len(), "{words:?}");
        assert!(words.iter().all(|word| !word.is_empty() && !word.contains('_')), "{words:?}");
    }
}
