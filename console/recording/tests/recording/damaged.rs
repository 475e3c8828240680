//! Damaged journals are read up to the damage or refused with a message, and never cause a panic.

use crate::{events, journal::read_journal};
use mutations::{mutated, mutations};
use proptest::prelude::*;
use recording::{JournalReader, JournalWriter, read_ending};
use std::{fs, time::Instant};

fn journal() -> Vec<u8> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("events.jsonl");
    let now = Instant::now();
    let mut journal = JournalWriter::create(&path, now).expect("a new file");
    for event in events(12) {
        journal.append(&event, now).expect("room on the disk");
    }
    journal.finish().expect("room on the disk");
    fs::read(&path).expect("readable")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_damaged_journal_is_read_as_far_as_it_goes_or_refused(damage in mutations()) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("events.jsonl");
        let bytes = mutated(&journal(), &damage);
        fs::write(&path, &bytes).expect("writable");
        // Reading line by line gives the same result as reading all events at once.
        let mut n_lines = 0;
        let by_lines = JournalReader::open(&path).and_then(|mut reader| {
            while let Some(line) = reader.next_line()? {
                n_lines += 1;
                let as_written = serde_json::from_slice::<mission::Event>(line.raw).ok();
                let is_plain = std::str::from_utf8(line.raw).is_ok_and(|raw| foreign::unplain(raw).is_none());
                assert!(as_written.as_ref() == Some(&line.event) || !is_plain, "{:?}", line.event);
            }
            Ok(())
        });
        match (by_lines, read_journal(&path)) {
            (Ok(()), Ok(journal)) => prop_assert_eq!(journal.events.len(), n_lines),
            (Err(one), Err(other)) => {
                prop_assert_eq!(one.to_string(), other.to_string());
                prop_assert!(one.to_string().contains("events.jsonl"), "{}", one);
            }
            (one, other) => prop_assert!(false, "{:?} by lines, {:?} at once", one, other.map(|_| ())),
        }
        let _ = read_ending(&path).expect("the file is there");
    }
}
