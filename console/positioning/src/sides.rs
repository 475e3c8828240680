//! The two positions that stations on a line leave: which of them, and what decides.

use crate::{
    anchor::{Anchor, anchored},
    fix::{ELLIPSE_95, Fix, Prior, Ranging},
    linear::conditioning,
    nonlinear::mirror_of,
    quality::inverse_of,
};
use nalgebra::Matrix2;
use world::{Boundary, Point, Station};

/// A position further from what is believed than this, as a squared distance in standard deviations, contradicts it: one honest one in
/// 10 000.
const CONTRADICTS: f64 = 18.42;
/// By how much more the other position has to contradict it: one wrong choice in 1000.
const DECIDES: f64 = 13.82;
/// Stations nearer to a line than this condition number can leave a second position.
pub(crate) const MIRROR_CONDITIONING: f64 = 5.0;

/// What is known about the side of the stations on which a fix lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sides {
    /// There is one position only, or both are one within the error.
    One,
    /// The other position lies behind the wall.
    ByWalls,
    /// The other position is too far from where the robot was believed to be.
    ByBelief,
    /// Nothing decides. The belief may contradict both.
    Open {
        /// The other position.
        other: Point,
        /// Whether both are too far from where the robot was believed to be.
        contradicts: bool,
    },
}

impl Sides {
    /// What decides between a fix and its mirror image; `prior` is what is believed, if that can be relied on.
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

/// Whether a position lies further behind the wall than its error.
pub(crate) fn is_behind(boundary: &Boundary, at: Point, covariance: &Matrix2<f64>) -> bool {
    -boundary.wall_distance_m(at) > crate::fix::ellipse_95(covariance).0
}

/// One position with a covariance that holds both sides: the middle of both, and half their distance as a standard deviation.
pub(crate) fn both(fix: &Fix, other: Point) -> (Point, Matrix2<f64>) {
    let half = (other - fix.position) / 2.0;
    (fix.position + half, fix.covariance + half * half.transpose())
}

/// The other place from which all stations have nearly the same ranges, if the stations are so nearly on a line that there is one.
pub fn mirrored(ranges: &[Ranging], stations: &[Station], at: Point) -> Option<Point> {
    let anchors: Vec<Anchor> = anchored(ranges, stations).ok()?;
    (anchors.len() >= 3 && conditioning(&anchors) > MIRROR_CONDITIONING).then(|| mirror_of(&anchors, at))?
}

fn squared(away: world::Vector, inverse: &Matrix2<f64>) -> f64 {
    away.dot(&(inverse * away))
}
