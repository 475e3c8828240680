//! A plan as whoever draws it gets it.

use planner_api::Plan;
use world::{Point, World};

/// A plan of one planner for one tank.
#[derive(Debug, Clone, Copy)]
pub struct Picture<'a> {
    /// The case of the tank, as in the rows.
    pub case: &'a str,
    /// Its seed.
    pub seed: u64,
    /// The planner and its mode, as in the rows.
    pub method: &'a str,
    /// The tank.
    pub world: &'a World,
    /// Where the tether comes in.
    pub anchor: Point,
    /// Room that the middle of the hull needs, metres.
    pub room_m: f64,
    /// Width of the floor scanned in one pass, metres.
    pub swath_m: f64,
    /// What was planned.
    pub plan: &'a Plan,
    /// The cable when it is longest, from the anchor to the robot.
    pub cable: &'a [Point],
}
