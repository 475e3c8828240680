//! Pictures of tanks: SVG in millimetres of paper, with the x axis of the tank frame to the right and y up.

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
