//! Shared functions for all planners that drive a robot: finding what is in the way and how far away it is, finding
//! space for the hull, and a pilot that drives towards a target, slows down near obstacles and keeps its distance.
//!
//! Frame: the tank frame, metres, radians. Distances to obstacles are measured from the robot's hull to the outline.
#![forbid(unsafe_code)]

pub mod blockage;
pub mod body;
pub mod contact;
pub mod detour;
pub mod drawing;
pub mod evade;
pub mod guard;
pub mod known_map;
pub mod params;
pub mod pilot;
pub mod room;
pub mod side;
pub mod solid;
pub mod stall;
pub mod tangents;
pub mod tick;

pub use body::{Body, solid_parts, solids};
pub use contact::{Contact, Source, wall_contacts};
pub use drawing::Forces;
pub use known_map::{KnownMap, Nearby};
pub use params::Flight;
pub use pilot::{Decision, Pilot};
pub use room::{Keep, Room};
pub use side::Side;
pub use solid::Solid;
pub use tick::Tick;
