//! Details of past runs, beyond their lines in a list: read from disk when a run is selected and there is room
//! to show it.

use super::{Entry, Run, Together};
use account::Summary;
use mission::Severity;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// The number of runs that are remembered.
const MOST: usize = 8;
/// The number of events of a run that are remembered: the last ones.
const MOST_EVENTS: usize = 60;

/// The details of a past run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Glimpse {
    /// The run, folded from its journal, without its log.
    pub run: Run,
    /// The report of the run; `None` if it has none.
    pub summary: Option<Box<Summary>>,
    /// For a re-scan: the floor that it and the runs before it have scanned together, or why this floor cannot be
    /// computed.
    #[serde(default)]
    pub combined: Option<Result<Box<Together>, String>>,
    /// The last events of severity INFO and above, newest first.
    #[serde(default)]
    pub events: Vec<Entry>,
}

impl Glimpse {
    /// The details of a run that has been folded from its journal. Of its log, only the last events are kept.
    pub fn of(
        mut run: Run,
        summary: Option<Box<Summary>>,
        combined: Option<Result<Box<Together>, String>>,
    ) -> Self {
        let log = std::mem::take(&mut run.log);
        let entries = (log.oldest()..log.end()).rev().filter_map(|number| log.get(number));
        let shown = entries.filter(|entry| entry.severity >= Severity::Info);
        let events = shown.take(MOST_EVENTS).cloned().collect();
        Self { run, summary, combined, events }
    }

    /// The combined scan of a re-scan and the runs before it.
    pub fn together(&self) -> Option<&Together> {
        self.combined.iter().flatten().map(|together| &**together).next()
    }
}

/// A request for a glimpse: the name of a run and how it ended. A run that ends is read again.
pub type RunKey = (String, String);

/// The runs that were read most recently.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Glimpses {
    /// The run that was requested last.
    asked: Option<RunKey>,
    known: VecDeque<(RunKey, Result<Box<Glimpse>, String>)>,
}

impl Glimpses {
    /// The details of a run, or the reason why it cannot be read, as a sentence; `None` until it has been read.
    pub fn of(&self, run: &str) -> Option<&Result<Box<Glimpse>, String>> {
        self.known.iter().rev().find(|((name, _), _)| name == run).map(|(_, found)| found)
    }

    /// Requests a run; returns whether it has to be read.
    pub(crate) fn ask(&mut self, key: RunKey) -> bool {
        if self.asked.as_ref() == Some(&key) || self.known.iter().any(|(known, _)| *known == key) {
            return false;
        }
        self.asked = Some(key);
        true
    }

    /// Forgets the run that was requested; returns whether one was being read.
    pub(crate) fn give_up(&mut self) -> bool {
        self.asked.take().is_some()
    }

    /// Records the details of a run.
    pub(crate) fn take(&mut self, key: RunKey, found: Result<Box<Glimpse>, String>) {
        self.known.retain(|((name, _), _)| *name != key.0);
        if self.asked.as_ref() == Some(&key) {
            self.asked = None;
        }
        self.known.push_back((key, found));
        if self.known.len() > MOST {
            self.known.pop_front();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_is_read_once_and_again_when_it_has_ended() {
        let mut glimpses = Glimpses::default();
        let key = |end: &str| ("run".to_owned(), end.to_owned());
        assert!(glimpses.ask(key("RUNNING")) && !glimpses.ask(key("RUNNING")), "once");
        assert!(glimpses.give_up() && !glimpses.give_up() && glimpses.ask(key("RUNNING")), "again");
        glimpses.take(key("RUNNING"), Err("no journal".into()));
        assert!(!glimpses.ask(key("RUNNING")) && glimpses.ask(key("complete")));
        glimpses.take(key("complete"), Ok(Box::default()));
        assert!(glimpses.of("run").is_some_and(Result::is_ok), "the newer one");
        for other in 0..MOST {
            glimpses.take((other.to_string(), String::new()), Ok(Box::default()));
        }
        assert!(glimpses.of("run").is_none() && glimpses.ask(key("complete")), "the oldest is forgotten");
    }
}
