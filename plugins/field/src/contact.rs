//! What a force law needs to know of something solid nearby.

use world::{Point, Vector};

/// What stands there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Source {
    /// An obstacle, by its id.
    Obstacle(u32),
    /// A gap too narrow for the robot, closed by a line that the planner made up.
    Gap,
    /// The wall of the tank.
    Wall,
}

/// Something solid near the robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// What stands there.
    pub source: Source,
    /// Distance from the hull to the outline, metres; negative when they overlap.
    pub distance_m: f64,
    /// Unit vector from the outline to the robot.
    pub away: Vector,
}

/// Unit vector along `vector`, or `fallback` where it has no direction.
pub fn direction_or(vector: Vector, fallback: Vector) -> Vector {
    let length = vector.norm();
    if length > 1e-9 { vector / length } else { fallback }
}

/// Unit vector out of an outline through `point`.
///
/// `signed_m` is the distance to the outline, negative inside, `closest` the outline's nearest point and `center` what
/// stands for its middle: on the outline itself, the way out is away from there.
pub fn away_from(point: Point, signed_m: f64, closest: Point, center: Point) -> Vector {
    let outward = (point - closest) * signed_m.signum();
    let from_center = direction_or(point - center, Vector::x());
    direction_or(outward, from_center)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_out_points_outward_inside_on_and_outside_the_outline() {
        let center = Point::origin();
        let closest = Point::new(1.0, 0.0);
        for (x, signed_m) in [(0.5, -0.5), (1.0, 0.0), (1.5, 0.5)] {
            assert!((away_from(Point::new(x, 0.0), signed_m, closest, center) - Vector::x()).norm() < 1e-12);
        }
        assert!((away_from(center, 0.0, center, center).norm() - 1.0).abs() < 1e-12);
    }
}
