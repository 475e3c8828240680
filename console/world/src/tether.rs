//! The tether: a taut cable from an anchor to the robot, among columns, pipes and walls.
//!
//! Model: the cable cannot stretch; a reel at the anchor takes up all slack; friction does not change the cable's
//! shape; the cable may touch obstacles; the floor is flat. The cable is then the one shortest line into which the path
//! driven can be deformed without lifting the cable over an obstacle. For a slack or dragging tether, the model gives
//! no bounds.
//!
//! Read the files in this order: `cable` (the exact taut line), `cable_obstacles` (the obstacles that it can bear on),
//! `certify` (the effect of a whole path on the cable), `pull` (the force that moves the cable), `own_gap` (how near the hull comes
//! to its own cable), `homotopy` (the cheap cross-check), `geodesic` (the shortest
//! cable that would suffice).

mod cable;
mod cable_obstacles;
mod case;
mod certificate;
mod certify;
mod clearance;
mod cuts;
mod geodesic;
mod ground;
mod home;
mod homotopy;
mod own_gap;
mod pull;
mod reach;
mod reasons;
mod replay;
mod rounded_polygon;
mod sealed_region;
mod sidestep;
mod sweep;

#[cfg(test)]
mod funnel;
#[cfg(test)]
mod tests;

pub use cable::{Cable, Contact, TetherError, capstan_factor};
pub use cable_obstacles::{Bearing, CableObstacles};
pub use case::{Case, Limits};
pub use certificate::Certificate;
pub use certify::{Strain, certify, certify_on, strain};
pub use cuts::crossings;
pub use geodesic::Geodesic;
pub use ground::Ground;
pub use homotopy::{HomotopySignature, RayCrossing, Rays};
pub use own_gap::OwnGap;
pub use pull::{Drag, Pull, PullLimits, Reel};
pub use reach::Reach;
pub use reasons::BACK_M;
