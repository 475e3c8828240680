//! A journal, read tick by tick.

use crate::failure::bad_input;
use mission::{Event, EventKind, RunOpened};
use recording::{JournalLine, JournalReader};
use std::path::Path;

/// The lines of one tick.
#[derive(Debug, Default)]
pub(super) struct RecordedTick {
    pub tick: u64,
    /// Each line as it is in the file, and what it says.
    pub lines: Vec<(Vec<u8>, Event)>,
    /// Whether the journal stops in this tick: then only the lines that come before all answers of planners are compared.
    pub is_cut: bool,
}

impl RecordedTick {
    /// The lines to compare.
    pub(super) fn to_compare(&self) -> &[(Vec<u8>, Event)] {
        let is_answer = |(_, event): &(Vec<u8>, Event)| {
            let is_said = matches!(
                event.kind,
                EventKind::Drawn { .. }
                    | EventKind::Scalars { .. }
                    | EventKind::PlannerLogged { .. }
                    | EventKind::PlannerLate { .. }
            );
            is_said || event.kind.closes().is_some()
        };
        let end = if self.is_cut { self.lines.iter().position(is_answer) } else { None };
        &self.lines[..end.unwrap_or(self.lines.len())]
    }
}

/// How the run was opened, by the first event of its journal.
///
/// # Errors
/// It is another event, or there is none.
pub(super) fn opening(first: Option<&Event>) -> anyhow::Result<&RunOpened> {
    match first.map(|event| &event.kind) {
        Some(EventKind::RunOpened(opened)) => Ok(opened),
        _ => Err(bad_input(
            "the journal does not begin with the opening of a run, so it cannot be computed again",
        )),
    }
}

/// Reads a journal tick by tick.
pub(super) struct Ticks {
    reader: JournalReader,
    /// The first line of the tick that comes next.
    ahead: Option<(Vec<u8>, Event)>,
    ended: bool,
    no_end: Option<String>,
}

impl Ticks {
    /// Opens a journal.
    ///
    /// # Errors
    /// There is none, or its first line is none of a journal.
    pub(super) fn open(path: &Path) -> anyhow::Result<Self> {
        let reader = JournalReader::open(path).map_err(|error| bad_input(error.to_string()))?;
        let mut ticks = Self { reader, ahead: None, ended: false, no_end: None };
        ticks.ahead = ticks.line()?;
        Ok(ticks)
    }

    /// How the run was opened.
    ///
    /// # Errors
    /// The first line is another event, or there is none.
    pub(super) fn opened(&self) -> anyhow::Result<&RunOpened> {
        opening(self.ahead.as_ref().map(|(_, event)| event))
    }

    /// The next tick; `None` after the last one.
    ///
    /// # Errors
    /// A line cannot be understood.
    pub(super) fn next(&mut self) -> anyhow::Result<Option<RecordedTick>> {
        let Some(first) = self.ahead.take() else { return Ok(None) };
        let mut recorded = RecordedTick { tick: first.1.tick, lines: vec![first], is_cut: false };
        while let Some(line) = self.line()? {
            if line.1.tick != recorded.tick {
                self.ahead = Some(line);
                return Ok(Some(recorded));
            }
            recorded.lines.push(line);
        }
        let ends =
            recorded.lines.last().is_some_and(|(_, event)| matches!(event.kind, EventKind::Ended { .. }));
        if ends && self.reader.truncated().is_none() {
            return Ok(Some(recorded));
        }
        let torn = self.reader.truncated().map(|why| format!("{why}, ")).unwrap_or_default();
        self.no_end = Some(format!("{torn}it stops in tick {}", recorded.tick));
        recorded.is_cut = true;
        Ok(Some(recorded))
    }

    /// Why the journal has no end; to be asked after the last tick.
    pub(super) fn no_end(&self) -> Option<String> {
        self.no_end.clone()
    }

    fn line(&mut self) -> anyhow::Result<Option<(Vec<u8>, Event)>> {
        if self.ended {
            return Ok(None);
        }
        let line = self.reader.next_line().map_err(|error| bad_input(error.to_string()))?;
        self.ended = line.is_none();
        Ok(line.map(|JournalLine { raw, event }| (raw.to_vec(), event)))
    }
}
