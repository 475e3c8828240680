//! A quick look at a journal, for a list.

use crate::budget::Budget;
use account::{Fold, Summary};
use mission::{Event, EventKind};
use recording::{JournalError, JournalReader};
use std::path::Path;

/// The content of a journal up to the first damage.
pub(crate) struct Glance {
    pub summary: Summary,
    /// Description of the damage.
    pub damage: Option<String>,
    /// Whether only the beginning and the end were read.
    pub is_partial: bool,
}

impl Glance {
    /// Reads a journal within a budget.
    pub(crate) fn at(journal: &Path, budget: &Budget) -> Self {
        let mut reading = Reading { fold: Fold::of_figures(), reachable: None, is_partial: false };
        let damage = reading.read(journal, budget).err().map(|error| error.to_string());
        let Reading { fold, reachable, is_partial } = reading;
        let mut summary = fold.summary();
        if let (Some(coverage), Some(reachable), true) = (&mut summary.coverage, reachable, is_partial) {
            coverage.reachable = reachable;
        }
        Self { summary, damage, is_partial }
    }
}

struct Reading {
    fold: Fold,
    /// Scanned share of the reachable floor, from the last event that contains it.
    reachable: Option<f64>,
    is_partial: bool,
}

impl Reading {
    fn read(&mut self, journal: &Path, budget: &Budget) -> Result<(), JournalError> {
        let (mut reader, most) = (JournalReader::open(journal)?, budget.lines());
        let read = self.read_up_to(&mut reader, most);
        budget.take_lines(reader.bytes());
        if !read? {
            self.is_partial = true;
            JournalReader::open_end(journal)?.try_for_each(|event| -> Result<(), JournalError> {
                self.take(&event?);
                Ok::<_, JournalError>(())
            })?;
        }
        Ok(())
    }

    /// Reads at least one event; returns whether all events were read.
    fn read_up_to(&mut self, reader: &mut JournalReader, most: u64) -> Result<bool, JournalError> {
        while let Some(event) = reader.next().transpose()? {
            self.take(&event);
            if reader.bytes() >= most {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn take(&mut self, event: &Event) {
        if let EventKind::Progressed { covered_reachable, .. } = event.kind {
            self.reachable = Some(covered_reachable);
        }
        self.fold.apply(event);
    }
}
