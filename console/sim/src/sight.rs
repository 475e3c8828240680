//! Determines which obstacles the robot sees.

use geometry::{
    polyline::{edges, segments_cross},
    unit_vector,
};
use world::{Boundary, Obstacle, ObstacleMap, Point, Pose, Shape, Sighting};

/// Distance, metres, within which a ray counts as having hit an outline.
const TOUCH_M: f64 = 1e-6;
/// Number of points tested on a round outline.
const ROUND_POINTS: u32 = 24;

/// The obstacles that have some part within `reach_m` of the robot's centre and in its line of sight.
pub(crate) fn sightings(
    map: &ObstacleMap,
    boundary: &Boundary,
    obstacles: &[Obstacle],
    pose: &Pose,
    reach_m: f64,
) -> Vec<Sighting> {
    let robot_from_tank = pose.tank_from_robot().inverse();
    let eye = pose.position;
    map.within(eye, reach_m)
        .into_iter()
        .filter(|near| {
            let shape = &obstacles[near.index].shape;
            let sees = |point: &Point| {
                (point - eye).norm() <= reach_m + TOUCH_M
                    && !is_behind_wall(boundary, eye, *point)
                    && is_first_hit(map, shape, eye, *point)
            };
            sees(&near.closest) || outline_points(shape).iter().any(sees)
        })
        .map(|near| Sighting {
            id: near.id,
            shape_in_robot: obstacles[near.index].shape.transformed(&robot_from_tank),
        })
        .collect()
}

/// Whether a ray towards a point on an obstacle's outline hits that obstacle before any other.
fn is_first_hit(map: &ObstacleMap, shape: &Shape, eye: Point, point: Point) -> bool {
    let way = point - eye;
    let distance = way.norm();
    if distance < TOUCH_M || shape.distance_m(eye) <= 0.0 {
        return true;
    }
    let direction = way / distance;
    match map.ray_m(eye, direction, distance + TOUCH_M) {
        Some(hit) => hit >= distance - TOUCH_M || shape.distance_m(eye + direction * hit) <= TOUCH_M,
        None => true,
    }
}

/// Points on an outline: enough of them to see an obstacle even if its nearest point is hidden.
pub(crate) fn outline_points(shape: &Shape) -> Vec<Point> {
    match shape {
        Shape::Disc { center, radius_m } => (0..ROUND_POINTS)
            .map(|k| std::f64::consts::TAU * f64::from(k) / f64::from(ROUND_POINTS))
            .map(|angle| center + unit_vector(angle) * *radius_m)
            .collect(),
        Shape::Polygon { vertices } => with_midpoints(vertices, vertices.first()),
        Shape::Polyline { points, .. } => with_midpoints(points, None),
    }
}

fn with_midpoints(points: &[Point], closing: Option<&Point>) -> Vec<Point> {
    let corners: Vec<Point> = points.iter().chain(closing).copied().collect();
    let midpoints = corners.windows(2).map(|pair| nalgebra::center(&pair[0], &pair[1]));
    corners.iter().copied().chain(midpoints).collect()
}

/// Whether a straight wall is between two points; a round wall is never between them.
fn is_behind_wall(boundary: &Boundary, a: Point, b: Point) -> bool {
    let Boundary::Polygon { vertices } = boundary else { return false };
    edges(vertices).any(|(c, d)| segments_cross(a, b, c, d))
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::ObstacleId;

    fn disc(id: u32, x: f64, y: f64, radius_m: f64) -> Obstacle {
        let shape = Shape::Disc { center: Point::new(x, y), radius_m };
        Obstacle { id: ObstacleId(id), name: format!("C{id}"), shape, known: id.is_multiple_of(2) }
    }

    fn seen(boundary: &Boundary, obstacles: &[Obstacle], pose: &Pose, reach_m: f64) -> Vec<u32> {
        let map = ObstacleMap::new(boundary, obstacles);
        sightings(&map, boundary, obstacles, pose, reach_m).iter().map(|s| s.id.0).collect()
    }

    const ROUND: Boundary = Boundary::Circle { radius_m: 10.0 };

    #[test]
    fn what_is_near_and_not_hidden_is_seen() {
        let obstacles =
            [disc(1, 2.0, 0.0, 0.5), disc(2, 3.2, 0.0, 0.3), disc(3, 0.0, 2.0, 0.0), disc(4, 7.0, 0.0, 1.0)];
        assert_eq!(seen(&ROUND, &obstacles, &Pose::new(0.0, 0.0, 0.0), 4.0), [1, 3]);
    }

    #[test]
    fn a_large_column_is_seen_past_a_small_one() {
        let obstacles = [disc(1, 1.0, 0.0, 0.1), disc(2, 4.0, 0.0, 2.0)];
        assert_eq!(seen(&ROUND, &obstacles, &Pose::new(0.0, 0.0, 0.0), 3.0), [1, 2]);
    }

    #[test]
    fn nothing_is_seen_round_the_corner_of_a_wall() {
        let corner = |x: f64, y: f64| Point::new(x, y);
        let l_shaped = Boundary::Polygon {
            vertices: vec![
                corner(-5.0, -5.0),
                corner(5.0, -5.0),
                corner(5.0, 0.0),
                corner(0.0, 0.0),
                corner(0.0, 5.0),
                corner(-5.0, 5.0),
            ],
        };
        let obstacles = [disc(1, -1.0, 4.0, 0.2), disc(2, 2.0, -4.0, 0.2)];
        assert_eq!(seen(&l_shaped, &obstacles, &Pose::new(4.0, -1.0, 0.0), 10.0), [2]);
    }

    #[test]
    fn an_outline_is_reported_in_the_frame_of_the_robot() {
        let obstacles = [disc(1, 2.0, 3.0, 0.5)];
        let map = ObstacleMap::new(&ROUND, &obstacles);
        let pose = Pose::new(2.0, 1.0, std::f64::consts::FRAC_PI_2);
        let sighted = sightings(&map, &ROUND, &obstacles, &pose, 5.0);
        assert!((sighted[0].shape_in_robot.center() - Point::new(2.0, 0.0)).norm() < 1e-12);
    }
}
