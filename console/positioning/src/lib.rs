//! Where the robot is: acoustic-emission ranges to a fix, fixes and odometry to a pose.
//!
//! Nothing here knows the truth, a clock or a file. Frame and units as in [`world`].

pub mod fix;

pub use fix::{Exclusion, Fix, FixError, Integrity, PositionSolver, Ranging, Residual};
