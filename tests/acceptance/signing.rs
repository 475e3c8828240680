//! What must not be signed, and what is said of a run after it was signed.

use crate::{
    bench::{Bench, Ended, change_journal, journal_text, scenario},
    report_file::FACTS,
};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// A scan, and the facts that its report needs.
fn scanned(bench: &Bench) -> PathBuf {
    bench.fly(&scenario("cover-circle.toml"), &[]);
    bench.file("facts.toml", FACTS);
    bench.file("found.csv", "t_s,kind\n60,=1+1\n");
    bench.runs().pop().unwrap()
}

fn sign(bench: &Bench, run: &Path, file: &str) -> Ended {
    let facts = ["--inspection", "facts.toml", "--indications", "found.csv", "--sign", "L. Kern"];
    bench.tankops(&[&["report", run.to_str().unwrap(), "-o", file], &facts[..]].concat())
}

fn assert_refused(ended: &Ended, why: &str) {
    assert!(
        ended.code == Some(2) && ended.err.contains("not signed: ") && ended.err.contains(why),
        "{why}: {ended:?}"
    );
}

fn digest(text: &str) -> String {
    Sha256::digest(text.as_bytes()).iter().fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}

/// Changes a line of the journal that no figure depends on, and recomputes every digest, as a forger would.
fn forge(run: &Path) {
    let before = journal_text(run);
    let after = before.replacen("certified", "certifies", 1);
    assert_ne!(before, after);
    change_journal(run, &after);
    let file = run.join("report.json");
    let report = std::fs::read_to_string(&file).unwrap().replace(&digest(&before), &digest(&after));
    let lines = |is_seal: bool| {
        report.split_inclusive('\n').filter(move |line| line.contains("\"report_sha256\"") == is_seal)
    };
    let sealed = lines(true).next().unwrap().split('"').nth(3).unwrap();
    let report = report.replace(sealed, &digest(&lines(false).collect::<String>()));
    std::fs::write(file, report).unwrap();
}

#[test]
fn a_journal_whose_every_digest_was_forged_is_not_signed_because_it_is_recomputed() {
    let bench = Bench::new();
    let run = scanned(&bench);
    forge(&run);
    let text = bench.tankops(&["report", run.to_str().unwrap()]);
    assert!(text.code == Some(0) && !text.out.contains("differ"), "the digests agree: {text:?}");
    assert_refused(&sign(&bench, &run, "a.html"), "different from tick");
    assert!(!bench.path().join("a.html").exists());
}

#[test]
fn a_signature_is_missed_where_its_list_was_deleted_and_a_run_where_another_took_its_name() {
    let bench = Bench::new();
    let run = scanned(&bench);
    let signed = sign(&bench, &run, "a.html");
    assert!(signed.code == Some(0) && signed.out.contains("signed as revision A"), "{signed:?}");
    let verified = bench.verify(&run, &["--from-journal"]);
    assert!(
        verified.code == Some(0) && verified.out.contains("signed: revision A by L. Kern"),
        "{verified:?}"
    );
    // A signed report is written over by nothing, not even as the report of another run.
    bench.fly(&scenario("cover-circle.toml"), &["--seed", "2", "--set", "mission.time_limit_s=60"]);
    let other = bench.runs().into_iter().find(|other| *other != run).unwrap();
    let over = bench.tankops(&["report", other.to_str().unwrap(), "-o", "a.html", "--force"]);
    assert!(over.code == Some(2) && over.err.contains("read-only"), "{over:?}");

    let list = run.join("signed.json");
    let kept = std::fs::read_to_string(&list).unwrap();
    std::fs::remove_file(&list).unwrap();
    assert_refused(&sign(&bench, &run, "b.html"), "was signed as revision A by L. Kern");
    let draft = bench.tankops(&["report", run.to_str().unwrap(), "-o", "draft.json"]);
    assert!(draft.out.contains("WARNING: run ") && draft.out.contains("signatures says"), "{draft:?}");
    std::fs::write(&list, &kept).unwrap();

    let renamed = run.with_file_name("20300101T000000Z-cover-circle-tether-safe-1");
    std::fs::rename(&run, &renamed).unwrap();
    assert_refused(&sign(&bench, &renamed, "b.html"), "its folder was renamed");
    std::fs::rename(&renamed, &run).unwrap();

    // Another run under the name of the one that was signed.
    for file in ["events.jsonl.zst", "recording.rrd", "report.json"] {
        std::fs::copy(other.join(file), run.join(file)).unwrap();
    }
    let verified = bench.verify(&run, &["--from-journal"]);
    assert!(
        verified.code == Some(1) && verified.out.contains("signed revision A is about another journal"),
        "{verified:?}"
    );
    assert_refused(&sign(&bench, &run, "b.html"), "signed revision A is about another journal");
}

#[test]
fn tables_are_no_formulas_and_none_of_them_is_written_over() {
    let bench = Bench::new();
    let run = scanned(&bench);
    let table = |more: &[&str]| {
        bench.tankops(
            &[&["report", run.to_str().unwrap(), "-o", "t.csv", "--indications", "found.csv"], more].concat(),
        )
    };
    bench.file("t-track.csv", "precious");
    let refused = table(&[]);
    assert!(refused.code == Some(2) && refused.err.contains("t-track.csv already exists"), "{refused:?}");
    assert!(!bench.path().join("t.csv").exists());
    assert_eq!(table(&["--force"]).code, Some(0));
    let found = std::fs::read_to_string(bench.path().join("t-indications.csv")).unwrap();
    assert!(found.contains(",'=1+1,"), "{found}");
    let own = run.join("report.json");
    let over = bench.tankops(&["report", run.to_str().unwrap(), "-o", own.to_str().unwrap(), "--force"]);
    assert!(over.code == Some(2) && over.err.contains("is a file of the run"), "{over:?}");
}
