//! Cells as polygons with holes, in metres, in the form that other map programs read.

use super::trace::{Corner, rings, simplified};
use std::collections::HashMap;
use world::{Floor, Point, shape::ring_contains};

/// A polygon in the tank frame, metres: its outer ring runs counter-clockwise, its holes clockwise. No ring touches
/// itself, and the last point of a ring does not repeat the first.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Polygon {
    pub(crate) outer: Vec<Point>,
    pub(crate) holes: Vec<Vec<Point>>,
}

impl Polygon {
    /// The rings, the outer one first.
    pub(crate) fn rings(&self) -> impl Iterator<Item = &Vec<Point>> {
        std::iter::once(&self.outer).chain(&self.holes)
    }
}

/// The polygons around some cells of a floor; there are several if some of the cells touch only at a corner.
pub(crate) fn polygons(floor: &Floor, cells: &[usize]) -> Vec<Polygon> {
    let places = || cells.iter().map(|cell| (cell % floor.width, cell / floor.width));
    let (Some(west), Some(east)) = (places().map(|p| p.0).min(), places().map(|p| p.0).max()) else {
        return Vec::new();
    };
    let (south, north) = (places().map(|p| p.1).min().unwrap_or(0), places().map(|p| p.1).max().unwrap_or(0));
    let (width, height) = (east - west + 1, north - south + 1);
    let mut is_in = vec![false; width * height];
    for (x, y) in places() {
        is_in[(y - south) * width + x - west] = true;
    }
    let simple: Vec<Vec<Corner>> =
        rings((width, height), |cell| is_in[cell]).iter().flat_map(|ring| simple(ring)).collect();
    let (outer, holes): (Vec<_>, Vec<_>) = simple.into_iter().partition(|ring| double_area(ring) > 0);
    let at = |(x, y): &Corner| {
        let (column, row) = (west as f64 + f64::from(*x), south as f64 + f64::from(*y));
        Point::new(floor.origin.x + column * floor.cell_m, floor.origin.y + row * floor.cell_m)
    };
    let placed = |ring: &[Corner]| -> Vec<Point> { simplified(ring, 0.0).iter().map(at).collect() };
    let mut polygons: Vec<Polygon> =
        outer.iter().map(|ring| Polygon { outer: placed(ring), holes: vec![] }).collect();
    for hole in &holes {
        // The midpoint of an edge of a hole is inside the surrounding ring, and on no other edge.
        let middle = nalgebra::center(&at(&hole[0]), &at(&hole[1]));
        let around = (0..outer.len()).filter(|k| ring_contains(&polygons[*k].outer, middle));
        if let Some(k) = around.min_by_key(|k| double_area(&outer[*k])) {
            polygons[k].holes.push(placed(hole));
        }
    }
    polygons
}

/// Splits a ring into rings that pass each corner only once.
fn simple(ring: &[Corner]) -> Vec<Vec<Corner>> {
    let mut simple = Vec::new();
    let mut way: Vec<Corner> = Vec::new();
    let mut place_of: HashMap<Corner, usize> = HashMap::new();
    for corner in ring {
        if let Some(first) = place_of.get(corner).copied() {
            let round = way.split_off(first);
            for corner in &round {
                place_of.remove(corner);
            }
            simple.push(round);
        }
        place_of.insert(*corner, way.len());
        way.push(*corner);
    }
    simple.push(way);
    simple
}

/// Twice the area inside a ring, in cells; negative for a clockwise ring.
fn double_area(ring: &[Corner]) -> i64 {
    let edges = ring.iter().zip(ring.iter().cycle().skip(1));
    edges.map(|(a, b)| i64::from(a.0) * i64::from(b.1) - i64::from(a.1) * i64::from(b.0)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use world::{Boundary, World, shape::ring_area_m2};

    fn floor() -> Floor {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y));
        let boundary = Boundary::Polygon { vertices: corners.to_vec() };
        let world = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
        Floor::new(&world, 0.1, 0.0, 0.2, Point::new(0.5, 0.5))
    }

    /// Cells drawn as `#`, the first row in the north.
    fn drawn(rows: [&str; 10]) -> Vec<usize> {
        let row = |(y, row): (usize, &str)| -> Vec<usize> {
            row.chars().enumerate().filter(|(_, c)| *c == '#').map(|(x, _)| (9 - y) * 10 + x).collect()
        };
        rows.into_iter().enumerate().flat_map(row).collect()
    }

    fn area_cells(polygons: &[Polygon]) -> f64 {
        polygons.iter().flat_map(Polygon::rings).map(|ring| ring_area_m2(ring) / 0.01).sum()
    }

    fn is_in(polygon: &Polygon, place: Point) -> bool {
        ring_contains(&polygon.outer, place) && !polygon.holes.iter().any(|hole| ring_contains(hole, place))
    }

    #[test]
    fn an_island_in_a_hole_is_a_polygon_of_its_own_and_a_hole_that_touches_the_outline_stays_a_hole() {
        let cells = drawn([
            "..........",
            ".########.",
            ".#......#.",
            ".#.####.#.",
            ".#.#..#.#.",
            ".#.####.#.",
            ".#.....#..",
            ".########.",
            "..........",
            "..........",
        ]);
        let found = polygons(&floor(), &cells);
        let holes: Vec<usize> = found.iter().map(|polygon| polygon.holes.len()).collect();
        assert_eq!((found.len(), holes.iter().sum::<usize>()), (2, 2), "{found:?}");
        assert!((area_cells(&found) - cells.len() as f64).abs() < 1e-9);
    }

    proptest! {
        #[test]
        fn polygons_hold_their_cells_and_no_others(cells in prop::collection::btree_set(0_usize..100, 1..80)) {
            let floor = floor();
            let all: Vec<usize> = cells.iter().copied().collect();
            let found = polygons(&floor, &all);
            prop_assert!((area_cells(&found) - all.len() as f64).abs() < 1e-9);
            for cell in 0..100 {
                let around = found.iter().filter(|polygon| is_in(polygon, floor.center(cell))).count();
                prop_assert_eq!(around, usize::from(cells.contains(&cell)));
            }
            for ring in found.iter().flat_map(Polygon::rings) {
                let corners: std::collections::BTreeSet<[u64; 2]> =
                    ring.iter().map(|p| [p.x.to_bits(), p.y.to_bits()]).collect();
                prop_assert_eq!(corners.len(), ring.len(), "a ring must pass each corner only once");
            }
        }
    }
}
