//! Reads a journal tick by tick, for comparison with a recomputed run.

use super::{JournalError, JournalLine, JournalReader};
use mission::{Event, EventKind, Order, PlannerInfo, RunOpened};
use std::path::Path;

/// A line: its bytes in the file, and its event.
type Line = (Vec<u8>, Event);

/// The lines of one tick.
#[derive(Debug, Default)]
pub struct RecordedTick {
    /// Number of the tick.
    pub tick: u64,
    lines: Vec<Line>,
    /// Whether the journal stops in this tick; if so, only the lines before any planner answer are compared.
    is_cut: bool,
}

/// A difference between a line of a journal and its recomputation.
#[derive(Debug, PartialEq)]
pub struct Difference {
    /// The tick.
    pub tick: u64,
    /// The line of the journal.
    pub recorded: String,
    /// The recomputed line.
    pub computed: String,
}

impl RecordedTick {
    /// The events of the tick.
    pub fn events(&self) -> impl Iterator<Item = &EventKind> {
        self.lines.iter().map(|(_, event)| &event.kind)
    }

    /// The orders in the tick, including refused ones.
    pub fn orders(&self) -> Vec<Order> {
        let order = |event: &EventKind| match event {
            EventKind::Ordered { order } | EventKind::OrderRefused { order, .. } => Some(order.clone()),
            _ => None,
        };
        self.events().filter_map(order).collect()
    }

    /// The planners that were opened in this tick.
    pub fn opened_planners(&self) -> impl Iterator<Item = &PlannerInfo> {
        self.events().filter_map(|event| match event {
            EventKind::PlannerChosen { info, .. }
            | EventKind::PlannerPrepared { info, .. }
            | EventKind::ShadowBegan { info, .. } => Some(&**info),
            _ => None,
        })
    }

    /// Number of bytes of the tick's lines.
    pub fn bytes(&self) -> u64 {
        self.lines.iter().map(|(raw, _)| raw.len() as u64).sum()
    }

    /// Number of the tick's lines that can be compared.
    pub fn n_compared(&self) -> usize {
        self.to_compare().len()
    }

    /// The first line that differs, byte for byte, from the recomputed one; `None` if all are equal.
    ///
    /// # Errors
    /// A recomputed event cannot be written as JSON.
    pub fn difference(&self, computed: &[Event]) -> Result<Option<Difference>, serde_json::Error> {
        self.differences(computed).next().transpose()
    }

    /// The lines that differ, byte for byte, from the recomputed ones, in order. An item is an error if a recomputed event
    /// cannot be written as JSON.
    pub fn differences(
        &self,
        computed: &[Event],
    ) -> impl Iterator<Item = Result<Difference, serde_json::Error>> {
        let lines = self.to_compare();
        let end = if self.is_cut { lines.len() } else { lines.len().max(computed.len()) };
        let of_line = move |index: usize| {
            let ours = computed.get(index).map(serde_json::to_string).transpose();
            let ours = match ours {
                Ok(ours) => ours,
                Err(error) => return Some(Err(error)),
            };
            let theirs = lines.get(index).map(|(raw, _)| raw.as_slice());
            if ours.as_deref().map(str::as_bytes) == theirs {
                return None;
            }
            let theirs = theirs.map(|raw| String::from_utf8_lossy(raw).into_owned());
            let nothing = || "nothing more in this tick".to_owned();
            Some(Ok(Difference {
                tick: self.tick,
                recorded: theirs.unwrap_or_else(nothing),
                computed: ours.unwrap_or_else(nothing),
            }))
        };
        (0..end).filter_map(of_line)
    }

    fn to_compare(&self) -> &[Line] {
        let is_answer = |(_, event): &Line| {
            let is_said = matches!(
                event.kind,
                EventKind::Drawn { .. }
                    | EventKind::Scalars { .. }
                    | EventKind::PlannerLogged { .. }
                    | EventKind::PlannerLate { .. }
                    | EventKind::Shadowed { .. }
            );
            is_said || event.kind.closes().is_some()
        };
        let end = if self.is_cut { self.lines.iter().position(is_answer) } else { None };
        &self.lines[..end.unwrap_or(self.lines.len())]
    }
}

/// Reads a journal tick by tick.
pub struct Ticks {
    reader: JournalReader,
    /// The first line of the next tick.
    ahead: Option<Line>,
    ended: bool,
    no_end: Option<String>,
}

impl Ticks {
    /// Opens a journal.
    ///
    /// # Errors
    /// There is no journal, or its first line does not open a run.
    pub fn open(path: &Path) -> Result<Self, JournalError> {
        let reader = JournalReader::open_verbatim(path)?;
        let mut ticks = Self { reader, ahead: None, ended: false, no_end: None };
        ticks.ahead = ticks.line()?;
        Ok(ticks)
    }

    /// How the run was opened; must be called before the first tick is read.
    ///
    /// # Errors
    /// [`JournalError::NotOpened`].
    pub fn opened(&self) -> Result<&RunOpened, JournalError> {
        match self.ahead.as_ref().map(|(_, event)| &event.kind) {
            Some(EventKind::RunOpened(opened)) => Ok(opened),
            _ => Err(self.reader.not_opened()),
        }
    }

    /// Reads the next tick; `None` after the last one.
    ///
    /// # Errors
    /// A line is not a valid event.
    pub fn next_tick(&mut self) -> Result<Option<RecordedTick>, JournalError> {
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
        let torn = self.reader.truncated().map(|why| format!("{why}; ")).unwrap_or_default();
        self.no_end = Some(format!("{torn}the journal stops in tick {}", recorded.tick));
        recorded.is_cut = true;
        Ok(Some(recorded))
    }

    /// The reason why the journal has no end; must be called after the last tick.
    pub fn no_end(&self) -> Option<String> {
        self.no_end.clone()
    }

    fn line(&mut self) -> Result<Option<Line>, JournalError> {
        if self.ended {
            return Ok(None);
        }
        let line = self.reader.next_line()?;
        self.ended = line.is_none();
        Ok(line.map(|JournalLine { raw, event }| (raw.to_vec(), event)))
    }
}

#[cfg(test)]
mod tests;
