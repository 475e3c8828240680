//! Complete, truncated and damaged journals.

use crate::events;
use mission::{Event, event::JOURNAL_VERSION};
use recording::{
    JOURNAL_FILE, JournalError, JournalReader, JournalWriter, PLAIN_JOURNAL_FILE, events_sha256, read_ending,
};
use std::{
    fs,
    io::Write,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};
use tempfile::{TempDir, tempdir};

/// A journal that a user has uncompressed.
fn written(ticks: u64) -> (TempDir, PathBuf) {
    let (folder, packed) = packed(ticks);
    let plain = folder.path().join(PLAIN_JOURNAL_FILE);
    let bytes = fs::read(packed).expect("readable");
    fs::write(&plain, zstd::decode_all(&bytes[..]).expect("whole frames")).expect("writable");
    (folder, plain)
}

/// A compressed journal whose events were written a quarter of a second apart.
fn packed(ticks: u64) -> (TempDir, PathBuf) {
    let folder = tempdir().expect("a folder");
    let path = folder.path().join(JOURNAL_FILE);
    let now = Instant::now();
    let mut journal = JournalWriter::create(&path, now).expect("a new file");
    for (index, event) in events(ticks).iter().enumerate() {
        journal.append(event, now + Duration::from_millis(250 * index as u64)).expect("room on the disk");
    }
    journal.finish().expect("room on the disk");
    (folder, path)
}

/// A journal in memory.
#[derive(Debug)]
pub(crate) struct Journal {
    pub events: Vec<Event>,
    pub truncated: Option<String>,
}

pub(crate) fn read_journal(path: &Path) -> Result<Journal, JournalError> {
    let mut reader = JournalReader::open(path)?;
    let events = reader.by_ref().collect::<Result<_, _>>()?;
    Ok(Journal { events, truncated: reader.truncated().map(str::to_owned) })
}

fn change(path: &Path, change: impl FnOnce(String) -> String) {
    let text = fs::read_to_string(path).expect("a text file");
    fs::write(path, change(text)).expect("writable");
}

#[test]
fn what_is_written_is_read_back() {
    for (_folder, path) in [written(200), packed(200)] {
        let journal = read_journal(&path).expect("a whole journal");
        assert_eq!(journal.events, events(200));
        assert_eq!(journal.truncated, None);
    }
}

#[test]
fn the_hash_is_that_of_the_lines() {
    let folder = tempdir().expect("a folder");
    let path = folder.path().join(JOURNAL_FILE);
    let now = Instant::now();
    let mut journal = JournalWriter::create(&path, now).expect("a new file");
    let mut unwritten = JournalWriter::unwritten(now);
    for event in events(50) {
        journal.append(&event, now).expect("room on the disk");
        unwritten.append(&event, now).expect("nothing to fail");
    }
    let end = journal.finish().expect("room on the disk");
    let bytes = fs::read(&path).expect("readable");
    let lines = zstd::decode_all(&bytes[..]).expect("whole frames");
    assert_eq!(end.events_sha256, recording::sha256_of(&lines));
    assert_eq!(end.events_sha256, events_sha256(&path).expect("readable"));
    assert_eq!(end.bytes, bytes.len() as u64);
    assert_eq!(unwritten.finish().expect("nothing to fail").events_sha256, end.events_sha256);
}

#[test]
fn a_line_that_was_cut_off_by_a_kill_is_left_out() {
    let (_folder, path) = written(20);
    let whole = read_journal(&path).expect("a whole journal").events;
    change(&path, |text| text[..text.len() - 10].to_owned());
    let journal = read_journal(&path).expect("a torn journal can be read");
    assert_eq!(journal.events, whole[..whole.len() - 1]);
    let truncated = journal.truncated.expect("it is reported");
    assert!(truncated.starts_with(&format!("line {}, the last one, is cut off", whole.len())), "{truncated}");
}

#[test]
fn a_journal_cut_anywhere_gives_a_beginning_of_the_run() {
    for (_folder, path) in [written(3), packed(30)] {
        let whole = read_journal(&path).expect("a whole journal").events;
        let bytes = fs::read(&path).expect("readable");
        let mut read = 0;
        for length in (0..bytes.len()).step_by(97) {
            fs::write(&path, &bytes[..length]).expect("writable");
            let journal = read_journal(&path).expect("a torn journal can be read");
            assert!(whole.starts_with(&journal.events), "cut at {length}");
            assert!(read <= journal.events.len(), "more bytes say more");
            read = journal.events.len();
        }
        assert!(read + 20 > whole.len(), "{read} of {}", whole.len());
    }
}

#[test]
fn a_journal_is_followed_while_it_is_written_and_a_torn_line_is_waited_for() {
    followed(written(3));
    followed(packed(30));
}

fn followed((_folder, path): (TempDir, PathBuf)) {
    let whole = read_journal(&path).expect("a whole journal").events;
    let bytes = fs::read(&path).expect("readable");
    let mut at = 10;
    fs::write(&path, &bytes[..at]).expect("writable");
    let writer = path.clone();
    // Each time that the reader reaches the end of the file, a few more bytes are written.
    let reader = JournalReader::follow(&path, move || {
        let next = (at + 97).min(bytes.len());
        let mut file = fs::OpenOptions::new().append(true).open(&writer).expect("it is there");
        file.write_all(&bytes[at..next]).expect("writable");
        at = next;
        at < bytes.len()
    });
    let read: Result<Vec<_>, _> = reader.expect("readable").collect();
    assert_eq!(read.expect("every line is whole in the end"), whole);
}

#[test]
fn damage_in_the_middle_is_reported_with_line_and_column() {
    let (_folder, path) = written(20);
    change(&path, |text| {
        let mut lines: Vec<_> = text.lines().map(str::to_owned).collect();
        lines[6] = lines[6].replacen(':', ";", 1);
        lines.join("\n") + "\n"
    });
    let error = read_journal(&path).expect_err("line 7 is damaged");
    let JournalError::Damaged { line: 7, column, .. } = &error else { panic!("{error}") };
    assert_eq!(*column, 8);
    assert!(error.to_string().starts_with("the journal is damaged at line 7, column 8 ("), "{error}");
}

#[test]
fn a_journal_of_another_version_is_refused_with_advice() {
    for other in [JOURNAL_VERSION - 1, 99] {
        let (_folder, path) = written(2);
        change(&path, |text| {
            let ours = format!("\"journal_version\":{JOURNAL_VERSION}");
            text.replacen(&ours, &format!("\"journal_version\":{other},\"something_new\":1"), 1)
        });
        let error = read_journal(&path).expect_err("another version");
        assert!(matches!(error, JournalError::OtherVersion { theirs, .. } if theirs == other), "{error}");
        assert!(
            error.to_string().contains(&format!("version {other}, but this tankops reads version")),
            "{error}"
        );
    }
}

#[test]
fn a_file_that_is_no_journal_is_refused() {
    let folder = tempdir().expect("a folder");
    let path = folder.path().join("events.jsonl");
    fs::write(&path, "{\"tick\":0}\n").expect("writable");
    assert!(matches!(read_journal(&path), Err(JournalError::NotAJournal { .. })));
}

#[test]
fn a_journal_is_never_written_over() {
    let (_folder, path) = packed(2);
    let before = fs::read(&path).expect("readable");
    let error = JournalWriter::create(&path, Instant::now()).err().expect("it exists");
    assert!(matches!(error, JournalError::Create { .. }));
    assert_eq!(fs::read(&path).expect("readable"), before);
}

#[test]
fn events_reach_the_system_after_half_a_second_also_when_nothing_happens() {
    let folder = tempdir().expect("a folder");
    let path = folder.path().join(JOURNAL_FILE);
    let begin = Instant::now();
    let mut journal = JournalWriter::create(&path, begin).expect("a new file");
    let events = events(2);
    journal.append(&events[1], begin).expect("room on the disk");
    journal.tick(begin + Duration::from_millis(400)).expect("room on the disk");
    assert_eq!(journal.written_bytes(), 0);
    journal.tick(begin + Duration::from_millis(500)).expect("room on the disk");
    let first = journal.written_bytes();
    assert_eq!(first, fs::metadata(&path).expect("it is there").len());
    assert!(first > 0);
    journal.append(&events[2], begin + Duration::from_millis(600)).expect("room on the disk");
    assert_eq!(journal.written_bytes(), first, "the deadline counts from the last write");
    journal.append(&events[2], begin + Duration::from_millis(1001)).expect("room on the disk");
    assert!(journal.written_bytes() > first, "a busy stream meets the deadline too");
}

fn read_lines(path: &Path) -> (Vec<Vec<u8>>, JournalReader) {
    let mut reader = JournalReader::open(path).expect("readable");
    let mut lines = Vec::new();
    while let Some(line) = reader.next_line().expect("nothing is damaged") {
        lines.push(line.raw.to_owned());
    }
    (lines, reader)
}

#[test]
fn every_line_comes_with_the_bytes_of_the_file() {
    let (_folder, path) = written(20);
    let (lines, reader) = read_lines(&path);
    let joined: Vec<u8> = lines.iter().flat_map(|line| [line, &b"\n"[..]].concat()).collect();
    assert_eq!(joined, fs::read(&path).expect("readable"));
    assert_eq!((reader.unended_bytes(), reader.truncated()), (0, None));
}

#[test]
fn unknown_keys_and_white_space_are_read_but_show_in_the_bytes() {
    let (_folder, path) = written(20);
    let (before, _) = read_lines(&path);
    change(&path, |text| text.replacen("}\n", ",\"tampered\":true}\n", 3).replacen("}\n{", "} \n{", 6));
    let (after, _) = read_lines(&path);
    assert_eq!(read_journal(&path).expect("it can be read").events, events(20));
    assert_eq!(before.len(), after.len());
    let changed = before.iter().zip(&after).filter(|(before, after)| before != after).count();
    assert_eq!(changed, 6, "three of them in both ways");
}

#[test]
fn bytes_after_the_last_newline_are_counted() {
    let (_folder, path) = written(5);
    change(&path, |text| text.trim_end().to_owned());
    let (lines, reader) = read_lines(&path);
    assert_eq!(reader.unended_bytes(), lines.last().expect("events").len() as u64);
    assert_eq!(lines.len(), events(5).len(), "the event itself is whole");
    assert!(reader.truncated().is_some(), "but the journal is not");
    change(&path, |text| text + "\n{\"tick\":");
    let (lines, reader) = read_lines(&path);
    assert_eq!((lines.len(), reader.unended_bytes()), (events(5).len(), 8));
}

#[test]
fn an_empty_journal_says_that_it_is_empty() {
    let (_folder, path) = written(1);
    change(&path, |_| String::new());
    let journal = read_journal(&path).expect("it can be read");
    assert_eq!(journal.events.len(), 0);
    assert_eq!(journal.truncated.as_deref(), Some("the journal is empty"));
}

#[test]
fn the_ending_is_read_from_the_end_alone() {
    let last = events(500).pop().expect("events");
    let (_folder, path) = packed(500);
    assert_eq!(read_ending(&path).expect("readable"), Some(last.clone()));
    let (_folder, path) = written(500);
    assert_eq!(read_ending(&path).expect("readable"), Some(last));
    change(&path, |text| text[..text.len() - 10].to_owned());
    assert_eq!(read_ending(&path).expect("readable"), None);
}

#[test]
fn damage_in_a_compressed_journal_is_reported_and_what_comes_before_is_read() {
    let (_folder, path) = packed(3000);
    let mut bytes = fs::read(&path).expect("readable");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x55;
    fs::write(&path, &bytes).expect("writable");
    let mut reader = JournalReader::open(&path).expect("readable");
    let read: Vec<_> = reader.by_ref().map_while(Result::ok).collect();
    assert!(events(3000).starts_with(&read) && read.len() > 1000, "{} events", read.len());
    let error = read_journal(&path).expect_err("it is damaged").to_string();
    assert!(error.contains("the journal is damaged at line"), "{error}");
}

#[test]
fn a_journal_is_opened_near_any_time_and_at_any_place() {
    let ticks = 4000;
    let all = events(ticks);
    let last_s = all.last().expect("events").t_s;
    for (_folder, path) in [written(ticks), packed(ticks)] {
        for from_s in [-1.0, 0.0, 0.1, 0.3 * last_s, last_s, 2.0 * last_s] {
            let reader = JournalReader::open_near(&path, from_s).expect("readable");
            let near: Vec<Event> = reader.collect::<Result<_, _>>().expect("nothing is damaged");
            let wanted = all.iter().filter(|event| event.t_s >= from_s);
            assert!(near.iter().filter(|event| event.t_s >= from_s).eq(wanted), "from {from_s}");
            let is_late = path.ends_with(JOURNAL_FILE) && from_s >= last_s;
            assert!(!is_late || near.len() < all.len() / 2, "{} of {} were read", near.len(), all.len());
        }
        let mut reader = JournalReader::open(&path).expect("readable");
        let mut read = 0;
        for skip in [0, 7, all.len() / 2, 1] {
            read += reader.by_ref().take(skip).count();
            let mut other = JournalReader::open_at(&path, reader.place()).expect("readable");
            assert_eq!(other.next().expect("an event").expect("not damaged"), all[read]);
        }
    }
}
