//! The digest that every table carries: of all its bytes, where those of the digest itself count as zeros. It stands in the
//! metadata at the end of the file, so that other programs read the table as any other.

use crate::table::hex;
use parquet::{
    errors::ParquetError,
    file::{metadata::KeyValue, reader::ChunkReader},
};
use sha2::{Digest, Sha256};

const KEY: &str = "tankops.sha256";
/// Hexadecimal digits of a digest.
const DIGITS: usize = 64;
/// What says in another place that there is one, so that a file whose digest cannot be found is not taken for one without.
pub(crate) const CREATED_BY: &str = "tankops campaign, with digest";
/// The end of a Parquet file: length of the metadata, and a word.
const TAIL: u64 = 8;
/// Metadata that is searched at most, bytes.
const MOST_METADATA: u64 = 16 << 20;
/// Bytes that are read at once.
const PIECE: u64 = 1 << 20;

/// What a file says of its own bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Seal {
    /// They are as they were written.
    Whole,
    /// They are not.
    Damaged,
    /// Nothing: it was written by an earlier version, or by another program.
    None,
}

/// The place for the digest of a table that is being written.
pub(crate) fn place_holder() -> KeyValue {
    KeyValue::new(KEY.to_owned(), "0".repeat(DIGITS))
}

/// Puts the digest of a table in its place.
pub(crate) fn seal(bytes: &mut [u8]) {
    let digest = hex(&Sha256::digest(&*bytes));
    if let Some(at) = place_in(bytes) {
        bytes[at..at + DIGITS].copy_from_slice(digest.as_bytes());
    }
}

/// Compares the bytes of a table with its digest.
pub(crate) fn check(file: &impl ChunkReader) -> Result<Seal, ParquetError> {
    let length = file.len();
    let Some(metadata) = metadata(file)? else { return Ok(Seal::None) };
    let first = length - metadata.len() as u64;
    let Some(at) = place_in(&metadata) else {
        let says_so = metadata.windows(CREATED_BY.len()).any(|window| window == CREATED_BY.as_bytes());
        return Ok(if says_so { Seal::Damaged } else { Seal::None });
    };
    let mut hash = Sha256::new();
    let mut from = 0;
    while from < first {
        let piece = file.get_bytes(from, PIECE.min(first - from) as usize)?;
        hash.update(&piece);
        from += piece.len() as u64;
    }
    hash.update(&metadata[..at]);
    hash.update([b'0'; DIGITS]);
    hash.update(&metadata[at + DIGITS..]);
    let is_whole = hex(&hash.finalize()).as_bytes() == &metadata[at..at + DIGITS];
    Ok(if is_whole { Seal::Whole } else { Seal::Damaged })
}

/// The metadata at the end of a file with all that follows; nothing if it is not a Parquet file.
fn metadata(file: &impl ChunkReader) -> Result<Option<Vec<u8>>, ParquetError> {
    let Some(tail_at) = file.len().checked_sub(TAIL) else { return Ok(None) };
    let tail = file.get_bytes(tail_at, TAIL as usize)?;
    let Some((size, b"PAR1")) = tail.split_first_chunk::<4>() else { return Ok(None) };
    let size = u64::from(u32::from_le_bytes(*size));
    match tail_at.checked_sub(size) {
        Some(at) if size <= MOST_METADATA => Ok(Some(file.get_bytes(at, (size + TAIL) as usize)?.to_vec())),
        _ => Ok(None),
    }
}

/// Where the digest stands: after its key, as a text in Thrift's compact form, behind the last such key.
fn place_in(bytes: &[u8]) -> Option<usize> {
    let text = 0x18; // the next field, and it is a text
    let before = [&[text, KEY.len() as u8], KEY.as_bytes(), &[text, DIGITS as u8]].concat();
    let at = bytes.windows(before.len()).rposition(|window| window == before)? + before.len();
    (at + DIGITS <= bytes.len()).then_some(at)
}
