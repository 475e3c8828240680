//! Buffers bytes for a file that may temporarily have no space for them.

use std::io::{self, ErrorKind, Write};

/// Memory that remains allocated for waiting bytes after a long stall, bytes.
const KEPT_CAPACITY: usize = 1 << 20;

/// State of the writing.
#[derive(Debug, Clone, PartialEq, Eq)]
enum State {
    Fine,
    /// The last attempt failed; no data is lost.
    Stalled(String),
    /// The backlog exceeded its limit; bytes are lost, and no more are written.
    Ended(String),
}

/// A writer that keeps bytes that cannot be written yet, up to a limit.
///
/// The writer always receives a gapless prefix of the bytes that were added.
pub(crate) struct Backlog {
    out: Box<dyn Write + Send>,
    waiting: Vec<u8>,
    written: u64,
    limit: usize,
    state: State,
}

impl Backlog {
    /// `limit`: maximum number of bytes kept after a failed attempt.
    pub(crate) fn new(out: Box<dyn Write + Send>, limit: usize) -> Self {
        Self { out, waiting: Vec::new(), written: 0, limit, state: State::Fine }
    }

    /// The buffer to add bytes to; [`Backlog::drain`] writes them.
    pub(crate) fn waiting(&mut self) -> &mut Vec<u8> {
        &mut self.waiting
    }

    /// Number of waiting bytes.
    pub(crate) fn waiting_bytes(&self) -> usize {
        self.waiting.len()
    }

    /// Number of bytes handed to the system.
    pub(crate) fn written_bytes(&self) -> u64 {
        self.written
    }

    /// The system's error for the last attempt; `None` if it succeeded.
    pub(crate) fn trouble(&self) -> Option<&str> {
        match &self.state {
            State::Fine => None,
            State::Stalled(why) | State::Ended(why) => Some(why),
        }
    }

    /// Whether bytes are lost, so that no more are written.
    pub(crate) fn has_ended(&self) -> bool {
        matches!(self.state, State::Ended(_))
    }

    /// Writes as many of the waiting bytes as possible.
    pub(crate) fn drain(&mut self) {
        if self.has_ended() {
            self.waiting.clear();
            return;
        }
        let (done, outcome) = write_what_fits(&mut *self.out, &self.waiting);
        self.written += done as u64;
        self.waiting.drain(..done);
        self.state = match outcome {
            Ok(()) => State::Fine,
            Err(error) if self.waiting.len() <= self.limit => State::Stalled(error.to_string()),
            Err(error) => State::Ended(error.to_string()),
        };
        match self.state {
            State::Fine => self.waiting.shrink_to(KEPT_CAPACITY),
            State::Stalled(_) => {}
            State::Ended(_) => self.waiting = Vec::new(),
        }
    }
}

/// Writes until no bytes are left or an attempt fails; returns the number of bytes written, and the result.
fn write_what_fits(out: &mut dyn Write, bytes: &[u8]) -> (usize, io::Result<()>) {
    let mut done = 0;
    while done < bytes.len() {
        match out.write(&bytes[done..]) {
            Ok(0) => return (done, Err(ErrorKind::WriteZero.into())),
            Ok(length) => done += length,
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return (done, Err(error)),
        }
    }
    (done, out.flush())
}
