//! Trials of planners: layouts generated from a seed as in the papers, and the figures of a path on them.
//!
//! The crate is pure: the same seed gives the same layout on every machine. `reproduce` uses it to measure planners
//! across the plugin boundary; the planners' own tests use the same layouts and the same figures, and drive on the
//! layouts ([`fly`], [`cross`]).
//!
//! Frame: the tank frame, metres, radians.
#![forbid(unsafe_code)]

pub mod amphibious;
pub mod changed;
pub mod crossing;
pub mod discs;
pub mod entanglement;
pub mod flight;
pub mod paper;
pub mod scan;
pub mod score;
pub mod sensed;
pub mod spiral;
pub mod tanks;
pub mod traps;
pub mod walk;

pub use amphibious::AmphibiousLayout;
pub use changed::{Changed, changed};
pub use crossing::{Crossing, cross};
pub use entanglement::Entanglement;
pub use flight::{Outcome, Robot, fly};
pub use paper::{Distribution, Sampling};
pub use scan::Scan;
pub use score::{Safety, Score, floor_rmse_m, precision_recall, safety, score, score_paired, targets_ahead};
pub use sensed::{exact_pose, sensed_at_rest};
pub use spiral::Layout;
pub use traps::Trap;
pub use walk::WalkOutcome;
