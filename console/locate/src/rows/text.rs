//! Reads a text file and checks every byte.

use std::{
    fs::File,
    io::{self, Read},
};

/// The longest line that is read, bytes.
const LONGEST_LINE: usize = 1 << 16;

/// A file that refuses bytes that are not text, so that no reader collects an endless line. Every line is returned
/// with a line feed at its end, so that lines can be counted.
pub(crate) struct Text {
    file: File,
    in_line: usize,
    last: u8,
}

impl Text {
    pub(crate) fn new(file: File) -> Self {
        Self { file, in_line: 0, last: b'\n' }
    }

    pub(crate) fn into_file(self) -> File {
        self.file
    }

    /// Converts a byte: a carriage return becomes a line feed, and a line feed right after it is dropped.
    fn checked(&mut self, byte: u8) -> io::Result<Option<u8>> {
        let before = std::mem::replace(&mut self.last, byte);
        self.in_line += 1;
        match byte {
            b'\n' if before == b'\r' => Ok(None),
            b'\n' | b'\r' => {
                self.in_line = 0;
                Ok(Some(b'\n'))
            }
            0 => Err(no_text("not text: contains a zero byte; save the readings as CSV, in UTF-8")),
            _ if self.in_line > LONGEST_LINE => Err(no_text("not text: a line has more than 65,536 bytes")),
            _ => Ok(Some(byte)),
        }
    }
}

impl Read for Text {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            let n = self.file.read(buffer)?;
            if n == 0 {
                let is_open = !matches!(self.last, b'\n' | b'\r') && !buffer.is_empty();
                self.last = b'\n';
                buffer.iter_mut().take(1).filter(|_| is_open).for_each(|byte| *byte = b'\n');
                return Ok(usize::from(is_open));
            }
            let mut kept = 0;
            for k in 0..n {
                if let Some(byte) = self.checked(buffer[k])? {
                    buffer[kept] = byte;
                    kept += 1;
                }
            }
            if kept > 0 {
                return Ok(kept);
            }
        }
    }
}

fn no_text(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what)
}
