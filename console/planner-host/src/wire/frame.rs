//! Reads frames from a stream that may deliver them in pieces.

use super::LONGEST;
use super::body::Body;
use std::io::{ErrorKind, Read};
use std::time::Duration;

/// The number of bytes before the body.
pub(crate) const HEADER: usize = 13;
/// The position, in a frame, of the byte that states the kind.
pub(crate) const KIND_AT: usize = 4;

/// The outcome of waiting for a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Received {
    /// A complete frame; it stays readable until the next call.
    Frame,
    /// The peer has closed the connection.
    Closed,
    /// The bytes that arrived do not form a frame.
    Broken,
}

/// The outcome of reading from a stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Filled {
    /// Something arrived.
    Some,
    /// Nothing has arrived yet.
    Nothing,
    /// The peer has closed the connection.
    Closed,
    /// The stream cannot be read.
    Broken,
}

/// The length of a frame is invalid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NoFrame;

/// Reads frames, and keeps the part of the next one that has already arrived.
#[derive(Debug, Default)]
pub(crate) struct Incoming {
    buffer: Vec<u8>,
    /// The number of bytes in the buffer that hold data.
    filled: usize,
    /// Length of the current frame, which is at the front of the buffer.
    current: usize,
}

/// Buffer space for the frame of a step, so that most of these frames are read with one call.
const ROOM: usize = 16 << 10;

impl Incoming {
    /// Waits for a frame on a blocking stream, without a time limit.
    pub(crate) fn receive(&mut self, stream: &mut impl Read) -> Received {
        loop {
            match self.next_frame() {
                Some(Ok(())) => return Received::Frame,
                Some(Err(NoFrame)) => return Received::Broken,
                None => {}
            }
            match self.fill(stream) {
                Filled::Some | Filled::Nothing => {}
                Filled::Closed => return Received::Closed,
                Filled::Broken => return Received::Broken,
            }
        }
    }

    /// Advances to the next frame, if it has arrived completely; it stays readable until the next call.
    pub(crate) fn next_frame(&mut self) -> Option<Result<(), NoFrame>> {
        self.forget_current();
        let length = self.front_length()?;
        if !(HEADER - 4..=LONGEST).contains(&length) {
            return Some(Err(NoFrame));
        }
        if self.filled < 4 + length {
            return None;
        }
        self.current = 4 + length;
        Some(Ok(()))
    }

    /// Reads what has arrived: at most the rest of the next frame, or as much as the buffer has space for. Call this
    /// when there was no next frame.
    pub(crate) fn fill(&mut self, stream: &mut impl Read) -> Filled {
        let needed = self.front_length().map_or(ROOM, |length| 4 + length.min(LONGEST));
        self.make_room(needed.max(self.filled + 1));
        match stream.read(&mut self.buffer[self.filled..]) {
            Ok(0) => Filled::Closed,
            Ok(n) => {
                self.filled += n;
                Filled::Some
            }
            Err(error) => match error.kind() {
                ErrorKind::Interrupted | ErrorKind::WouldBlock => Filled::Nothing,
                ErrorKind::ConnectionReset | ErrorKind::BrokenPipe => Filled::Closed,
                _ => Filled::Broken,
            },
        }
    }

    fn forget_current(&mut self) {
        self.buffer.copy_within(self.current..self.filled, 0);
        self.filled -= self.current;
        self.current = 0;
    }

    fn front_length(&self) -> Option<usize> {
        let head = self.buffer[..self.filled].first_chunk::<4>()?;
        Some(u32::from_le_bytes(*head) as usize)
    }

    fn make_room(&mut self, n: usize) {
        if self.buffer.len() < n {
            self.buffer.resize(n, 0);
        }
    }

    /// Whether any data after the current frame has already arrived.
    pub(crate) fn has_more(&self) -> bool {
        self.filled > self.current
    }

    /// Returns the kind of the current frame.
    pub(crate) fn kind(&self) -> u8 {
        self.buffer[KIND_AT]
    }

    /// Returns the sequence number of the current frame.
    pub(crate) fn sequence(&self) -> u32 {
        self.number_at(KIND_AT + 1)
    }

    /// Returns the soft deadline of the current frame.
    pub(crate) fn soft_deadline(&self) -> Option<Duration> {
        let microseconds = self.number_at(KIND_AT + 5);
        (microseconds > 0).then(|| Duration::from_micros(microseconds.into()))
    }

    fn number_at(&self, at: usize) -> u32 {
        self.buffer[at..].first_chunk().map_or(0, |bytes| u32::from_le_bytes(*bytes))
    }

    /// Returns the body of the current frame.
    pub(crate) fn body(&self) -> Body<'_> {
        Body(&self.buffer[HEADER..self.current])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::body::Writer;
    use std::io::Write;
    use std::os::unix::net::UnixStream;

    fn frame(sequence: u32, text: &str) -> Vec<u8> {
        Writer::default().begin(5, sequence, 250).put(text).finish().expect("short").to_vec()
    }

    #[test]
    fn a_half_read_frame_is_kept_until_the_rest_arrives() {
        let (mut ours, mut theirs) = UnixStream::pair().expect("a pair");
        ours.set_nonblocking(true).expect("a socket");
        let mut incoming = Incoming::default();
        let bytes = frame(7, "hello");
        assert_eq!(incoming.fill(&mut ours), Filled::Nothing);
        for piece in [&bytes[..2], &bytes[2..9], &bytes[9..bytes.len() - 1]] {
            theirs.write_all(piece).expect("written");
            assert_eq!(incoming.fill(&mut ours), Filled::Some);
            assert_eq!(incoming.next_frame(), None);
        }
        theirs.write_all(&bytes[bytes.len() - 1..]).expect("written");
        assert_eq!(incoming.fill(&mut ours), Filled::Some);
        assert_eq!(incoming.next_frame(), Some(Ok(())));
        assert_eq!((incoming.kind(), incoming.sequence()), (5, 7));
        assert_eq!(incoming.soft_deadline(), Some(Duration::from_micros(250)));
        assert_eq!(incoming.body().take(), Ok("hello"));
        assert!(!incoming.has_more());
    }

    #[test]
    fn two_frames_that_arrive_at_once_are_read_one_by_one() {
        let (mut ours, mut theirs) = UnixStream::pair().expect("a pair");
        theirs.write_all(&[frame(1, "a"), frame(2, "b")].concat()).expect("written");
        let mut incoming = Incoming::default();
        assert_eq!(incoming.receive(&mut ours), Received::Frame);
        assert!(incoming.has_more());
        assert_eq!((incoming.sequence(), incoming.body().take()), (1, Ok("a")));
        assert_eq!(incoming.receive(&mut ours), Received::Frame);
        assert_eq!((incoming.sequence(), incoming.body().take()), (2, Ok("b")));
        drop(theirs);
        assert_eq!(incoming.receive(&mut ours), Received::Closed);
    }

    #[test]
    fn a_length_that_no_frame_has_is_refused_before_any_memory_is_reserved() {
        for length in [0_u32, 8, u32::MAX] {
            let (mut ours, mut theirs) = UnixStream::pair().expect("a pair");
            theirs.write_all(&length.to_le_bytes()).expect("written");
            assert_eq!(Incoming::default().receive(&mut ours), Received::Broken, "{length}");
        }
    }

    #[test]
    fn a_frame_larger_than_the_buffer_is_read_whole() {
        let (mut ours, mut theirs) = UnixStream::pair().expect("a pair");
        let text = "x".repeat(3 * ROOM);
        let bytes = frame(1, &text);
        let writer = std::thread::spawn(move || theirs.write_all(&bytes));
        let mut incoming = Incoming::default();
        assert_eq!(incoming.receive(&mut ours), Received::Frame);
        assert_eq!(incoming.body().take(), Ok(&*text));
        writer.join().expect("no panic").expect("written");
    }
}
