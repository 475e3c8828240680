//! The digest stored in every table. It covers all bytes of the table, with the digits of the digest itself treated as
//! zeros. It is stored in the metadata at the end of the file, so other programs can read the table like any other.

use parquet::{
    errors::ParquetError,
    file::{metadata::KeyValue, reader::ChunkReader},
};
use sha2::{Digest, Sha256};

const KEY: &str = "tankops.sha256";
/// Number of hexadecimal digits in a digest.
const DIGITS: usize = 64;
/// States in a second place that the file has a digest. If the digest cannot be found, the file is therefore not
/// mistaken for a file without a digest.
pub(crate) const CREATED_BY: &str = "tankops campaign, with digest";
/// The end of a Parquet file: the length of the metadata, and a magic word.
const TAIL: u64 = 8;
/// Maximum size of the metadata to be searched, bytes.
const MOST_METADATA: u64 = 16 << 20;
/// Number of bytes read at a time.
const PIECE: u64 = 1 << 20;

/// The result of checking a file against its digest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Seal {
    /// The bytes are unchanged.
    Whole,
    /// At least one byte was changed.
    Damaged,
    /// The file has no digest: it was written by an earlier version or by another program.
    None,
}

/// The placeholder for the digest of a table that is being written.
pub(crate) fn place_holder() -> KeyValue {
    KeyValue::new(KEY.to_owned(), "0".repeat(DIGITS))
}

/// Writes the digest of a table over its placeholder.
pub(crate) fn seal(bytes: &mut [u8]) {
    let digest = hex::encode(Sha256::digest(&*bytes));
    if let Some(at) = place_in(bytes) {
        bytes[at..at + DIGITS].copy_from_slice(digest.as_bytes());
    }
}

/// Checks the bytes of a table against its digest.
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
    let is_whole = hex::encode(hash.finalize()).as_bytes() == &metadata[at..at + DIGITS];
    Ok(if is_whole { Seal::Whole } else { Seal::Damaged })
}

/// The metadata at the end of a file and everything after it; `None` if it is not a Parquet file.
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

/// Position of the digest: directly after the last occurrence of its key, encoded as text in Thrift's compact form.
fn place_in(bytes: &[u8]) -> Option<usize> {
    let text = 0x18; // the next field, and it is a text
    let before = [&[text, KEY.len() as u8], KEY.as_bytes(), &[text, DIGITS as u8]].concat();
    let at = bytes.windows(before.len()).rposition(|window| window == before)? + before.len();
    (at + DIGITS <= bytes.len()).then_some(at)
}
