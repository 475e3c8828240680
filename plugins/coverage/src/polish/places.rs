//! Which points of a path lie near a place, without a look at all of them.

use world::{Point, Vector};

/// Edge of a bucket, metres.
const BUCKET_M: f64 = 1.0;

/// Indices of points in buckets; good as long as the points stay as they are.
pub(super) struct Places {
    low: Point,
    columns: usize,
    rows: usize,
    /// For every bucket where its indices begin.
    begins: Vec<usize>,
    indices: Vec<usize>,
}

impl Places {
    /// Sorts points into buckets.
    pub(super) fn new(points: &[Point]) -> Self {
        let first = points.first().copied().unwrap_or_else(Point::origin);
        let low = points.iter().fold(first, |low, p| low.inf(p));
        let high = points.iter().fold(first, |high, p| high.sup(p));
        let count = |span_m: f64| (span_m / BUCKET_M) as usize + 1;
        let (columns, rows) = (count(high.x - low.x), count(high.y - low.y));
        let mut places =
            Self { low, columns, rows, begins: vec![0; columns * rows + 1], indices: Vec::new() };
        let buckets: Vec<usize> = points.iter().map(|p| places.bucket(*p)).collect();
        for bucket in &buckets {
            places.begins[bucket + 1] += 1;
        }
        for bucket in 1..places.begins.len() {
            places.begins[bucket] += places.begins[bucket - 1];
        }
        places.indices = vec![0; points.len()];
        let mut next = places.begins.clone();
        for (index, bucket) in buckets.into_iter().enumerate() {
            places.indices[next[bucket]] = index;
            next[bucket] += 1;
        }
        places
    }

    fn column_and_row(&self, at: Point) -> (usize, usize) {
        let offset = (at - self.low) / BUCKET_M;
        ((offset.x as usize).min(self.columns - 1), (offset.y as usize).min(self.rows - 1))
    }

    fn bucket(&self, at: Point) -> usize {
        let (column, row) = self.column_and_row(at);
        row * self.columns + column
    }

    /// Indices of all points within a distance of a place, and of some more; each once, in no order.
    pub(super) fn near(&self, at: Point, reach_m: f64) -> impl Iterator<Item = usize> + '_ {
        let reach = Vector::new(reach_m, reach_m);
        let (from, to) = (self.column_and_row(at - reach), self.column_and_row(at + reach));
        (from.1..=to.1)
            .flat_map(move |row| {
                let first = row * self.columns;
                &self.indices[self.begins[first + from.0]..self.begins[first + to.0 + 1]]
            })
            .copied()
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
            let points: Vec<Point> = points.into_iter().map(|(x, y)| Point::new(x, y)).collect();
            let at = Point::new(at.0, at.1);
            let mut near: Vec<usize> = Places::new(&points).near(at, reach_m).collect();
            near.sort_unstable();
            prop_assert!(near.windows(2).all(|pair| pair[0] < pair[1]));
            for (index, point) in points.iter().enumerate() {
                prop_assert!((point - at).norm() > reach_m || near.contains(&index));
            }
        }
    }
}
