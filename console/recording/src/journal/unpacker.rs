//! The lines of a compressed journal, also of one that is still being written or whose writer was killed.

use super::limits::check_expansion;
use std::io::{self, BufRead, BufReader, Read};
use zstd::stream::raw::{DParameter, Decoder, InBuffer, Operation, OutBuffer};

/// Frames are remembered this far apart, bytes of lines: a file may have millions of them.
const BETWEEN_FRAMES: u64 = 1 << 18;
/// How far back what is compressed may point, as a power of two in bytes: what is written here points back by 128 kB, and `zstd`
/// at its usual levels by no more than this.
const MOST_WINDOW: u32 = 23;

/// Where a frame begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct FrameStart {
    /// In the file, bytes.
    pub file: u64,
    /// In the lines, bytes.
    pub content: u64,
}

/// Decompresses frame after frame. A file that stops within one gives what can be read of it.
pub(super) struct Unpacker<R> {
    packed: BufReader<R>,
    decoder: Decoder<'static>,
    /// Begins of the frames met so far, in order.
    frames: Vec<FrameStart>,
    at: FrameStart,
    began: FrameStart,
    in_frame: bool,
    /// Whether the decoder may hold more than it could give.
    holds_back: bool,
}

impl<R: Read> Unpacker<R> {
    /// `at`: where in the file and in the lines the first frame begins.
    pub(super) fn new(packed: R, at: FrameStart) -> io::Result<Self> {
        let (packed, mut decoder) = (BufReader::with_capacity(1 << 16, packed), Decoder::new()?);
        decoder.set_parameter(DParameter::WindowLogMax(MOST_WINDOW))?;
        Ok(Self { packed, decoder, frames: Vec::new(), at, began: at, in_frame: false, holds_back: false })
    }

    /// The last frame that begins at or before so many bytes of lines.
    pub(super) fn frame_before(&self, content: u64) -> FrameStart {
        let after = self.frames.partition_point(|frame| frame.content <= content);
        after.checked_sub(1).map_or(FrameStart::default(), |last| self.frames[last])
    }

    /// Remembers that a frame begins here, unless one begins a little before.
    fn remember(&mut self) {
        if self.frames.last().is_none_or(|last| self.at.content >= last.content + BETWEEN_FRAMES) {
            self.frames.push(self.at);
        }
    }

    /// Gives what the decoder makes of the next bytes of the file, or of none of them.
    fn decode(&mut self, takes_more: bool, into: &mut [u8]) -> io::Result<usize> {
        let packed = if takes_more { self.packed.fill_buf()? } else { &[] };
        let (mut input, mut output) = (InBuffer::around(packed), OutBuffer::around(into));
        let rest = self.decoder.run(&mut input, &mut output).map_err(|error| {
            let why = format!("what is compressed from byte {} on is damaged: {error}", self.at.file);
            io::Error::new(io::ErrorKind::InvalidData, why)
        })?;
        let (taken, given) = (input.pos(), output.pos());
        self.packed.consume(taken);
        self.at.file += taken as u64;
        self.at.content += given as u64;
        check_expansion(self.at.file - self.began.file, self.at.content - self.began.content)?;
        self.holds_back = given == into.len();
        if rest == 0 {
            (self.in_frame, self.holds_back) = (false, false);
            self.decoder.reinit()?;
        }
        Ok(given)
    }
}

impl<R: Read> Read for Unpacker<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if into.is_empty() {
            return Ok(0);
        }
        if self.holds_back {
            let given = self.decode(false, into)?;
            if given > 0 {
                return Ok(given);
            }
        }
        while !self.packed.fill_buf()?.is_empty() {
            if !self.in_frame {
                self.in_frame = true;
                self.remember();
            }
            let given = self.decode(true, into)?;
            if given > 0 {
                return Ok(given);
            }
        }
        Ok(0)
    }
}
