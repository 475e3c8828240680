//! The floor that the hull centre may occupy, given hard clearances to all solids and to the wall.

use crate::body::solid_parts;
use geometry::{Boundary, Point, Vector, convex::Part, polyline::edges};
use planner_api::Site;

/// Edge length of a bucket, metres.
const BUCKET_M: f64 = 1.0;
/// Maximum spare distance that is reported, metres; larger distances are reported as this value.
pub const MOST_SPARE_M: f64 = 0.6;
/// Tolerance for rounding, metres.
const ROUNDING_M: f64 = 1e-9;

/// A solid and the distance that the hull centre keeps from it.
#[derive(Debug, Clone)]
struct KeptPart {
    part: Part,
    keep_m: f64,
    /// The bounding box of the part.
    low: Point,
    high: Point,
}

impl KeptPart {
    fn new(part: Part, keep_m: f64) -> Self {
        let (low, high) = bounds(&part);
        Self { part, keep_m, low, high }
    }

    /// A lower bound for the distance from the part to a box, metres.
    fn least_m(&self, low: Point, high: Point) -> f64 {
        (self.low - high).sup(&(low - self.high)).sup(&Vector::zeros()).norm()
    }

    /// The distance to a position, metres, if it is below a limit.
    fn distance_below(&self, at: Point, limit_m: f64) -> Option<f64> {
        (self.least_m(at, at) < limit_m.max(f64::MIN_POSITIVE))
            .then(|| self.part.distance(at).0)
            .filter(|m| *m < limit_m)
    }
}

fn bounds(part: &Part) -> (Point, Point) {
    let far = f64::INFINITY;
    let none = (Point::new(far, far), Point::new(-far, -far));
    part.corners().iter().fold(none, |(low, high), (at, radius_m)| {
        let around = Vector::new(*radius_m, *radius_m);
        (low.inf(&(at - around)), high.sup(&(at + around)))
    })
}

/// Distances that the hull centre must keep, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Keep {
    /// From the outline of an obstacle.
    pub obstacle_m: f64,
    /// From the wall.
    pub wall_m: f64,
}

/// The floor that is open to the hull centre.
///
/// Obstacles are looked up in buckets of one metre, so the cost of a query depends only on what is nearby.
#[derive(Debug, Clone)]
pub struct Room {
    wall: Boundary,
    keep: Keep,
    parts: Vec<KeptPart>,
    low: Point,
    columns: usize,
    buckets: Vec<Vec<u32>>,
}

impl Room {
    /// Creates the floor of a site, without its no-go zones.
    pub fn new(site: &Site<'_>, keep: Keep) -> Self {
        Self::of_parts(site.boundary.to_owned(), solid_parts(site).map(|(_, part)| part), keep)
    }

    /// Creates the floor between some parts.
    pub fn of_parts(wall: Boundary, parts: impl Iterator<Item = Part>, keep: Keep) -> Self {
        let mut parts: Vec<KeptPart> = parts.map(|part| KeptPart::new(part, keep.obstacle_m)).collect();
        if let Boundary::Polygon { vertices } = &wall {
            let piece = |(a, b)| KeptPart::new(Part::segment(a, b), keep.wall_m);
            parts.extend(edges(vertices).map(piece));
        }
        let (low, high) = wall.bounds();
        let columns = ((high.x - low.x) / BUCKET_M).ceil().max(1.0) as usize + 1;
        let rows = ((high.y - low.y) / BUCKET_M).ceil().max(1.0) as usize + 1;
        let mut room = Self { wall, keep, parts, low, columns, buckets: vec![Vec::new(); columns * rows] };
        for index in 0..room.parts.len() {
            room.enter(index);
        }
        room
    }

    /// The spare distance at a position, metres: negative where the hull centre must not be, and at most 0.6.
    pub fn spare_m(&self, at: Point) -> f64 {
        let wall = self.wall.wall_distance_m(at) - self.keep.wall_m + ROUNDING_M;
        self.near(at).fold(wall.min(MOST_SPARE_M), |spare_m, s| {
            s.distance_below(at, spare_m + s.keep_m).map_or(spare_m, |m| m - s.keep_m)
        })
    }

    /// Whether a position is inside an obstacle or outside the wall.
    pub fn is_solid(&self, at: Point) -> bool {
        self.wall.wall_distance_m(at) < 0.0 || self.near(at).any(|s| s.distance_below(at, 0.0).is_some())
    }

    /// Whether the hull centre may move straight from `a` to `b`, which are less than 0.6 m apart.
    pub fn is_free(&self, a: Point, b: Point) -> bool {
        let wall_m = self.wall.wall_distance_m(a).min(self.wall.wall_distance_m(b));
        wall_m - self.keep.wall_m >= -ROUNDING_M
            && self.near(nalgebra::center(&a, &b)).all(|s| {
                s.least_m(a.inf(&b), a.sup(&b)) >= s.keep_m || s.part.segment_distance_m(a, b) >= s.keep_m
            })
    }

    /// The parts near a position, each with its required distance, for callers that examine them one by one.
    pub fn parts_near(&self, at: Point) -> impl Iterator<Item = (&Part, f64)> + '_ {
        self.near(at).map(|s| (&s.part, s.keep_m))
    }

    /// The wall.
    pub fn wall(&self) -> &Boundary {
        &self.wall
    }

    /// The distances kept.
    pub fn keep(&self) -> Keep {
        self.keep
    }

    fn near(&self, at: Point) -> impl Iterator<Item = &KeptPart> + '_ {
        let bucket = self.bucket(at).map_or(&[][..], |index| &self.buckets[index]);
        bucket.iter().map(|index| &self.parts[*index as usize])
    }

    fn bucket(&self, at: Point) -> Option<usize> {
        let (x, y) = ((at.x - self.low.x) / BUCKET_M, (at.y - self.low.y) / BUCKET_M);
        let inside = x >= 0.0 && y >= 0.0 && (x as usize) < self.columns;
        Some((y as usize) * self.columns + x as usize).filter(|index| inside && *index < self.buckets.len())
    }

    /// Adds a part to every bucket in which it can matter.
    fn enter(&mut self, index: usize) {
        let kept = &self.parts[index];
        let reach_m = kept.keep_m + MOST_SPARE_M + BUCKET_M * std::f64::consts::FRAC_1_SQRT_2;
        let n_rows = self.buckets.len() / self.columns;
        let around = Vector::new(reach_m, reach_m);
        let (from, to) = (kept.low - around - self.low, kept.high + around - self.low);
        let indices =
            |from: f64, to: f64, n: usize| (from / BUCKET_M) as usize..((to / BUCKET_M) as usize + 1).min(n);
        for row in indices(from.y, to.y, n_rows) {
            for column in indices(from.x, to.x, self.columns) {
                let corner = Vector::new(column as f64 + 0.5, row as f64 + 0.5) * BUCKET_M;
                if kept.part.distance(self.low + corner).0 < reach_m {
                    self.buckets[row * self.columns + column].push(index as u32);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn room(discs: &[(f64, f64, f64)]) -> Room {
        let part = |&(x, y, r): &(f64, f64, f64)| Part::disc(Point::new(x, y), r);
        let keep = Keep { obstacle_m: 0.3, wall_m: 0.1 };
        Room::of_parts(Boundary::Circle { radius_m: 5.0 }, discs.iter().map(part), keep)
    }

    #[test]
    fn the_wall_and_the_obstacles_are_kept_at_their_own_distances() {
        let room = room(&[(1.0, 0.0, 0.2)]);
        assert!((room.spare_m(Point::new(1.6, 0.0)) - 0.1).abs() < 1e-6);
        assert!((room.spare_m(Point::new(-4.8, 0.0)) - 0.1).abs() < 1e-6);
        assert!(room.is_free(Point::new(1.0, 0.5), Point::new(1.2, 0.5)));
        assert!(!room.is_free(Point::new(0.8, 0.49), Point::new(1.2, 0.49)));
        assert!(!room.is_free(Point::new(-4.8, 0.0), Point::new(-4.95, 0.0)));
    }

    proptest! {
        #[test]
        fn the_buckets_forget_nothing_that_matters(
            discs in prop::collection::vec((-5.0..5.0_f64, -5.0..5.0_f64, 0.0..1.5_f64), 1..9),
            at in (-4.0..4.0_f64, -4.0..4.0_f64),
        ) {
            let at = Point::new(at.0, at.1);
            let all = discs.iter().map(|(x, y, r)| (at - Point::new(*x, *y)).norm() - r - 0.3);
            let truth = all.fold((4.9 - at.coords.norm()).min(MOST_SPARE_M), f64::min);
            prop_assert!((room(&discs).spare_m(at) - truth).abs() < 1e-6);
        }
    }
}
