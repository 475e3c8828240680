//! A spatial index that finds the objects near a position without examining all of them.

use world::Point;

/// Indices of objects, by position: each index is in every square bucket that the object's bounding box touches.
pub(crate) struct Buckets {
    low: Point,
    edge_m: f64,
    columns: usize,
    rows: usize,
    numbers: Vec<Vec<u32>>,
}

impl Buckets {
    /// Sorts bounding boxes, grown by a margin, into buckets of this edge length, metres.
    pub(crate) fn new(edge_m: f64, margin_m: f64, boxes: &[(Point, Point)]) -> Self {
        let far = f64::INFINITY;
        let low = boxes.iter().fold(Point::new(far, far), |low, (from, _)| low.inf(from));
        let high = boxes.iter().fold(Point::new(-far, -far), |high, (_, to)| high.sup(to));
        let count = |span_m: f64| (span_m / edge_m).max(0.0) as usize + 1;
        let (columns, rows) = (count(high.x - low.x), count(high.y - low.y));
        let mut buckets = Self { low, edge_m, columns, rows, numbers: vec![Vec::new(); columns * rows] };
        for (number, (from, to)) in boxes.iter().enumerate() {
            for bucket in buckets.meeting(*from, *to, margin_m) {
                buckets.numbers[bucket].push(number as u32);
            }
        }
        buckets
    }

    /// The indices in the bucket of a position, in order.
    pub(crate) fn at(&self, at: Point) -> &[u32] {
        let (x, y) = ((at.x - self.low.x) / self.edge_m, (at.y - self.low.y) / self.edge_m);
        let is_inside = x >= 0.0 && y >= 0.0 && x < self.columns as f64 && y < self.rows as f64;
        if is_inside { &self.numbers[y as usize * self.columns + x as usize] } else { &[] }
    }

    /// The indices of all points within a distance of a position, and of some points slightly farther away. Larger
    /// objects may appear several times.
    pub(crate) fn near(&self, at: Point, reach_m: f64) -> impl Iterator<Item = usize> {
        self.meeting(at, at, reach_m).flat_map(|bucket| &self.numbers[bucket]).map(|number| *number as usize)
    }

    fn meeting(&self, from: Point, to: Point, margin_m: f64) -> impl Iterator<Item = usize> + use<> {
        let index = |m: f64, n: usize| ((m / self.edge_m) as usize).min(n - 1);
        let (from, to, columns) = (from - self.low, to - self.low, self.columns);
        let rows = index(from.y - margin_m, self.rows)..=index(to.y + margin_m, self.rows);
        let across = index(from.x - margin_m, columns)..=index(to.x + margin_m, columns);
        rows.flat_map(move |row| across.clone().map(move |column| row * columns + column))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn no_point_within_reach_is_left_out_and_none_comes_twice(
            points in prop::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64), 1..60),
            at in (-12.0..12.0_f64, -12.0..12.0_f64),
            reach_m in 0.0..3.0_f64,
        ) {
            let points: Vec<(Point, Point)> = points.into_iter().map(|(x, y)| (Point::new(x, y), Point::new(x, y))).collect();
            let at = Point::new(at.0, at.1);
            let mut near: Vec<usize> = Buckets::new(1.0, 0.0, &points).near(at, reach_m).collect();
            near.sort_unstable();
            prop_assert!(near.windows(2).all(|pair| pair[0] < pair[1]));
            for (index, (point, _)) in points.iter().enumerate() {
                prop_assert!((point - at).norm() > reach_m || near.contains(&index));
            }
        }
    }
}
