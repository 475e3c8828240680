//! The records of a ZIP file, as packages use them.

use crate::PackageError;

/// Signatures of the records.
const LOCAL: u32 = 0x0403_4b50;
const CENTRAL: u32 = 0x0201_4b50;
const END: u32 = 0x0605_4b50;
/// Version 2.0, and a Unix system.
const VERSION: u16 = 20;
const MADE_BY: u16 = 3 << 8 | VERSION;
/// The date 1980-01-01: a package of the same files is the same.
const DATE: u16 = 0x21;
/// A regular file that its owner may write and everyone may read.
const MODE: u32 = 0o100_644 << 16;
/// Lengths of the records without names, bytes.
pub(crate) const LOCAL_BYTES: u64 = 30;
pub(crate) const CENTRAL_BYTES: u64 = 46;
pub(crate) const END_BYTES: u64 = 22;

/// The facts of an entry that both of its headers state.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Header {
    pub(crate) name: String,
    pub(crate) crc: u32,
    pub(crate) bytes: u32,
}

impl Header {
    fn common(&self) -> Vec<u8> {
        let mut record = Vec::new();
        for word in [VERSION, 0, 0, 0, DATE] {
            record.extend(word.to_le_bytes());
        }
        for word in [self.crc, self.bytes, self.bytes] {
            record.extend(word.to_le_bytes());
        }
        record.extend((self.name.len() as u16).to_le_bytes());
        record.extend(0_u16.to_le_bytes());
        record
    }

    /// The header in front of the content.
    pub(crate) fn local(&self) -> Vec<u8> {
        [&LOCAL.to_le_bytes()[..], &self.common(), self.name.as_bytes()].concat()
    }

    /// The header in the directory, for content whose header begins at `offset`.
    pub(crate) fn central(&self, offset: u32) -> Vec<u8> {
        let mut record = [&CENTRAL.to_le_bytes()[..], &MADE_BY.to_le_bytes(), &self.common()].concat();
        record.extend([0_u8; 6]);
        record.extend(MODE.to_le_bytes());
        record.extend(offset.to_le_bytes());
        record.extend(self.name.as_bytes());
        record
    }

    /// Bytes of the local header.
    pub(crate) fn local_bytes(&self) -> u64 {
        LOCAL_BYTES + self.name.len() as u64
    }
}

/// The record at the end of the file.
pub(crate) fn end(entries: u16, directory_bytes: u32, directory_at: u32) -> Vec<u8> {
    let mut record = END.to_le_bytes().to_vec();
    for word in [0, 0, entries, entries] {
        record.extend(word.to_le_bytes());
    }
    record.extend(directory_bytes.to_le_bytes());
    record.extend(directory_at.to_le_bytes());
    record.extend(0_u16.to_le_bytes());
    record
}

fn word16(record: &[u8], at: usize) -> u16 {
    u16::from_le_bytes([record[at], record[at + 1]])
}

fn word32(record: &[u8], at: usize) -> u32 {
    u32::from_le_bytes([record[at], record[at + 1], record[at + 2], record[at + 3]])
}

/// Reads the end: the number of entries, and the length and the place of the directory.
pub(crate) fn read_end(record: &[u8]) -> Option<(usize, u64, u64)> {
    let entries = word16(record, 10);
    let (bytes, at) = (word32(record, 12), word32(record, 16));
    (record == end(entries, bytes, at)).then(|| (usize::from(entries), u64::from(bytes), u64::from(at)))
}

/// Reads the next header of a directory: the header, its offset, and the rest of the directory.
pub(crate) fn read_central(directory: &[u8]) -> Result<(Header, u32, &[u8]), PackageError> {
    let form = || PackageError::Form("the directory of the ZIP file is damaged".into());
    let record = directory.get(..CENTRAL_BYTES as usize).filter(|record| word32(record, 0) == CENTRAL);
    let record = record.ok_or_else(form)?;
    let length = usize::from(word16(record, 28));
    let rest = &directory[CENTRAL_BYTES as usize..];
    let (name, rest) = rest.split_at_checked(length).ok_or_else(form)?;
    let name = String::from_utf8_lossy(name).into_owned();
    let shown = || foreign::plain_lines(&name).into_owned();
    if word16(record, 10) != 0 || word16(record, 8) != 0 {
        return Err(PackageError::Compressed(shown()));
    }
    if !crate::is_name(&name) {
        return Err(PackageError::Name(shown()));
    }
    let header = Header { crc: word32(record, 16), bytes: word32(record, 24), name };
    let offset = word32(record, 42);
    if [record, header.name.as_bytes()].concat() != header.central(offset) {
        return Err(PackageError::Form(format!(
            "entry {} is not written as tankops writes packages; pack the files with `tankops report --package`",
            header.name
        )));
    }
    Ok((header, offset, rest))
}
