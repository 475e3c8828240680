//! The tank floor and everything on it: boundary, obstacles, stations, zones, sensor readings, the coverage grid,
//! shortest paths, the tether and the preset spiral.
//!
//! Frame: the tank frame, with its origin at the tank's centre, x east, y north, metres; angles in radians,
//! counter-clockwise. Cost: distance queries use a bounding volume hierarchy, so their cost grows with the logarithm of
//! the number of obstacles.

mod beside_limit;
pub mod coverage;
pub mod medium;
pub mod obstacles;
pub mod plates;
pub mod readings;
pub mod scan;
mod scanner;
pub mod shortest;
pub mod spiral;
pub mod tank;
pub mod tether;
mod tiles;
mod total;
mod truth;
mod wear;

pub use beside_limit::beside_limit;
pub use coverage::{
    Cell, CellRun, Counts, CoverageGrid, Floor, FloorClass, FloorMaker, KindRun, ShellFigures, ShellStretch,
    ShellZone, SweptArea, Tool, ToolPart,
};
/// Points, poses and shapes are re-exported, so that a crate that uses the tank need not also depend on `geometry`.
pub use geometry::{self, Amphibious, Boundary, Pace, Point, Pose, Shape, Vector, polyline, shape};
pub use medium::{Medium, Mode, PressureSensor, SensedMedium};
pub use obstacles::{Near, ObstacleMap};
pub use plates::{DeadBands, DrawnPlate, NO_PLATE, Plate, PlateKind, PlateLayout, PlateMap, RegularPlates};
pub use readings::{Odometry, PulseSet, RangeSet, Readings, Sighting};
pub use scan::{NO_ECHO, Scan};
pub use scanner::Scanner;
pub use tank::{Obstacle, ObstacleId, Station, StationId, World, Zone, ZoneKind};
pub use tiles::Tiles;
pub use truth::{CableLies, TetherTruth, Truth};
pub use wear::{FloorWear, LossProfile, MetalLoss, PlateSide};
