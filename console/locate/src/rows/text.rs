//! A text file, byte by byte checked to be one.

use std::{
    fs::File,
    io::{self, Read},
};

/// A line with more bytes than this is none.
const LONGEST_LINE: usize = 1 << 16;

/// A file whose bytes are refused where they are no text, so that no reader collects an endless line.
pub(crate) struct Text {
    file: File,
    in_line: usize,
}

impl Text {
    pub(crate) fn new(file: File) -> Self {
        Self { file, in_line: 0 }
    }

    pub(crate) fn into_file(self) -> File {
        self.file
    }
}

impl Read for Text {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n = self.file.read(buffer)?;
        for byte in &buffer[..n] {
            self.in_line = if *byte == b'\n' || *byte == b'\r' { 0 } else { self.in_line + 1 };
            if *byte == 0 {
                return Err(no_text("no text: a byte 0; save the readings as CSV, in UTF-8"));
            }
            if self.in_line > LONGEST_LINE {
                return Err(no_text("no text: a line of more than 65,536 bytes"));
            }
        }
        Ok(n)
    }
}

fn no_text(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what)
}
