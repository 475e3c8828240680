//! The papers' tables and figures, with our values beside the printed ones, and the tuning of parameters.
//!
//! A [`Study`] generates layouts or measurements from a seed, calls planners across the plugin boundary as the console
//! does, and returns [`Row`]s. Layouts run in parallel; only the measured times depend on the number of threads. The
//! registry ([`study`], [`studies`]) is on top: no study depends on the registry or on another study. The [`account`]
//! of the papers names the studies, and a test checks that it names each of them.
#![forbid(unsafe_code)]

pub mod account;
mod coverage;
mod fields;
mod own_map;
mod positioning;
mod registry;
mod spiral;
mod study;
mod surveys;
mod table;
mod tethers;
mod traps;
pub mod tune;

pub use registry::{gallery, list, studies, study};
pub use study::{Gallery, Options, Parts, Result, Row, Runner, Study, StudyError, Verdict};
pub use table::{csv, table};
