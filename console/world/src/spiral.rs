//! The preset Archimedean spiral from the wall to the centre (Wang et al. 2023, eq. 2, with the radius corrected).

use geometry::{Point, unit_vector};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// An inward, counter-clockwise Archimedean spiral about the tank's centre.
///
/// `theta_i = i * step_rad`, `r_i = outer_radius_m - pitch_m * theta_i / (2 pi)`. In print, the paper's radius lacks
/// the index, which would give a circle; its Section 3.3 uses the formula above.
///
/// ```
/// use world::spiral::Spiral;
/// let spiral = Spiral { outer_radius_m: 5.0, inner_radius_m: 0.1, pitch_m: 0.5, step_rad: 0.02 };
/// assert_eq!(spiral.points()[0], world::Point::new(5.0, 0.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Spiral {
    /// Radius of the first point, metres.
    pub outer_radius_m: f64,
    /// The spiral ends at the first point with a radius below this, metres (0.1 in the paper).
    pub inner_radius_m: f64,
    /// Distance between adjacent turns, metres.
    pub pitch_m: f64,
    /// Angle between consecutive points, radians.
    pub step_rad: f64,
}

impl Spiral {
    /// The spiral of Wang et al. 2023: R 10, d 0.4 pi, t 0.02, 2477 points.
    pub const WANG_2023: Self = Self {
        outer_radius_m: 10.0,
        inner_radius_m: 0.1,
        pitch_m: 0.4 * std::f64::consts::PI,
        step_rad: 0.02,
    };

    /// Returns the preset points, tank frame: all points with `r_i >= inner_radius_m`, and the first one below it.
    ///
    /// ```
    /// assert_eq!(world::spiral::Spiral::WANG_2023.points().len(), 2477);
    /// ```
    pub fn points(&self) -> Vec<Point> {
        let radius_at = |i: usize| self.outer_radius_m - self.pitch_m * (i as f64 * self.step_rad) / TAU;
        let mut points = Vec::new();
        for i in 0.. {
            let (radius, theta) = (radius_at(i), i as f64 * self.step_rad);
            if radius < 0.0 {
                break;
            }
            points.push(Point::from(unit_vector(theta) * radius));
            if radius < self.inner_radius_m {
                break;
            }
        }
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_spiral_has_2477_points_and_250_metres() {
        let points = Spiral::WANG_2023.points();
        assert_eq!(points.len(), 2477);
        assert!((geometry::polyline::length_m(&points) - 250.0).abs() < 1.0);
        assert_eq!(points[0], Point::new(10.0, 0.0));
    }

    #[test]
    fn neighbouring_turns_are_one_pitch_apart() {
        let spiral = Spiral { outer_radius_m: 5.0, inner_radius_m: 0.1, pitch_m: 0.5, step_rad: TAU / 100.0 };
        let points = spiral.points();
        assert!((points[0].coords.norm() - points[100].coords.norm() - 0.5).abs() < 1e-12);
    }
}
