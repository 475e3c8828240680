//! Trials of planners: layouts drawn from a seed as the papers draw them, and the figures of a path on them.
//!
//! Pure: the same seed gives the same layout, everywhere. `reproduce` measures planners with it over the plugin
//! boundary; the planners' own tests use the same layouts and the same figures.
//!
//! Frame: the tank frame, metres, radians.
#![forbid(unsafe_code)]

pub mod haul;
pub mod paper;
pub mod score;
pub mod shore;
pub mod spiral;
pub mod tanks;
pub mod traps;
pub mod verdict;

pub use haul::Haul;
pub use paper::{Distribution, Sampling};
pub use score::{Safety, Score, floor_rmse_m, precision_recall, safety, score};
pub use shore::Shore;
pub use spiral::Layout;
pub use traps::Trap;
pub use verdict::{Verdict, verdict};
