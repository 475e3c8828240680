//! The mouth of a trap: whether the robot has withdrawn from it, and the virtual circles that close it.

use crate::view::{Edge, View};
use std::f64::consts::PI;
use steering::{KnownMap, Solid};
use world::{Point, Vector};

/// Gain of the minimum angle at an edge circle, per metre of its radius (the paper's `N delta`).
const THETA_PER_M: f64 = 0.15;
/// Space that the seal needs in front of the robot, in addition to the edge's radius and twice the hull radius, metres.
const ROOM_M: f64 = 0.5;
/// Width of the opening above which the robot counts as being outside, radians.
const OPEN_RAD: f64 = 0.98 * PI;
/// Minimum angle under which a mouth is seen, radians; a smaller angle means that the robot is inside a spiral.
const NARROW_RAD: f64 = 0.15;
/// Width of the opening above which the robot has left a spiral, radians.
const OUT_RAD: f64 = 1.1 * PI;
/// Width of the opening above which the robot has left any trap, radians.
const FAR_OUT_RAD: f64 = 1.3 * PI;
/// Minimum radius of virtual circles, metres.
const SMALLEST_M: f64 = 0.15;
/// Maximum number of intervals between the virtual circles of a seal. Neighbouring circles are at most one radius apart
/// unless this limit applies.
const MOST_CIRCLES: usize = 400;

/// First id of virtual circles.
pub const FIRST_VIRTUAL: u32 = 0x8000_0000;
/// Last id of virtual circles; ids of no-go zones count down from the largest number.
pub const LAST_VIRTUAL: u32 = 0xf000_0000;

/// Whether a solid is virtual.
pub fn is_virtual(solid: &Solid) -> bool {
    (FIRST_VIRTUAL..LAST_VIRTUAL).contains(&solid.id)
}

/// The two edges of a trap, as seen from where the robot was stuck.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mouth {
    edges: [(Point, f64); 2],
    outward: Vector,
}

impl Mouth {
    /// The mouth of a group as seen from inside; `None` inside a spiral, where no mouth is visible.
    pub fn seen(stuck: Point, view: &View) -> Option<Self> {
        (view.gap_rad >= NARROW_RAD).then(|| Self::between(stuck, view.leftmost, view.rightmost))
    }

    fn between(stuck: Point, one: Edge, other: Edge) -> Self {
        let edges = [one.corner, other.corner];
        let along = edges[1].0 - edges[0].0;
        let across = Vector::new(-along.y, along.x);
        let inward = stuck - nalgebra::center(&edges[0].0, &edges[1].0);
        let outward = if across.dot(&inward) > 0.0 { -across } else { across };
        Self { edges, outward: outward.try_normalize(1e-9).unwrap_or_else(Vector::zeros) }
    }

    /// Whether the robot has withdrawn far enough to close the mouth in front of it.
    ///
    /// The paper's angle theta (eq. 14) is a cotangent of a cosine, for an angle that never changes sign. We read it as
    /// the angle between the mouth and the robot at an edge, negative inside. The paper's bound (eq. 17) can never
    /// hold; we read it as `N R delta`. The angle alone would leave a hole beside the robot, so there must also be
    /// space for the seal.
    pub fn is_withdrawn(&self, at: Point, hull_m: f64, gap_rad: f64) -> bool {
        let along = (self.edges[1].0 - self.edges[0].0).try_normalize(1e-9).unwrap_or_else(Vector::x);
        let beyond = |(edge, radius_m): &(Point, f64)| {
            let from = at - edge;
            let out_m = from.dot(&self.outward);
            let theta_rad = out_m.atan2(from.dot(&along).abs());
            theta_rad > THETA_PER_M * radius_m && out_m >= radius_m + 2.0 * hull_m + ROOM_M
        };
        gap_rad >= OPEN_RAD && self.edges.iter().all(beyond)
    }

    /// The mouth of a spiral, if the robot has left it. If a different mouth was seen from inside, the robot must be
    /// further out.
    pub fn left_behind(at: Point, view: &View, had_seen: bool) -> Option<Self> {
        let out_rad = if had_seen { FAR_OUT_RAD } else { OUT_RAD };
        (view.gap_rad > out_rad).then(|| Self::from_outside(at, view))
    }

    /// The mouth between the outermost solids, as seen from outside.
    pub fn from_outside(at: Point, view: &View) -> Self {
        let mut mouth = Self::between(at, view.leftmost, view.rightmost);
        mouth.outward = -mouth.outward;
        mouth
    }

    /// Virtual circles along the mouth; none of them covers the robot or the goal.
    pub fn circles(&self, map: &KnownMap, at: Point, goal: Point, first_id: u32) -> Vec<Solid> {
        let [(from, r_1), (to, r_2)] = self.edges;
        let radius_m = f64::midpoint(r_1, r_2).max(SMALLEST_M);
        let n_gaps = ((to - from).norm() / radius_m).ceil().clamp(1.0, MOST_CIRCLES as f64) as u32;
        let is_off =
            |center: &Point| [at, goal].iter().all(|place| (place - center).norm() > radius_m + map.hull_m);
        (1..n_gaps)
            .map(|k| from + (to - from) * (f64::from(k) / f64::from(n_gaps)))
            .filter(is_off)
            .zip(first_id..LAST_VIRTUAL)
            .map(|(center, id)| Solid::disc(id, center, radius_m))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::Boundary;

    /// A mouth from (0, -2) to (0, 2) of a trap to the east.
    fn mouth() -> Mouth {
        let edge = |index: usize, y: f64| Edge { index, corner: (Point::new(0.0, y), 0.5) };
        Mouth::between(Point::new(3.0, 0.0), edge(0, 2.0), edge(1, -2.0))
    }

    #[test]
    fn the_robot_has_withdrawn_when_there_is_room_for_the_seal() {
        let withdrawn = |x: f64| mouth().is_withdrawn(Point::new(x, 0.0), 0.3, 3.2);
        assert!(!withdrawn(1.0) && !withdrawn(-0.5) && !withdrawn(-1.5) && withdrawn(-1.7));
        assert!(!mouth().is_withdrawn(Point::new(-5.0, 0.0), 0.3, 2.0));
    }

    #[test]
    fn the_seal_leaves_no_hole_but_where_the_goal_is() {
        let map = KnownMap { solids: vec![], wall: Boundary::Circle { radius_m: 9.0 }, hull_m: 0.3 };
        let seal = |goal: Point| mouth().circles(&map, Point::new(-4.0, 0.0), goal, FIRST_VIRTUAL);
        let whole = seal(Point::new(8.0, 0.0));
        assert_eq!(whole.len(), 7);
        assert!(whole.windows(2).all(|w| (w[1].center - w[0].center).norm() <= w[0].radius_m + 1e-9));
        assert!(whole.iter().all(is_virtual));
        assert!(seal(Point::new(0.0, 0.0)).len() < 7);
    }
}
