//! What a scanner at the robot's centre would measure, without noise.

use geometry::polyline::edges;
use world::{Boundary, ObstacleMap, Point, Pose, Vector};

/// Distances along evenly spaced rays, counter-clockwise from straight ahead; `None` beyond `most_m`, metres.
pub(crate) fn scan(
    map: &ObstacleMap,
    boundary: &Boundary,
    pose: &Pose,
    rays: u32,
    most_m: f64,
) -> Vec<Option<f64>> {
    let ray = |n: u32| {
        let angle = pose.heading_rad + std::f64::consts::TAU * f64::from(n) / f64::from(rays);
        let direction = Vector::new(angle.cos(), angle.sin());
        let wall_m = wall_m(boundary, pose.position, direction);
        let hit_m = map.ray_m(pose.position, direction, most_m).unwrap_or(f64::INFINITY).min(wall_m);
        (hit_m <= most_m).then_some(hit_m)
    };
    (0..rays).map(ray).collect()
}

/// Distance along a ray to the wall, metres; infinite if the ray does not reach it.
fn wall_m(boundary: &Boundary, from: Point, direction: Vector) -> f64 {
    match boundary {
        Boundary::Circle { radius_m } => {
            let along = from.coords.dot(&direction);
            let rest = radius_m * radius_m - from.coords.norm_squared() + along * along;
            if rest < 0.0 { f64::INFINITY } else { (rest.sqrt() - along).max(0.0) }
        }
        Boundary::Polygon { vertices } => {
            let hits = edges(vertices).filter_map(|(a, b)| {
                let (edge, to) = (b - a, a - from);
                let across = direction.perp(&edge);
                let (along_m, share) = (to.perp(&edge) / across, to.perp(&direction) / across);
                (across != 0.0 && along_m >= 0.0 && (0.0..=1.0).contains(&share)).then_some(along_m)
            });
            hits.fold(f64::INFINITY, f64::min)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::{Obstacle, ObstacleId, Shape};

    #[test]
    fn rays_end_at_columns_and_walls() {
        let column = Obstacle {
            id: ObstacleId(1),
            name: "column".into(),
            shape: Shape::Disc { center: Point::new(0.0, 2.0), radius_m: 0.5 },
            known: false,
        };
        let square = [(-4.0, -3.0), (4.0, -3.0), (4.0, 3.0), (-4.0, 3.0)];
        let square = Boundary::Polygon { vertices: square.map(|(x, y)| Point::new(x, y)).to_vec() };
        for (boundary, wanted) in [
            (Boundary::Circle { radius_m: 5.0 }, [Some(4.0), Some(1.5), None, Some(5.0)]),
            (square, [Some(3.0), Some(1.5), Some(5.0), Some(3.0)]),
        ] {
            let map = ObstacleMap::new(&boundary, std::slice::from_ref(&column));
            let from = |x: f64, n: usize| scan(&map, &boundary, &Pose::new(x, 0.0, 0.0), 4, 5.2)[n];
            let found = [from(1.0, 0), from(0.0, 1), from(1.0, 2), from(0.0, 3)];
            let is_near = |(one, other): (&Option<f64>, &Option<f64>)| match (one, other) {
                (Some(one), Some(other)) => (one - other).abs() < 1e-9,
                (one, other) => one == other,
            };
            assert!(found.iter().zip(&wanted).all(is_near), "{found:?}");
        }
    }
}
