//! Coverage planners and the tether, in tanks like those of the original study and in random tanks.
//!
//! Pan 2025 prints no figures to compare with. Our figures use the settings of `trials::tanks`: the tool is a flat bar
//! across the heading with a swath of 0.6 m, coverage is counted in cells of 0.05 m, and the radius of the hull plus
//! the clearance is 0.3 m. The figures include the return path.

mod measured;
mod rows;
mod suite;

pub(crate) use measured::{is_result, plan};

use crate::study::Study;

/// The studies.
pub(crate) const STUDIES: &[Study] = &[
    Study {
        name: "pan-maps",
        about: "after Pan 2025: round tanks with 14 and 28 columns and a square tank with 18; every \
                coverage planner",
        layouts: 10,
        run: suite::pan_maps,
    },
    Study {
        name: "coverage-suite",
        about: "random tanks of radius 5 to 50 m with 0 to 120 columns; every coverage planner, with its \
                tether",
        layouts: 20,
        run: suite::random,
    },
];
