//! Reads packages.

use crate::{
    Fault, MOST_ENTRIES, PackageError, SUMS,
    header::{END_BYTES, Header, read_central, read_end},
};
use sha2::{Digest, Sha256};
use std::{
    collections::{BTreeMap, BTreeSet},
    io::{Read, Seek, SeekFrom},
};

/// The largest directory, and the largest list of digests, bytes.
const MOST_LIST_BYTES: u64 = 8 << 20;
/// Size of the pieces in which content is read, bytes.
const PIECE: usize = 1 << 16;

/// A package that is being read.
#[derive(Debug)]
pub struct Package<R> {
    input: R,
    entries: Vec<Entry>,
    /// The entries whose content does not have the checksum in their header, as far as they were read.
    miscounted: BTreeSet<String>,
}

/// An entry of a package.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// Its name.
    pub name: String,
    /// Length of its content, bytes.
    pub bytes: u64,
    begin: u64,
    crc: u32,
}

impl<R: Read + Seek> Package<R> {
    /// Opens a package and checks its form; the content is not read yet.
    ///
    /// # Errors
    /// The file cannot be read, or is not in the form in which [`crate::Writer`] writes packages.
    pub fn open(mut input: R) -> Result<Self, PackageError> {
        let length = input.seek(SeekFrom::End(0))?;
        let not_one = || {
            PackageError::Form("not a package of tankops, or only a part of one: the end of the file is missing or was changed".into())
        };
        let end_at = length.checked_sub(END_BYTES).ok_or_else(not_one)?;
        let end = read(&mut input, end_at, END_BYTES)?;
        let (count, bytes, at) = read_end(&end).ok_or_else(not_one)?;
        if at + bytes != end_at || count > MOST_ENTRIES || bytes > MOST_LIST_BYTES {
            return Err(not_one());
        }
        let directory = read(&mut input, at, bytes)?;
        let (mut rest, mut entries, mut names, mut next) = (&directory[..], Vec::new(), BTreeSet::new(), 0);
        while !rest.is_empty() {
            let (header, offset, after) = read_central(rest)?;
            rest = after;
            if !names.insert(header.name.to_ascii_lowercase()) {
                return Err(PackageError::Twice(header.name));
            }
            let begin = next + header.local_bytes();
            next = begin + u64::from(header.bytes);
            if begin - header.local_bytes() != u64::from(offset) || next > at {
                return Err(PackageError::Hidden(header.name));
            }
            let Header { name, crc, bytes } = header;
            entries.push(Entry { name, crc, bytes: u64::from(bytes), begin });
        }
        if entries.len() != count || next != at {
            return Err(PackageError::Form("bytes are hidden between the entries and the directory".into()));
        }
        for entry in &entries {
            let header = Header { name: entry.name.clone(), crc: entry.crc, bytes: entry.bytes as u32 };
            let begin = entry.begin - header.local_bytes();
            if read(&mut input, begin, header.local_bytes())? != header.local() {
                return Err(PackageError::Hidden(entry.name.clone()));
            }
        }
        Ok(Self { input, entries, miscounted: BTreeSet::new() })
    }

    /// The entries, in their order.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The content of an entry of at most this length; `None` without such an entry.
    ///
    /// # Errors
    /// The file cannot be read, or the entry is longer.
    pub fn content(&mut self, name: &str, most_bytes: u64) -> Result<Option<Vec<u8>>, PackageError> {
        let Some(entry) = self.entries.iter().find(|entry| entry.name == name) else { return Ok(None) };
        if entry.bytes > most_bytes {
            return Err(PackageError::TooLarge(format!("{name} is longer than {most_bytes} bytes")));
        }
        let (begin, bytes) = (entry.begin, entry.bytes);
        Ok(Some(read(&mut self.input, begin, bytes)?))
    }

    /// SHA-256 of each entry, hexadecimal, by name.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn digests(&mut self) -> Result<BTreeMap<String, String>, PackageError> {
        let mut digests = BTreeMap::new();
        for Entry { name, bytes, begin, crc } in &self.entries {
            self.input.seek(SeekFrom::Start(*begin))?;
            let (mut digest, mut left, mut piece) = (Sha256::new(), *bytes, vec![0; PIECE]);
            let mut checksum = crc32fast::Hasher::new();
            while left > 0 {
                let count = left.min(PIECE as u64) as usize;
                self.input.read_exact(&mut piece[..count])?;
                digest.update(&piece[..count]);
                checksum.update(&piece[..count]);
                left -= count as u64;
            }
            if checksum.finalize() != *crc {
                self.miscounted.insert(name.clone());
            }
            digests.insert(name.clone(), hex::encode(digest.finalize()));
        }
        Ok(digests)
    }

    /// Compares the digests of all entries with the list; empty if every entry is as listed.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn faults(&mut self, digests: &BTreeMap<String, String>) -> Result<Vec<Fault>, PackageError> {
        let Some(list) = self.content(SUMS, MOST_LIST_BYTES)? else { return Ok(vec![Fault::NoList]) };
        let list = String::from_utf8_lossy(&list);
        let (mut faults, mut listed) = (Vec::new(), BTreeMap::new());
        for (number, line) in (1..).zip(list.lines()) {
            let Some((sha256, name)) = line.split_once("  ").filter(|(sha256, _)| is_digest(sha256)) else {
                faults.push(Fault::Line(number));
                continue;
            };
            let name = foreign::plain_lines(name).into_owned();
            if listed.insert(name.clone(), sha256.to_owned()).is_some() {
                faults.push(Fault::ListedTwice(name));
            }
        }
        for (name, expected) in &listed {
            match digests.get(name) {
                None => faults.push(Fault::Missing(name.clone())),
                Some(found) if found == expected && self.miscounted.contains(name) => {
                    faults.push(Fault::Checksum(name.clone()));
                }
                Some(found) if found == expected => {}
                Some(found) => faults.push(Fault::Altered {
                    name: name.clone(),
                    expected: foreign::plain_lines(expected).into_owned(),
                    found: found.clone(),
                }),
            }
        }
        let is_added = |name: &&String| *name != SUMS && !listed.contains_key(*name);
        faults.extend(digests.keys().filter(is_added).cloned().map(Fault::Added));
        Ok(faults)
    }
}

fn is_digest(text: &str) -> bool {
    text.len() == 64 && text.bytes().all(|byte| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte))
}

fn read(input: &mut (impl Read + Seek), begin: u64, bytes: u64) -> Result<Vec<u8>, PackageError> {
    input.seek(SeekFrom::Start(begin))?;
    let mut content = vec![0; bytes as usize];
    input.read_exact(&mut content)?;
    Ok(content)
}
