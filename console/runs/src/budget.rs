//! Limits how much is read from the files of past runs for a list. A list is an overview that may be shown even during a
//! mission; it must not take longer just because a run was long or a file is damaged.

use recording::{events_sha256_while, sha256_while};
use std::{cell::Cell, io, path::Path};

/// Maximum size of the journal lines that are read for a list, bytes: for one run, and for all runs together.
const LINES_OF_ONE: u64 = 16 << 20;
const LINES_OF_ALL: u64 = 64 << 20;
/// Maximum size of the files whose digests are computed for a list, bytes.
const DIGESTED: u64 = 1 << 30;

/// The remaining budget.
#[derive(Debug)]
pub(crate) struct Budget {
    lines: Cell<u64>,
    lines_of_one: u64,
    digested: Cell<u64>,
}

impl Budget {
    /// The budget for a list of runs.
    pub(crate) fn of_a_list() -> Self {
        Self { lines: Cell::new(LINES_OF_ALL), lines_of_one: LINES_OF_ONE, digested: Cell::new(DIGESTED) }
    }

    /// No limit, for a single run that the user asked for.
    pub(crate) fn of_one_run() -> Self {
        Self { lines: Cell::new(u64::MAX), lines_of_one: u64::MAX, digested: Cell::new(u64::MAX) }
    }

    /// Maximum number of bytes to read from the lines of the next journal.
    pub(crate) fn lines(&self) -> u64 {
        self.lines.get().min(self.lines_of_one)
    }

    /// Deducts the bytes of lines that were read.
    pub(crate) fn take_lines(&self, bytes: u64) {
        self.lines.set(self.lines.get().saturating_sub(bytes));
    }

    /// Computes [`recording::events_sha256`].
    ///
    /// # Errors
    /// As for that function; also [`io::ErrorKind::QuotaExceeded`] if the file is too long for the remaining budget.
    pub(crate) fn events_sha256(&self, path: &Path) -> io::Result<String> {
        self.digest(|goes_on| events_sha256_while(path, goes_on))
    }

    /// Computes [`recording::sha256`].
    ///
    /// # Errors
    /// As for [`Budget::events_sha256`].
    pub(crate) fn sha256(&self, path: &Path) -> io::Result<String> {
        self.digest(|goes_on| sha256_while(path, goes_on))
    }

    fn digest(
        &self,
        compute: impl FnOnce(&mut dyn FnMut(u64) -> bool) -> io::Result<String>,
    ) -> io::Result<String> {
        let (most, mut read) = (self.digested.get(), 0);
        let digest = compute(&mut |bytes| {
            read = bytes;
            bytes < most
        });
        self.digested.set(most.saturating_sub(read));
        digest.map_err(|error| match error.kind() {
            io::ErrorKind::Interrupted => io::Error::new(
                io::ErrorKind::QuotaExceeded,
                "not compared with the report, because reading it would take too long for a list; `tankops verify` compares it",
            ),
            _ => error,
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    #[test]
    fn what_is_left_is_shared_by_all_runs_of_a_list() {
        let budget = Budget::of_a_list();
        assert_eq!(budget.lines(), LINES_OF_ONE);
        budget.take_lines(LINES_OF_ALL - 5);
        assert_eq!(budget.lines(), 5);
        budget.take_lines(6);
        assert_eq!((budget.lines(), Budget::of_one_run().lines()), (0, u64::MAX));
    }

    #[test]
    fn files_that_are_too_long_are_not_digested() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        std::fs::write(&file, vec![b'x'; 3 << 18]).unwrap();
        let budget = Budget { digested: Cell::new(4 << 18), ..Budget::of_a_list() };
        assert_eq!(budget.sha256(&file).unwrap(), recording::sha256(&file).unwrap());
        let error = budget.sha256(&file).unwrap_err();
        assert!(
            error.kind() == io::ErrorKind::QuotaExceeded
                && error.to_string().contains("would take too long for a list")
        );
    }
}
