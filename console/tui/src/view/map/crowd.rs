//! Tells lines that would merge on the map with what has been drawn before.

use std::collections::BTreeMap;
use world::Point;

/// A line merges if more than this share of it is close to what has been drawn.
const MERGED: f64 = 0.35;

/// What has been drawn, in square tiles as wide as the distance at which lines merge.
pub(super) struct Crowd {
    merge_m: f64,
    tiles: BTreeMap<(i64, i64), Vec<Point>>,
}

impl Crowd {
    /// Nothing has been drawn yet. Lines that are closer than `merge_m` metres merge.
    pub(super) fn new(merge_m: f64) -> Self {
        Self { merge_m, tiles: BTreeMap::new() }
    }

    fn tile(&self, at: &Point) -> (i64, i64) {
        ((at.x / self.merge_m).floor() as i64, (at.y / self.merge_m).floor() as i64)
    }

    /// Adds points that are drawn.
    pub(super) fn add(&mut self, points: Vec<Point>) {
        for point in points {
            self.tiles.entry(self.tile(&point)).or_default().push(point);
        }
    }

    /// Whether a line with these points would merge with what has been drawn.
    pub(super) fn merges(&self, points: &[Point]) -> bool {
        let is_near = |at: &&Point| {
            let (x, y) = self.tile(at);
            let around = (-1..=1).flat_map(|right| (-1..=1).map(move |up| (x + right, y + up)));
            let mut near = around.filter_map(|tile| self.tiles.get(&tile)).flatten();
            near.any(|other| (other - *at).norm() < self.merge_m)
        };
        points.iter().filter(is_near).count() as f64 > MERGED * points.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_beside_another_merges_and_one_across_it_does_not() {
        let line =
            |turn: fn(f64) -> Point| (0..=40).map(|step| turn(0.25 * f64::from(step))).collect::<Vec<_>>();
        let mut crowd = Crowd::new(1.0);
        let first = line(|along| Point::new(along, 0.0));
        assert!(!crowd.merges(&first));
        crowd.add(first);
        assert!(crowd.merges(&line(|along| Point::new(along, 0.9))));
        assert!(!crowd.merges(&line(|along| Point::new(along, -1.1))));
        assert!(!crowd.merges(&line(|along| Point::new(5.0, along - 5.0))));
    }
}
