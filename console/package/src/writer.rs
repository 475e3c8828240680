//! Writes packages.

use crate::{
    MOST_BYTES, MOST_ENTRIES, PackageError, SUMS,
    header::{Header, end},
    name::is_name,
};
use sha2::{Digest, Sha256};
use std::{
    collections::BTreeMap,
    io::{self, Read, Seek, SeekFrom, Write},
};

/// Size of the pieces in which content is copied, bytes.
const PIECE: usize = 1 << 16;

/// A package that is being written.
#[derive(Debug)]
pub struct Writer<W> {
    out: W,
    at: u64,
    entries: Vec<(Header, u32)>,
    /// SHA-256 of each entry, by name.
    sums: BTreeMap<String, String>,
}

impl<W: Write + Seek> Writer<W> {
    /// Begins a package; `out` must be empty.
    pub fn new(out: W) -> Self {
        Self { out, at: 0, entries: Vec::new(), sums: BTreeMap::new() }
    }

    /// Adds a file, and returns its SHA-256, hexadecimal.
    ///
    /// # Errors
    /// The name is not allowed or taken, the content cannot be read or written, or the package becomes too large.
    pub fn add(&mut self, name: &str, content: impl Read) -> Result<String, PackageError> {
        if !is_name(name) || name == SUMS {
            return Err(PackageError::Name(foreign::plain_lines(name).into_owned()));
        }
        if self.sums.keys().any(|known| known.eq_ignore_ascii_case(name)) {
            return Err(PackageError::Twice(name.to_owned()));
        }
        let sha256 = self.store(name, content)?;
        self.sums.insert(name.to_owned(), sha256.clone());
        Ok(sha256)
    }

    /// Stores an entry. The header is written again once the content is known.
    fn store(&mut self, name: &str, mut content: impl Read) -> Result<String, PackageError> {
        if self.entries.len() >= MOST_ENTRIES {
            return Err(PackageError::TooLarge(format!("a package has at most {MOST_ENTRIES} files")));
        }
        let begin = self.at;
        let mut header = Header { name: name.to_owned(), crc: 0, bytes: 0 };
        self.out.write_all(&header.local())?;
        let (mut crc, mut digest, mut bytes) = (crc32fast::Hasher::new(), Sha256::new(), 0_u64);
        let mut piece = vec![0; PIECE];
        loop {
            let count = match content.read(&mut piece) {
                Ok(0) => break,
                Ok(count) => count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => return Err(error.into()),
            };
            bytes += count as u64;
            if begin + header.local_bytes() + bytes > MOST_BYTES {
                return Err(PackageError::TooLarge(format!(
                    "the package becomes larger than 4 GB with {name}; pack fewer runs"
                )));
            }
            crc.update(&piece[..count]);
            digest.update(&piece[..count]);
            self.out.write_all(&piece[..count])?;
        }
        (header.crc, header.bytes) = (crc.finalize(), bytes as u32);
        self.out.seek(SeekFrom::Start(begin))?;
        self.out.write_all(&header.local())?;
        self.at = begin + header.local_bytes() + bytes;
        self.out.seek(SeekFrom::Start(self.at))?;
        self.entries.push((header, begin as u32));
        Ok(hex::encode(digest.finalize()))
    }

    /// Writes the list of digests and the directory, and returns what was written to.
    ///
    /// # Errors
    /// The system refuses to write, or the package becomes too large.
    pub fn finish(mut self) -> Result<W, PackageError> {
        let lines = self.sums.iter().map(|(name, sha256)| format!("{sha256}  {name}\n"));
        let list: String = lines.collect();
        self.store(SUMS, list.as_bytes())?;
        let directory: Vec<u8> =
            self.entries.iter().flat_map(|(header, offset)| header.central(*offset)).collect();
        if self.at + directory.len() as u64 > MOST_BYTES {
            return Err(PackageError::TooLarge(
                "the package becomes larger than 4 GB; pack fewer runs".into(),
            ));
        }
        self.out.write_all(&directory)?;
        self.out.write_all(&end(self.entries.len() as u16, directory.len() as u32, self.at as u32))?;
        self.out.flush()?;
        Ok(self.out)
    }
}
