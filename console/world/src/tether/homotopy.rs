//! Homotopy signatures: which rays a path crosses, and in which direction; crossings that are undone cancel out.
//!
//! One ray leaves each obstacle, all in the same direction, so that no two rays cross. Two paths with the same ends
//! can be deformed into each other without lifting the cable over an obstacle if, and only if, their signatures are
//! equal: as words over the obstacles, they are elements of a free group. Signatures are cheap and exact, but contain
//! neither lengths nor angles.
//!
//! Source: Kim, Bhattacharya and Kumar 2014, "Path planning for a tethered mobile robot".

use geometry::{Point, Vector, unit_vector};

/// Bearing of the rays, radians; chosen so that no edge on a drawing is likely to be parallel to the rays.
const BEARING_RAD: f64 = 1.134_567_891;

/// A crossing of a ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RayCrossing {
    /// Index of the obstacle whose ray was crossed.
    pub obstacle: usize,
    /// Whether the ray was crossed counter-clockwise about the obstacle.
    pub ccw: bool,
}

/// The reduced sequence of rays that a path crosses.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct HomotopySignature {
    crossings: Vec<RayCrossing>,
}

/// A ray from one point within each obstacle, indexed to find the rays that a move crosses.
#[derive(Debug, Clone)]
pub struct Rays {
    direction: Vector,
    /// For each ray, in ascending order: its distance to the right of a parallel ray through the origin, metres; its
    /// obstacle; its origin.
    sorted: Vec<(f64, usize, Point)>,
}

impl Rays {
    /// Creates rays from these origins, tank frame; obstacles are named by their index.
    ///
    /// ```
    /// use world::{Point, tether::{HomotopySignature, Rays}};
    /// let rays = Rays::new(&[Point::new(4.0, 0.0), Point::new(8.0, 0.0)]);
    /// let above = [Point::new(0.0, 0.0), Point::new(6.0, 4.0), Point::new(12.0, 0.0)];
    /// assert_eq!(HomotopySignature::of(&above, &rays).crossings()[1].obstacle, 1);
    /// ```
    pub fn new(origins: &[Point]) -> Self {
        let direction = unit_vector(BEARING_RAD);
        let mut sorted: Vec<(f64, usize, Point)> = origins
            .iter()
            .enumerate()
            .map(|(k, origin)| (-direction.perp(&origin.coords), k, *origin))
            .collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self { direction, sorted }
    }

    fn offset_m(&self, point: Point) -> f64 {
        -self.direction.perp(&point.coords)
    }
}

impl HomotopySignature {
    /// Returns the signature of a whole path.
    ///
    /// ```
    /// use world::{Point, tether::{HomotopySignature, Rays}};
    /// let rays = Rays::new(&[Point::new(4.0, 0.0)]);
    /// let (out, round) = (Point::new(4.0, 2.0), [Point::new(8.0, 0.0), Point::new(4.0, -2.0)]);
    /// let path = [Point::origin(), out, round[0], round[1], Point::origin()];
    /// assert_eq!(HomotopySignature::of(&path, &rays).crossings().len(), 1);
    /// ```
    pub fn of(path: &[Point], rays: &Rays) -> Self {
        let mut signature = Self::default();
        path.windows(2).for_each(|pair| signature.extend(pair[0], pair[1], rays));
        signature
    }

    /// Appends a straight move of the path.
    ///
    /// ```
    /// use world::{Point, tether::{HomotopySignature, Rays}};
    /// let rays = Rays::new(&[Point::new(4.0, 0.0)]);
    /// let mut signature = HomotopySignature::default();
    /// signature.extend(Point::new(0.0, 2.0), Point::new(8.0, 2.0), &rays);
    /// assert!(!signature.crossings()[0].ccw);
    /// ```
    pub fn extend(&mut self, from: Point, to: Point, rays: &Rays) {
        let (start_m, end_m) = (rays.offset_m(from), rays.offset_m(to));
        let until = |bound_m: f64| rays.sorted.partition_point(|(offset_m, ..)| *offset_m < bound_m);
        let passed = &rays.sorted[until(start_m.min(end_m))..until(start_m.max(end_m))];
        let cross = |(offset_m, obstacle, origin): &(f64, usize, Point)| {
            let share = (offset_m - start_m) / (end_m - start_m);
            let is_crossed = rays.direction.dot(&(from + (to - from) * share - origin)) > 0.0;
            is_crossed.then_some(RayCrossing { obstacle: *obstacle, ccw: end_m < start_m })
        };
        // The move back meets the rays in exactly the reverse order, even if rays coincide, so all crossings cancel
        // out.
        if end_m < start_m {
            passed.iter().rev().filter_map(cross).for_each(|crossing| self.append(crossing));
        } else {
            passed.iter().filter_map(cross).for_each(|crossing| self.append(crossing));
        }
    }

    fn append(&mut self, crossing: RayCrossing) {
        let inverse = RayCrossing { ccw: !crossing.ccw, ..crossing };
        if self.crossings.last() == Some(&inverse) {
            self.crossings.pop();
        } else {
            self.crossings.push(crossing);
        }
    }

    /// The remaining crossings, in the order of the path.
    ///
    /// ```
    /// use world::{Point, tether::{HomotopySignature, RayCrossing, Rays}};
    /// let rays = Rays::new(&[Point::new(4.0, 0.0)]);
    /// let west = [Point::new(8.0, 2.0), Point::new(0.0, 2.0)];
    /// let signature = HomotopySignature::of(&west, &rays);
    /// assert_eq!(signature.crossings(), [RayCrossing { obstacle: 0, ccw: true }]);
    /// ```
    pub fn crossings(&self) -> &[RayCrossing] {
        &self.crossings
    }

    /// Whether every crossing has been undone.
    ///
    /// ```
    /// use world::{Point, tether::{HomotopySignature, Rays}};
    /// let rays = Rays::new(&[Point::new(4.0, 0.0)]);
    /// let there_and_back = [Point::new(0.0, 2.0), Point::new(8.0, 2.0), Point::new(0.0, 2.0)];
    /// assert!(HomotopySignature::of(&there_and_back, &rays).is_empty());
    /// ```
    pub fn is_empty(&self) -> bool {
        self.crossings.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back_is_empty_even_where_obstacles_share_their_ray_origin() {
        let origins =
            [Point::new(1.0, 2.0), Point::new(1.0, 2.0), Point::new(-1.0, 0.5), Point::new(1.0, 2.0)];
        let rays = Rays::new(&origins);
        let way = [Point::new(-6.0, 4.0), Point::new(9.0, 6.0), Point::new(9.0, -5.0), Point::new(-6.0, 4.5)];
        assert!(HomotopySignature::of(&way[..2], &rays).crossings().len() >= 3);
        let back = way.iter().rev().skip(1);
        let there_and_back: Vec<Point> = way.iter().chain(back).copied().collect();
        assert!(HomotopySignature::of(&there_and_back, &rays).is_empty());
    }
}
