//! Journals that were made to use up memory or time are refused early; valid journals of any length are read.

use crate::{events, synthetic};
use mission::{Event, EventKind, LogLine};
use recording::{
    JOURNAL_FILE, JournalError, JournalReader, JournalWriter, PLAIN_JOURNAL_FILE, Ticks, events_sha256,
    read_ending,
};
use std::{
    fs::{self, File},
    io::{BufWriter, Write},
    path::{Path, PathBuf},
    time::Instant,
};
use tempfile::{TempDir, tempdir};

/// The lines of a made-up run.
fn lines(ticks: u64) -> Vec<String> {
    events(ticks).iter().map(|event| serde_json::to_string(event).expect("JSON") + "\n").collect()
}

/// A journal made of lines, compressed in one piece as by `zstd`.
fn packed(lines: impl IntoIterator<Item = impl AsRef<[u8]>>) -> (TempDir, PathBuf) {
    let folder = tempdir().expect("a folder");
    let path = folder.path().join(JOURNAL_FILE);
    let mut packer = zstd::Encoder::new(File::create(&path).expect("a file"), 1).expect("a packer");
    for line in lines {
        packer.write_all(line.as_ref()).expect("room on the disk");
    }
    packer.finish().expect("room on the disk");
    (folder, path)
}

/// The number of events that can be read, and the error after them, if any.
fn read(path: &Path) -> (usize, Option<String>) {
    let mut reader = JournalReader::open(path).expect("a file");
    let mut n = 0;
    loop {
        match reader.next() {
            Some(Ok(_)) => n += 1,
            Some(Err(error)) => return (n, Some(error.to_string())),
            None => return (n, None),
        }
    }
}

fn refused(path: &Path, why: &str) -> usize {
    let (n, error) = read(path);
    assert!(error.as_ref().is_some_and(|error| error.contains(why)), "{why}: {error:?} after {n}");
    n
}

#[test]
fn a_line_that_is_there_millions_of_times_is_refused_within_its_tick() {
    let lines = lines(3);
    let last = lines.last().expect("a line").clone();
    let again = "{\"tick\":2,\"t_s\":0.2,\"event\":\"resumed\"}\n".repeat(1000);
    let (_folder, path) =
        packed(lines[..lines.len() - 1].iter().cloned().chain(vec![again; 300]).chain([last]));
    assert!(refused(&path, "tick 2 has more than 50000 lines") < 60_000);
}

#[test]
fn zeros_without_end_are_refused_by_every_reader() {
    let block = vec![0; 1 << 20];
    let (_folder, path) = packed(std::iter::repeat_n(&block, 300));
    assert_eq!(refused(&path, "unpack to more than"), 0);
    let (_folder, path) =
        packed([lines(1)[0].clone().into_bytes()].iter().chain(std::iter::repeat_n(&block, 300)));
    assert_eq!(refused(&path, "unpack to more than"), 1);
    assert!(events_sha256(&path).is_err_and(|error| error.to_string().contains("more than any run writes")));
    assert!(read_ending(&path).is_err());
}

#[test]
fn a_line_without_end_and_one_of_a_million_lists_are_refused() {
    let head = lines(1)[0].clone();
    let begin = r#"{"tick":1,"t_s":0.1,"event":"planner_logged","planner":"x","level":"info","message":""#;
    let folder = tempdir().expect("a folder");
    let path = folder.path().join(PLAIN_JOURNAL_FILE);
    let mut file = BufWriter::new(File::create(&path).expect("a file"));
    write!(file, "{head}{begin}").expect("room on the disk");
    let much = vec![b'a'; 1 << 20];
    (0..41).for_each(|_| file.write_all(&much).expect("room on the disk"));
    drop(file);
    assert_eq!(refused(&path, "longer than 40 MB"), 1);
    let of_lists = |key: &str| {
        format!("{head}{{\"tick\":1,\"t_s\":0.1,\"event\":\"{key}\":[{}[]]}}\n", "[],".repeat(2_000_000))
    };
    for key in ["drawn\",\"drawings", "covered\",\"runs", "planned\",\"cuts"] {
        fs::write(&path, of_lists(key)).expect("room on the disk");
        assert_eq!(refused(&path, "more values than any event"), 1);
    }
}

#[test]
fn time_does_not_go_back_and_a_run_is_opened_once() {
    let lines = lines(30);
    let later = lines.iter().position(|line| line.starts_with("{\"tick\":20,")).expect("a line");
    let (_folder, path) = packed(lines[..=later].iter().chain(&lines[1..]));
    assert_eq!(refused(&path, "time goes back"), later + 1);
    let (_folder, path) = packed(lines[..=later].iter().chain(&lines));
    assert_eq!(refused(&path, "is opened a second time"), later + 1);
}

#[test]
fn frames_without_anything_cost_no_memory_and_are_passed() {
    let mut bytes = zstd::encode_all(lines(20).concat().as_bytes(), 1).expect("packed");
    let empty = zstd::encode_all(&b""[..], 1).expect("packed");
    (0..100_000).for_each(|_| bytes.extend_from_slice(&empty));
    let folder = tempdir().expect("a folder");
    let path = folder.path().join(JOURNAL_FILE);
    fs::write(&path, bytes).expect("room on the disk");
    assert_eq!(read(&path), (events(20).len(), None));
}

/// A mission that is held for a day: only the time changes. No valid journal is more regular than this one.
#[test]
fn a_day_of_a_robot_that_stands_still_is_read() {
    const TICKS: u64 = 864_000;
    let run = synthetic::run(3);
    let folder = tempdir().expect("a folder");
    let path = folder.path().join(JOURNAL_FILE);
    let now = Instant::now();
    let mut journal = JournalWriter::create(&path, now).expect("a new file");
    run[0].iter().for_each(|event| journal.append(event, now).expect("room on the disk"));
    let still = |event: &&Event| matches!(event.kind, EventKind::Estimated { .. } | EventKind::Truth { .. });
    let still: Vec<EventKind> = run[1].iter().filter(still).map(|event| event.kind.clone()).collect();
    for tick in 1..TICKS {
        let t_s = (tick as f64).mul_add(1e5, 0.5).floor() / 1e6;
        for kind in &still {
            journal.append(&Event { tick, t_s, kind: kind.clone() }, now).expect("room on the disk");
        }
    }
    let end = run[2].last().expect("an end").kind.clone();
    journal
        .append(&Event { tick: TICKS, t_s: TICKS as f64 / 10.0, kind: end }, now)
        .expect("room on the disk");
    let sha256 = journal.finish().expect("room on the disk").events_sha256;
    let n = run[0].len() + still.len() * (TICKS as usize - 1) + 1;
    assert_eq!(read(&path), (n, None));
    assert_eq!(events_sha256(&path).expect("whole"), sha256);
    let ending = read_ending(&path).expect("readable").expect("an end");
    assert_eq!(ending.tick, TICKS);
    let end = JournalReader::open_end(&path).expect("a file").map(|event| event.expect("sound"));
    let of_end: Vec<Event> = end.collect();
    assert!(of_end.len() < 20_000 && of_end.last() == Some(&ending), "{}", of_end.len());
}

/// The text of an event in the log.
fn said(event: &Event) -> String {
    let stations = &[];
    event.log_line(stations).map(|LogLine { text, .. }| text).unwrap_or_default()
}

#[test]
fn texts_of_a_journal_are_plain_and_lines_that_are_compared_stay_as_they_are() {
    let mut run = events(3);
    let message = "a\u{1b}[2Jb\u{9b}c\u{202e}d\u{e0001}e".to_owned();
    let level = planner_api::LogLevel::Warn;
    run.insert(
        run.len() - 1,
        Event {
            tick: 2,
            t_s: 0.2,
            kind: EventKind::PlannerLogged { planner: "x".into(), level, message: message.clone() },
        },
    );
    if let EventKind::RunOpened(opened) = &mut run[0].kind {
        opened.scenario_toml.push_str("# \u{202e}\r\n");
        opened.world.stations[0].name = "A\u{202e}".into();
    }
    let lines = run.iter().map(|event| serde_json::to_string(event).expect("JSON") + "\n");
    let (_folder, path) = packed(lines);
    let read: Vec<Event> =
        JournalReader::open(&path).expect("a file").collect::<Result<_, _>>().expect("sound");
    let EventKind::RunOpened(opened) = &read[0].kind else { panic!("no opening") };
    assert_eq!(opened.world.stations[0].name, "A�");
    assert!(opened.scenario_toml.ends_with("# \u{202e}\r\n"), "its digest is that of the file");
    assert!(read.iter().map(said).any(|text| text.contains("a�[2Jb�c�d�e")));
    let mut ticks = Ticks::open(&path).expect("a journal");
    assert_eq!(ticks.opened().expect("opened").world.stations[0].name, "A\u{202e}");
    let mut messages = Vec::new();
    while let Some(tick) = ticks.next_tick().expect("sound") {
        messages.extend(tick.events().filter_map(|kind| match kind {
            EventKind::PlannerLogged { message, .. } => Some(message.clone()),
            _ => None,
        }));
    }
    assert!(messages.contains(&message));
}

#[test]
fn a_pipe_or_a_sparse_file_in_place_of_a_journal_is_refused_at_once() {
    let folder = tempdir().expect("a folder");
    let path = folder.path().join(JOURNAL_FILE);
    File::create(&path).and_then(|file| file.set_len(1 << 40)).expect("a sparse file");
    let refused =
        |path: &Path| JournalReader::open(path).err().map(|error| matches!(error, JournalError::Read { .. }));
    assert_eq!(refused(&path), Some(true));
    assert!(events_sha256(&path).is_err() && recording::sha256(&path).is_err());
    fs::remove_file(&path).expect("ours");
    assert!(std::process::Command::new("mkfifo").arg(&path).status().expect("mkfifo").success());
    assert_eq!(refused(&path), Some(true));
}
