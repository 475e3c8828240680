//! Output to the terminal, one frame at a time.

use super::meter::Meter;
use super::restore::is_taken;
use std::io::{self, Stdout, Write};

/// Begins a synchronized update: the terminal shows nothing until the frame is complete.
const BEGIN: &[u8] = b"\x1b[?2026h";
/// Ends the synchronized update: the terminal shows the frame.
const END: &[u8] = b"\x1b[?2026l";

/// Buffers everything until the flush and then sends it as one synchronized update; on a slow line, the terminal shows
/// a frame while it arrives, because the state of the robot comes first.
///
/// After the terminal has been restored, further output is dropped, because half a frame must not reach the shell's
/// screen after a panic or at exit.
pub(super) struct FrameOutput<W: Write = Stdout> {
    bytes: Vec<u8>,
    to: W,
    is_ours: fn() -> bool,
    meter: Meter,
}

impl FrameOutput {
    /// Creates an output that is measured.
    pub(super) fn measured(meter: Meter) -> Self {
        Self { bytes: BEGIN.to_vec(), to: io::stdout(), is_ours: is_taken, meter }
    }
}

impl<W: Write> Write for FrameOutput<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        if !(self.is_ours)() {
            self.bytes.truncate(BEGIN.len());
            return Ok(());
        }
        if self.bytes.len() > BEGIN.len() {
            let frame = if self.meter.is_slow() {
                &self.bytes[BEGIN.len()..]
            } else {
                self.bytes.extend_from_slice(END);
                &self.bytes
            };
            let sent = self.meter.write(&mut self.to, frame);
            self.bytes.truncate(BEGIN.len());
            sent?;
        }
        self.to.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn output() -> FrameOutput<Vec<u8>> {
        FrameOutput {
            bytes: BEGIN.to_vec(),
            to: Vec::new(),
            is_ours: || true,
            meter: Meter::new(|| std::time::Duration::ZERO),
        }
    }

    #[test]
    fn a_frame_is_sent_whole_and_framed() {
        let mut output = output();
        output.write_all(b"half a ").and_then(|()| output.write_all(b"frame")).expect("memory");
        assert!(output.to.is_empty());
        output.flush().expect("memory");
        assert_eq!(output.to, [BEGIN, b"half a frame", END].concat());
        assert_eq!(output.meter.take().bytes, output.to.len());
    }

    #[test]
    fn a_frame_on_a_slow_line_is_shown_while_it_arrives() {
        let mut output = output();
        output.meter.set_slow(true);
        output.write_all(b"a frame").and_then(|()| output.flush()).expect("memory");
        assert_eq!(output.to, b"a frame");
    }

    #[test]
    fn nothing_is_sent_to_a_terminal_that_was_given_back() {
        let mut output = FrameOutput { is_ours: || false, ..output() };
        output.write_all(b"half a frame").and_then(|()| output.flush()).expect("memory");
        output.is_ours = || true;
        output.flush().expect("memory");
        assert!(output.to.is_empty());
    }

    #[test]
    fn nothing_is_sent_when_nothing_changed() {
        let mut output = output();
        output.flush().expect("memory");
        assert!(output.to.is_empty());
    }
}
