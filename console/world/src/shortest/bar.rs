//! The solids that block the robot: all points within a given distance of a segment.

use crate::obstacles::Boxes;
use geometry::{
    Point, Vector,
    polyline::{nearest_on_segment, segments_cross},
};

/// The overlap up to which two outlines count as only touching, metres.
pub(super) const TOUCH_M: f64 = 1e-9;

/// All points within `radius_m` of a segment; a disc if both ends coincide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bar {
    pub a: Point,
    pub b: Point,
    pub radius_m: f64,
}

impl Bar {
    /// Returns the distance from a point to the outline, metres; negative inside.
    pub(super) fn distance_m(&self, at: Point) -> f64 {
        (at - nearest_on_segment(self.a, self.b, at)).norm() - self.radius_m
    }

    /// Whether a segment enters the bar, rather than merely touching it.
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
            || segments_cross(a, b, self.a, self.b)
    }

    fn bounds(&self) -> (Point, Point) {
        let margin = Vector::new(self.radius_m, self.radius_m);
        (self.a.inf(&self.b) - margin, self.a.sup(&self.b) + margin)
    }
}

/// Many bars, in a bounding volume hierarchy.
#[derive(Debug, Clone)]
pub(super) struct Bars {
    all: Vec<Bar>,
    boxes: Boxes,
}

impl Bars {
    pub(super) fn new(all: Vec<Bar>) -> Self {
        Self { boxes: Boxes::new(all.iter().map(Bar::bounds)), all }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Bar> {
        self.all.iter()
    }

    /// Whether any bar blocks a segment.
    pub(super) fn block(&self, a: Point, b: Point) -> bool {
        self.boxes.near(a, b, 0.0).any(|index| self.all[index].blocks(a, b))
    }

    /// Returns the bars whose boxes come within a radius of a point; a few other bars may be included.
    pub(super) fn near(&self, center: Point, radius_m: f64) -> impl Iterator<Item = &Bar> {
        self.boxes.near(center, center, radius_m).map(|index| &self.all[index])
    }
}
