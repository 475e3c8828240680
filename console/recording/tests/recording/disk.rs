//! A disk that fails.

use crate::{events, synthetic};
use recording::{Identity, JournalError, JournalWriter, Recorder, RecordingError, RunRecorder};
use std::{
    io::{self, Write},
    time::{Duration, Instant},
};

/// A disk with room for so many bytes.
struct SmallDisk {
    left: usize,
}

fn small_disk(bytes: usize) -> Box<dyn Write + Send> {
    Box::new(SmallDisk { left: bytes })
}

impl Write for SmallDisk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.left == 0 {
            return Err(io::Error::from(io::ErrorKind::StorageFull));
        }
        let written = bytes.len().min(self.left);
        self.left -= written;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_stops_the_journal_and_is_told_once() {
    let now = Instant::now();
    let mut journal = JournalWriter::writing_to(small_disk(200_000), now);
    let events = events(3000);
    let errors: Vec<_> = events.iter().filter_map(|event| journal.append(event, now).err()).collect();
    assert_eq!(errors.len(), 1);
    assert!(matches!(errors[0], JournalError::Write { bytes, .. } if bytes > 60_000), "{}", errors[0]);
    assert_eq!(journal.finish().expect_err("it is not whole"), errors[0]);
}

#[cfg(target_os = "linux")]
#[test]
fn the_journal_tells_the_words_of_the_system() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("linux has it");
    let mut journal = JournalWriter::writing_to(Box::new(full), Instant::now());
    let later = Instant::now() + Duration::from_secs(1);
    let error = journal.append(&events(1)[0], later).expect_err("there is no room");
    assert!(error.to_string().contains("No space left on device"), "{error}");
}

#[test]
fn a_full_disk_stops_the_recording_and_is_told_once() {
    let begin = Instant::now();
    let mut recorder =
        Recorder::writing_to(small_disk(300_000), &Identity::of_run("test"), begin).expect("opens");
    let health = recorder.health();
    let mut errors = Vec::new();
    for (index, event) in events(3000).iter().enumerate() {
        errors.extend(recorder.push(event, begin + Duration::from_millis(index as u64)).err());
    }
    assert_eq!(errors.len(), 1, "{errors:?}");
    assert!(matches!(errors[0], RecordingError::Write { .. }));
    assert!(health.bytes() <= 300_000);
    assert!(recorder.finish().is_err(), "it is not whole");
    assert!(begin.elapsed() < Duration::from_secs(30));
}

#[test]
fn a_recorder_is_dropped_soon_after_an_error() {
    let now = Instant::now();
    let mut recorder = Recorder::writing_to(small_disk(100), &Identity::of_run("test"), now).expect("opens");
    for event in events(700) {
        // Whichever event it hits: the drop is what counts here.
        let _ = recorder.push(&event, now);
    }
    let begin = Instant::now();
    drop(recorder);
    assert!(begin.elapsed() < Duration::from_secs(2));
}

#[test]
fn the_mission_goes_on_when_the_recording_fails_and_the_journal_is_whole() {
    let now = Instant::now();
    let recorder = Recorder::writing_to(small_disk(300_000), &Identity::of_run("test"), now).expect("opens");
    let run = RunRecorder::spawn(JournalWriter::unwritten(now), Some(recorder)).expect("a thread");
    for events in synthetic::run(2000) {
        run.send(events);
    }
    let finished = run.finish(Duration::from_secs(20));
    assert!(finished.events_sha256.is_some());
    let error = finished.error.expect("it is told");
    assert!(error.starts_with("the recording stopped: "), "{error}");
}

#[test]
fn the_recording_goes_on_when_the_journal_fails() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("recording.rrd");
    let now = Instant::now();
    let recorder = Recorder::create(&path, &Identity::of_run("test"), now).expect("a new file");
    let journal = JournalWriter::writing_to(small_disk(1000), now);
    let run = RunRecorder::spawn(journal, Some(recorder)).expect("a thread");
    for events in synthetic::run(300) {
        run.send(events);
    }
    let finished = run.finish(Duration::from_secs(20));
    assert_eq!(finished.events_sha256, None);
    assert!(finished.error.expect("it is told").starts_with("the journal stopped after"));
    assert!(recording::inspect(&path).expect("readable").is_complete());
}

#[test]
fn a_recording_is_never_written_over() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("recording.rrd");
    std::fs::write(&path, "precious").expect("writable");
    let error = Recorder::create(&path, &Identity::of_run("test"), Instant::now()).err().expect("it exists");
    assert!(matches!(error, RecordingError::Create { .. }));
    assert_eq!(std::fs::read(&path).expect("readable"), b"precious");
}
