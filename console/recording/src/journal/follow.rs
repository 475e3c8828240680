//! Reading a file that somebody else is still writing.

use std::{
    fs::File,
    io::{self, Read},
};

/// A file whose end is reached only when nobody writes to it any more.
pub(super) struct Follow<W> {
    file: File,
    /// Waits a little; whether somebody still writes.
    goes_on: W,
    is_over: bool,
}

impl<W> Follow<W> {
    pub(super) fn new(file: File, goes_on: W) -> Self {
        Self { file, goes_on, is_over: false }
    }
}

impl<W: FnMut() -> bool> Read for Follow<W> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        loop {
            let length = self.file.read(into)?;
            if length > 0 || self.is_over || into.is_empty() {
                return Ok(length);
            }
            // What was written just before the writer stopped is read in one more turn.
            self.is_over = !(self.goes_on)();
        }
    }
}
