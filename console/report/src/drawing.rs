//! Pictures of tanks for people: SVG in millimetres of paper, with the tank frame's x to the right and y up.

pub(crate) mod badges;
pub mod curves;
mod floor;
pub(crate) mod forecast;
pub(crate) mod frame;
pub mod plan;
pub(crate) mod plates;
pub(crate) mod polygons;
pub(crate) mod sheet;
pub(crate) mod trace;

pub use floor::floor;
