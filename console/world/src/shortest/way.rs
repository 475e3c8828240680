//! Shortest paths as tangents and arcs, and why there is none.

use geometry::{Point, unit_vector};

/// An arc is drawn at most this far outside the circle, metres, ...
const ARC_EXCESS_M: f64 = 4e-5;
/// ... and with corners no sharper than this, radians.
const ARC_STEP_RAD: f64 = 0.2;

/// A piece of a shortest path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Piece {
    /// A segment.
    Straight {
        /// Its start.
        from: Point,
        /// Its end.
        to: Point,
    },
    /// An arc about a grown disc or corner.
    Arc {
        /// Its centre.
        center: Point,
        /// Its radius, metres.
        radius_m: f64,
        /// Bearing of its start from the centre, radians.
        from_rad: f64,
        /// Angle turned through, radians, positive counter-clockwise.
        sweep_rad: f64,
    },
}

/// A shortest path, tank frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Way {
    /// Its pieces, each beginning where the one before ends.
    pub pieces: Vec<Piece>,
    /// Its length, metres.
    pub length_m: f64,
}

impl Way {
    /// The path as a chain of points that comes no nearer to anything than the path itself: an arc is replaced by tangents,
    /// at most 0.04 mm outside it.
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

/// Where consecutive tangents of an arc cross, from its first tangent to its last.
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

/// Why there is no shortest path.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NoWay {
    /// The robot does not fit at the start.
    #[error("the start ({:.3}, {:.3}) is too near to something solid, by {by_m:.3} m", at.x, at.y)]
    StartBlocked {
        /// The start.
        at: Point,
        /// Room that it lacks, metres.
        by_m: f64,
    },
    /// The robot does not fit at the goal.
    #[error("the goal ({:.3}, {:.3}) is too near to something solid, by {by_m:.3} m", at.x, at.y)]
    GoalBlocked {
        /// The goal.
        at: Point,
        /// Room that it lacks, metres.
        by_m: f64,
    },
    /// Proved: no path leads from start to goal.
    #[error("there is no way: the search tried all {n_tangents} tangents that can be reached from the start")]
    Unreachable {
        /// Number of tangents tested.
        n_tangents: usize,
    },
    /// The caller stopped the search.
    #[error("the search was stopped")]
    Stopped,
}
