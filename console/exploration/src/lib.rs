//! Makes a map of a floor from scans at known poses: free floor, solid objects, and the places to look at next.
//!
//! The crate is pure: the same scans and poses give the same map. The memory depends only on the size of the tank. Poses
//! and results are in the tank frame, scans in the robot frame; metres, radians.
//!
//! [`Exploration`] keeps an occupancy grid with log odds (Moravec and Elfes 1985). A frontier is free floor beside floor
//! that no scan has shown (Yamauchi 1997); [`Ways`] contains the ways of the hull through free floor to the frontiers.
//! [`Body`] is a connected object: a disc if the points say so, with standard deviations, else an outline.
//! [`SurveyMap`] is the result: one state per cell, and the columns.
#![forbid(unsafe_code)]

mod beams;
mod bodies;
mod cells;
mod circle;
mod difference;
mod distances;
mod frontiers;
mod grid;
mod grown;
mod map;
mod ros;
mod survey;
mod unseen;
mod views;
mod ways;

pub use bodies::{Body, Column};
pub use cells::{CellState, changes, runs};
pub use difference::Fate;
pub use frontiers::Frontier;
pub use grid::Grid;
pub use map::{SurveyMap, column_numbers};
pub use ros::RosMap;
pub use survey::{Exploration, Scanning};
pub use unseen::Unseen;
pub use views::View;
pub use ways::Ways;

#[cfg(test)]
mod tests;
