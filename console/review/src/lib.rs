//! Operations on past runs: read, report, verify, and re-scan missed floor; and the stream of a run in progress.

mod flown;
pub mod package;
mod past;
mod readings;
mod register;
mod rescan;
mod stream;
mod survey;
mod track;
mod verify;

pub use past::{combined, continued, inspection, read_all, report_page, report_text, summary, text_of};
pub use readings::readings;
pub use register::register;
pub use rescan::{MIN_AREA_M2, MissedScan, NextScan, doubt, missed_scan, rescan_of};
pub use stream::{Selection, StreamEnd, StreamLine, printed, stream};
pub use survey::{PastSurvey, past_survey};
pub use track::track;
pub use verify::{Verified, verdict, verify};
