//! The tether: a taut cable from an anchor to the robot, among columns, pipes and walls.
//!
//! Model (one sentence each): the cable cannot stretch, a reel at the anchor takes up all slack, friction does not
//! change its shape, it may touch obstacles, the floor is flat. It is then the one shortest line that can be reached
//! from the way driven without lifting the cable over an obstacle. Slack and dragged cable are not bounded by it.
//!
//! Read in this order: [`cable`] (the exact taut line), [`ground`] (what it can bear on), [`certificate`] (what a whole
//! path does to the cable), [`word`] (the cheap second answer), [`geodesic`] (the least cable that would do).

pub mod cable;
pub mod certificate;
mod cuts;
pub mod geodesic;
pub mod ground;
mod home;
mod pocket;
mod reach;
mod sidestep;
mod solid;
mod sweep;
pub mod word;

#[cfg(test)]
mod funnel;
#[cfg(test)]
mod tests;

pub use cable::{Bearing, Cable, Contact, TetherError, capstan_factor};
pub use certificate::{Case, Certificate, Limits, certify};
pub use cuts::crossings;
pub use ground::Ground;
pub use reach::Reach;
pub use word::Word;
