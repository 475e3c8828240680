//! Reads a file that is still being written.

use std::{
    fs::File,
    io::{self, Read},
};

/// A file whose end is reached only when its writer has stopped.
pub(super) struct Follow<W> {
    file: File,
    /// Waits briefly; returns whether the file is still being written.
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
            // One more round reads the bytes written just before the writer stopped.
            self.is_over = !(self.goes_on)();
        }
    }
}
