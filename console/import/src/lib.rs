//! Import of floors and scans from the files of other programs.
//!
//! [`OccupancyMap::read`] reads a map of the ROS map server, and [`MapFloor::new`] turns it into a wall and convex
//! obstacles. [`drawing::read`] reads a DXF drawing, and [`columns::read`] a list of columns; both return a
//! [`FloorPlan`], which [`FloorPlan::scenario`] turns into a scenario. [`scan_log::read`] reads a log of laser scans.
//!
//! Coordinates are in the tank frame, in metres, unless a comment states *lattice*: then the unit is a cell of the map,
//! with x to the right, y up, and the origin at the lower left corner of the lower left cell.

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
pub mod scan_log;
mod simplify;
mod text;

pub use error::ImportError;
pub use floor::MapFloor;
pub use input::{Input, InputKind};
pub use occupancy::{OccupancyMap, Unseen};
pub use outside::is_wholly_outside;
pub use plan::{FloorPlan, Named};
