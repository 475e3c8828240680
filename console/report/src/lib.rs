//! Reports for people and scripts: on a run, on several runs together, on a plan, and on a forecast of accuracy.
//!
//! The figures come from [`account`]. This crate turns them into text ([`human()`]), pages ([`document`]) and
//! pictures ([`drawing`]), and does the same for plans ([`plan`]) and forecasts ([`forecast`]).

mod difference;
pub mod document;
pub mod drawing;
mod dxf;
pub mod forecast;
mod geojson;
mod guarantee;
pub mod human;
mod identity;
mod joined;
pub mod leg;
pub mod merged;
mod past_run;
pub mod plan;
mod plan_files;
pub mod print;
pub mod record;
pub mod rescan;

pub use difference::{Difference, first_difference};
pub use document::Document;
pub use human::human;
pub use identity::continued;
pub use merged::{Merged, MergedRun, merged};
pub use past_run::{ImportedReadings, PastRun};
pub use record::Record;
pub use rescan::{Rescan, rescan};

#[cfg(test)]
#[path = "../../account/src/samples.rs"]
mod samples;
