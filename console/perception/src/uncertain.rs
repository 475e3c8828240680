//! The uncertainty of scanned points.

use crate::drawing::GATE;
use nalgebra::{Matrix2, Matrix3};

/// Standard deviation of positions on a drawing, metres; a scan cannot locate the robot more accurately.
pub(crate) const DRAWING_SIGMA_M: f64 = 0.01;
/// Standard deviation of directions on a drawing, radians.
pub(crate) const DRAWING_SIGMA_RAD: f64 = 0.002;

/// Standard deviations that are added to those of an estimated pose, metres and radians. The errors that filters state
/// are too small, above all for the heading, and a drawn column must not be taken for another column beside it.
const DOUBT_M: f64 = 0.02;
const DOUBT_RAD: f64 = 0.012;

/// The uncertainty of a pose and of the distances measured from it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Uncertain {
    /// Standard deviation of a distance, metres.
    pub sigma_m: f64,
    covariance: Matrix3<f64>,
    /// Largest variance of the position in any direction, square metres.
    place_m2: f64,
}

impl Uncertain {
    /// Combines the standard deviation of a distance with the covariance of x, y and heading.
    fn new(sigma_m: f64, covariance: &Matrix3<f64>) -> Self {
        let place = covariance.fixed_view::<2, 2>(0, 0);
        let (mean, half) = (0.5 * place.trace(), 0.5 * (place[(0, 0)] - place[(1, 1)]));
        let place_m2 = mean + half.hypot(place[(0, 1)]);
        // Positions on a drawing are rounded, so no distance is exact.
        Self { sigma_m: sigma_m.max(0.005), covariance: *covariance, place_m2 }
    }

    /// The uncertainty of an estimated pose with this covariance of x, y and heading.
    pub(crate) fn estimated(sigma_m: f64, covariance: &Matrix3<f64>) -> Self {
        let place = DOUBT_M * DOUBT_M;
        let doubt = nalgebra::Vector3::new(place, place, DOUBT_RAD * DOUBT_RAD);
        Self::new(sigma_m, &(covariance + Matrix3::from_diagonal(&doubt)))
    }

    /// The uncertainty after the pose has been corrected by the drawing.
    pub(crate) fn corrected(&self, covariance: &Matrix3<f64>) -> Self {
        let place = DRAWING_SIGMA_M * DRAWING_SIGMA_M;
        let floor = nalgebra::Vector3::new(place, place, DRAWING_SIGMA_RAD * DRAWING_SIGMA_RAD);
        Self::new(self.sigma_m, &(covariance + Matrix3::from_diagonal(&floor)))
    }

    /// The inverse covariance of the pose; `None` if the covariance is not positive.
    pub(crate) fn information(&self) -> Option<Matrix3<f64>> {
        let floor = Matrix3::from_diagonal(&nalgebra::Vector3::new(1e-8, 1e-8, 1e-10));
        (self.covariance + floor).cholesky().map(|root| root.inverse())
    }

    /// The variance of the position of a point at a distance, in the direction in which it is largest, square metres.
    pub(crate) fn point_m2(&self, range_m: f64) -> f64 {
        self.place_m2 + range_m * range_m * self.covariance[(2, 2)]
    }

    /// The maximum distance between a scanned point and its true position, metres, for a point at `range_m` from the
    /// scanner.
    pub(crate) fn gate_m(&self, range_m: f64) -> f64 {
        GATE * (self.sigma_m * self.sigma_m + self.point_m2(range_m)).sqrt()
    }

    /// The covariance of the position of an object, given its offset from the robot.
    pub(crate) fn of_place(&self, arm: geometry::Vector) -> Matrix2<f64> {
        let slope = nalgebra::Matrix2x3::new(1.0, 0.0, -arm.y, 0.0, 1.0, arm.x);
        slope * self.covariance * slope.transpose()
    }
}
