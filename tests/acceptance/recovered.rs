//! A run whose writer was killed is closed by a person, and can be used from then on.

use crate::{
    bench::{Bench, Ended, change_journal, journal_text, scenario},
    report_file::FACTS,
};
use sha2::{Digest, Sha256};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// A killed scan: without its report, and with the temporary files of its writer.
fn killed(bench: &Bench) -> PathBuf {
    bench.fly(&scenario("cover-circle.toml"), &[]);
    let run = bench.runs().pop().unwrap();
    fs::rename(run.join("report.json"), bench.path().join("kept.json")).unwrap();
    fs::write(run.join("report.json.part"), vec![b'\n'; 256 << 10]).unwrap();
    fs::write(run.join(".recording-failed.reserve"), vec![b' '; 4096]).unwrap();
    run
}

/// Stops a journal in the middle of a block of its last frame.
fn cut_block(run: &Path) {
    let file = run.join("events.jsonl.zst");
    let bytes = fs::read(&file).unwrap();
    fs::write(&file, &bytes[..bytes.len() - bytes.len() / 50]).unwrap();
}

fn digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}

fn recover(bench: &Bench, run: &Path) -> Ended {
    bench.tankops(&["recover", run.to_str().unwrap(), "--by", "L. Kern"])
}

#[test]
fn a_killed_run_is_closed_once_and_then_signed_and_noticed_when_it_is_changed() {
    let bench = Bench::new();
    let run = killed(&bench);
    cut_block(&run);
    let name = run.to_str().unwrap();
    let (journal, recording) = (fs::read(run.join("events.jsonl.zst")), fs::read(run.join("recording.rrd")));
    let listed = |bench: &Bench| bench.tankops(&["runs", "--json"]).json();
    assert_eq!(listed(&bench)[0]["end"], "CRASHED");
    bench.file("facts.toml", FACTS);
    let facts = ["--inspection", "facts.toml", "--indications", "found.csv", "--sign", "L. Kern"];
    bench.file("found.csv", "t_s,kind\n60,pit\n");
    let sign = |file: &str| bench.tankops(&[&["report", name, "-o", file], &facts[..]].concat());
    let open = sign("a.html");
    assert!(open.code == Some(2) && open.err.contains("tankops recover"), "{open:?}");

    let closed = recover(&bench, &run);
    assert!(closed.code == Some(0) && closed.out.contains("the end of the mission: "), "{closed:?}");
    assert!(!run.join("report.json.part").exists() && !run.join(".recording-failed.reserve").exists());
    assert_eq!(fs::read(run.join("events.jsonl.zst")).unwrap(), journal.unwrap(), "the journal is as it was");
    assert_eq!(fs::read(run.join("recording.rrd")).unwrap(), recording.unwrap());
    let list = listed(&bench);
    assert_eq!(list[0]["end"], "RECOVERED");
    assert!(list[0]["note"].as_str().unwrap().starts_with("killed, recovered by L. Kern, "), "{list}");
    let again = recover(&bench, &run);
    assert!(again.code == Some(2) && again.err.contains("already recovered by L. Kern"), "{again:?}");
    let verified = bench.verify(&run, &["--from-journal"]);
    assert!(
        verified.code == Some(0)
            && verified.out.contains("equal: ")
            && verified.out.contains("recovered by L. Kern"),
        "{verified:?}"
    );
    let text = bench.tankops(&["report", name]);
    assert!(text.out.contains("recovered        by L. Kern"), "{text:?}");

    let signed = sign("a.html");
    assert!(signed.code == Some(0) && signed.out.contains("signed as revision A"), "{signed:?}");
    let page = fs::read_to_string(bench.path().join("a.html")).unwrap();
    assert!(page.contains("Recovered") && page.contains("missing: the end of the mission"), "the page");
    let rescan = bench.tankops(&["rescan", name, "-o", "again.toml"]);
    assert!([Some(0), Some(1)].contains(&rescan.code) && !rescan.out.contains("was killed"), "{rescan:?}");

    // The current file differs from the one that was recovered.
    cut_block(&run);
    let changed = bench.verify(&run, &["--from-journal"]);
    assert!(
        changed.code == Some(1) && changed.out.contains("the report was made from a different"),
        "{changed:?}"
    );
    assert!(
        listed(&bench)[0]["note"].as_str().unwrap().contains("the report was made from a different journal")
    );
}

#[test]
fn a_run_is_recovered_wherever_its_journal_stops() {
    let bench = Bench::new();
    let run = killed(&bench);
    let text = journal_text(&run);
    let end_of = |lines: usize| text.match_indices('\n').nth(lines - 1).unwrap().0 + 1;
    // The amount of journal that is present, and the message about it.
    let cases = [
        (end_of(1), "the journal holds everything up to T+00:00:00"),
        (end_of(60) - 20, "is cut off after"),
        (end_of(60), "the journal holds everything up to T+"),
        (text.len(), "missing:\n  wall-clock figures"),
    ];
    for (length, said) in cases {
        change_journal(&run, &text[..length]);
        let closed = recover(&bench, &run);
        assert!(closed.code == Some(0) && closed.out.contains(said), "{length}: {closed:?}");
        let is_whole = length == text.len();
        assert_eq!(closed.out.contains("the end of the mission"), !is_whole, "{length}: {closed:?}");
        let verified = bench.verify(&run, &["--from-journal"]);
        assert_eq!(verified.code, Some(0), "{length}: {verified:?}");
        let listed = bench.tankops(&["runs", "--json"]).json();
        assert_eq!(listed[0]["end"], if is_whole { "complete" } else { "RECOVERED" }, "{listed}");
        fs::remove_file(run.join("report.json")).unwrap();
    }
    change_journal(&run, "");
    let nothing = recover(&bench, &run);
    assert!(nothing.code == Some(2) && nothing.err.contains("there is nothing to recover"), "{nothing:?}");
    assert!(!run.join("report.json").exists());
}

/// A run whose recording was not closed in time: its report has no figures, and its recording and readings have no end.
fn not_closed(bench: &Bench) -> PathBuf {
    bench.fly(&scenario("inspect-circle.toml"), &[]);
    let run = bench.runs().pop().unwrap();
    let report = fs::read_to_string(run.join("report.json")).unwrap();
    let mut report: serde_json::Value = serde_json::from_str(&report).unwrap();
    let why = "the recording was not closed within 0.9 s; its end may be missing";
    report["logs"]["error"] = why.into();
    for key in ["events_sha256", "coverage", "floor", "readings", "readings_sha256", "tracking"] {
        report[key] = serde_json::Value::Null;
    }
    report["violations"] = serde_json::json!(["expected collisions_max = 0, actual no value"]);
    write_sealed(&run, &mut report);
    for name in ["recording.rrd", "readings.parquet"] {
        let bytes = fs::read(run.join(name)).unwrap();
        fs::write(run.join(name), &bytes[..bytes.len() / 2]).unwrap();
    }
    fs::write(run.join(".recording-failed.reserve"), vec![b' '; 4096]).unwrap();
    fs::write(run.join("recording-failed.txt"), why).unwrap();
    run
}

/// Writes a report with the digest of its lines.
fn write_sealed(run: &Path, report: &mut serde_json::Value) {
    report["report_sha256"] = "".into();
    let text = serde_json::to_string_pretty(&report).unwrap() + "\n";
    let lines = text.split_inclusive('\n').filter(|line| !line.contains("\"report_sha256\""));
    report["report_sha256"] = digest(lines.collect::<String>().as_bytes()).into();
    fs::write(run.join("report.json"), serde_json::to_string_pretty(&report).unwrap() + "\n").unwrap();
}

#[test]
fn a_run_whose_recording_was_not_closed_is_made_whole_from_its_journal() {
    let bench = Bench::new();
    let run = not_closed(&bench);
    let listed = |bench: &Bench| bench.tankops(&["runs", "--json"]).json()[0]["end"].clone();
    assert_eq!(listed(&bench), "RECORDING FAILED");
    let journal = fs::read(run.join("events.jsonl.zst")).unwrap();
    let closed = recover(&bench, &run);
    assert!(closed.code == Some(0) && closed.out.contains("nothing is missing"), "{closed:?}");
    assert_eq!(fs::read(run.join("events.jsonl.zst")).unwrap(), journal, "the journal is as it was");
    let mut left: Vec<String> = fs::read_dir(&run)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    left.sort();
    let whole = ["events.jsonl.zst", "readings.parquet", "recording.rrd", "report.json", "run.lock"];
    assert_eq!(left, whole);
    assert_eq!(listed(&bench), "complete");
    let report: serde_json::Value =
        serde_json::from_slice(&fs::read(run.join("report.json")).unwrap()).unwrap();
    assert!(report["floor"]["reachable"]["area_m2"].as_f64().unwrap() > 10.0, "{report}");
    assert_eq!(report["violations"], serde_json::json!([]));
    assert!(report["logs"]["error"].is_null(), "{report}");
    for (key, name) in [("recording_sha256", "recording.rrd"), ("readings_sha256", "readings.parquet")] {
        assert_eq!(report[key], digest(&fs::read(run.join(name)).unwrap()), "{name}");
    }
    assert!(report["planner_calls"]["step"].as_u64().unwrap() > 0, "the figures of the writer are kept");
    let verified = bench.verify(&run, &["--from-journal"]);
    assert!(verified.code == Some(0) && verified.out.contains("equal: "), "{verified:?}");
    // The readings are those of the run.
    let name = run.to_str().unwrap();
    let exported = bench.tankops(&["export", name, "--readings", "again.parquet"]);
    assert_eq!(exported.code, Some(0), "{exported:?}");
    assert_eq!(
        fs::read(run.join("readings.parquet")).unwrap(),
        fs::read(bench.path().join("again.parquet")).unwrap()
    );
    // It can be signed.
    bench.file("facts.toml", FACTS);
    let facts = ["-o", "a.html", "--inspection", "facts.toml", "--sign", "L. Kern"];
    let signed = bench.tankops(&[&["report", name], &facts[..]].concat());
    assert!(!signed.err.contains("recover") && !signed.err.contains("digest"), "{signed:?}");
    let again = recover(&bench, &run);
    assert!(again.code == Some(2) && again.err.contains("already recovered by L. Kern"), "{again:?}");
}

#[test]
fn a_report_that_goes_beyond_the_journal_is_kept_by_a_recovery() {
    let bench = Bench::new();
    let run = killed(&bench);
    // The disk was full for the journal, but the report was written to the space reserved for it.
    let report = fs::read_to_string(bench.path().join("kept.json")).unwrap();
    let mut report: serde_json::Value = serde_json::from_str(&report).unwrap();
    report["logs"]["error"] = "No space left on device (os error 28)".into();
    for key in ["events_sha256", "recording_sha256"] {
        report[key] = serde_json::Value::Null;
    }
    write_sealed(&run, &mut report);
    let before = fs::read(run.join("report.json")).unwrap();
    let text = journal_text(&run);
    let end = text.match_indices('\n').nth(59).unwrap().0 + 1;
    change_journal(&run, &text[..end]);
    let closed = recover(&bench, &run);
    assert!(
        closed.code == Some(0) && closed.out.contains("kept as report-before-recovery.json"),
        "{closed:?}"
    );
    assert_eq!(fs::read(run.join("report-before-recovery.json")).unwrap(), before);
    let verified = bench.verify(&run, &["--from-journal"]);
    assert_eq!(verified.code, Some(0), "{verified:?}");
}

#[test]
fn a_run_that_is_being_written_or_was_closed_is_not_recovered() {
    let bench = Bench::new();
    let run = killed(&bench);
    let writer = fs::File::open(run.join("run.lock")).unwrap();
    writer.lock().unwrap();
    let refused = recover(&bench, &run);
    assert!(refused.code == Some(2) && refused.err.contains("still being written"), "{refused:?}");
    drop(writer);
    fs::rename(bench.path().join("kept.json"), run.join("report.json")).unwrap();
    let refused = recover(&bench, &run);
    assert!(refused.code == Some(2) && refused.err.contains("nothing to recover"), "{refused:?}");
    for name in ["n.a.", "?"] {
        let refused = bench.tankops(&["recover", run.to_str().unwrap(), "--by", name]);
        assert!(refused.code == Some(2) && refused.err.contains("name of the person"), "{refused:?}");
    }
}
