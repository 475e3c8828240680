#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use recording::JOURNAL_FILE;
use std::fs;

#[test]
fn a_report_goes_beyond_a_journal_that_ends_before_it() {
    let summary = |ticks, outcome| Summary { ticks: Some(ticks), outcome, ..Summary::default() };
    let complete = Some(mission::Outcome::Complete);
    assert!(goes_beyond(&summary(9, complete), &summary(3, None)));
    assert!(goes_beyond(&summary(9, complete), &summary(9, None)));
    assert!(!goes_beyond(&summary(9, complete), &summary(9, complete)));
    assert!(!goes_beyond(&Summary::default(), &summary(3, None)));
}

fn write_report(folder: &Path, summary: &Summary) {
    RunFolder::take(folder).unwrap().write_report(summary).unwrap();
}

#[test]
fn what_cannot_be_recovered_is_refused_and_nothing_is_changed() {
    let logs = tempfile::tempdir().unwrap();
    let run = RunFolder::create(logs.path(), "demo", "rpf", 1).unwrap();
    let folder = run.path().to_owned();
    let refused = || recover(&folder, "L. Kern", |_| None).unwrap_err();
    fs::write(folder.join(JOURNAL_FILE), "").unwrap();
    let names = || {
        let mut names: Vec<_> =
            fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    };
    let before = names();
    assert!(refused().to_string().contains("is still being written; first end it"), "{}", refused());
    drop(run);
    assert!(refused().to_string().contains("there is nothing to recover, and the folder can be removed"));
    assert_eq!(names(), before);
    write_report(&folder, &Summary { events_sha256: Some("c10".into()), ..Summary::default() });
    assert!(refused().to_string().starts_with("the run has a report, so it was closed when it ended"));
    // A report that states that the run was not closed does not stop the recovery; the journal is read.
    write_report(&folder, &Summary::default());
    assert!(refused().to_string().contains("there is nothing to recover, and the folder can be removed"));
    let text = fs::read_to_string(folder.join("report.json")).unwrap();
    fs::write(folder.join("report.json"), text.replace("\"ticks\": null", "\"ticks\": 9")).unwrap();
    assert!(refused().to_string().contains("was changed after the run ended"), "{}", refused());
    fs::write(folder.join("report.json"), "{").unwrap();
    assert!(refused().to_string().contains("report.json is damaged"), "{}", refused());
    assert!(refused().is_input());
}
