//! Many boxes, with a query for those that a segment meets.

use geometry::Point;
use glam::DVec2;
use parry2d_f64::{
    bounding_volume::Aabb,
    partitioning::{Bvh, BvhBuildStrategy},
};

/// Allowance for rounding in every test, metres and square metres; a segment that merely touches a box meets the box.
const SLACK: f64 = 1e-9;

/// Boxes in a tree; the cost of a query grows with the logarithm of the number of boxes, plus the number of boxes
/// found.
#[derive(Debug, Clone)]
pub(crate) struct Boxes {
    tree: Bvh,
}

impl Boxes {
    /// Creates boxes from their lowest and highest corners.
    pub(crate) fn new(boxes: impl IntoIterator<Item = (Point, Point)>) -> Self {
        let boxes: Vec<Aabb> =
            boxes.into_iter().map(|(low, high)| Aabb::new(low.into(), high.into())).collect();
        Self { tree: Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes) }
    }

    /// Returns the indices of the boxes that come within `room_m` of a segment, in the order of the tree; a few other
    /// boxes may be included.
    pub(crate) fn near(&self, a: Point, b: Point, room_m: f64) -> impl Iterator<Item = usize> + '_ {
        let (a, b): (DVec2, DVec2) = (a.into(), b.into());
        let (middle, half) = ((a + b) / 2.0, (b - a) / 2.0);
        let reach = half.abs() + DVec2::splat(room_m);
        let leaves = self.tree.leaves(move |node| {
            let around = node.aabb();
            let (from, extent) =
                ((around.mins + around.maxs) / 2.0 - middle, (around.maxs - around.mins) / 2.0);
            let (gap, wide) = (from.abs(), extent + DVec2::splat(room_m));
            let along = half.abs();
            gap.x <= extent.x + reach.x + SLACK
                && gap.y <= extent.y + reach.y + SLACK
                && half.perp_dot(from).abs() <= wide.x * along.y + wide.y * along.x + SLACK
        });
        leaves.map(|leaf| leaf as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Point> {
        (-9.0..9.0_f64, -9.0..9.0_f64).prop_map(|(x, y)| Point::new(x, y))
    }

    proptest! {
        #[test]
        fn no_box_that_a_segment_comes_near_is_left_out(
            corners in prop::collection::vec((point(), 0.0..1.0_f64, 0.0..1.0_f64), 0..30),
            a in point(),
            b in point(),
            room_m in 0.0..0.5_f64,
        ) {
            let boxes: Vec<(Point, Point)> =
                corners.iter().map(|(p, w, h)| (*p, Point::new(p.x + w, p.y + h))).collect();
            let mut found: Vec<usize> = Boxes::new(boxes.clone()).near(a, b, room_m).collect();
            found.sort_unstable();
            for (k, (low, high)) in boxes.iter().enumerate() {
                let is_met = (0..=200).any(|step| {
                    let at = a + (b - a) * (f64::from(step) / 200.0);
                    (at - at.sup(low).inf(high)).norm() <= room_m
                });
                prop_assert!(!is_met || found.binary_search(&k).is_ok());
            }
            prop_assert!(found.windows(2).all(|w| w[0] < w[1]));
        }

        #[test]
        fn no_box_that_a_segment_only_touches_is_left_out(
            corners in prop::collection::vec((-20..20_i32, -20..20_i32, 0..8_i32, 0..8_i32), 1..20),
            ends in [-20..20_i32, -20..20_i32, -20..20_i32, -20..20_i32],
            step_cm in 1..100_i32,
        ) {
            let at = |x: i32, y: i32| Point::new(f64::from(x), f64::from(y)) * (f64::from(step_cm) / 100.0);
            let boxes: Vec<(Point, Point)> =
                corners.iter().map(|(x, y, w, h)| (at(*x, *y), at(x + w, y + h))).collect();
            let (a, b) = (at(ends[0], ends[1]), at(ends[2], ends[3]));
            let found: Vec<usize> = Boxes::new(boxes.clone()).near(a, b, 0.0).collect();
            for (k, (low, high)) in boxes.iter().enumerate() {
                let is_met = [a, b].iter().any(|end| end.sup(low).inf(high) == *end);
                prop_assert!(!is_met || found.contains(&k));
            }
        }
    }

    #[test]
    fn boxes_beside_a_slanting_segment_are_left_out() {
        let boxes = (0..100).map(|k| Point::new(f64::from(k % 10), f64::from(k / 10)));
        let boxes = Boxes::new(boxes.map(|p| (p, Point::new(p.x + 0.5, p.y + 0.5))));
        assert!(boxes.near(Point::origin(), Point::new(10.0, 10.0), 0.1).count() < 30);
        assert_eq!(Boxes::new([]).near(Point::origin(), Point::new(1.0, 1.0), 1.0).count(), 0);
    }
}
