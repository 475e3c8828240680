//! A solid near the robot: its distance and direction.

use geometry::{
    Boundary, Point, Vector, direction_or,
    polyline::{edges, nearest_on_segment},
};

/// The kind of solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Source {
    /// An obstacle, by its id.
    Obstacle(u32),
    /// A gap too narrow for the robot, closed by a virtual line.
    Gap,
    /// The wall of the tank.
    Wall,
}

/// A solid near the robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// The kind of solid.
    pub source: Source,
    /// Distance from the hull to the outline, metres; negative when they overlap.
    pub distance_m: f64,
    /// Unit vector from the outline to the robot.
    pub away: Vector,
}

/// The wall as contacts of a hull: one for a round wall, or one for every segment within reach of a straight wall.
pub fn wall_contacts(wall: &Boundary, at: Point, hull_m: f64, reach_m: f64) -> Vec<Contact> {
    let contact =
        |outline_m: f64, away: Vector| Contact { source: Source::Wall, distance_m: outline_m - hull_m, away };
    let all = match wall {
        Boundary::Circle { radius_m } => {
            vec![contact(radius_m - at.coords.norm(), direction_or(-at.coords, Vector::x()))]
        }
        Boundary::Polygon { vertices } => edges(vertices)
            .map(|(a, b)| {
                let off = at - nearest_on_segment(a, b, at);
                let inward = Vector::new(a.y - b.y, b.x - a.x);
                contact(off.norm(), direction_or(off, direction_or(inward, Vector::x())))
            })
            .collect(),
    };
    all.into_iter().filter(|c: &Contact| c.distance_m < reach_m).collect()
}
