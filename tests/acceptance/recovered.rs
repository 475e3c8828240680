//! A run whose writer was killed is closed by a person, and can be used from then on.

use crate::{
    bench::{Bench, Ended, change_journal, journal_text, scenario},
    report_file::FACTS,
};
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
    assert!(
        page.contains("Killed, recovered") && page.contains("missing: the end of the mission"),
        "the page"
    );
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
        (end_of(1), "the journal holds everything up to T+0.0 s"),
        (end_of(60) - 20, "is cut off after"),
        (end_of(60), "the journal holds everything up to T+"),
        (text.len(), "the index of the recording"),
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
