//! Cells as outlines: rings on the grid of cell corners, simplified, as SVG path data.

use account::together;
use std::fmt::Write;
use world::{Floor, Point};

/// A corner of a cell: column and row, counted from the south-west corner of the grid.
pub(super) type Corner = (i32, i32);

/// Returns the outlines of the selected cells of a grid, given by its width and height in cells, as path data in units
/// of cells: x to the right, y up from the south-west corner of the grid. Points closer than `tolerance` cells to the
/// simplified outline are dropped; 0 keeps every corner.
pub(crate) fn outlines(size: (usize, usize), is_in: impl Fn(usize) -> bool, tolerance: f64) -> String {
    let mut path = String::new();
    for ring in rings(size, is_in) {
        write_ring(&mut path, &simplified(&ring, tolerance));
    }
    path
}

/// The directions from a corner. Of two directions in use, the first in this order belongs to the more southerly
/// cell.
const WAYS: [Corner; 4] = [(0, -1), (-1, 0), (1, 0), (0, 1)];

/// The directions of the outline from each corner, column by column: one bit for each of [`WAYS`], two where cells
/// touch only at the corner.
struct Edges {
    rows: usize,
    ways: Vec<u8>,
}

impl Edges {
    fn of((width, height): (usize, usize), is_in: impl Fn(usize) -> bool) -> Self {
        let rows = height + 1;
        let mut ways = vec![0; (width + 1) * rows];
        // Compares each cell with its neighbours to the west and south; a cell beyond the grid is outside.
        let mut south = vec![false; width];
        for y in 0..=height {
            let mut west = false;
            for x in 0..=width {
                let here = x < width && y < height && is_in(y * width + x);
                let below = x < width && south[x];
                let corner = |x: usize, y: usize| x * rows + y;
                match (below, here) {
                    (false, true) => ways[corner(x, y)] |= 1 << 2,
                    (true, false) => ways[corner(x + 1, y)] |= 1 << 1,
                    _ => {}
                }
                match (west, here) {
                    (true, false) => ways[corner(x, y)] |= 1 << 3,
                    (false, true) => ways[corner(x, y + 1)] |= 1,
                    _ => {}
                }
                if x < width {
                    south[x] = here;
                }
                west = here;
            }
        }
        Self { rows, ways }
    }

    fn at(&mut self, (x, y): Corner) -> &mut u8 {
        &mut self.ways[x as usize * self.rows + y as usize]
    }

    /// Removes and returns the next direction from a corner. Where cells touch only at the corner, the outline turns
    /// left so that the outlines of the cells stay separate.
    fn take(&mut self, here: Corner, came: Option<Corner>) -> Option<Corner> {
        let open = self.at(here);
        let left = |way: Corner| came.map_or(0, |came| came.0 * way.1 - came.1 * way.0);
        let ways = (0..WAYS.len()).filter(|way| *open >> way & 1 == 1);
        let way = ways.reduce(|one, other| if left(WAYS[other]) > left(WAYS[one]) { other } else { one })?;
        *open &= !(1 << way);
        Some(WAYS[way])
    }
}

/// The closed rings around cells of a grid of the given width and height, counter-clockwise around cells and
/// clockwise around holes, with every corner along them.
pub(super) fn rings(size: (usize, usize), is_in: impl Fn(usize) -> bool) -> Vec<Vec<Corner>> {
    let mut edges = Edges::of(size, is_in);
    let mut rings = Vec::new();
    for index in 0..edges.ways.len() {
        let first = ((index / edges.rows) as i32, (index % edges.rows) as i32);
        while edges.ways[index] != 0 {
            rings.push(take_ring(&mut edges, first));
        }
    }
    rings
}

/// Removes one ring from the edges.
fn take_ring(edges: &mut Edges, first: Corner) -> Vec<Corner> {
    let mut ring = vec![first];
    let (mut here, mut came) = (first, None);
    while let Some(way) = edges.take(here, came) {
        came = Some(way);
        here = (here.0 + way.0, here.1 + way.1);
        if here == first {
            break;
        }
        ring.push(here);
    }
    ring
}

pub(super) fn simplified(ring: &[Corner], tolerance: f64) -> Vec<Corner> {
    if tolerance <= 0.0 || ring.len() < 5 {
        let n = ring.len();
        let turns = |k: &usize| {
            let (a, b, c) = (ring[(k + n - 1) % n], ring[*k], ring[(k + 1) % n]);
            (b.0 - a.0) * (c.1 - b.1) != (b.1 - a.1) * (c.0 - b.0)
        };
        return (0..n).filter(turns).map(|k| ring[k]).collect();
    }
    let far = |k: &usize| {
        let (dx, dy) = (ring[*k].0 - ring[0].0, ring[*k].1 - ring[0].1);
        i64::from(dx).pow(2) + i64::from(dy).pow(2)
    };
    let middle = (0..ring.len()).max_by_key(far).unwrap_or(0);
    let closed: Vec<Corner> = ring[middle..].iter().chain(&ring[..1]).copied().collect();
    let points = |part: &[Corner]| -> Vec<Point> {
        part.iter().map(|(x, y)| Point::new(f64::from(*x), f64::from(*y))).collect()
    };
    let mut kept: Vec<Corner> = Vec::new();
    for part in [&ring[..=middle], &closed] {
        let thinned = thinned(&points(part), tolerance);
        kept.extend(thinned[..thinned.len() - 1].iter().map(|p| (p.x as i32, p.y as i32)));
    }
    if kept.len() < 3 { simplified(ring, 0.0) } else { kept }
}

/// Simplifies a line: drops points that are within a tolerance of the simplified line (Douglas-Peucker).
pub(crate) fn thinned(points: &[Point], tolerance: f64) -> Vec<Point> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut kept = vec![false; points.len()];
    (kept[0], kept[points.len() - 1]) = (true, true);
    let mut open = vec![(0, points.len() - 1)];
    while let Some((first, last)) = open.pop() {
        let (a, b) = (points[first], points[last]);
        let off = |k: &usize| (points[*k] - world::polyline::nearest_on_segment(a, b, points[*k])).norm();
        let farthest = (first + 1..last).map(|k| (off(&k), k)).max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, k)) = farthest.filter(|(off, _)| *off > tolerance) {
            kept[k] = true;
            open.extend([(first, k), (k, last)]);
        }
    }
    points.iter().zip(kept).filter(|(_, kept)| *kept).map(|(point, _)| *point).collect()
}

fn write_ring(path: &mut String, ring: &[Corner]) {
    let Some((first, rest)) = ring.split_first() else { return };
    // Writing to a String cannot fail.
    let _ = write!(path, "M{} {}", first.0, first.1);
    let mut at = *first;
    for corner in rest {
        let (dx, dy) = (corner.0 - at.0, corner.1 - at.1);
        let _ = match (dx, dy) {
            (_, 0) => write!(path, "h{dx}"),
            (0, _) => write!(path, "v{dy}"),
            _ => write!(path, "l{dx} {dy}"),
        };
        at = *corner;
    }
    path.push('z');
}

/// The cell of a group that is deepest inside it, and its depth in cells.
pub(crate) fn deepest(floor: &Floor, cells: &[usize]) -> (usize, usize) {
    let mut left: std::collections::BTreeSet<usize> = cells.iter().copied().collect();
    let mut depth = 0;
    loop {
        let inner: std::collections::BTreeSet<usize> = left
            .iter()
            .filter(|cell| {
                let (column, row) = (*cell % floor.width, *cell / floor.width);
                let is_inside = column > 0 && column + 1 < floor.width && row > 0 && row + 1 < floor.height;
                is_inside
                    && [*cell - 1, *cell + 1, *cell - floor.width, *cell + floor.width]
                        .iter()
                        .all(|next| left.contains(next))
            })
            .copied()
            .collect();
        if inner.is_empty() || depth > 60 {
            let mut groups = together(floor, left);
            groups.sort_by_key(|group| std::cmp::Reverse(group.len()));
            let largest = groups.first().map_or(cells, Vec::as_slice);
            return (largest[largest.len() / 2], depth + 1);
        }
        left = inner;
        depth += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::{Boundary, World};

    fn floor() -> Floor {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y));
        let boundary = Boundary::Polygon { vertices: corners.to_vec() };
        let world = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
        Floor::new(&world, 0.1, 0.0, 0.2, Point::new(0.5, 0.5))
    }

    fn signed_area(path: &str) -> i32 {
        let mut area = 0;
        let (mut x, mut y, mut start) = (0, 0, (0, 0));
        let numbers = |text: &str| -> Vec<i32> { text.split(' ').filter_map(|n| n.parse().ok()).collect() };
        let mut rest = path;
        while let Some(command) = rest.chars().next() {
            let end = rest[1..].find(|c: char| c.is_ascii_alphabetic()).map_or(rest.len(), |at| at + 1);
            let n = numbers(&rest[1..end]);
            let (dx, dy) = match command {
                'M' => {
                    (x, y) = (n[0], n[1]);
                    start = (x, y);
                    (0, 0)
                }
                'h' => (n[0], 0),
                'v' => (0, n[0]),
                'l' => (n[0], n[1]),
                _ => (start.0 - x, start.1 - y),
            };
            area += x * dy - y * dx;
            (x, y) = (x + dx, y + dy);
            rest = &rest[end..];
        }
        area / 2
    }

    #[test]
    fn outlines_enclose_as_many_cells_as_there_are_holes_left_out_and_touching_cells_apart() {
        let floor = floor();
        let ring = |cell: usize| (2..7).contains(&(cell % 10)) && (2..7).contains(&(cell / 10)) && cell != 44;
        assert_eq!(signed_area(&outlines((floor.width, floor.height), ring, 0.0)), 24);
        let touching = |cell: usize| cell == 11 || cell == 22;
        let path = outlines((floor.width, floor.height), touching, 0.0);
        assert_eq!((path.matches('M').count(), signed_area(&path)), (2, 2), "{path}");
        assert_eq!(outlines((floor.width, floor.height), |_| false, 0.0), "");
        assert_eq!(outlines((floor.width, floor.height), |_| true, 0.75), "M0 0h10v10h-10z");
    }

    #[test]
    fn the_deepest_cell_of_a_square_is_its_middle() {
        let floor = floor();
        let square: Vec<usize> =
            (0..100).filter(|c| (2..7).contains(&(c % 10)) && (2..7).contains(&(c / 10))).collect();
        assert_eq!(deepest(&floor, &square), (44, 3));
    }
}
