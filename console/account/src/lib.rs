//! The results of a run: its figures, the account of its floor, and the facts that people add.
//!
//! [`Fold`] reads every event of a run once and returns a [`Summary`]: the object that `run --json` prints, and that
//! [`Expect`] compares with the bounds of a scenario. Every part of the program that shows, records, compares or
//! reports a run gets its figures here, so that they always agree. Events contain neither wall-clock figures nor files;
//! the app fills them in.
//!
//! An [`Estimate`] gives the same figures for a plan that has not been run. Facts that only people know are the
//! [`Notes`] on a run and the [`Inspection`]. This crate uses no files, clocks, pages or pictures.

mod accuracy;
mod doubt;
mod drawn;
pub mod estimate;
pub mod expect;
mod extremes;
mod figures;
mod floor;
pub mod fold;
mod inspection;
pub mod notes;
mod overlap;
mod passes;
mod protection;
mod ranging;
mod readings;
mod sampled;
#[cfg(test)]
mod samples;
mod scanned;
mod silence;
mod stretch;
pub mod summary;
mod tethered;
mod tracking;
mod true_errors;
mod turning;
mod vehicle;

pub use doubt::{DoubtWatch, InDoubt, TakenBack};
pub use drawn::DrawnZone;
pub use estimate::Estimate;
pub use expect::{Expect, Miss};
pub use extremes::{Extreme, Worst};
pub use figures::{Figure, FigureId, Figures, Limit};
pub use floor::{
    Account, Area, Cause, CriticalZone, Evidence, Explained, LeftOut, Measure, MissReason, OutOfReach,
    Percent, PlateAccount, Reasons, Resumption, Shares, Slivers, Solid, ZoneArc, ZoneOfPlate, account,
    area_of, areas, plate_map, together, updated_floor,
};
pub use fold::Fold;
pub use inspection::{Date, Inspection, is_placeholder, says_nothing};
pub use mission::clock;
pub use notes::Notes;
pub use overlap::Overlap;
pub use passes::Passes;
pub use ranging::{Biased, Calibrated, Calibration, PulseRecord, Ranging, StationClock, not_as_surveyed};
pub use readings::{
    Detection, Detections, Finding, Imported, Judge, LOSS_CLASSES, PlateThickness, Reading, ReadingsSummary,
    Survey, Track, Whereabouts,
};
pub use scanned::Scanned;
pub use silence::Silence;
pub use summary::{
    Accuracy, Coverage, CoverageByTruth, Logs, PlannerCalls, Positioning, Protection, REPORT_VERSION,
    Regained, Stops, Summary, Tether, Tracking,
};
pub use vehicle::VehicleRecord;

#[cfg(test)]
extern crate self as account;
