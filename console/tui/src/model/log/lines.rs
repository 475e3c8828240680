//! The log lines of a run, up to a limit.

use super::chunk::{self, Chunk};
use super::entry::Entry;
use super::filter::Filter;
use super::occurrence::What;
use mission::Severity;
use serde::{Deserialize, Serialize};
use std::{borrow::Cow, collections::VecDeque, sync::Arc};

/// The minimum number of lines kept; older lines are dropped in chunks of 1024.
pub const MAX_LINES: usize = 100_000;
/// The maximum memory for full chunks, bytes. The line about a rejected station takes only about 0.7 kB, with all the
/// data for its detail view. Only planner messages can take more, so the number of lines is normally reached first.
const MAX_BYTES: usize = 96 << 20;
/// The maximum length of a line's text, characters; planner messages can be of any length.
const MAX_TEXT: usize = 1000;

/// The log, newest line last. Each line keeps its own number; the first line of a run is 0.
///
/// A clone shares the full chunks.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Log {
    chunks: VecDeque<Arc<Chunk>>,
    /// The number of dropped lines.
    dropped: u64,
    /// The number of lines kept.
    len: usize,
    /// The memory used by full chunks, bytes.
    bytes: usize,
}

impl Log {
    /// Adds a line about the console itself.
    pub fn add(&mut self, t_s: f64, severity: Severity, source: &'static str, text: String) {
        let source = Cow::Borrowed(source);
        self.push(Entry { tick: 0, t_s, severity, source, text, count: 1, what: What::Console });
    }

    /// Adds a line; a repeat of the last line only raises its count.
    pub fn push(&mut self, mut entry: Entry) {
        if let Some((cut, _)) = entry.text.char_indices().nth(MAX_TEXT) {
            entry.text.truncate(cut);
        }
        let last = self.newest().and_then(|number| self.get(number));
        let is_again = last.is_some_and(|last| {
            (last.severity, &last.source, &last.text) == (entry.severity, &entry.source, &entry.text)
        });
        if !is_again && self.chunks.back().is_none_or(|chunk| chunk.is_full()) {
            self.begin_chunk();
        }
        let Some(chunk) = self.chunks.back_mut().map(Arc::make_mut) else { return };
        if is_again {
            chunk.repeat_last(entry);
        } else {
            chunk.push(entry);
            self.len += 1;
        }
    }

    fn begin_chunk(&mut self) {
        self.bytes += self.chunks.back().map_or(0, |full| full.bytes());
        self.chunks.push_back(Arc::default());
        while self.len >= MAX_LINES + chunk::LINES || (self.bytes > MAX_BYTES && self.chunks.len() > 1) {
            let Some(oldest) = self.chunks.pop_front() else { return };
            self.bytes -= oldest.bytes();
            self.dropped += oldest.entries().len() as u64;
            self.len -= oldest.entries().len();
        }
    }

    /// The line with the given number, if it is still kept.
    pub fn get(&self, number: u64) -> Option<&Entry> {
        let (chunk, index) = self.at(number)?;
        self.chunks.get(chunk)?.entries().get(index)
    }

    /// The chunk that holds a line, and the index in the chunk.
    fn at(&self, number: u64) -> Option<(usize, usize)> {
        let index = usize::try_from(number.checked_sub(self.dropped)?).ok()?;
        Some((index / chunk::LINES, index % chunk::LINES))
    }

    /// The numbers of the lines from `from` on that pass a filter.
    pub(super) fn passing<'a>(&'a self, filter: &'a Filter, from: u64) -> impl Iterator<Item = u64> + 'a {
        let (first, index) = self.at(from).unwrap_or_default();
        self.chunks.iter().enumerate().skip(first).flat_map(move |(at, chunk)| {
            let before = self.dropped + (at * chunk::LINES) as u64;
            let lines = chunk.lines(if at == first { index } else { 0 });
            lines.filter(|(_, line)| filter.passes(line)).map(move |(index, _)| before + index as u64)
        })
    }

    /// The number of the newest line.
    pub fn newest(&self) -> Option<u64> {
        self.end().checked_sub(1).filter(|_| !self.is_empty())
    }

    /// The number of the oldest line kept.
    pub fn oldest(&self) -> u64 {
        self.dropped
    }

    /// The number that the next line will get.
    pub fn end(&self) -> u64 {
        self.dropped + self.len as u64
    }

    /// The number of lines kept.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether the log is empty.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_line_again_is_counted_and_not_repeated() {
        let mut log = Log::default();
        for t_s in [1.0, 2.0, 3.0] {
            log.add(t_s, Severity::Watch, "ae", "station 2 rejected".into());
        }
        let last = log.get(0).expect("a line");
        assert_eq!((log.len(), last.count, last.t_s), (1, 3, 3.0));
    }

    #[test]
    fn old_lines_make_room_and_the_others_keep_their_numbers() {
        let mut log = Log::default();
        for i in 0..MAX_LINES + 5000 {
            log.add(i as f64, Severity::Info, "mission", i.to_string());
        }
        assert!((MAX_LINES..MAX_LINES + chunk::LINES).contains(&log.len()), "{}", log.len());
        let (oldest, newest) = (log.oldest(), MAX_LINES as u64 + 4999);
        let text = |number: u64| log.get(number).map(|entry| entry.text.clone());
        assert_eq!((text(oldest - 1), text(oldest)), (None, Some(oldest.to_string())));
        assert_eq!((log.newest(), text(newest)), (Some(newest), Some(newest.to_string())));
    }

    #[test]
    fn long_texts_are_cut_and_take_the_room_of_older_lines() {
        let mut log = Log::default();
        for i in 0..MAX_LINES {
            log.add(0.0, Severity::Info, "plan", format!("{i}{}", "é".repeat(MAX_TEXT)));
        }
        let last = log.newest().and_then(|number| log.get(number)).expect("a line");
        assert_eq!(last.text.chars().count(), MAX_TEXT);
        assert!(log.bytes <= MAX_BYTES && log.len() < MAX_LINES);
    }

    #[test]
    fn a_hundred_thousand_stations_that_come_and_go_are_kept_with_their_details() {
        let mut run = crate::model::Run::default();
        for tick in 0..MAX_LINES as u64 + 2000 {
            let station = world::StationId(tick as u32 % 40);
            let reason = positioning::Exclusion::Residual { residual_m: tick as f64, gate_m: 0.15 };
            let kind = mission::EventKind::StationRejected { station, reason };
            run.fold(&mission::Event { tick, t_s: tick as f64, kind });
        }
        assert!(run.log.len() >= MAX_LINES && run.log.bytes <= 72 << 20, "{} bytes", run.log.bytes);
    }

    #[test]
    fn a_copy_goes_its_own_way() {
        let mut log = Log::default();
        log.add(1.0, Severity::Info, "plan", "planned".into());
        let copy = log.clone();
        log.add(2.0, Severity::Info, "plan", "planned".into());
        log.add(3.0, Severity::Info, "plan", "again".into());
        let counts = |log: &Log| (log.len(), log.get(0).map(|entry| entry.count));
        assert_eq!((counts(&log), counts(&copy)), ((2, Some(2)), (1, Some(1))));
    }
}
