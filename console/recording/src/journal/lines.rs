//! The lines of a journal, whether its file is compressed or not.

use super::unpacker::{FrameStart, Unpacker};
use std::{
    io::{self, BufRead, BufReader, Read},
    path::Path,
};

/// Size of the read buffer, bytes.
const BUFFER_BYTES: usize = 1 << 18;

/// The lines of a file.
pub(super) enum Lines {
    Plain(BufReader<Box<dyn Read + Send>>),
    Packed(BufReader<Unpacker<Box<dyn Read + Send>>>),
}

impl Lines {
    /// The lines of the file with this path, from a given place on; `bytes` is the content of the file from there.
    pub(super) fn of(bytes: impl Read + Send + 'static, path: &Path, at: FrameStart) -> io::Result<Self> {
        let bytes: Box<dyn Read + Send> = Box::new(bytes);
        Ok(if is_packed(path) {
            Self::Packed(BufReader::with_capacity(BUFFER_BYTES, Unpacker::new(bytes, at)?))
        } else {
            Self::Plain(BufReader::with_capacity(BUFFER_BYTES, bytes))
        })
    }

    pub(super) fn text(&mut self) -> &mut dyn BufRead {
        match self {
            Self::Plain(lines) => lines,
            Self::Packed(lines) => lines,
        }
    }

    /// The file offset at which to start reading to reach a place, given the number of bytes of lines before that
    /// place.
    pub(super) fn frame_before(&self, bytes: u64) -> FrameStart {
        match self {
            Self::Plain(_) => FrameStart { file: bytes, content: bytes },
            Self::Packed(lines) => lines.get_ref().frame_before(bytes),
        }
    }
}

/// Whether a file is compressed, by its name.
pub(super) fn is_packed(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "zst")
}
