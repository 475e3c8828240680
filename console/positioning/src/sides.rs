//! Chooses between the two positions that stations on a line allow.

use crate::{
    anchor::{Anchor, anchored},
    fix::{ELLIPSE_95, Fix, Prior, Ranging},
    linear::conditioning,
    nonlinear::mirror_of,
    quality::inverse_of,
};
use nalgebra::Matrix2;
use world::{Boundary, Point, Station};

/// The normalised squared distance beyond which a position contradicts the estimate. One correct position in 10,000
/// lies beyond it.
const CONTRADICTS: f64 = 18.42;
/// The difference in normalised squared distance that decides between the two positions. With this difference, one
/// choice in 1000 is wrong.
const DECIDES: f64 = 13.82;
/// Condition number above which stations are nearly on a line, and can allow a second position.
pub(crate) const MIRROR_CONDITIONING: f64 = 5.0;

/// The criterion that decides on which side of the stations a fix lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sides {
    /// There is only one position, or both are the same within the error.
    One,
    /// The other position lies behind the wall.
    ByWalls,
    /// The other position is too far from the robot's estimated position.
    ByBelief,
    /// Nothing decides. The estimate may contradict both positions.
    Open {
        /// The other position.
        other: Point,
        /// Whether both positions are too far from the robot's estimated position.
        contradicts: bool,
    },
}

impl Sides {
    /// Finds the criterion that decides between a fix and its mirror image; `prior` is the estimate, if it is
    /// reliable.
    pub(crate) fn of(fix: &Fix, boundary: Option<&Boundary>, prior: Option<Prior>) -> Self {
        let Some(other) = fix.mirror else { return Self::One };
        let is_one = inverse_of(&fix.covariance)
            .is_none_or(|inverse| squared(other - fix.position, &inverse) <= ELLIPSE_95);
        if is_one {
            return Self::One;
        }
        if boundary.is_some_and(|boundary| is_behind(boundary, other, &fix.covariance)) {
            return Self::ByWalls;
        }
        let Some((near, covariance)) = prior else { return Self::Open { other, contradicts: false } };
        let Some(inverse) = inverse_of(&(covariance + fix.covariance)) else {
            return Self::Open { other, contradicts: false };
        };
        let (here, there) = (squared(fix.position - near, &inverse), squared(other - near, &inverse));
        match here <= CONTRADICTS {
            true if there - here >= DECIDES => Self::ByBelief,
            is_near => Self::Open { other, contradicts: !is_near && there > CONTRADICTS },
        }
    }
}

/// Whether a position lies behind the wall by more than its error.
pub(crate) fn is_behind(boundary: &Boundary, at: Point, covariance: &Matrix2<f64>) -> bool {
    -boundary.wall_distance_m(at) > crate::fix::ellipse_95(covariance).0
}

/// Returns one position with a covariance that covers both sides: their midpoint, and half the distance between them as
/// a standard deviation.
pub(crate) fn both(fix: &Fix, other: Point) -> (Point, Matrix2<f64>) {
    let half = (other - fix.position) / 2.0;
    (fix.position + half, fix.covariance + half * half.transpose())
}

/// Returns the mirror image of a place, with nearly the same ranges from all stations, if the stations are sufficiently
/// close to a line.
pub fn mirrored(ranges: &[Ranging], stations: &[Station], at: Point) -> Option<Point> {
    let anchors: Vec<Anchor> = anchored(ranges, stations).ok()?;
    (anchors.len() >= 3 && conditioning(&anchors) > MIRROR_CONDITIONING).then(|| mirror_of(&anchors, at))?
}

fn squared(away: world::Vector, inverse: &Matrix2<f64>) -> f64 {
    away.dot(&(inverse * away))
}
