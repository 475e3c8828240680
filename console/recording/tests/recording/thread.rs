//! The recorder's thread.

use crate::{events, synthetic};
use recording::{JournalWriter, Options, RunRecorder, inspect, read_journal};
use std::{
    io::{self, Write},
    sync::{Arc, Condvar, Mutex},
    time::{Duration, Instant},
};
use tempfile::tempdir;

#[test]
fn a_run_leaves_journal_recording_and_hash() {
    let folder = tempdir().expect("a folder");
    let recorder = RunRecorder::start(folder.path(), Options::default()).expect("new files");
    for events in synthetic::run(300) {
        recorder.send(events);
    }
    let finished = recorder.finish(Duration::from_secs(20));
    assert_eq!(finished.error, None);
    assert_eq!(finished.events_sha256.expect("a whole journal").len(), 64);
    let journal = read_journal(&finished.journal.expect("asked for")).expect("a whole journal");
    assert_eq!(journal.events, events(300));
    assert!(inspect(&finished.recording.expect("asked for")).expect("readable").is_complete());
}

#[test]
fn what_is_not_asked_for_is_not_written_but_the_hash_is_the_same() {
    let hash = |options| {
        let folder = tempdir().expect("a folder");
        let recorder = RunRecorder::start(folder.path(), options).expect("new files");
        for events in synthetic::run(20) {
            recorder.send(events);
        }
        let finished = recorder.finish(Duration::from_secs(20));
        (finished.events_sha256, std::fs::read_dir(folder.path()).expect("readable").count())
    };
    let (nothing, no_files) = hash(Options { rrd: false, journal: false });
    let (journal, one_file) = hash(Options { rrd: false, journal: true });
    assert_eq!((no_files, one_file), (0, 1));
    assert!(nothing.is_some());
    assert_eq!(nothing, journal);
}

#[test]
fn the_health_tells_bytes_and_that_nothing_waits() {
    let folder = tempdir().expect("a folder");
    let recorder = RunRecorder::start(folder.path(), Options::default()).expect("new files");
    for events in synthetic::run(100) {
        recorder.send(events);
    }
    let until = Instant::now() + Duration::from_secs(20);
    while (recorder.health().lag > 0 || recorder.health().journal_bytes == 0) && Instant::now() < until {
        std::thread::yield_now();
    }
    let health = recorder.health();
    assert_eq!((health.lag, &health.error), (0, &None));
    let on_disk = |name| std::fs::metadata(folder.path().join(name)).expect("it is there").len();
    assert!(health.journal_bytes > 0 && health.rrd_bytes > 0);
    assert!(health.journal_bytes <= on_disk("events.jsonl") && health.rrd_bytes <= on_disk("recording.rrd"));
}

/// A disk that answers only when it is let.
#[derive(Clone, Default)]
struct StuckDisk(Arc<(Mutex<bool>, Condvar)>);

impl StuckDisk {
    fn free(&self) {
        *self.0.0.lock().expect("not poisoned") = true;
        self.0.1.notify_all();
    }
}

impl Write for StuckDisk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let freed = self.0.0.lock().expect("not poisoned");
        drop(self.0.1.wait_while(freed, |freed| !*freed).expect("not poisoned"));
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_disk_that_does_not_answer_is_not_waited_for_longer_than_asked() {
    let disk = StuckDisk::default();
    let journal = JournalWriter::writing_to(Box::new(disk.clone()), Instant::now());
    let recorder = RunRecorder::spawn(journal, None).expect("a thread");
    recorder.send(events(50));
    let begin = Instant::now();
    let finished = recorder.finish(Duration::from_millis(200));
    assert!(begin.elapsed() < Duration::from_secs(2));
    let error = finished.error.expect("it is told");
    assert!(error.contains("was not closed within 0.2 s"), "{error}");
    disk.free();
}

#[test]
fn the_sender_waits_when_the_queue_is_full_and_nothing_is_lost() {
    let disk = StuckDisk::default();
    let journal = JournalWriter::writing_to(Box::new(disk.clone()), Instant::now());
    let recorder = Arc::new(RunRecorder::spawn(journal, None).expect("a thread"));
    let batches = 12_000;
    let big: Arc<[_]> = events(2).into();
    let sender = {
        let (recorder, big) = (Arc::clone(&recorder), Arc::clone(&big));
        std::thread::spawn(move || (0..batches).for_each(|_| recorder.send(Arc::clone(&big))))
    };
    let until = Instant::now() + Duration::from_secs(20);
    while recorder.health().lag < 8192 && Instant::now() < until {
        std::thread::yield_now();
    }
    assert!(!sender.is_finished(), "the sender waits for the disk");
    disk.free();
    sender.join().expect("the sender ends");
    let recorder = Arc::into_inner(recorder).expect("the sender is gone");
    let finished = recorder.finish(Duration::from_secs(20));
    let mut expected = JournalWriter::unwritten(Instant::now());
    for _ in 0..batches {
        big.iter().for_each(|event| expected.append(event, Instant::now()).expect("nothing to fail"));
    }
    assert_eq!(finished.events_sha256, Some(expected.finish().expect("nothing to fail").events_sha256));
}
