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

/// A package that is being written.
#[derive(Debug)]
pub struct Writer<W> {
    out: W,
    at: u64,
    entries: Vec<(Header, u32)>,
    /// SHA-256 of each entry, by name.
    sums: BTreeMap<String, String>,
}

/// The content of an entry, on its way into the package.
struct Sink<'a, W> {
    out: &'a mut W,
    crc: crc32fast::Hasher,
    digest: Sha256,
    bytes: u64,
    most_bytes: u64,
}

impl<W: Write> Write for Sink<'_, W> {
    fn write(&mut self, piece: &[u8]) -> io::Result<usize> {
        if self.bytes + piece.len() as u64 > self.most_bytes {
            return Err(io::Error::new(
                io::ErrorKind::FileTooLarge,
                "the package becomes larger than 4 GB; pack fewer runs",
            ));
        }
        let count = self.out.write(piece)?;
        self.crc.update(&piece[..count]);
        self.digest.update(&piece[..count]);
        self.bytes += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// SHA-256 of the content that `fill` writes, hexadecimal: what [`Writer::add_with`] returns for this content.
///
/// # Errors
/// Those of `fill`.
pub fn sha256_of<E>(fill: impl FnOnce(&mut dyn Write) -> Result<(), E>) -> Result<String, E> {
    let mut sink = Sink {
        out: &mut io::sink(),
        crc: crc32fast::Hasher::new(),
        digest: Sha256::new(),
        bytes: 0,
        most_bytes: MOST_BYTES,
    };
    fill(&mut sink)?;
    Ok(hex::encode(sink.digest.finalize()))
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
    pub fn add(&mut self, name: &str, mut content: impl Read) -> Result<String, PackageError> {
        self.add_with(name, |sink| io::copy(&mut content, sink).map(drop).map_err(PackageError::from))
    }

    /// Adds a file whose content `fill` writes, and returns its SHA-256, hexadecimal.
    ///
    /// # Errors
    /// Those of [`Writer::add`] and of `fill`.
    pub fn add_with<E: From<PackageError>>(
        &mut self,
        name: &str,
        fill: impl FnOnce(&mut dyn Write) -> Result<(), E>,
    ) -> Result<String, E> {
        if !is_name(name) || name == SUMS {
            return Err(PackageError::Name(foreign::plain_lines(name).into_owned()).into());
        }
        if self.sums.keys().any(|known| known.eq_ignore_ascii_case(name)) {
            return Err(PackageError::Twice(name.to_owned()).into());
        }
        let sha256 = self.store(name, fill)?;
        self.sums.insert(name.to_owned(), sha256.clone());
        Ok(sha256)
    }

    /// Stores an entry. Its header is written again once the content is known.
    fn store<E: From<PackageError>>(
        &mut self,
        name: &str,
        fill: impl FnOnce(&mut dyn Write) -> Result<(), E>,
    ) -> Result<String, E> {
        if self.entries.len() >= MOST_ENTRIES {
            let why = format!("a package has at most {MOST_ENTRIES} files");
            return Err(PackageError::TooLarge(why).into());
        }
        let begin = self.at;
        let mut header = Header { name: name.to_owned(), crc: 0, bytes: 0 };
        self.out.write_all(&header.local()).map_err(PackageError::from)?;
        let mut sink = Sink {
            out: &mut self.out,
            crc: crc32fast::Hasher::new(),
            digest: Sha256::new(),
            bytes: 0,
            most_bytes: MOST_BYTES.saturating_sub(begin + header.local_bytes()),
        };
        fill(&mut sink)?;
        let Sink { crc, digest, bytes, .. } = sink;
        (header.crc, header.bytes) = (crc.finalize(), bytes as u32);
        self.at = begin + header.local_bytes() + bytes;
        self.rewrite(begin, &header).map_err(PackageError::from)?;
        self.entries.push((header, begin as u32));
        Ok(hex::encode(digest.finalize()))
    }

    fn rewrite(&mut self, begin: u64, header: &Header) -> io::Result<()> {
        self.out.seek(SeekFrom::Start(begin))?;
        self.out.write_all(&header.local())?;
        self.out.seek(SeekFrom::Start(self.at)).map(drop)
    }

    /// Writes the list of digests and the directory, and returns what was written to.
    ///
    /// # Errors
    /// The system refuses to write, or the package becomes too large.
    pub fn finish(mut self) -> Result<W, PackageError> {
        let lines = self.sums.iter().map(|(name, sha256)| format!("{sha256}  {name}\n"));
        let list: String = lines.collect();
        self.store(SUMS, |sink| sink.write_all(list.as_bytes()).map_err(PackageError::from))?;
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
