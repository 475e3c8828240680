//! The file below the MCAP library. After an error, the library panics when it is used or dropped, so it must not see one:
//! the first error is kept for the caller, and nothing is written after it.

use std::{
    cell::OnceCell,
    io::{self, Seek, SeekFrom, Write},
    rc::Rc,
};

/// A writer that never fails; its first error is in [`Failure`].
pub(super) struct Out<W> {
    inner: W,
    failure: Failure,
    /// The position and the length that the file would have without the error, bytes.
    at: u64,
    length: u64,
}

/// The first error of a file.
#[derive(Debug, Clone, Default)]
pub(super) struct Failure(Rc<OnceCell<io::Error>>);

impl Failure {
    /// The first error; `None` if all data was written.
    pub(super) fn error(&self) -> Option<&io::Error> {
        self.0.get()
    }

    fn note(&self, done: io::Result<()>) {
        if let Err(error) = done {
            // Only the first error tells the cause.
            let _ = self.0.set(error);
        }
    }
}

impl<W: Write + Seek> Out<W> {
    /// An empty file, and its first error.
    pub(super) fn new(inner: W) -> (Self, Failure) {
        let failure = Failure::default();
        (Self { inner, failure: failure.clone(), at: 0, length: 0 }, failure)
    }

    fn unless_failed(&mut self, act: impl FnOnce(&mut W) -> io::Result<()>) {
        if self.failure.error().is_none() {
            self.failure.note(act(&mut self.inner));
        }
    }
}

impl<W: Write + Seek> Write for Out<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.unless_failed(|inner| inner.write_all(bytes));
        self.at += bytes.len() as u64;
        self.length = self.length.max(self.at);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.unless_failed(W::flush);
        Ok(())
    }
}

impl<W: Write + Seek> Seek for Out<W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let at = match to {
            SeekFrom::Start(at) => Some(at),
            SeekFrom::Current(by) => self.at.checked_add_signed(by),
            SeekFrom::End(by) => self.length.checked_add_signed(by),
        };
        let at = at.ok_or(io::ErrorKind::InvalidInput)?;
        self.unless_failed(|inner| inner.seek(SeekFrom::Start(at)).map(drop));
        self.at = at;
        Ok(at)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use ::mcap::{McapResult, WriteOptions, records::MessageHeader};
    use std::{collections::BTreeMap, io::Cursor};

    /// A disk with room for some bytes.
    struct Disk {
        file: Cursor<Vec<u8>>,
        room: usize,
    }

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if self.file.position() as usize + bytes.len() > self.room {
                return Err(io::ErrorKind::StorageFull.into());
            }
            self.file.write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Seek for Disk {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.file.seek(to)
        }
    }

    /// Writes a file with several chunks; returns the file.
    fn written<W: Write + Seek>(out: W) -> McapResult<W> {
        let mut writer = WriteOptions::new().chunk_size(Some(200)).create(out)?;
        let id = writer.add_schema("schema", "ros2msg", &[1; 20])?;
        let id = writer.add_channel(id, "/topic", "cdr", &BTreeMap::new())?;
        for sequence in 0..40 {
            let header = MessageHeader { channel_id: id, sequence, log_time: 1, publish_time: 1 };
            writer.write_to_known_channel(&header, &[7; 50])?;
        }
        writer.finish()?;
        Ok(writer.into_inner())
    }

    #[test]
    fn a_disk_that_fills_at_any_byte_gives_its_error_and_no_panic() {
        let disk = |room| Disk { file: Cursor::new(Vec::new()), room };
        let (out, failure) = Out::new(disk(usize::MAX));
        let whole = written(out).unwrap().inner.file.into_inner();
        assert!(failure.error().is_none());
        assert_eq!(whole, written(Cursor::new(Vec::new())).unwrap().into_inner());
        for room in 0..whole.len() {
            let (out, failure) = Out::new(disk(room));
            let part = written(out).unwrap().inner.file.into_inner();
            let error = failure.error().map(io::Error::kind);
            assert_eq!(error, Some(io::ErrorKind::StorageFull), "room for {room} bytes");
            assert!(part.len() <= room);
        }
    }
}
