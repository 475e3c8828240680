//! Floors from the files of other programs.
//!
//! [`OccupancyMap::read`] takes the map of a ROS map server, [`MapFloor::new`] makes a wall and convex obstacles of it.
//! [`drawing::read`] takes a DXF drawing, [`columns::read`] a list of columns; both give a [`FloorPlan`], of which
//! [`FloorPlan::scenario`] makes a scenario.
//!
//! Frame: the tank frame, metres, unless a comment says *lattice*: cells of the map, x right, y up, the origin at the lower
//! left corner of the lower left cell.

pub mod columns;
mod contour;
pub mod drawing;
mod error;
mod floor;
mod input;
mod occupancy;
mod outside;
mod pieces;
pub mod plan;
mod simplify;
mod text;

pub use error::ImportError;
pub use floor::MapFloor;
pub use input::{Input, InputKind};
pub use occupancy::{OccupancyMap, Unseen};
pub use outside::is_wholly_outside;
pub use plan::{FloorPlan, Named};
