//! The recorder's thread.

use crate::{events, journal::read_journal, synthetic};
use recording::{FAILURE_FILE, JOURNAL_FILE, JournalWriter, Options, RunRecorder, inspect, recorded_failure};
use std::{
    fs,
    io::{self, Write},
    path::Path,
    sync::{Arc, Condvar, Mutex, mpsc},
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
        (finished.events_sha256, fs::read_dir(folder.path()).expect("readable").count())
    };
    let (nothing, no_files) = hash(Options { rrd: false, journal: false });
    let (journal, one_file) = hash(Options { rrd: false, journal: true });
    assert_eq!((no_files, one_file), (0, 1));
    assert!(nothing.is_some());
    assert_eq!(nothing, journal);
}

#[test]
fn a_flushed_journal_has_every_event_that_was_sent_before() {
    let folder = tempdir().expect("a folder");
    let recorder = RunRecorder::start(folder.path(), Options::default()).expect("new files");
    for events in synthetic::run(7) {
        recorder.send(events);
    }
    let (done, answered) = mpsc::channel();
    recorder.flush(done);
    answered.recv_timeout(Duration::from_secs(20)).expect("an answer");
    // A stopped process writes nothing more: the file is read as it is now.
    let journal = read_journal(&folder.path().join(JOURNAL_FILE)).expect("readable");
    assert_eq!(journal.events, events(7));
}

#[test]
fn the_health_reports_bytes_and_that_nothing_waits() {
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
    let on_disk = |name| fs::metadata(folder.path().join(name)).expect("it is there").len();
    assert!(health.journal_bytes > 0 && health.rrd_bytes > 0);
    assert!(
        health.journal_bytes <= on_disk("events.jsonl.zst") && health.rrd_bytes <= on_disk("recording.rrd")
    );
}

/// A disk that blocks every write until it is freed.
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
    let recorder = RunRecorder::spawn(journal.expect("memory"), None).expect("a thread");
    recorder.send(events(50));
    let begin = Instant::now();
    let finished = recorder.finish(Duration::from_millis(200));
    assert!(begin.elapsed() < Duration::from_secs(2));
    let error = finished.error.expect("it is reported");
    assert!(error.contains("was not closed within 0.2 s"), "{error}");
    disk.free();
}

#[test]
fn the_sender_waits_when_the_queue_is_full_and_nothing_is_lost() {
    let disk = StuckDisk::default();
    let journal = JournalWriter::writing_to(Box::new(disk.clone()), Instant::now());
    let recorder = Arc::new(RunRecorder::spawn(journal.expect("memory"), None).expect("a thread"));
    let batches = 12_000;
    // The beginning of a run takes long to process, but the queue must be filled by the later events.
    let big: Arc<[_]> = events(3).split_off(1).into();
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

/// Waits until the health reports an error; returns the error and the time that this took.
fn noticed(recorder: &RunRecorder) -> (String, Duration) {
    let begin = Instant::now();
    loop {
        if let Some(error) = recorder.health().error {
            return (error, begin.elapsed());
        }
        assert!(begin.elapsed() < Duration::from_secs(10), "it is never noticed");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn recorder_with_events(folder: &Path) -> RunRecorder {
    let recorder = RunRecorder::start(folder, Options::default()).expect("new files");
    for events in synthetic::run(20) {
        recorder.send(events);
    }
    // Wait until some data has been written, so that the file can be truncated.
    std::thread::sleep(Duration::from_millis(800));
    assert_eq!(recorder.health().error, None);
    recorder
}

/// A change that another program makes to the folder of a run.
type Change = fn(&Path);

#[test]
fn what_happens_to_the_files_is_noticed_within_a_second_also_while_nothing_is_written() {
    let changes: [(&str, Change); 5] = [
        ("the journal on disk differs from what was written: the file was deleted or moved", |folder| {
            fs::remove_dir_all(folder).expect("ours");
        }),
        ("the journal on disk differs from what was written: the file was deleted or moved", |folder| {
            fs::remove_file(folder.join("events.jsonl.zst")).expect("ours");
        }),
        ("the recording on disk differs from what was written: the file was deleted or moved", |folder| {
            fs::remove_file(folder.join("recording.rrd")).expect("ours");
        }),
        ("the journal on disk differs from what was written: the file was replaced", |folder| {
            fs::rename(folder, folder.with_extension("old")).expect("ours");
            fs::create_dir(folder).expect("ours");
            fs::copy(folder.with_extension("old").join("events.jsonl.zst"), folder.join("events.jsonl.zst"))
                .expect("ours");
        }),
        ("the journal on disk differs from what was written: the file has 0 bytes", |folder| {
            drop(fs::File::create(folder.join("events.jsonl.zst")).expect("ours"));
        }),
    ];
    for (sentence, change) in changes {
        let logs = tempdir().expect("a folder");
        let folder = logs.path().join("run");
        fs::create_dir(&folder).expect("a folder");
        let recorder = recorder_with_events(&folder);
        change(&folder);
        let (error, after) = noticed(&recorder);
        assert!(error.starts_with(sentence), "{error}");
        assert!(after < Duration::from_secs(1), "{after:?}");
        let finished = recorder.finish(Duration::from_secs(20));
        // The end of the journal makes an emptied file longer again, but the lost data stays lost.
        let sentence = sentence.split_once(" the file has 0").map_or(sentence, |(sentence, _)| sentence);
        let error = finished.error.expect("it is still so");
        assert!(error.starts_with(sentence), "{error}");
        assert_eq!(finished.events_sha256.is_some(), sentence.starts_with("the recording"));
    }
}

#[test]
fn a_change_is_noticed_while_events_come_in() {
    let logs = tempdir().expect("a folder");
    let folder = logs.path().join("run");
    fs::create_dir(&folder).expect("a folder");
    let recorder = recorder_with_events(&folder);
    fs::remove_dir_all(&folder).expect("ours");
    let begin = Instant::now();
    while recorder.health().error.is_none() && begin.elapsed() < Duration::from_secs(5) {
        recorder.send(events(1));
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(begin.elapsed() < Duration::from_secs(1), "{:?}", begin.elapsed());
}

#[test]
fn a_folder_that_comes_back_is_whole_again() {
    let logs = tempdir().expect("a folder");
    let folder = logs.path().join("run");
    fs::create_dir(&folder).expect("a folder");
    let recorder = recorder_with_events(&folder);
    let elsewhere = logs.path().join("elsewhere");
    fs::rename(&folder, &elsewhere).expect("ours");
    noticed(&recorder);
    fs::rename(&elsewhere, &folder).expect("ours");
    let until = Instant::now() + Duration::from_secs(10);
    while recorder.health().error.is_some() && Instant::now() < until {
        std::thread::sleep(Duration::from_millis(5));
    }
    let finished = recorder.finish(Duration::from_secs(20));
    assert_eq!(finished.error, None);
    assert!(finished.events_sha256.is_some());
    assert_eq!(recorded_failure(&folder), None);
}

#[test]
fn a_failure_leaves_a_sign_in_the_folder_and_a_whole_run_none() {
    let names = |folder: &Path| {
        let entries = fs::read_dir(folder).expect("readable");
        let mut names: Vec<_> = entries.map(|entry| entry.expect("readable").file_name()).collect();
        names.sort();
        names
    };
    let folder = tempdir().expect("a folder");
    let recorder = recorder_with_events(folder.path());
    assert_eq!(recorder.finish(Duration::from_secs(20)).error, None);
    assert_eq!(names(folder.path()), ["events.jsonl.zst", "recording.rrd"]);
    let folder = tempdir().expect("a folder");
    let recorder = recorder_with_events(folder.path());
    fs::remove_file(folder.path().join("recording.rrd")).expect("ours");
    let (error, _) = noticed(&recorder);
    // The report is then on disk, even if the process is killed later.
    let until = Instant::now() + Duration::from_secs(1);
    while recorded_failure(folder.path()).is_none() && Instant::now() < until {
        std::thread::yield_now();
    }
    assert_eq!(recorded_failure(folder.path()), Some(error));
    recorder.finish(Duration::from_secs(20));
    assert_eq!(names(folder.path()), ["events.jsonl.zst", FAILURE_FILE]);
}
