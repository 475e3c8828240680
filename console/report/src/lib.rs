//! What people and scripts read: of a run, of several together, of a plan, of a forecast of the accuracy.
//!
//! [`Fold`] reads every event of a run once and gives a [`Summary`]: the object that `run --json` prints, the text of
//! [`human()`], and what [`Expect`] holds to the bounds of a scenario. The events contain neither wall-clock figures nor files; the
//! app fills them in. Plans ([`plan`]) and forecasts ([`forecast`]) are pictures, too ([`drawing`]).

pub mod account;
mod accuracy;
mod difference;
pub mod document;
pub mod drawing;
mod drawn;
mod dxf;
pub mod estimate;
pub mod expect;
pub mod fold;
pub mod forecast;
mod geojson;
pub mod human;
mod identity;
mod joined;
pub mod leg;
pub mod merged;
pub mod notes;
mod overlap;
mod passes;
pub mod plan;
mod plan_files;
pub mod print;
pub mod record;
pub mod rescan;
mod sampled;
mod scanned;
pub mod summary;
mod tethered;
mod tracking;
mod turning;

pub use account::Account;
pub use difference::{Difference, first_difference};
pub use document::{Document, Inspection};
pub use drawn::DrawnZone;
pub use estimate::Estimate;
pub use expect::{Expect, Miss};
pub use fold::Fold;
pub use human::{human, text::clock};
pub use joined::PastRun;
pub use merged::{Merged, MergedRun, merged};
pub use overlap::Overlap;
pub use record::Record;
pub use rescan::{Rescan, rescan};
pub use summary::{
    Accuracy, Coverage, CoverageByTruth, Logs, PlannerCalls, Positioning, REPORT_VERSION, Stops, Summary,
    Tether, Tracking,
};
