//! What a run comes to: its figures, the account of its floor, and what people add to it.
//!
//! [`Fold`] reads every event of a run once and gives a [`Summary`]: the object that `run --json` prints, and what [`Expect`]
//! compares with the bounds of a scenario. Whoever shows, records, compares or reports a run gets its figures here, so that no
//! two of them differ. Events contain neither wall-clock figures nor files; the app fills them in.
//!
//! An [`Estimate`] is the same of a plan that nobody has flown. What only people know are [`Notes`] about a run and the facts
//! of an [`Inspection`]. Nothing here knows a file, a clock, a page or a picture.

mod accuracy;
mod clock;
mod drawn;
pub mod estimate;
pub mod expect;
mod floor;
pub mod fold;
mod inspection;
pub mod notes;
mod overlap;
mod passes;
mod sampled;
#[cfg(test)]
mod samples;
mod scanned;
pub mod summary;
mod tethered;
mod tracking;
mod turning;

pub use clock::clock;
pub use drawn::DrawnZone;
pub use estimate::Estimate;
pub use expect::{Expect, Miss};
pub use floor::{
    Account, Area, Cause, CriticalZone, Evidence, Explained, Measure, MissReason, OutOfReach, Percent,
    PlateAccount, Reasons, Shares, Slivers, Solid, ZoneArc, ZoneOfPlate, account, area_of, areas, plate_map,
    together, updated_floor,
};
pub use fold::Fold;
pub use inspection::{Date, Inspection, is_placeholder, says_nothing};
pub use notes::Notes;
pub use overlap::Overlap;
pub use passes::Passes;
pub use scanned::Scanned;
pub use summary::{
    Accuracy, Coverage, CoverageByTruth, Logs, PlannerCalls, Positioning, REPORT_VERSION, Stops, Summary,
    Tether, Tracking,
};

#[cfg(test)]
extern crate self as account;
