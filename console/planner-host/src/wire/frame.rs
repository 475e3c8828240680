//! Frames over a stream that may deliver them in pieces.

use super::LONGEST;
use super::body::Body;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;
use std::io::{ErrorKind, Read};
use std::os::fd::AsFd;
use std::time::{Duration, Instant};

/// Bytes before the body.
pub(crate) const HEADER: usize = 13;
/// Where the kind stands in a frame.
pub(crate) const KIND_AT: usize = 4;

/// What came of waiting for a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Received {
    /// A whole frame; it stays readable until the next call.
    Frame,
    /// Not in time; what has arrived of a frame is kept.
    Late,
    /// The other side is gone.
    Closed,
    /// What arrived is no frame.
    Broken,
}

/// Reads frames; keeps what has arrived of the next one, also across missed deadlines.
#[derive(Debug, Default)]
pub(crate) struct Incoming {
    buffer: Vec<u8>,
    /// Bytes of the buffer that hold data.
    filled: usize,
    /// Length of the frame at the front that the last call returned.
    current: usize,
}

/// Room for a step's frame, so that most are read at once.
const ROOM: usize = 16 << 10;

impl Incoming {
    /// Waits for a frame until a moment, or for as long as it takes.
    pub(crate) fn receive(&mut self, stream: &mut (impl Read + AsFd), until: Option<Instant>) -> Received {
        self.forget_current();
        loop {
            match self.front_length() {
                Some(length) if !(HEADER - 4..=LONGEST).contains(&length) => return Received::Broken,
                Some(length) if self.filled >= 4 + length => {
                    self.current = 4 + length;
                    return Received::Frame;
                }
                Some(length) => self.make_room(4 + length),
                None => self.make_room(ROOM),
            }
            if !is_readable(stream, until) {
                return Received::Late;
            }
            match stream.read(&mut self.buffer[self.filled..]) {
                Ok(0) => return Received::Closed,
                Ok(n) => self.filled += n,
                Err(error) => match error.kind() {
                    ErrorKind::Interrupted | ErrorKind::WouldBlock => {}
                    ErrorKind::ConnectionReset | ErrorKind::BrokenPipe => return Received::Closed,
                    _ => return Received::Broken,
                },
            }
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

    /// Whether more than the current frame has arrived already.
    pub(crate) fn has_more(&self) -> bool {
        self.filled > self.current
    }

    /// Kind of the current frame.
    pub(crate) fn kind(&self) -> u8 {
        self.buffer[KIND_AT]
    }

    /// Sequence number of the current frame.
    pub(crate) fn sequence(&self) -> u32 {
        self.number_at(KIND_AT + 1)
    }

    /// Soft deadline of the current frame.
    pub(crate) fn soft_deadline(&self) -> Option<Duration> {
        let microseconds = self.number_at(KIND_AT + 5);
        (microseconds > 0).then(|| Duration::from_micros(microseconds.into()))
    }

    fn number_at(&self, at: usize) -> u32 {
        self.buffer[at..].first_chunk().map_or(0, |bytes| u32::from_le_bytes(*bytes))
    }

    /// Body of the current frame.
    pub(crate) fn body(&self) -> Body<'_> {
        Body(&self.buffer[HEADER..self.current])
    }
}

fn is_readable(stream: &impl AsFd, until: Option<Instant>) -> bool {
    loop {
        let left = until.map(|until| until.saturating_duration_since(Instant::now()));
        let timeout = left.and_then(|left| Timespec::try_from(left).ok());
        match poll(&mut [PollFd::new(stream, PollFlags::IN)], timeout.as_ref()) {
            Ok(0) => return false,
            Err(Errno::INTR) => {}
            // Errors of the stream show when it is read.
            Ok(_) | Err(_) => return true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::body::Writer;
    use std::io::Write;
    use std::os::unix::net::UnixStream;

    fn frame(sequence: u32, text: &str) -> Vec<u8> {
        Writer::default().begin(5, sequence, 250).text(text).finish().expect("short").to_vec()
    }

    fn soon() -> Instant {
        Instant::now() + Duration::from_millis(1)
    }

    #[test]
    fn a_half_read_frame_survives_a_missed_deadline() {
        let (mut ours, mut theirs) = UnixStream::pair().expect("a pair");
        let mut incoming = Incoming::default();
        let bytes = frame(7, "hello");
        for piece in [&bytes[..2], &bytes[2..9], &bytes[9..bytes.len() - 1]] {
            theirs.write_all(piece).expect("written");
            assert_eq!(incoming.receive(&mut ours, Some(soon())), Received::Late);
        }
        theirs.write_all(&bytes[bytes.len() - 1..]).expect("written");
        assert_eq!(incoming.receive(&mut ours, None), Received::Frame);
        assert_eq!((incoming.kind(), incoming.sequence()), (5, 7));
        assert_eq!(incoming.soft_deadline(), Some(Duration::from_micros(250)));
        assert_eq!(incoming.body().text(), Ok("hello".to_owned()));
        assert!(!incoming.has_more());
    }

    #[test]
    fn two_frames_that_arrive_at_once_are_read_one_by_one() {
        let (mut ours, mut theirs) = UnixStream::pair().expect("a pair");
        theirs.write_all(&[frame(1, "a"), frame(2, "b")].concat()).expect("written");
        let mut incoming = Incoming::default();
        assert_eq!(incoming.receive(&mut ours, None), Received::Frame);
        assert!(incoming.has_more());
        assert_eq!((incoming.sequence(), incoming.body().text()), (1, Ok("a".to_owned())));
        assert_eq!(incoming.receive(&mut ours, None), Received::Frame);
        assert_eq!((incoming.sequence(), incoming.body().text()), (2, Ok("b".to_owned())));
        drop(theirs);
        assert_eq!(incoming.receive(&mut ours, None), Received::Closed);
    }

    #[test]
    fn a_length_that_no_frame_has_is_refused_before_any_memory_is_reserved() {
        for length in [0_u32, 8, u32::MAX] {
            let (mut ours, mut theirs) = UnixStream::pair().expect("a pair");
            theirs.write_all(&length.to_le_bytes()).expect("written");
            assert_eq!(Incoming::default().receive(&mut ours, None), Received::Broken, "{length}");
        }
    }

    #[test]
    fn a_frame_larger_than_the_buffer_is_read_whole() {
        let (mut ours, mut theirs) = UnixStream::pair().expect("a pair");
        let text = "x".repeat(3 * ROOM);
        let bytes = frame(1, &text);
        let writer = std::thread::spawn(move || theirs.write_all(&bytes));
        let mut incoming = Incoming::default();
        assert_eq!(incoming.receive(&mut ours, None), Received::Frame);
        assert_eq!(incoming.body().text(), Ok(text));
        writer.join().expect("no panic").expect("written");
    }
}
