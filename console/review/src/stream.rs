//! The events of a run as a stream of JSON lines, while the run continues.

use foreign::plain_json;
use mission::EventKind;
use recording::{JournalError, JournalLine, JournalReader, journal_of};
use runs::{Standing, standing};
use serde::{Deserialize, Serialize};
use std::{
    io::{self, BufWriter, Write},
    path::Path,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    thread,
    time::{Duration, Instant},
};

/// The interval at which a journal that has not grown is rechecked.
const LOOK_AGAIN: Duration = Duration::from_millis(50);

/// A line of a stream that is not an event of the run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub enum StreamLine {
    /// The stream is alive, but for some time it has not contained an event.
    Heartbeat {
        /// The tick of the last event in the journal.
        tick: u64,
        /// The mission time of that event, seconds.
        t_s: f64,
    },
}

/// The events that a stream contains.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Selection {
    /// The kinds of event (the values of the key `event`); empty for all kinds.
    pub kinds: Vec<String>,
    /// Mission time of the first event, seconds.
    pub from_s: f64,
    /// Mission time of the last event, seconds; `None` for the end of the run.
    pub to_s: Option<f64>,
}

impl Selection {
    /// Whether the stream contains an event.
    pub fn contains(&self, JournalLine { raw, event }: &JournalLine<'_>) -> bool {
        /// The only part of a line that is parsed.
        #[derive(Deserialize)]
        struct Name<'a> {
            event: &'a str,
        }
        let is_one = |name: Name<'_>| self.kinds.iter().any(|kind| kind == name.event);
        event.t_s >= self.from_s
            && (self.kinds.is_empty() || serde_json::from_slice(raw).is_ok_and(is_one))
            && !self.is_past(event.t_s)
    }

    /// Whether a mission time, seconds, is after the last event.
    pub fn is_past(&self, t_s: f64) -> bool {
        self.to_s.is_some_and(|to_s| t_s > to_s)
    }
}

/// The line of an event as it is in the journal, with a newline; control characters are escaped.
pub fn printed(line: &JournalLine<'_>) -> String {
    plain_json(&String::from_utf8_lossy(line.raw)).into_owned() + "\n"
}

/// The reason why a stream ended.
#[derive(Debug)]
pub enum StreamEnd {
    /// The run ended, or the last selected event was written.
    Complete,
    /// The journal ends before the run does; the tick of its last event, if it has one.
    Incomplete(Option<u64>),
    /// The receiver takes no more lines.
    Closed(io::Error),
}

/// Writes the selected events of a run to `to`, from the first one on, until the run ends. At least after every
/// `heartbeat`, a line is written. The journal is the buffer: a slow receiver delays only its own stream.
///
/// # Errors
/// The journal cannot be read.
pub fn stream(
    folder: &Path,
    selection: &Selection,
    heartbeat: Duration,
    to: impl Write + Send + 'static,
) -> Result<StreamEnd, JournalError> {
    let out = Arc::new(Mutex::new(Out {
        to: BufWriter::new(to),
        last: (0, 0.0),
        at: Instant::now(),
        failed: None,
    }));
    let (waiting, of_run) = (Arc::clone(&out), folder.to_owned());
    let goes_on = move || {
        thread::sleep(LOOK_AGAIN);
        // The last bytes of a run are written before it counts as ended, so they are still read.
        lock(&waiting).wait(heartbeat) && standing(&of_run) == Standing::Running
    };
    let mut reader = JournalReader::follow(&journal_of(folder), goes_on)?;
    let (mut last, mut is_over) = (None, false);
    while !is_over && let Some(line) = reader.next_line()? {
        let event = &line.event;
        last = Some(event.tick);
        is_over = selection.is_past(event.t_s) || matches!(event.kind, EventKind::Ended { .. });
        let text = selection.contains(&line).then(|| printed(&line));
        if !lock(&out).pass((event.tick, event.t_s), text.as_deref()) {
            break;
        }
    }
    let mut out = lock(&out);
    out.flush();
    Ok(match out.failed.take() {
        Some(error) => StreamEnd::Closed(error),
        None if is_over => StreamEnd::Complete,
        None => StreamEnd::Incomplete(last),
    })
}

fn lock<W: Write>(out: &Mutex<Out<W>>) -> MutexGuard<'_, Out<W>> {
    out.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The receiver, shared between the reader of lines and its waiting.
struct Out<W: Write> {
    to: BufWriter<W>,
    /// Tick and mission time, seconds, of the last event.
    last: (u64, f64),
    /// When a line was written last.
    at: Instant,
    failed: Option<io::Error>,
}

impl<W: Write> Out<W> {
    /// Takes note of an event, and writes its line if the stream contains it; returns whether the receiver takes more.
    fn pass(&mut self, last: (u64, f64), line: Option<&str>) -> bool {
        self.last = last;
        if let Some(line) = line {
            let written = self.to.write_all(line.as_bytes());
            self.keep(written);
            self.at = Instant::now();
        }
        self.failed.is_none()
    }

    /// Sends the written lines while the journal does not grow, and a heartbeat if it is due.
    fn wait(&mut self, heartbeat: Duration) -> bool {
        if self.at.elapsed() >= heartbeat {
            let (tick, t_s) = self.last;
            let line = serde_json::to_string(&StreamLine::Heartbeat { tick, t_s }).unwrap_or_default() + "\n";
            self.pass(self.last, Some(&line));
        }
        self.flush();
        self.failed.is_none()
    }

    fn flush(&mut self) {
        let flushed = self.to.flush();
        self.keep(flushed);
    }

    fn keep(&mut self, done: io::Result<()>) {
        self.failed = self.failed.take().or(done.err());
    }
}
