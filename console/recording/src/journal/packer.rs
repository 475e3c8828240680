//! Lines of a journal, compressed while they are written.
//!
//! The file is a row of zstd frames, each with a checksum; `zstdcat` shows the lines. A frame begins with a line and holds
//! about a megabyte of them, so that a reader can begin anywhere without reading what comes before. Within a frame everything
//! that was flushed can be read, whatever becomes of the writer.

use std::io;
use zstd::stream::raw::{CParameter, Encoder, InBuffer, Operation, OutBuffer};

/// On journals level 9 takes a sixth less space than the default of 3.
const LEVEL: i32 = 9;
/// What repeats in lines is long: only matches of so many bytes are looked for, and at few places (a power of two). That takes
/// two thirds of the level's own time, and 2 % less space.
const LEAST_MATCH: u32 = 6;
const SEARCH_LOG: u32 = 1;
/// Bytes of lines in a frame, at least: a reader decompresses as much to get to a place.
const FRAME_BYTES: usize = 1 << 20;
/// Nothing in a frame lies further back than this power of two, bytes. The level's own choice takes 15 MB more memory.
const WINDOW_LOG: u32 = FRAME_BYTES.ilog2() + 1;
/// Entries of the table of matches, a power of two: enough for a frame.
const HASH_LOG: u32 = 19;
/// Bytes that the compressor is offered for its output at a time.
const STEP_BYTES: usize = 16 << 10;

/// Compresses lines.
pub(super) struct Packer {
    encoder: Encoder<'static>,
    /// Bytes of lines in the frame that is open.
    in_frame: usize,
    /// Whether some of them are not in the output yet.
    holds_back: bool,
}

impl Packer {
    pub(super) fn new() -> io::Result<Self> {
        let mut encoder = Encoder::new(LEVEL)?;
        encoder.set_parameter(CParameter::ChecksumFlag(true))?;
        encoder.set_parameter(CParameter::WindowLog(WINDOW_LOG))?;
        encoder.set_parameter(CParameter::HashLog(HASH_LOG))?;
        encoder.set_parameter(CParameter::MinMatch(LEAST_MATCH))?;
        encoder.set_parameter(CParameter::SearchLog(SEARCH_LOG))?;
        Ok(Self { encoder, in_frame: 0, holds_back: false })
    }

    /// Takes a whole line and appends what is compressed so far to `out`.
    pub(super) fn add(&mut self, line: &[u8], out: &mut Vec<u8>) -> io::Result<()> {
        let mut input = InBuffer::around(line);
        while input.pos() < line.len() {
            with_room(out, |room| self.encoder.run(&mut input, room))?;
        }
        self.in_frame += line.len();
        self.holds_back = true;
        if self.in_frame >= FRAME_BYTES { self.end_frame(out) } else { Ok(()) }
    }

    /// Whether there are lines that could not be read yet from the output.
    pub(super) fn holds_back(&self) -> bool {
        self.holds_back
    }

    /// Appends what was held back, so that every line can be read.
    pub(super) fn flush(&mut self, out: &mut Vec<u8>) -> io::Result<()> {
        while self.holds_back && with_room(out, |room| self.encoder.flush(room))? > 0 {}
        self.holds_back = false;
        Ok(())
    }

    /// Appends the end of the frame that is open, if there is one.
    pub(super) fn end_frame(&mut self, out: &mut Vec<u8>) -> io::Result<()> {
        while self.in_frame > 0 && with_room(out, |room| self.encoder.finish(room, true))? > 0 {}
        (self.in_frame, self.holds_back) = (0, false);
        self.encoder.reinit()
    }
}

/// Lets the compressor append to `out`; gives what it returns.
fn with_room(
    out: &mut Vec<u8>,
    step: impl FnOnce(&mut OutBuffer<'_, Vec<u8>>) -> io::Result<usize>,
) -> io::Result<usize> {
    out.reserve(STEP_BYTES);
    let end = out.len();
    step(&mut OutBuffer::around_pos(out, end))
}
