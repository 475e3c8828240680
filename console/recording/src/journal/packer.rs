//! Lines of a journal, compressed while they are written.
//!
//! The file is a row of zstd frames, each with a checksum; `zstdcat` shows the lines. A frame begins with a line and holds
//! about a megabyte of them, so that a reader can begin anywhere without reading what comes before. Within a frame everything
//! that was flushed can be read, whatever becomes of the writer.

use std::io;
use zstd::{
    stream::raw::{CParameter, Encoder, InBuffer, Operation, OutBuffer},
    zstd_safe::Strategy,
};

/// Bytes of lines in a frame, at least: a reader decompresses as much to get to a place.
const FRAME_BYTES: usize = 1 << 20;
/// How matches are looked for: what repeats in a journal is the tick before, so a small table with a look at the four newest
/// places of each six bytes finds better ones than level 9 of zstd with its table of megabytes, in less than half of the time.
/// Journals of four scenarios are 3 to 5 % smaller so; larger tables make them larger again, because they lead further back.
const SEARCH: [CParameter; 6] = [
    CParameter::Strategy(Strategy::ZSTD_greedy),
    CParameter::WindowLog(17),
    CParameter::HashLog(13),
    CParameter::ChainLog(13),
    CParameter::SearchLog(2),
    CParameter::MinMatch(6),
];
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
        let mut encoder = Encoder::new(zstd::DEFAULT_COMPRESSION_LEVEL)?;
        encoder.set_parameter(CParameter::ChecksumFlag(true))?;
        for parameter in SEARCH {
            encoder.set_parameter(parameter)?;
        }
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
