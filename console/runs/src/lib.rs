//! Runs on disk: the folder of each run, the files written to it, whether the run was kept, and the contents of past
//! runs.
//!
//! Every run is written by a [`RunLog`] into its own [`RunFolder`]: the journal and the recording while the run is in
//! progress, the report at its end. The journal is authoritative. The report is derived from the journal, and is trusted
//! only as long as it agrees with the journal ([`standing()`]).

mod beside;
mod budget;
mod by_journal;
mod error;
mod files;
mod folder;
mod glance;
mod imported;
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
mod verified;
mod whole;

pub use by_journal::by_journal;
pub use error::{RunError, is_of_machine};
pub use files::{began, utc, utc_day_minute, utc_minute};
pub use folder::{RunFolder, find, is_run};
pub use imported::{IMPORT_FILE, write_import};
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
pub use verified::{Proof, VERIFIED_FILE};
pub use whole::{write_by_draft, write_whole, write_whole_with};
