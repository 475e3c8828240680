//! Compresses the lines of a journal while they are written.
//!
//! The file is a sequence of zstd frames, each with a checksum; `zstdcat` shows the lines. A frame starts at the
//! start of a line and contains about a megabyte of lines, so that a reader can start at any frame without the part
//! before it. Within a frame, everything that was flushed can be read even if the writer is killed.

use std::io;
use zstd::{
    stream::raw::{CParameter, Encoder, InBuffer, Operation, OutBuffer},
    zstd_safe::Strategy,
};

/// Minimum number of bytes of lines in a frame; a reader decompresses this much to reach a place.
const FRAME_BYTES: usize = 1 << 20;
/// Parameters of the match search. A journal mostly repeats the previous tick. A small table with the four latest
/// occurrences of every six-byte sequence therefore finds better matches than level 9 of zstd, whose table takes
/// megabytes, and needs less than half the time. Journals of four scenarios become 3 to 5 % smaller. With larger tables
/// the journals become larger again, because the matches are further back.
const SEARCH: [CParameter; 6] = [
    CParameter::Strategy(Strategy::ZSTD_greedy),
    CParameter::WindowLog(17),
    CParameter::HashLog(13),
    CParameter::ChainLog(13),
    CParameter::SearchLog(2),
    CParameter::MinMatch(6),
];
/// Size of the output buffer that the compressor is given each time.
const STEP_BYTES: usize = 16 << 10;

/// Compresses lines.
pub(super) struct Packer {
    encoder: Encoder<'static>,
    /// Number of bytes of lines in the open frame.
    in_frame: usize,
    /// Whether some of these bytes are not in the output yet.
    holds_back: bool,
}

impl Packer {
    pub(super) fn new() -> io::Result<Self> {
        let mut encoder = Encoder::new(zstd::DEFAULT_COMPRESSION_LEVEL)?;
        encoder.set_parameter(CParameter::ChecksumFlag(true))?;
        for parameter in SEARCH {
            encoder.set_parameter(parameter)?;
        }
        Ok(Self { encoder, in_frame: 0, holds_back: false })
    }

    /// Adds a complete line and appends the data compressed so far to `out`.
    pub(super) fn add(&mut self, line: &[u8], out: &mut Vec<u8>) -> io::Result<()> {
        let mut input = InBuffer::around(line);
        while input.pos() < line.len() {
            with_room(out, |room| self.encoder.run(&mut input, room))?;
        }
        self.in_frame += line.len();
        self.holds_back = true;
        if self.in_frame >= FRAME_BYTES { self.end_frame(out) } else { Ok(()) }
    }

    /// Whether some lines cannot be read from the output yet.
    pub(super) fn holds_back(&self) -> bool {
        self.holds_back
    }

    /// Appends the data held back, so that every line can be read.
    pub(super) fn flush(&mut self, out: &mut Vec<u8>) -> io::Result<()> {
        while self.holds_back && with_room(out, |room| self.encoder.flush(room))? > 0 {}
        self.holds_back = false;
        Ok(())
    }

    /// Appends the end of the open frame, if there is one.
    pub(super) fn end_frame(&mut self, out: &mut Vec<u8>) -> io::Result<()> {
        while self.in_frame > 0 && with_room(out, |room| self.encoder.finish(room, true))? > 0 {}
        (self.in_frame, self.holds_back) = (0, false);
        self.encoder.reinit()
    }
}

/// Calls `step` to run the compressor, which appends to `out`; returns the result of `step`.
fn with_room(
    out: &mut Vec<u8>,
    step: impl FnOnce(&mut OutBuffer<'_, Vec<u8>>) -> io::Result<usize>,
) -> io::Result<usize> {
    out.reserve(STEP_BYTES);
    let end = out.len();
    step(&mut OutBuffer::around_pos(out, end))
}
