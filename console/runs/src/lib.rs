//! Runs on disk: the folder of each, what is written to it, whether it was kept, and what past ones hold.
//!
//! A run that is flown is written by a [`RunLog`] into a [`RunFolder`] of its own: journal and recording while it is under
//! way, the report at its end. The journal is the truth; the report is a copy of what it says, and is believed as long as it
//! fits it ([`standing()`]).

mod beside;
mod budget;
mod error;
mod files;
mod folder;
mod glance;
mod kept;
mod list;
mod log;
mod logs;
mod notes;
mod past;
mod recover;
mod register;
mod report_file;
mod signed;
mod standing;
mod whole;

pub use error::RunError;
pub use files::{utc, utc_minute};
pub use folder::{RunFolder, find, is_run};
pub use kept::Kept;
pub use list::{Listed, list, table};
pub use log::{CLOSE_TIMEOUT, Closed, RunLog};
pub use logs::{check_logs, check_recorder, free_bytes};
pub use notes::{NOTES_FILE, read_notes, write_notes};
pub use past::Past;
pub use recover::recover;
pub use register::Register;
pub use report_file::{end_is_missing, journal_doubt};
pub use signed::{SIGNED_FILE, Signatures, add_signed, signatures, signed_list, signed_under_another_name};
pub use standing::{Standing, standing};
pub use whole::{write_by_draft, write_whole};
