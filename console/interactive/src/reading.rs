//! Reads what the terminal sends.

use rustix::{
    event::{PollFd, PollFlags, Timespec, poll},
    io::Errno,
    stdio::stdin,
};
use std::{
    collections::VecDeque,
    io::Write,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    thread,
    time::{Duration, Instant},
};
use tui::terminal::{Decoder, Input};

/// Asks for the background colour (OSC 11), and then for the kind of the terminal (DA1), which every terminal answers.
/// If the answer to the second question comes first, the terminal does not report its background.
const ASK_BACKGROUND: &[u8] = b"\x1b]11;?\x1b\\\x1b[c";
/// The pause after the system has refused to read, because another process has the terminal.
const REFUSED: Duration = Duration::from_millis(100);

/// The number of frames drawn so far, shared between the screen and the reader.
#[derive(Clone, Default)]
pub(super) struct Frames(Arc<AtomicU64>);

impl Frames {
    /// Counts a frame that is on the screen; returns its number, from 1.
    pub(super) fn count(&self) -> u64 {
        self.0.fetch_add(1, Ordering::SeqCst) + 1
    }

    fn last(&self) -> u64 {
        self.0.load(Ordering::SeqCst)
    }
}

/// Reads and decodes what the terminal sends. Only one reader may exist at a time.
pub(super) struct Reader {
    decoder: Decoder,
    /// Inputs that have been decoded but not taken, each with the number of the last frame drawn before it was read.
    waiting: VecDeque<(Input, u64)>,
    frames: Frames,
}

/// What happened while the reader waited.
#[derive(PartialEq, Eq)]
enum Heard {
    Bytes,
    Nothing,
    Closed,
}

impl Reader {
    /// Creates a reader.
    pub(super) fn new(frames: Frames) -> Self {
        Self { decoder: Decoder::default(), waiting: VecDeque::new(), frames }
    }

    /// Waits for the next input; returns it with the number of the last frame drawn before it was read. `None` once
    /// the terminal is closed.
    pub(super) fn next(&mut self) -> Option<(Input, u64)> {
        loop {
            if let Some(next) = self.waiting.pop_front() {
                return Some(next);
            }
            match self.hear(self.decoder.patience()) {
                Heard::Bytes => {}
                Heard::Nothing => self.keep(Decoder::give_up),
                Heard::Closed => return None,
            }
        }
    }

    /// Asks the terminal for its background colour; `None` if it does not answer in time. Keys that arrive in the
    /// meantime are kept, and a later answer is swallowed.
    pub(super) fn background(&mut self, within: Duration) -> Option<[u8; 3]> {
        let mut terminal = std::io::stdout();
        terminal.write_all(ASK_BACKGROUND).and_then(|()| terminal.flush()).ok()?;
        let end = Instant::now() + within;
        loop {
            let left = end.checked_duration_since(Instant::now())?;
            if self.hear(Some(left)) != Heard::Bytes {
                return None;
            }
            let mut answers = self.waiting.iter().filter_map(|(input, _)| match input {
                Input::Background(colour) => Some(Some(*colour)),
                Input::Kind => Some(None),
                _ => None,
            });
            if let Some(colour) = answers.next() {
                return colour;
            }
        }
    }

    /// Waits for bytes and decodes them; without a time limit, waits indefinitely.
    fn hear(&mut self, patience: Option<Duration>) -> Heard {
        let mut bytes = [0; 1024];
        loop {
            let terminal = stdin();
            let mut watched = [PollFd::from_borrowed_fd(terminal, PollFlags::IN)];
            let limit = patience.and_then(|patience| Timespec::try_from(patience).ok());
            match poll(&mut watched, limit.as_ref()) {
                Ok(0) => return Heard::Nothing,
                Ok(_) => {}
                Err(Errno::INTR) => continue,
                Err(_) => return Heard::Closed,
            }
            // A key that arrives while a frame is being drawn does not count as pressed after that frame.
            let seen = self.frames.last();
            match rustix::io::read(terminal, &mut bytes) {
                Ok(0) => return Heard::Closed,
                Ok(length) => {
                    self.keep_seen(seen, |decoder, inputs| decoder.feed(&bytes[..length], inputs));
                    return Heard::Bytes;
                }
                Err(Errno::INTR | Errno::AGAIN) => {}
                Err(_) if watched[0].revents().contains(PollFlags::HUP) => return Heard::Closed,
                Err(Errno::IO) => thread::sleep(REFUSED),
                Err(_) => return Heard::Closed,
            }
        }
    }

    fn keep(&mut self, decode: impl FnOnce(&mut Decoder, &mut Vec<Input>)) {
        let seen = self.frames.last();
        self.keep_seen(seen, decode);
    }

    fn keep_seen(&mut self, seen: u64, decode: impl FnOnce(&mut Decoder, &mut Vec<Input>)) {
        let mut inputs = Vec::new();
        decode(&mut self.decoder, &mut inputs);
        self.waiting.extend(inputs.into_iter().map(|input| (input, seen)));
    }
}
