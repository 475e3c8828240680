//! The summary section of an MCAP file, in a fixed order. The library repeats schemas and channels there in an order that
//! changes from run to run; equal journals must give equal files.
//!
//! The form of the section: <https://mcap.dev/spec>, "Summary Section" and "Footer".

use std::{
    fs::{File, OpenOptions},
    io::{self, Read, Seek, SeekFrom, Write},
    path::Path,
};

/// The magic bytes at the end of a file.
const MAGIC: &[u8] = b"\x89MCAP0\r\n";
/// Length of the opcode and the length before the content of a record, bytes.
const HEAD: usize = 9;
/// Length of the content of the footer: start of the summary, start of its offsets, CRC.
const FOOTER: usize = 8 + 8 + 4;
const SCHEMA: u8 = 0x03;
const CHANNEL: u8 = 0x04;

/// Sorts the schemas and the channels in the summary of a file by their ids, and renews its checksum.
///
/// # Errors
/// The system refuses to read or write; or the file is not a complete MCAP file.
pub(super) fn sort(path: &Path) -> io::Result<()> {
    let mut file = OpenOptions::new().read(true).write(true).open(path)?;
    let end = (HEAD + FOOTER + MAGIC.len()) as u64;
    let length = file.metadata()?.len();
    let tail = read(&mut file, length.checked_sub(end).ok_or_else(damaged)?, end as usize)?;
    let begin = u64_at(&tail, HEAD).filter(|begin| (1..=length - end).contains(begin)).ok_or_else(damaged)?;
    // The checksum is that of the section and of the footer before the checksum.
    let summed = length - (4 + MAGIC.len() as u64);
    let mut section = read(&mut file, begin, (summed - begin) as usize)?;
    let footer = section.len() - (HEAD + FOOTER - 4);
    let sorted = sorted(&section[..footer])?;
    section[..footer].copy_from_slice(&sorted);
    file.seek(SeekFrom::Start(begin))?;
    file.write_all(&section)?;
    file.write_all(&crc32fast::hash(&section).to_le_bytes())
}

/// The records of a summary, each group of schemas or channels by its ids; the places of the groups do not change.
fn sorted(section: &[u8]) -> io::Result<Vec<u8>> {
    let mut records = records(section)?;
    for group in records.chunk_by_mut(|one, other| one[0] == other[0]) {
        if [SCHEMA, CHANNEL].contains(&group[0][0]) {
            // The id is the first value of the content.
            group.sort_by_key(|record| record.get(HEAD..HEAD + 2).map(|id| [id[1], id[0]]));
        }
    }
    Ok(records.concat())
}

/// Divides a section into its records.
fn records(mut rest: &[u8]) -> io::Result<Vec<&[u8]>> {
    let mut records = Vec::new();
    while !rest.is_empty() {
        let content = u64_at(rest, 1).and_then(|bytes| usize::try_from(bytes).ok());
        let record = content.and_then(|content| rest.split_at_checked(HEAD.checked_add(content)?));
        let (record, others) = record.ok_or_else(damaged)?;
        records.push(record);
        rest = others;
    }
    Ok(records)
}

fn u64_at(bytes: &[u8], at: usize) -> Option<u64> {
    Some(u64::from_le_bytes(bytes.get(at..at + 8)?.try_into().ok()?))
}

fn read(file: &mut File, from: u64, length: usize) -> io::Result<Vec<u8>> {
    let mut bytes = vec![0; length];
    file.seek(SeekFrom::Start(from))?;
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}

fn damaged() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, "the MCAP file was changed while it was written")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use ::mcap::{MessageStream, WriteOptions, records::MessageHeader};
    use std::collections::BTreeMap;

    /// A file with many topics, as the library writes it, and with a sorted summary.
    fn written() -> Vec<u8> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.mcap");
        let mut writer = WriteOptions::new().create(File::create_new(&path).unwrap()).unwrap();
        for topic in 0..40_u16 {
            let id = writer.add_schema(&format!("schema-{topic}"), "ros2msg", &[1; 20]).unwrap();
            let id = writer.add_channel(id, &format!("/{topic}"), "cdr", &BTreeMap::new()).unwrap();
            let header = MessageHeader { channel_id: id, sequence: 0, log_time: 1, publish_time: 1 };
            writer.write_to_known_channel(&header, &topic.to_le_bytes()).unwrap();
        }
        writer.finish().unwrap();
        drop(writer);
        sort(&path).unwrap();
        std::fs::read(path).unwrap()
    }

    #[test]
    fn equal_contents_give_equal_files_that_can_be_read() {
        let bytes = written();
        assert_eq!(bytes, written());
        let summary = ::mcap::Summary::read(&bytes).unwrap().unwrap();
        assert_eq!((summary.channels.len(), summary.schemas.len()), (40, 40));
        assert_eq!(MessageStream::new(&bytes).unwrap().map(Result::unwrap).count(), 40);
    }

    #[test]
    fn a_file_without_its_end_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.mcap");
        let bytes = written();
        for length in [0, 5, 40] {
            std::fs::write(&path, &bytes[..length]).unwrap();
            assert!(sort(&path).is_err(), "{length}");
        }
    }
}
