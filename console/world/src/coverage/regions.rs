//! Converts cells of the floor to polygons, and polygons to cells.

use super::floor::Floor;
use geometry::{
    Point, Vector,
    shape::{bounds_of, rectangle, ring_contains},
};

/// Returns the corners of a square around a point, counter-clockwise from the south-west corner.
///
/// ```
/// use world::{Point, coverage::regions::square};
/// assert_eq!(square(Point::new(1.0, 1.0), 2.0)[2], Point::new(2.0, 2.0));
/// ```
pub fn square(center: Point, edge_m: f64) -> Vec<Point> {
    rectangle(center - Vector::new(edge_m, edge_m) / 2.0, center + Vector::new(edge_m, edge_m) / 2.0)
}

/// Returns, for every cell, whether its centre lies in one of the polygons; `None` if there are no polygons, which
/// means that all cells count.
///
/// ```
/// use world::{Boundary, Floor, Point, World};
/// # let boundary = Boundary::Circle { radius_m: 5.0 };
/// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
/// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
/// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
/// use world::coverage::regions::{cells_within, square};
/// let within = cells_within(&floor, &[square(Point::origin(), 1.0)]).unwrap();
/// assert_eq!(within.iter().filter(|is_within| **is_within).count(), 100);
/// ```
pub fn cells_within(floor: &Floor, polygons: &[Vec<Point>]) -> Option<Vec<bool>> {
    if polygons.is_empty() {
        return None;
    }
    let mut within = vec![false; floor.len()];
    for vertices in polygons {
        let (low, high) = bounds_of(vertices);
        for index in floor.cells_in(low, high) {
            within[index] |= ring_contains(vertices, floor.center(index));
        }
    }
    Some(within)
}

/// Returns the selected cells as boxes that do not overlap, made of blocks of `block` by `block` cells.
///
/// A block is included if at least half of its floor is selected, so slivers are dropped and ragged edges are
/// straightened. Adjacent blocks in a row are joined, and so are equal stretches in consecutive rows. Every cell is
/// tested once.
///
/// ```
/// use world::{Boundary, Floor, Point, World};
/// # let boundary = Boundary::Circle { radius_m: 5.0 };
/// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
/// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
/// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
/// let boxes = world::coverage::regions::boxes(&floor, 1, |cell| floor.is_floor(cell));
/// let area_m2: f64 = boxes.iter().map(|b| world::shape::ring_area_m2(b)).sum();
/// assert!((area_m2 - 78.54).abs() < 0.5);
/// ```
pub fn boxes(floor: &Floor, block: usize, is_wanted: impl Fn(usize) -> bool) -> Vec<Vec<Point>> {
    let (columns, rows) = (floor.width.div_ceil(block), floor.height.div_ceil(block));
    let mut done: Vec<BlockBox> = Vec::new();
    let mut open: Vec<BlockBox> = Vec::new();
    for row in 0..rows {
        let spans = spans(columns, |column| is_taken(floor, block, column, row, &is_wanted));
        let (mut kept, closed): (Vec<BlockBox>, Vec<BlockBox>) =
            open.into_iter().partition(|b| spans.contains(&(b.first, b.end)));
        done.extend(closed);
        for b in &mut kept {
            b.top = row + 1;
        }
        for (first, end) in spans {
            if !kept.iter().any(|b| b.first == first) {
                kept.push(BlockBox { first, end, bottom: row, top: row + 1 });
            }
        }
        open = kept;
    }
    done.extend(open);
    done.sort_by_key(|b| (b.bottom, b.first));
    let edge_m = floor.cell_m * block as f64;
    let corner = |column: usize, row: usize| floor.origin + Vector::new(column as f64, row as f64) * edge_m;
    done.iter().map(|b| rectangle(corner(b.first, b.bottom), corner(b.end, b.top))).collect()
}

/// A box of blocks; `end` and `top` are exclusive.
struct BlockBox {
    first: usize,
    end: usize,
    bottom: usize,
    top: usize,
}

/// Runs of included columns: the first column, and the column after the last.
fn spans(columns: usize, is_taken: impl Fn(usize) -> bool) -> Vec<(usize, usize)> {
    let mut spans: Vec<(usize, usize)> = Vec::new();
    for column in (0..columns).filter(|column| is_taken(*column)) {
        match spans.last_mut() {
            Some((_, end)) if *end == column => *end += 1,
            _ => spans.push((column, column + 1)),
        }
    }
    spans
}

fn is_taken(
    floor: &Floor,
    block: usize,
    column: usize,
    row: usize,
    is_wanted: &impl Fn(usize) -> bool,
) -> bool {
    let (mut of_floor, mut wanted) = (0, 0);
    for y in row * block..((row + 1) * block).min(floor.height) {
        for x in column * block..((column + 1) * block).min(floor.width) {
            let index = y * floor.width + x;
            of_floor += usize::from(floor.is_floor(index));
            wanted += usize::from(is_wanted(index));
        }
    }
    wanted > 0 && 2 * wanted >= of_floor
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Boundary, World, shape::ring_area_m2};
    use proptest::prelude::*;

    fn floor() -> Floor {
        let vertices = square(Point::origin(), 4.0);
        let boundary = Boundary::Polygon { vertices };
        let world = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
        Floor::new(&world, 0.1, 0.2, 0.4, Point::origin())
    }

    proptest! {
        #[test]
        fn boxes_of_single_cells_hold_exactly_the_wanted_cells(seed in prop::collection::vec(any::<bool>(), 64)) {
            let floor = floor();
            let is_wanted = |index: usize| seed[(index / 3 + index / floor.width) % 64];
            let boxes = boxes(&floor, 1, is_wanted);
            let within = cells_within(&floor, &boxes);
            let wanted: Vec<bool> = (0..floor.len()).map(is_wanted).collect();
            prop_assert_eq!(within.unwrap_or(vec![false; floor.len()]), wanted.clone());
            let area_m2: f64 = boxes.iter().map(|b| ring_area_m2(b)).sum();
            let count = wanted.iter().filter(|w| **w).count();
            prop_assert!((area_m2 - count as f64 * 0.01).abs() < 1e-9, "boxes overlap");
        }
    }

    #[test]
    fn blocks_leave_slivers_out_and_join_what_belongs_together() {
        let floor = floor();
        assert_eq!(boxes(&floor, 4, |index| index / floor.width == 7), Vec::<Vec<Point>>::new());
        let half = boxes(&floor, 4, |index| index / floor.width < 20);
        assert_eq!(half, [rectangle(Point::new(-2.0, -2.0), Point::new(2.0, 0.0))]);
    }
}
