//! Wang et al. 2023: acoustic-emission positioning, compared with the theoretical limit.

mod bound;
mod detectable;
mod estimator;
mod filter;
mod integrity;
mod limits;
mod odometry;
mod outcome;
mod robust;
mod sessions;
mod setup;
mod significance;
mod spiral;
mod table3;

use crate::study::Study;

/// The studies.
pub(crate) const STUDIES: &[Study] = &[
    table3::STUDY,
    spiral::STUDY,
    limits::STUDY,
    robust::STUDY,
    filter::STUDY,
    integrity::STUDY,
    sessions::STUDY,
    detectable::STUDY,
];
