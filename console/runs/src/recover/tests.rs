#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use recording::JOURNAL_FILE;
use std::fs;

#[test]
fn what_cannot_be_recovered_is_refused_and_nothing_is_changed() {
    let logs = tempfile::tempdir().unwrap();
    let run = RunFolder::create(logs.path(), "demo", "rpf", 1).unwrap();
    let folder = run.path().to_owned();
    let refused = || recover(&folder, "L. Kern").unwrap_err();
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
    fs::write(folder.join("report.json"), r#"{"events_sha256": null}"#).unwrap();
    assert!(refused().to_string().starts_with("the run has a report, so it was closed when it ended"));
    fs::write(folder.join("report.json"), "{").unwrap();
    assert!(refused().to_string().contains("report.json is damaged"), "{}", refused());
    assert!(refused().is_input());
}
