//! Bytes for a file that may have no room for them now.

use std::io::{self, ErrorKind, Write};

/// Memory that stays reserved for waiting bytes after a long stall, bytes.
const KEPT_CAPACITY: usize = 1 << 20;

/// How writing goes.
#[derive(Debug, Clone, PartialEq, Eq)]
enum State {
    Fine,
    /// The last attempt failed; nothing is lost.
    Stalled(String),
    /// More waited than is kept; bytes are lost and nothing is written any more.
    Ended(String),
}

/// A writer that keeps what could not be written, up to a limit, until it can be.
///
/// What reaches the writer is always a beginning of what was put in, without a gap.
pub(crate) struct Backlog {
    out: Box<dyn Write + Send>,
    waiting: Vec<u8>,
    written: u64,
    limit: usize,
    state: State,
}

impl Backlog {
    /// `limit`: bytes that are kept after a failed attempt.
    pub(crate) fn new(out: Box<dyn Write + Send>, limit: usize) -> Self {
        Self { out, waiting: Vec::new(), written: 0, limit, state: State::Fine }
    }

    /// Where to put bytes; they are written by [`Backlog::drain`].
    pub(crate) fn waiting(&mut self) -> &mut Vec<u8> {
        &mut self.waiting
    }

    /// Bytes that wait.
    pub(crate) fn waiting_bytes(&self) -> usize {
        self.waiting.len()
    }

    /// Bytes that the system has.
    pub(crate) fn written_bytes(&self) -> u64 {
        self.written
    }

    /// Why the last attempt failed, in the words of the system; none when it succeeded.
    pub(crate) fn trouble(&self) -> Option<&str> {
        match &self.state {
            State::Fine => None,
            State::Stalled(why) | State::Ended(why) => Some(why),
        }
    }

    /// Whether bytes are lost, so that nothing is written any more.
    pub(crate) fn has_ended(&self) -> bool {
        matches!(self.state, State::Ended(_))
    }

    /// Writes what waits, as far as it can be written.
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

/// Writes until everything is written or an attempt fails; how many bytes were written, and how it ended.
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
