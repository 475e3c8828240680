//! Wang et al. 2023: acoustic-emission positioning, and how far it is from what is possible.

mod filter;
mod limits;
mod method;
mod odometry;
mod robust;
mod scene;
mod spiral_fix;
mod student;
mod table3;
mod tally;

use crate::study::Study;

/// The studies.
pub const STUDIES: &[Study] =
    &[table3::STUDY, spiral_fix::STUDY, limits::STUDY, robust::STUDY, filter::STUDY];
