//! Discs on a floor (centre and radius, metres) in the forms that planners and `world` use, and paths among the discs.

use planner_api::{Obstacle, Outline};
use world::{
    Boundary, ObstacleId, Point, Shape, Vector, World, polyline,
    shortest::{GrownFloor, NoWay, Way},
};

/// The discs in the form for planners, as on the drawing; ids from 0.
pub fn obstacles(discs: &[(Point, f64)]) -> Vec<Obstacle<'static>> {
    let obstacle = |(id, &(center, radius_m)): (usize, &(Point, f64))| Obstacle {
        id: id as u32,
        outline: Outline::Disc { center, radius_m },
        discovered: false,
        velocity_m_per_s: Vector::zeros(),
    };
    discs.iter().enumerate().map(obstacle).collect()
}

/// The discs in the form of a tank's drawing; ids from 0, named `C0` and so on.
pub fn world(boundary: Boundary, discs: &[(Point, f64)]) -> World {
    let obstacle = |(id, &(center, radius_m)): (usize, &(Point, f64))| world::Obstacle {
        id: ObstacleId(id as u32),
        name: format!("C{id}"),
        shape: Shape::Disc { center, radius_m },
        known: true,
    };
    let obstacles = discs.iter().enumerate().map(obstacle).collect();
    World { boundary, obstacles, stations: Vec::new(), zones: Vec::new() }
}

/// Distance from a place to the nearest disc, metres; negative inside one, infinite without discs.
pub fn distance_m(discs: &[(Point, f64)], at: Point) -> f64 {
    discs.iter().map(|(center, radius_m)| (at - center).norm() - radius_m).fold(f64::INFINITY, f64::min)
}

/// The least distance from a path to a disc, metres; negative through one, infinite without discs.
pub fn path_distance_m(discs: &[(Point, f64)], path: &[Point]) -> f64 {
    let from_path = |(center, radius_m): &(Point, f64)| polyline::distance_m(path, *center) - radius_m;
    discs.iter().map(from_path).fold(f64::INFINITY, f64::min)
}

/// The exact shortest path of a round robot among discs on a floor with these corners.
///
/// # Errors
/// There is no path, or the robot does not fit at an end.
pub fn shortest_path(
    corners: &[Point],
    discs: &[(Point, f64)],
    hull_m: f64,
    start: Point,
    goal: Point,
) -> Result<Way, NoWay> {
    let wall = Boundary::Polygon { vertices: corners.to_vec() };
    let shape = |&(center, radius_m): &(Point, f64)| Shape::Disc { center, radius_m };
    let shapes: Vec<Shape> = discs.iter().map(shape).collect();
    let floor = GrownFloor::new(&wall, hull_m, shapes.iter().map(|shape| (shape, hull_m)));
    floor.shortest(start, goal, &mut || true)
}
