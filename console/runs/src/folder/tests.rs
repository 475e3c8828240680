use super::*;
use crate::{
    report_file::{ReportFile, Reported, journal_doubt},
    standing::{Standing, standing},
};
use account::{Fold, Logs};
use mission::{Event, EventKind, Outcome};
use recording::{Finished, Options, PLAIN_JOURNAL_FILE, RunRecorder, events_sha256, sha256_of};
use std::time::{Duration, UNIX_EPOCH};

#[test]
fn a_folder_that_is_being_written_is_running_and_then_crashed() {
    let logs = tempfile::tempdir().unwrap();
    let folder = RunFolder::create(logs.path(), "demo tank/7", "rpf", 1).unwrap();
    let name = folder.path().file_name().unwrap().to_str().unwrap().to_owned();
    assert!(name.ends_with("-demo-tank-7-rpf-1"), "{name}");
    assert_eq!(standing(folder.path()), Standing::Running);
    let path = folder.path().to_path_buf();
    drop(folder);
    assert_eq!(standing(&path), Standing::JournalOnly { doubt: None, failure: None });
}

#[test]
fn two_runs_in_one_second_get_two_folders() {
    let logs = tempfile::tempdir().unwrap();
    let folders: Vec<RunFolder> =
        (0..3).map(|_| RunFolder::create(logs.path(), "demo", "rpf", 1).unwrap()).collect();
    assert_ne!(folders[0].path(), folders[1].path());
    assert_ne!(folders[1].path(), folders[2].path());
}

#[test]
fn the_latest_of_the_runs_of_one_second_is_the_one_that_began_last() {
    let logs = tempfile::tempdir().unwrap();
    let [first, last, second] = [("a", 1), ("b", 3), ("c", 2)].map(|(name, began_s)| {
        let folder = logs.path().join(format!("20261125T080000Z-{name}-rpf-1"));
        fs::create_dir(&folder).unwrap();
        fs::write(folder.join(JOURNAL_FILE), "").unwrap();
        let lock = File::create(folder.join(LOCK_FILE)).unwrap();
        lock.set_modified(UNIX_EPOCH + Duration::from_secs(began_s)).unwrap();
        folder
    });
    assert_eq!(past_runs(logs.path()).unwrap(), [first, second, last.clone()]);
    assert_eq!(find(Path::new("latest"), logs.path()).unwrap(), last);
}

#[test]
fn a_clock_out_of_range_is_clamped() {
    assert_eq!(utc(UNIX_EPOCH), "19700101T000000Z");
    assert_eq!(utc(UNIX_EPOCH - Duration::from_secs(1)), "19700101T000000Z");
    assert_eq!(utc(UNIX_EPOCH - Duration::from_secs(1 << 40)), "19700101T000000Z");
    let latest = utc(UNIX_EPOCH + Duration::from_secs(1 << 40));
    assert!(latest.starts_with("9999"), "{latest}");
}

/// A finished run of one event, in its own folder; also returns the result of the recorder and the summary.
fn ended(logs: &Path) -> (PathBuf, Finished, Summary) {
    let folder = RunFolder::create(logs, "demo", "rpf", 1).unwrap();
    let recorder = RunRecorder::start(folder.path(), Options { rrd: false, journal: true }).unwrap();
    let kind = EventKind::Ended { outcome: Outcome::Complete, reason: "all scanned".into() };
    let event = Event { tick: 7, t_s: 0.7, kind };
    recorder.send(vec![event.clone()]);
    let finished = recorder.finish(Duration::from_secs(20));
    let mut fold = Fold::new();
    fold.apply(&event);
    let logs = Logs { journal: None, recording: None, error: finished.error.clone(), is_open: false };
    let events_sha256 = finished.events_sha256.clone();
    let summary = Summary { events_sha256, logs: Some(logs), ..fold.summary() };
    folder.write_report(&summary).unwrap();
    (folder.path().to_owned(), finished, summary)
}

fn doubt(folder: &Path) -> String {
    match standing(folder) {
        Standing::JournalOnly { doubt: Some(doubt), .. } => doubt,
        other => panic!("{other:?}"),
    }
}

fn change(path: &Path, old: &str, new: &str) {
    let text = fs::read_to_string(path).unwrap();
    assert!(text.contains(old), "{text}");
    fs::write(path, text.replace(old, new)).unwrap();
}

#[test]
fn a_report_is_believed_as_long_as_it_fits_the_journal() {
    let logs = tempfile::tempdir().unwrap();
    let (folder, _, summary) = ended(logs.path());
    assert_eq!(standing(&folder), Standing::Ended(Box::new(summary.clone())));
    // The same bytes are written again, so that the newer file is hashed.
    let journal = folder.join(JOURNAL_FILE);
    fs::write(&journal, fs::read(&journal).unwrap()).unwrap();
    assert_eq!(standing(&folder), Standing::Ended(Box::new(summary)));
}

#[test]
fn a_changed_report_is_not_believed() {
    let logs = tempfile::tempdir().unwrap();
    let (folder, ..) = ended(logs.path());
    change(&folder.join(REPORT_FILE), "\"complete\"", "\"stuck\"");
    assert!(doubt(&folder).contains("was changed"), "{}", doubt(&folder));
}

#[test]
fn a_damaged_report_does_not_hide_the_journal() {
    let logs = tempfile::tempdir().unwrap();
    let (folder, ..) = ended(logs.path());
    fs::write(folder.join(REPORT_FILE), "{").unwrap();
    assert!(doubt(&folder).contains("damaged"), "{}", doubt(&folder));
    fs::write(folder.join(REPORT_FILE), [0xff, 0xfe]).unwrap();
    assert!(doubt(&folder).contains("cannot be read"), "{}", doubt(&folder));
}

#[test]
fn a_changed_journal_is_noticed_whatever_its_length() {
    let logs = tempfile::tempdir().unwrap();
    for new in ["all scanneD", "everything scanned"] {
        let (folder, ..) = ended(logs.path());
        let packed = fs::read(folder.join(JOURNAL_FILE)).unwrap();
        let plain = folder.join(PLAIN_JOURNAL_FILE);
        fs::write(&plain, zstd::decode_all(&packed[..]).unwrap()).unwrap();
        fs::remove_file(folder.join(JOURNAL_FILE)).unwrap();
        change(&plain, "all scanned", new);
        assert!(
            doubt(&folder).contains("the report was made from a different journal"),
            "{}",
            doubt(&folder)
        );
        assert_eq!(journal_doubt(&folder, events_sha256(&plain).ok().as_deref()), Some(doubt(&folder)));
    }
}

#[test]
fn a_lost_journal_is_noticed_and_the_run_still_listed() {
    let logs = tempfile::tempdir().unwrap();
    let (folder, ..) = ended(logs.path());
    fs::remove_file(folder.join(JOURNAL_FILE)).unwrap();
    assert!(doubt(&folder).contains("events.jsonl.zst cannot be read"), "{}", doubt(&folder));
    assert_eq!(past_runs(logs.path()).unwrap(), [folder]);
}

#[test]
fn a_run_whose_writer_failed_is_distinguished_from_one_that_was_killed() {
    let logs = tempfile::tempdir().unwrap();
    let (folder, _, summary) = ended(logs.path());
    fs::remove_file(folder.join(REPORT_FILE)).unwrap();
    fs::write(folder.join(FAILURE_FILE), "the disk is full\n").unwrap();
    let failure = Some("the disk is full".to_owned());
    assert_eq!(standing(&folder), Standing::JournalOnly { doubt: None, failure });
    // A run whose report could still be written.
    let (folder, ..) = ended(logs.path());
    let logs =
        Logs { journal: None, recording: None, error: Some("the disk is full".into()), is_open: false };
    let summary = Summary { events_sha256: None, logs: Some(logs), ..summary };
    fs::write(folder.join(REPORT_FILE), ReportFile::text("a", &summary, [None; 2], None).unwrap()).unwrap();
    assert_eq!(standing(&folder), Standing::NotRecorded(Box::new(summary), "the disk is full".into()));
}

#[test]
fn the_report_takes_the_space_that_was_reserved_for_it() {
    let logs = tempfile::tempdir().unwrap();
    let folder = RunFolder::create(logs.path(), "demo", "rpf", 1).unwrap();
    let draft = draft_of(&folder.path().join(REPORT_FILE));
    assert_eq!(fs::metadata(&draft).unwrap().len(), REPORT_RESERVE as u64);
    folder.write_report(&Summary::default()).unwrap();
    assert!(!draft.exists());
    let text = fs::read_to_string(folder.path().join(REPORT_FILE)).unwrap();
    assert_eq!(serde_json::from_str::<Summary>(&text).unwrap(), Summary::default());
}

#[test]
fn a_changed_figure_is_noticed_with_the_journal_and_without() {
    let logs = tempfile::tempdir().unwrap();
    let (folder, _, summary) = ended(logs.path());
    let figures = |summary: &Summary| Reported::read(&folder).unwrap().unwrap().figures_doubt(summary);
    assert_eq!(figures(&summary), None);
    change(&folder.join(REPORT_FILE), "\"holds\": 0", "\"holds\": 1");
    assert!(doubt(&folder).starts_with("report.json was changed after the run ended"), "{}", doubt(&folder));
    assert_eq!(
        figures(&summary).as_deref(),
        Some("report.json was changed: holds is 1; the journal gives 0")
    );
    let text = fs::read_to_string(folder.join(REPORT_FILE)).unwrap();
    let mut unsealed: Vec<&str> = text.lines().filter(|line| !line.contains("report_sha256")).collect();
    let last = unsealed.len() - 2;
    unsealed[last] = unsealed[last].trim_end_matches(',');
    fs::write(folder.join(REPORT_FILE), unsealed.join("\n")).unwrap();
    assert!(figures(&summary).is_some_and(|doubt| doubt.contains("its line report_sha256 is missing")));
    // A person who changes a figure may change the digest, too.
    let other = Summary { holds: 1, ..summary.clone() };
    let text = ReportFile::text("a", &other, [None; 2], None).unwrap();
    fs::write(folder.join(REPORT_FILE), text).unwrap();
    assert!(figures(&summary).is_some() && figures(&other).is_none());
}

#[test]
fn a_report_that_does_not_parse_is_no_report() {
    let logs = tempfile::tempdir().unwrap();
    let (folder, _, summary) = ended(logs.path());
    let file = folder.join(REPORT_FILE);
    let text = fs::read_to_string(&file).unwrap();
    for (before, after) in
        [("\"holds\": 0", "\"holds\": \"none\""), ("\"holds\": 0", "\"holds\": 0, \"holds\": 0")]
    {
        assert!(text.contains(before));
        fs::write(&file, text.replace(before, after)).unwrap();
        let doubt = Reported::read(&folder).unwrap().unwrap().figures_doubt(&summary);
        assert!(
            doubt.as_ref().is_some_and(|doubt| doubt.starts_with("report.json is damaged: ")),
            "{doubt:?}"
        );
    }
}

#[test]
fn a_pipe_in_place_of_a_report_is_named_and_not_waited_for() {
    let logs = tempfile::tempdir().unwrap();
    let (folder, ..) = ended(logs.path());
    let file = folder.join(REPORT_FILE);
    fs::remove_file(&file).unwrap();
    rustix::fs::mkfifoat(rustix::fs::CWD, &file, rustix::fs::Mode::from_raw_mode(0o600)).unwrap();
    assert!(doubt(&folder).contains("it is not a regular file"), "{}", doubt(&folder));
}

#[test]
fn the_digest_of_a_report_is_that_of_its_other_lines() {
    let text = ReportFile::text("a", &Summary::default(), [None; 2], None).unwrap();
    let (others, own): (Vec<&str>, Vec<&str>) =
        text.split_inclusive('\n').partition(|line| !line.contains("\"report_sha256\""));
    assert_eq!(own, [format!("  \"report_sha256\": \"{}\"\n", sha256_of(others.concat().as_bytes()))]);
}
