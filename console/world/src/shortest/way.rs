//! Shortest paths as tangents and arcs, and the reasons why a search finds none.

use geometry::{Point, unit_vector};

/// Maximum distance by which the chain of points for an arc lies outside the circle, metres.
const ARC_EXCESS_M: f64 = 4e-5;
/// Maximum turn at each corner of the chain of points for an arc, radians.
const ARC_STEP_RAD: f64 = 0.2;

/// A piece of a shortest path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Piece {
    /// A segment.
    Straight {
        /// The start of the segment.
        from: Point,
        /// The end of the segment.
        to: Point,
    },
    /// An arc about a grown disc or corner.
    Arc {
        /// The centre of the arc.
        center: Point,
        /// The radius of the arc, metres.
        radius_m: f64,
        /// Bearing of the start of the arc from the centre, radians.
        from_rad: f64,
        /// Angle of the arc, radians, positive counter-clockwise.
        sweep_rad: f64,
    },
}

/// A shortest path, tank frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Way {
    /// The pieces, each beginning where the previous one ends.
    pub pieces: Vec<Piece>,
    /// The length of the path, metres.
    pub length_m: f64,
}

impl Way {
    /// Returns the path as a chain of points that comes no closer to any solid than the path itself: arcs are
    /// replaced by tangents, at most 0.04 mm outside.
    ///
    /// ```
    /// use world::{Point, shortest::{Piece, Way}};
    /// let quarter = Piece::Arc { center: Point::origin(), radius_m: 1.0, from_rad: 0.0, sweep_rad: 1.57 };
    /// let points = Way { pieces: vec![quarter], length_m: 1.57 }.points();
    /// assert!(points.iter().all(|p| (1.0..1.00005).contains(&p.coords.norm())));
    /// ```
    pub fn points(&self) -> Vec<Point> {
        let mut points: Vec<Point> = Vec::new();
        for piece in &self.pieces {
            match *piece {
                Piece::Straight { from, to } => {
                    if points.is_empty() {
                        points.push(from);
                    }
                    points.push(to);
                }
                Piece::Arc { center, radius_m, from_rad, sweep_rad } => {
                    points.extend(tangent_corners(center, radius_m, from_rad, sweep_rad));
                }
            }
        }
        points.dedup();
        points
    }
}

/// Returns the points where consecutive tangents to an arc cross, from the first tangent to the last.
fn tangent_corners(
    center: Point,
    radius_m: f64,
    from_rad: f64,
    sweep_rad: f64,
) -> impl Iterator<Item = Point> {
    let step_rad = (8.0 * ARC_EXCESS_M / radius_m).sqrt().min(ARC_STEP_RAD);
    let n = (sweep_rad.abs() / step_rad).ceil().max(1.0);
    let half_rad = sweep_rad / n / 2.0;
    let outer_m = radius_m / half_rad.cos();
    (0..n as u32).map(move |k| center + unit_vector(from_rad + half_rad * f64::from(2 * k + 1)) * outer_m)
}

/// The reason why no shortest path was found.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NoWay {
    /// The robot does not fit at the start.
    #[error("the start ({:.3}, {:.3}) is {by_m:.3} m too close to something solid", at.x, at.y)]
    StartBlocked {
        /// The start.
        at: Point,
        /// The missing clearance, metres.
        by_m: f64,
    },
    /// The robot does not fit at the goal.
    #[error("the goal ({:.3}, {:.3}) is {by_m:.3} m too close to something solid", at.x, at.y)]
    GoalBlocked {
        /// The goal.
        at: Point,
        /// The missing clearance, metres.
        by_m: f64,
    },
    /// It is proven that no path leads from start to goal.
    #[error("there is no path: the search tried all {n_tangents} tangents reachable from the start")]
    Unreachable {
        /// The number of tangents tested.
        n_tangents: usize,
    },
    /// The caller stopped the search.
    #[error("the search was stopped")]
    Stopped,
}
