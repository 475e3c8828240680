//! What a force law needs to know of something solid nearby.

use geometry::Vector;

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
