//! Wang et al. 2023: planners on the preset spiral.

use crate::study::Study;

/// The studies.
pub const STUDIES: &[Study] = &[];
