//! What blocks the way: everything within a radius of a segment.

use super::TOUCH_M;
use crate::{geometry::Point, polyline::nearest_on_segment};
use glam::DVec2;
use parry2d_f64::{
    bounding_volume::Aabb,
    partitioning::{Bvh, BvhBuildStrategy},
};
use std::fmt;

/// Everything within `radius_m` of a segment; a disc when both ends are one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bar {
    pub a: Point,
    pub b: Point,
    pub radius_m: f64,
}

impl Bar {
    /// Distance from a point to the outline, metres; negative inside.
    pub(super) fn distance_m(&self, at: Point) -> f64 {
        (at - nearest_on_segment(self.a, self.b, at)).norm() - self.radius_m
    }

    /// Whether a segment leads through it, by more than a touch.
    fn blocks(&self, a: Point, b: Point) -> bool {
        let least_m = self.radius_m - TOUCH_M;
        let is_near = |p: Point, q: Point, at: Point| {
            (at - nearest_on_segment(p, q, at)).norm_squared() < least_m * least_m
        };
        if self.a == self.b {
            return is_near(a, b, self.a);
        }
        is_near(a, b, self.a)
            || is_near(a, b, self.b)
            || is_near(self.a, self.b, a)
            || is_near(self.a, self.b, b)
            || cross(a, b, self.a, self.b)
    }

    fn bounds(&self) -> Aabb {
        let margin = DVec2::splat(self.radius_m);
        let (low, high): (DVec2, DVec2) = (self.a.inf(&self.b).into(), self.a.sup(&self.b).into());
        Aabb::new(low - margin, high + margin)
    }
}

/// Whether two segments cross.
fn cross(a: Point, b: Point, c: Point, d: Point) -> bool {
    let side = |from: Point, to: Point, at: Point| (to - from).perp(&(at - from));
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

/// Many bars, found through a bounding volume hierarchy.
#[derive(Clone)]
pub(super) struct Bars {
    all: Vec<Bar>,
    tree: Bvh,
}

impl fmt::Debug for Bars {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(&self.all).finish()
    }
}

impl Bars {
    pub(super) fn new(all: Vec<Bar>) -> Self {
        let boxes: Vec<Aabb> = all.iter().map(Bar::bounds).collect();
        Self { tree: Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes), all }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Bar> {
        self.all.iter()
    }

    /// Whether any blocks a segment.
    pub(super) fn block(&self, a: Point, b: Point) -> bool {
        let (low, high): (DVec2, DVec2) = (a.inf(&b).into(), a.sup(&b).into());
        let normal = DVec2::new(a.y - b.y, b.x - a.x);
        let offset = normal.dot(a.into());
        let meets = |mins: DVec2, maxs: DVec2| {
            let (center, half) = ((mins + maxs) * 0.5, (maxs - mins) * 0.5);
            let apart = (normal.dot(center) - offset).abs() > normal.abs().dot(half) + f64::EPSILON;
            !apart && mins.cmple(high).all() && maxs.cmpge(low).all()
        };
        let near = self.tree.leaves(|node| meets(node.mins(), node.maxs()));
        let mut near = near.map(|leaf| &self.all[leaf as usize]);
        near.any(|bar| bar.blocks(a, b))
    }

    /// Those whose boxes meet that of a circle.
    pub(super) fn near(&self, center: Point, radius_m: f64) -> impl Iterator<Item = &Bar> {
        let (low, high) = (DVec2::from(center) - radius_m, DVec2::from(center) + radius_m);
        let near =
            self.tree.leaves(move |node| node.mins().cmple(high).all() && node.maxs().cmpge(low).all());
        near.map(|leaf| &self.all[leaf as usize])
    }
}
