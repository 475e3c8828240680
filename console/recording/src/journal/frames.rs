//! Finds the frames of a compressed journal without decompressing it.
//!
//! A zstd frame (RFC 8878) states the length of each of its blocks. A journal of several hours is therefore scanned
//! in milliseconds, even if its writer was killed, and needs no separate index.

use std::{
    fs::File,
    io::{self, BufReader, Read, Seek},
};

const MAGIC: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];
/// Length of the magic number, the frame header descriptor and the window descriptor, bytes. The frames that we write
/// state no content length and use no dictionary.
const HEADER_BYTES: u64 = 6;
const CHECKSUM_BYTES: i64 = 4;
const BLOCK_HEADER_BYTES: u64 = 3;

/// Minimum distance between two listed frames, bytes of the file: a damaged file may contain millions of empty
/// frames.
const BETWEEN: u64 = 4096;

/// The offsets of frames in the file, bytes, in ascending order: the first frame, and each frame that is far enough
/// from the previous listed frame. If the file contains other data, only the frames before that data are listed.
pub(super) fn starts(file: &File) -> io::Result<Vec<u64>> {
    let mut walk = Walk { file: BufReader::new(file), at: 0 };
    walk.file.rewind()?;
    let mut starts: Vec<u64> = Vec::new();
    loop {
        let start = walk.at;
        let is_cut_off = match walk.frame() {
            Ok(true) => false,
            Ok(false) => return Ok(starts),
            // The last frame of a writer that was killed.
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => true,
            Err(error) => return Err(error),
        };
        let is_apart = starts.last().is_none_or(|last| start >= last + BETWEEN);
        starts.extend((walk.at > start && is_apart).then_some(start));
        if is_cut_off {
            return Ok(starts);
        }
    }
}

struct Walk<'a> {
    file: BufReader<&'a File>,
    at: u64,
}

impl Walk<'_> {
    /// Skips a frame; returns whether there was one in the form that this program writes.
    fn frame(&mut self) -> io::Result<bool> {
        let header: [u8; HEADER_BYTES as usize] = self.take()?;
        // Descriptor: a checksum, no dictionary, no content length.
        if header[..4] != MAGIC || header[4] != 0b100 {
            return Ok(false);
        }
        self.at += HEADER_BYTES;
        loop {
            let [low, middle, high] = self.take()?;
            let header = u32::from_le_bytes([low, middle, high, 0]);
            let (is_last, kind, size) = (header & 1 == 1, header >> 1 & 3, i64::from(header >> 3));
            // An RLE block takes one byte in the file, regardless of its decompressed length.
            let length = if kind == 1 { 1 } else { size } + if is_last { CHECKSUM_BYTES } else { 0 };
            self.file.seek_relative(length)?;
            self.at += BLOCK_HEADER_BYTES + length as u64;
            if is_last {
                return Ok(true);
            }
        }
    }

    fn take<const N: usize>(&mut self) -> io::Result<[u8; N]> {
        let mut bytes = [0; N];
        self.file.read_exact(&mut bytes)?;
        Ok(bytes)
    }
}
