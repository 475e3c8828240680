//! A disk that fails.

use crate::{events, synthetic};
use account::{Fold, Summary};
use mission::Event;
use recording::{Identity, JournalError, JournalWriter, Recorder, RecordingError, RunRecorder};
use std::{
    io::{self, Read, Write},
    sync::{
        Arc, Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    time::{Duration, Instant},
};

/// A disk with room for a number of bytes, which can change while the disk is written.
#[derive(Clone)]
struct SmallDisk {
    room: Arc<AtomicUsize>,
    written: Arc<Mutex<Vec<u8>>>,
}

impl SmallDisk {
    fn new(room: usize) -> Self {
        Self { room: Arc::new(AtomicUsize::new(room)), written: Arc::default() }
    }

    fn grow(&self, bytes: usize) {
        self.room.fetch_add(bytes, Ordering::Relaxed);
    }

    fn written(&self) -> Vec<u8> {
        self.written.lock().expect("not poisoned").clone()
    }
}

fn small_disk(bytes: usize) -> Box<dyn Write + Send> {
    Box::new(SmallDisk::new(bytes))
}

impl Write for SmallDisk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let room = self.room.load(Ordering::Relaxed);
        if room == 0 {
            return Err(io::Error::from(io::ErrorKind::StorageFull));
        }
        let written = bytes.len().min(room);
        self.room.fetch_sub(written, Ordering::Relaxed);
        self.written.lock().expect("not poisoned").extend_from_slice(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A file of which only the call with the number `fails_at` fails.
struct FaultyFile {
    calls: usize,
    fails_at: usize,
    /// The file accepts one in this many bytes of each call, like a disk that is nearly full.
    takes_one_of: usize,
    disk: SmallDisk,
    was_reached: Arc<AtomicUsize>,
}

impl FaultyFile {
    fn fault(&mut self) -> io::Result<()> {
        self.calls += 1;
        if self.calls == self.fails_at {
            self.was_reached.store(1, Ordering::Relaxed);
            return Err(io::Error::from(io::ErrorKind::StorageFull));
        }
        Ok(())
    }
}

impl Write for FaultyFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.fault()?;
        self.disk.write(&bytes[..bytes.len().div_ceil(self.takes_one_of)])
    }

    fn flush(&mut self) -> io::Result<()> {
        self.fault()
    }
}

/// Appends events that are a second apart; returns the errors on the way.
fn append_slowly(journal: &mut JournalWriter, events: &[Event], begin: Instant) -> Vec<JournalError> {
    let at = |index: usize| begin + Duration::from_secs(index as u64);
    events.iter().enumerate().filter_map(|(index, event)| journal.append(event, at(index)).err()).collect()
}

fn packed_to(out: Box<dyn Write + Send>, now: Instant) -> JournalWriter {
    JournalWriter::writing_to(out, now).expect("memory for the compressor")
}

/// The readable part of the lines in a file.
fn unpacked(bytes: &[u8]) -> Vec<u8> {
    let mut lines = Vec::new();
    let mut decoder = zstd::Decoder::new(bytes).expect("memory");
    // A file that stops within a frame gives an error after its readable part.
    let _ = decoder.read_to_end(&mut lines);
    lines
}

fn lines(events: &[Event]) -> Vec<u8> {
    let line = |event| serde_json::to_string(event).expect("an event is JSON") + "\n";
    events.iter().map(line).collect::<String>().into_bytes()
}

#[test]
fn a_call_that_fails_once_costs_the_journal_nothing_whichever_it_is() {
    let events = events(8);
    let whole = lines(&events);
    for fails_at in 1.. {
        let (disk, was_reached) = (SmallDisk::new(usize::MAX), Arc::new(AtomicUsize::new(0)));
        let file = FaultyFile {
            calls: 0,
            fails_at,
            takes_one_of: 2,
            disk: disk.clone(),
            was_reached: Arc::clone(&was_reached),
        };
        let begin = Instant::now();
        let mut journal = packed_to(Box::new(file), begin);
        let reported = append_slowly(&mut journal, &events, begin);
        // After a fault in the very last call, no further call can try again.
        match journal.finish() {
            Ok(end) => {
                assert_eq!(unpacked(&disk.written()), whole, "call {fails_at}");
                assert_eq!(end.bytes, disk.written().len() as u64);
            }
            Err(error) => assert!(matches!(error, JournalError::Write { .. }), "{error}"),
        }
        assert!(whole.starts_with(&unpacked(&disk.written())), "call {fails_at}");
        assert!(reported.len() <= 1, "call {fails_at}: {reported:?}");
        if was_reached.load(Ordering::Relaxed) == 0 {
            assert!(fails_at > 50, "so many calls are made");
            return;
        }
    }
}

#[test]
fn a_call_that_fails_once_costs_the_recording_nothing_whichever_it_is() {
    let (events, mut n_lost) = (events(3), 0);
    for fails_at in 1.. {
        let (disk, was_reached) = (SmallDisk::new(usize::MAX), Arc::new(AtomicUsize::new(0)));
        // The file takes whole messages: partial writes are tested with the journal, and each call needs a new recorder.
        let file = FaultyFile {
            calls: 0,
            fails_at,
            takes_one_of: 1,
            disk: disk.clone(),
            was_reached: Arc::clone(&was_reached),
        };
        let begin = Instant::now();
        let mut recorder =
            Recorder::writing_to(Box::new(file), &Identity::of_run("test"), begin).expect("opens");
        for event in &events {
            recorder.push(event, &Fold::new(), begin).expect("nothing is lost");
        }
        let path = tempfile::NamedTempFile::new().expect("a file");
        // After a fault in the very last call, no further call can try again; the fault is reported.
        match recorder.finish(&Summary::default(), None) {
            Ok(_) => {
                std::fs::write(path.path(), disk.written()).expect("writable");
                assert!(recording::inspect(path.path()).expect("readable").is_complete(), "call {fails_at}");
            }
            Err(error) => {
                assert!(matches!(error, RecordingError::Write { .. }), "{error}");
                n_lost += 1;
            }
        }
        assert!(n_lost <= 2, "call {fails_at}");
        if was_reached.load(Ordering::Relaxed) == 0 {
            assert!(fails_at > 50, "so many calls are made: {fails_at}");
            return;
        }
    }
}

#[test]
fn a_full_disk_is_reported_once_and_the_journal_is_not_whole() {
    let now = Instant::now();
    let mut journal = packed_to(small_disk(20_000), now);
    let events = events(3000);
    let errors: Vec<_> = events.iter().filter_map(|event| journal.append(event, now).err()).collect();
    assert_eq!(errors.len(), 1);
    assert!(matches!(errors[0], JournalError::Stalled { bytes: 20_000, .. }), "{}", errors[0]);
    let error = journal.finish().expect_err("it is not whole");
    assert!(matches!(error, JournalError::Write { bytes: 20_000, .. }), "{error}");
}

#[test]
fn a_disk_that_has_space_again_gives_a_whole_journal() {
    let begin = Instant::now();
    let disk = SmallDisk::new(2_000);
    let mut journal = packed_to(Box::new(disk.clone()), begin);
    let events = events(100);
    let reported = append_slowly(&mut journal, &events[..events.len() / 2], begin);
    assert_eq!(reported.len(), 1);
    assert!(journal.trouble().is_some());
    disk.grow(10_000_000);
    let later = begin + Duration::from_hours(1);
    journal.tick(later).expect("there is space again");
    assert_eq!(journal.trouble(), None);
    assert!(append_slowly(&mut journal, &events[events.len() / 2..], later).is_empty());
    journal.finish().expect("it is whole");
    assert_eq!(unpacked(&disk.written()), lines(&events));
}

#[test]
fn a_disk_that_stays_full_ends_the_journal_when_too_much_waits() {
    let begin = Instant::now();
    let mut journal = packed_to(small_disk(1000), begin);
    let events = events(30_000);
    let mut errors = Vec::new();
    // Up to 4 MB are kept. Writing is tried once a second; in between, thousands of events are kept.
    for (second, events) in events.chunks(5000).enumerate() {
        let now = begin + Duration::from_secs(second as u64);
        errors.extend(events.iter().filter_map(|event| journal.append(event, now).err()));
    }
    assert!(matches!(errors[..], [JournalError::Stalled { .. }, JournalError::Write { bytes: 1000, .. }]));
    assert!(journal.finish().is_err());
}

#[cfg(target_os = "linux")]
#[test]
fn the_journal_reports_the_message_of_the_system() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("linux has it");
    let mut journal = packed_to(Box::new(full), Instant::now());
    let later = Instant::now() + Duration::from_secs(1);
    let error = journal.append(&events(1)[0], later).expect_err("there is no room");
    assert!(error.to_string().contains("No space left on device"), "{error}");
}

#[test]
fn a_full_disk_is_reported_and_the_recording_is_not_whole() {
    let begin = Instant::now();
    let mut recorder =
        Recorder::writing_to(small_disk(300_000), &Identity::of_run("test"), begin).expect("opens");
    let health = recorder.health();
    for (index, event) in events(3000).iter().enumerate() {
        recorder
            .push(event, &Fold::new(), begin + Duration::from_millis(index as u64))
            .expect("it is kept in memory");
    }
    let until = Instant::now() + Duration::from_secs(20);
    while health.error().is_none() && Instant::now() < until {
        std::thread::yield_now();
    }
    assert!(matches!(recorder.trouble(), Some(RecordingError::Stalled { .. })));
    assert!(health.bytes() <= 300_000);
    assert!(recorder.finish(&Summary::default(), None).is_err(), "it is not whole");
    assert!(begin.elapsed() < Duration::from_secs(30));
}

#[test]
fn a_disk_that_has_space_again_gives_a_whole_recording() {
    let begin = Instant::now();
    let disk = SmallDisk::new(100_000);
    let mut recorder =
        Recorder::writing_to(Box::new(disk.clone()), &Identity::of_run("test"), begin).expect("opens");
    for event in events(1200) {
        recorder.push(&event, &Fold::new(), begin).expect("it is kept in memory");
    }
    disk.grow(100_000_000);
    recorder.finish(&Summary::default(), None).expect("it is whole");
    let path = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(path.path(), disk.written()).expect("writable");
    assert!(recording::inspect(path.path()).expect("readable").is_complete());
}

#[test]
fn a_recorder_is_dropped_soon_after_an_error() {
    let now = Instant::now();
    let mut recorder = Recorder::writing_to(small_disk(100), &Identity::of_run("test"), now).expect("opens");
    for event in events(700) {
        // Any event may meet the fault; this test is about the drop.
        let _ = recorder.push(&event, &Fold::new(), now);
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
    let error = finished.error.expect("it is reported");
    assert!(error.starts_with("the recording stopped: "), "{error}");
}

#[test]
fn the_recording_goes_on_when_the_journal_fails() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("recording.rrd");
    let now = Instant::now();
    let recorder = Recorder::create(&path, &Identity::of_run("test"), now).expect("a new file");
    let journal = packed_to(small_disk(1000), now);
    let run = RunRecorder::spawn(journal, Some(recorder)).expect("a thread");
    for events in synthetic::run(300) {
        run.send(events);
    }
    let finished = run.finish(Duration::from_secs(20));
    assert_eq!(finished.events_sha256, None);
    assert!(finished.error.expect("it is reported").starts_with("the journal stopped after"));
    assert!(recording::inspect(&path).expect("readable").is_complete());
}

#[test]
fn when_both_files_fail_both_are_reported() {
    let now = Instant::now();
    let recorder = Recorder::writing_to(small_disk(1000), &Identity::of_run("test"), now).expect("opens");
    let journal = packed_to(small_disk(1000), now);
    let run = RunRecorder::spawn(journal, Some(recorder)).expect("a thread");
    for events in synthetic::run(300) {
        run.send(events);
    }
    let error = run.finish(Duration::from_secs(20)).error.expect("it is reported");
    assert!(error.starts_with("the journal stopped after 1000 bytes: "), "{error}");
    assert!(error.contains("; the recording stopped: "), "{error}");
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
