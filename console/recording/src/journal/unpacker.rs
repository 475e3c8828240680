//! Reads the lines of a compressed journal, even if it is still being written or its writer was killed.

use super::limits::check_expansion;
use std::io::{self, BufRead, BufReader, Read};
use zstd::stream::raw::{DParameter, Decoder, InBuffer, Operation, OutBuffer};

/// Minimum distance between two stored frames, bytes of lines: a file may contain millions of frames.
const BETWEEN_FRAMES: u64 = 1 << 18;
/// Largest distance of back references in compressed data, bytes, as an exponent of two. This program uses 128 kB, and
/// `zstd` at its usual levels stays within this limit.
const MOST_WINDOW: u32 = 23;

/// The start of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct FrameStart {
    /// Offset of the frame in the file, bytes.
    pub file: u64,
    /// Offset of the frame in the lines, bytes.
    pub content: u64,
}

/// Decompresses frame after frame. If the file stops within a frame, it returns everything that can be read.
pub(super) struct Unpacker<R> {
    packed: BufReader<R>,
    decoder: Decoder<'static>,
    /// Starts of the frames read so far, in order.
    frames: Vec<FrameStart>,
    at: FrameStart,
    began: FrameStart,
    in_frame: bool,
    /// Whether the decoder may hold data that it has not returned yet.
    holds_back: bool,
}

impl<R: Read> Unpacker<R> {
    /// `at`: where the first frame starts, in the file and in the lines.
    pub(super) fn new(packed: R, at: FrameStart) -> io::Result<Self> {
        let (packed, mut decoder) = (BufReader::with_capacity(1 << 16, packed), Decoder::new()?);
        decoder.set_parameter(DParameter::WindowLogMax(MOST_WINDOW))?;
        Ok(Self { packed, decoder, frames: Vec::new(), at, began: at, in_frame: false, holds_back: false })
    }

    /// The last frame that starts at or before this number of bytes of lines.
    pub(super) fn frame_before(&self, content: u64) -> FrameStart {
        let after = self.frames.partition_point(|frame| frame.content <= content);
        after.checked_sub(1).map_or(FrameStart::default(), |last| self.frames[last])
    }

    /// Stores the start of a frame, unless a stored frame starts shortly before it.
    fn remember(&mut self) {
        if self.frames.last().is_none_or(|last| self.at.content >= last.content + BETWEEN_FRAMES) {
            self.frames.push(self.at);
        }
    }

    /// Decompresses the next bytes of the file, or returns remaining output if there are no more bytes.
    fn decode(&mut self, takes_more: bool, into: &mut [u8]) -> io::Result<usize> {
        let packed = if takes_more { self.packed.fill_buf()? } else { &[] };
        let (mut input, mut output) = (InBuffer::around(packed), OutBuffer::around(into));
        let rest = self.decoder.run(&mut input, &mut output).map_err(|error| {
            let why = format!("the compressed data from byte {} on is damaged: {error}", self.at.file);
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
