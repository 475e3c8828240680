//! Floors from the files of other programs.
//!
//! [`OccupancyMap::read`] takes the map of a ROS map server, [`MapFloor::new`] makes a wall and convex obstacles of it.
//!
//! Frame: the tank frame, metres, unless a comment says *lattice*: cells of the map, x right, y up, the origin at the lower
//! left corner of the lower left cell.

mod contour;
mod error;
mod floor;
mod occupancy;
mod pieces;
mod simplify;

pub use error::ImportError;
pub use floor::MapFloor;
pub use occupancy::OccupancyMap;
