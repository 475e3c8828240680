//! The papers' tables and figures, ours beside the printed values.
//!
//! A [`Study`] draws layouts or measurements from a seed, asks planners over the plugin boundary as the console does,
//! and gives [`Row`]s. Layouts run in parallel; rows do not depend on the number of threads, except times.
#![forbid(unsafe_code)]

mod bench;
pub mod coverage;
pub mod fields;
mod planners;
pub mod positioning;
mod row;
mod sample;
pub mod spiral;
mod study;
pub mod traps;
pub mod tune;

pub use bench::Bench;
pub use coverage::Picture;
pub use planners::{Planned, Planners};
pub use row::Row;
pub use sample::Sample;
pub use study::{Options, Problem, STUDIES, Study, study};
