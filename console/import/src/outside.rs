//! Tests whether outlines are outside the tank.

use world::{Boundary, Point, Shape};

/// Whether an outline is completely outside the tank.
pub fn is_wholly_outside(boundary: &Boundary, shape: &Shape) -> bool {
    if let Boundary::Circle { radius_m } = boundary {
        return shape.distance_m(Point::origin()) >= *radius_m;
    }
    let ((low, high), (tank_low, tank_high)) = (shape.bounds(), boundary.bounds());
    if low.x > tank_high.x || low.y > tank_high.y || high.x < tank_low.x || high.y < tank_low.y {
        return true;
    }
    let (points, reach_m) = samples(shape);
    let corner_inside = match boundary {
        Boundary::Polygon { vertices } => vertices.iter().any(|corner| shape.distance_m(*corner) < 0.0),
        Boundary::Circle { .. } => false,
    };
    !corner_inside && points.iter().all(|point| boundary.wall_distance_m(*point) <= -reach_m)
}

/// Points along an outline, close enough together to detect any part of the outline that is on the floor, and the
/// distance in metres by which the outline extends beyond them.
fn samples(shape: &Shape) -> (Vec<Point>, f64) {
    const PIECES: u32 = 16;
    let along = |a: &Point, b: &Point| -> Vec<Point> {
        let (a, b) = (*a, *b);
        (0..=PIECES).map(|k| a + (b - a) * (f64::from(k) / f64::from(PIECES))).collect()
    };
    match shape {
        Shape::Disc { center, radius_m } => (vec![*center], *radius_m),
        Shape::Polygon { vertices } => {
            let ring = vertices.iter().zip(vertices.iter().cycle().skip(1));
            (ring.flat_map(|(a, b)| along(a, b)).collect(), 0.0)
        }
        Shape::Polyline { points, half_width_m } => {
            (points.windows(2).flat_map(|w| along(&w[0], &w[1])).collect(), *half_width_m)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_obstacle_in_the_wall_is_not_wholly_outside() {
        let round = Boundary::Circle { radius_m: 5.0 };
        let square = Boundary::Polygon {
            vertices: [(-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0)]
                .map(|(x, y)| Point::new(x, y))
                .to_vec(),
        };
        for boundary in [round, square] {
            let disc = |x_m| Shape::Disc { center: Point::new(x_m, 0.0), radius_m: 0.5 };
            assert!(!is_wholly_outside(&boundary, &disc(5.4)));
            assert!(is_wholly_outside(&boundary, &disc(5.6)));
        }
    }
}
