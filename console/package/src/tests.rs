#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use header::{Header, end};
use proptest::prelude::*;
use std::io::Cursor;

fn packed(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut writer = Writer::new(Cursor::new(Vec::new()));
    for (name, content) in files {
        writer.add(name, *content).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

/// A ZIP file with these entries, whatever their names, without a list unless one is given.
fn forged(files: &[(&str, &[u8])]) -> Vec<u8> {
    let (mut out, mut directory) = (Vec::new(), Vec::new());
    for (name, content) in files {
        let header =
            Header { name: (*name).into(), crc: crc32fast::hash(content), bytes: content.len() as u32 };
        directory.extend(header.central(out.len() as u32));
        out.extend(header.local());
        out.extend(*content);
    }
    let end = end(files.len() as u16, directory.len() as u32, out.len() as u32);
    [out, directory, end].concat()
}

fn faults(bytes: &[u8]) -> Vec<String> {
    let mut package = Package::open(Cursor::new(bytes)).unwrap();
    let digests = package.digests().unwrap();
    package.faults(&digests).unwrap().iter().map(ToString::to_string).collect()
}

fn refused(bytes: &[u8]) -> String {
    Package::open(Cursor::new(bytes)).map(|_| ()).unwrap_err().to_string()
}

const FILES: [(&str, &[u8]); 3] =
    [("report.html", b"<page>"), ("readings/a.parquet", &[0, 159, 1]), ("empty", b"")];

#[test]
fn a_package_holds_its_files_and_a_list_that_sha256sum_reads() {
    let bytes = packed(&FILES);
    assert_eq!(faults(&bytes), [""; 0]);
    assert_eq!(bytes, packed(&FILES), "the same files give the same package");
    let mut package = Package::open(Cursor::new(&bytes)).unwrap();
    assert_eq!(package.content("report.html", 100).unwrap().as_deref(), Some(&b"<page>"[..]));
    assert!(package.content("report.html", 3).unwrap_err().to_string().contains("longer than 3 bytes"));
    let list = String::from_utf8(package.content(SUMS, 1000).unwrap().unwrap()).unwrap();
    let empty = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855  empty";
    assert_eq!(list.lines().next(), Some(empty));
    assert_eq!(list.lines().count(), 3);
}

#[test]
fn altered_missing_added_and_doubled_entries_are_named() {
    let list = |bytes: &[u8]| {
        let mut package = Package::open(Cursor::new(bytes)).unwrap();
        package.content(SUMS, 1000).unwrap().unwrap()
    };
    let sums = list(&packed(&FILES));
    let with = |files: &[(&str, &[u8])]| forged(&[files, &[(SUMS, &sums[..])]].concat());
    assert_eq!(faults(&with(&FILES)), [""; 0]);
    let altered = faults(&with(&[("report.html", b"<forged>"), FILES[1], FILES[2]]));
    assert!(
        altered.len() == 1 && altered[0].starts_with("report.html was altered: expected SHA-256"),
        "{altered:?}"
    );
    assert_eq!(faults(&with(&FILES[1..])), ["report.html is missing"]);
    let added = with(&[FILES[0], FILES[1], FILES[2], ("more.txt", b"x")]);
    assert_eq!(faults(&added), ["more.txt was added: SHA256SUMS does not list it"]);
    let twice = with(&[FILES[0], FILES[1], FILES[2], ("Report.HTML", b"x")]);
    assert_eq!(refused(&twice), "entry Report.HTML is in the package twice");
    assert_eq!(faults(&forged(&FILES)), ["SHA256SUMS is missing, so nothing can be checked"]);
    let doubled = [&sums[..], &sums[..]].concat();
    let doubled = faults(&forged(&[FILES[0], FILES[1], FILES[2], (SUMS, &doubled)]));
    assert!(doubled.contains(&"SHA256SUMS lists empty twice".to_owned()), "{doubled:?}");
    let broken = faults(&forged(&[(SUMS, b"no digest\n")]));
    assert_eq!(broken, ["SHA256SUMS cannot be read: line 1 is not a digest, two spaces and a name"]);
}

#[test]
fn names_that_lead_out_of_the_folder_are_refused() {
    for name in ["../evil", "/etc/cron.d/evil", "a/../../evil", "C:\\evil", "a\u{202e}b", "a//b", "."] {
        let why = refused(&forged(&[(name, b"x")]));
        assert!(why.contains("has a name that packages do not use") && !why.contains('\u{202e}'), "{why}");
        assert!(Writer::new(Cursor::new(Vec::new())).add(name, &b"x"[..]).is_err());
    }
}

#[test]
fn compressed_entries_and_shared_bytes_are_refused_without_unpacking() {
    let mut bytes = packed(&[("bomb", b"xx")]);
    let central = bytes.windows(4).position(|word| word == [0x50, 0x4b, 1, 2]).unwrap();
    bytes[central + 10] = 8;
    assert!(refused(&bytes).starts_with("entry bomb is compressed or encrypted"), "{}", refused(&bytes));
    // Two entries that share one content: the directory lists the second at the place of the first.
    let header = |name: &str| Header { name: name.into(), crc: 0, bytes: 0 };
    let (one, other) = (header("a"), header("b"));
    let directory = [one.central(0), other.central(0)].concat();
    let end = end(2, directory.len() as u32, one.local().len() as u32);
    assert!(refused(&[one.local(), directory, end].concat()).starts_with("entry b does not follow"));
}

#[test]
fn a_checksum_that_is_not_that_of_the_content_is_named() {
    let bytes = packed(&FILES);
    let crc = crc32fast::hash(FILES[0].1).to_le_bytes();
    let mut altered = bytes.clone();
    let places: Vec<usize> = (0..bytes.len() - 4).filter(|at| bytes[*at..at + 4] == crc).collect();
    assert_eq!(places.len(), 2, "in both headers");
    for at in places {
        altered[at] ^= 1;
    }
    let named = format!("the header of {} was altered: its CRC-32 is not that of the content", FILES[0].0);
    assert_eq!(faults(&altered), [named]);
}

#[test]
fn bytes_that_no_entry_holds_are_refused() {
    let bytes = packed(&FILES);
    for forged in [[&b"#!/bin/sh\n"[..], &bytes].concat(), [&bytes[..], b"more"].concat()] {
        refused(&forged);
    }
    // A local header that names another file than the directory.
    let mut renamed = bytes.clone();
    renamed[30] = b'R';
    assert_eq!(
        refused(&renamed),
        "entry report.html does not follow the entry before it; bytes are hidden, missing or shared"
    );
    assert!(refused(b"").contains("not a package of tankops"));
}

proptest! {
    #[test]
    fn no_change_of_a_byte_goes_unnoticed_or_panics(at in 0..1000_usize, to in any::<u8>()) {
        let bytes = packed(&FILES);
        let mut changed = bytes.clone();
        let at = at % bytes.len();
        changed[at] = to;
        if let Ok(mut package) = Package::open(Cursor::new(&changed)) {
            let digests = package.digests().unwrap();
            let faults = package.faults(&digests).unwrap();
            prop_assert!(changed == bytes || !faults.is_empty(), "byte {} became {}", at, to);
        }
    }

    #[test]
    fn any_bytes_are_refused_or_read_without_a_panic(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        if let Ok(mut package) = Package::open(Cursor::new(&bytes)) {
            let digests = package.digests().unwrap();
            let _ = package.faults(&digests).unwrap();
        }
    }

    #[test]
    fn a_shortened_package_is_refused(cut in 1..400_usize) {
        let bytes = packed(&FILES);
        let left = bytes.len().saturating_sub(cut);
        prop_assert!(Package::open(Cursor::new(&bytes[..left])).is_err());
    }
}

#[test]
fn the_digest_of_a_content_is_that_of_its_entry() {
    let mut writer = Writer::new(Cursor::new(Vec::new()));
    let entry = writer.add("a.txt", &b"seen"[..]).unwrap();
    let alone = sha256_of(|sink| sink.write_all(b"seen")).unwrap();
    assert_eq!(entry, alone);
    assert!(sha256_of(|_| Err("no content")).is_err());
}
