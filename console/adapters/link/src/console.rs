//! The pipes to the console: lines from standard input, messages to standard output. Neither may block the adapter.

use crate::message::FromVehicle;
use std::{
    io::{self, BufRead, Read, Write},
    sync::mpsc::{SyncSender, sync_channel},
    thread,
};

/// Maximum length of a line, bytes.
const LINE_MAX: u64 = 256 * 1024;
/// Maximum number of messages that wait for a console that does not read; further messages are dropped.
const WAITING_MAX: usize = 64;

/// Reads lines in a thread and passes each to `take`, then `None` at the end of the input. A line that is too long or
/// not UTF-8 is passed on as a text that is not a command. The thread ends when `take` returns false.
pub fn listen(take: impl FnMut(Option<String>) -> bool + Send + 'static) {
    thread::spawn(move || read_lines(io::stdin().lock(), take));
}

fn read_lines(mut input: impl BufRead, mut take: impl FnMut(Option<String>) -> bool) {
    loop {
        let mut bytes = Vec::new();
        let read = input.by_ref().take(LINE_MAX).read_until(b'\n', &mut bytes);
        let is_open = matches!(read, Ok(n) if n > 0);
        let line = is_open.then(|| String::from_utf8_lossy(&bytes).trim_end().to_owned());
        if !take(line) || !is_open {
            return;
        }
    }
}

/// A writer of messages that never waits for the console.
pub struct Speaker {
    waiting: SyncSender<FromVehicle>,
}

impl Speaker {
    /// Writes to standard output in a thread.
    pub fn start() -> Self {
        let (waiting, messages) = sync_channel::<FromVehicle>(WAITING_MAX);
        thread::spawn(move || {
            let mut output = io::stdout().lock();
            for message in messages {
                let Ok(mut line) = serde_json::to_vec(&message) else { continue };
                line.push(b'\n');
                if output.write_all(&line).and_then(|()| output.flush()).is_err() {
                    return;
                }
            }
        });
        Self { waiting }
    }

    /// Sends a message, which is dropped if the console does not read.
    pub fn say(&self, message: FromVehicle) {
        // A console that has left or does not read misses the message; the lease stops the vehicle.
        let _ = self.waiting.try_send(message);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(input: &[u8]) -> Vec<Option<String>> {
        let mut lines = Vec::new();
        read_lines(input, |line| {
            lines.push(line);
            true
        });
        lines
    }

    #[test]
    fn lines_end_with_the_input() {
        let expected = [Some("a".to_owned()), Some(String::new()), Some("b\u{fffd}".to_owned()), None];
        assert_eq!(lines(b"a\r\n\nb\xff"), expected);
    }

    #[test]
    fn a_line_that_is_too_long_is_cut_so_that_memory_stays_flat() {
        let most = usize::try_from(LINE_MAX).unwrap();
        let lines = lines(&vec![b'x'; 3 * most]);
        assert_eq!(lines.len(), 4);
        assert!(lines[..3].iter().all(|line| line.as_ref().is_some_and(|text| text.len() == most)));
    }
}
