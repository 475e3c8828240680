//! The pose of the robot according to a scan alone: the wall and the drawn obstacles are its landmarks.

use crate::{
    drawing::Corrected,
    uncertain::{DRAWING_SIGMA_M, DRAWING_SIGMA_RAD},
};
use geometry::{Pose, Vector};
use nalgebra::{Isometry2, Matrix3, UnitComplex, Vector3};
use world::Odometry;

/// The errors of the drawing are the same in successive scans. For these errors, this number of scans counts as one.
const ALIKE: f64 = 20.0;
/// Minimum number of points on the drawing.
const LEAST_POINTS: usize = 12;
/// Standard deviations, metres and radians, that stand for "not known": a scan shows no heading in an empty round tank.
const UNKNOWN_M: f64 = 10.0;
const UNKNOWN_RAD: f64 = 3.0;
/// Number of points on the drawing that count as one: neighbouring points have errors in common, such as those of a
/// rough wall.
const POINTS_ALIKE: f64 = 4.0;

/// The pose of the robot according to a scan. Directions that the scan does not show have large variances.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Matched {
    /// The pose at the end of the readings.
    pub pose: Pose,
    /// Covariance of x, y (square metres) and heading (square radians).
    pub covariance: Matrix3<f64>,
}

/// Separates what a scan shows from the estimate with which it was corrected. `from` is the transform from the robot
/// frame at the time of the scan to the tank frame before the correction; `since` is the motion since the scan. `None` if
/// the scan shows too little of the drawing.
pub(crate) fn matched(from: &Isometry2<f64>, corrected: &Corrected, since: &Odometry) -> Option<Matched> {
    if corrected.points < LEAST_POINTS {
        return None;
    }
    let unknown = Vector3::new(UNKNOWN_M, UNKNOWN_M, UNKNOWN_RAD).map(|sigma| sigma.powi(-2));
    let shown = corrected.information - corrected.prior + Matrix3::from_diagonal(&unknown);
    let inverse = shown.cholesky()?.inverse();
    // The correction balances the scan with the estimate; this is where the scan alone would have put the pose.
    let by = inverse * (corrected.information * corrected.by);
    let floor =
        Vector3::new(DRAWING_SIGMA_M, DRAWING_SIGMA_M, DRAWING_SIGMA_RAD).map(|sigma| ALIKE * sigma * sigma);
    let at_scan = inverse * POINTS_ALIKE + Matrix3::from_diagonal(&floor);
    let place = from.translation.vector + Vector::new(by.x, by.y);
    let turn = from.rotation * UnitComplex::new(by.z);
    let moved = turn * Vector::new(since.forward_m, since.sideways_m);
    // A turn at the time of the scan also moves the motion since then.
    let slope = Matrix3::new(1.0, 0.0, -moved.y, 0.0, 1.0, moved.x, 0.0, 0.0, 1.0);
    let covariance = slope * at_scan * slope.transpose();
    let at = place + moved;
    let pose = Pose::new(at.x, at.y, turn.angle() + since.turn_rad);
    let is_finite = at.iter().chain(covariance.iter()).all(|x| x.is_finite()) && pose.heading_rad.is_finite();
    is_finite.then_some(Matched { pose, covariance })
}
