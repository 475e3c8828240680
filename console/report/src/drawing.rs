//! Pictures of tanks: SVG in millimetres on paper, with the x axis of the tank frame pointing right and the y axis
//! up.

pub(crate) mod badges;
pub mod curves;
mod floor;
pub(crate) mod forecast;
pub(crate) mod frame;
pub mod plan;
pub(crate) mod plates;
pub(crate) mod polygons;
mod scanned;
pub(crate) mod sheet;
pub(crate) mod trace;

pub use floor::floor;
pub use scanned::scanned;
