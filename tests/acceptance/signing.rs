//! Reports that must not be signed, and the messages about a run after it was signed.

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

/// Changes a line of the journal on which no figure depends, and recomputes every digest, as a forger would.
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
    // Nothing overwrites a signed report, not even the report of another run.
    bench.fly(&scenario("cover-circle.toml"), &["--seed", "2", "--set", "mission.time_limit_s=60"]);
    let other = bench.runs().into_iter().find(|other| *other != run).unwrap();
    let over = bench.tankops(&["report", other.to_str().unwrap(), "-o", "a.html", "--force"]);
    assert!(
        over.code == Some(2) && over.err.contains("is the signed revision A, which must not be changed"),
        "{over:?}"
    );

    let list = run.join("signed.json");
    let kept = std::fs::read_to_string(&list).unwrap();
    std::fs::remove_file(&list).unwrap();
    assert_refused(&sign(&bench, &run, "b.html"), "was signed as revision A by L. Kern");
    let draft = bench.tankops(&["report", run.to_str().unwrap(), "-o", "draft.json"]);
    assert!(
        draft.out.contains("WARNING: run ")
            && draft.out.contains("signatures, but its signed.json is missing"),
        "{draft:?}"
    );
    std::fs::write(&list, &kept).unwrap();

    let renamed = run.with_file_name("20300101T000000Z-cover-circle-tether-safe-1");
    std::fs::rename(&run, &renamed).unwrap();
    assert_refused(&sign(&bench, &renamed, "b.html"), "rename the folder back to that name");
    let verified = bench.verify(&renamed, &["--from-journal"]);
    assert!(
        verified.code == Some(1) && verified.out.contains("NOT AS SIGNED: the folder is called 20300101"),
        "{verified:?}"
    );
    std::fs::rename(&renamed, &run).unwrap();

    // A different run with the name of the signed run.
    for file in ["events.jsonl.zst", "recording.rrd", "report.json"] {
        std::fs::copy(other.join(file), run.join(file)).unwrap();
    }
    let verified = bench.verify(&run, &["--from-journal"]);
    assert!(
        verified.code == Some(1) && verified.out.contains("signed revision A covers a different journal"),
        "{verified:?}"
    );
    assert_refused(&sign(&bench, &run, "b.html"), "signed revision A covers a different journal");
}

/// A scenario file of the round tank, changed so that it is a different tank.
fn tank(bench: &Bench, name: &str, facts: &str) -> PathBuf {
    let text = std::fs::read_to_string(scenario("cover-circle.toml")).unwrap();
    let text = text.replace("name = \"cover-circle\"", &format!("name = \"{name}\""));
    bench.file(&format!("{name}.toml"), format!("{text}\n[inspection]\n{facts}"))
}

#[test]
fn twin_tanks_never_become_one_report_and_a_rescan_names_the_run_that_it_continues() {
    let bench = Bench::new();
    let short = ["--set", "mission.time_limit_s=60"];
    let fly = |file: &Path, more: &[&str]| {
        let before = bench.runs();
        bench.fly(file, &[&short[..], more].concat());
        let run = bench.runs().into_iter().find(|run| !before.contains(run)).unwrap();
        run.to_str().unwrap().to_owned()
    };
    let t09 = "tank_id = \"T-09\"\nsite = \"Basel\"\nnominal_thickness_mm = 8\n";
    let one = fly(&tank(&bench, "tank-9", t09), &[]);
    let twin = fly(&tank(&bench, "tank-10", &t09.replace("T-09", "T-10")), &["--seed", "2"]);
    let other_name = fly(&tank(&bench, "tank-11", t09), &["--seed", "3"]);
    let again = fly(&tank(&bench, "tank-9", t09), &["--seed", "4"]);
    for command in [
        vec!["report"],
        vec!["report", "--json"],
        vec!["report", "-o", "s.html"],
        vec!["rescan", "-o", "s.toml"],
    ] {
        let together = |other: &str| bench.tankops(&[&command[..], &[&one, other]].concat());
        let refused = together(&twin);
        assert!(
            refused.code == Some(2)
                && refused.err.contains("inspection.tank_id is \"T-09\" in ")
                && refused.err.contains("and \"T-10\" in "),
            "{refused:?}"
        );
        let refused = together(&other_name);
        assert!(refused.code == Some(2) && refused.err.contains("name is tank-9 in "), "{refused:?}");
        assert_eq!(together(&again).code, Some(0), "another scan of the same tank: {:?}", together(&again));
    }
    std::fs::remove_file(bench.path().join("s.toml")).unwrap();
    // A re-scan of one tank is not a re-scan of the other.
    assert_eq!(bench.tankops(&["rescan", &one, "-o", "again.toml"]).code, Some(0));
    let rescan = fly(&bench.path().join("again.toml"), &[]);
    assert_eq!(bench.tankops(&["report", &one, &rescan]).code, Some(0));
    let refused = bench.tankops(&["report", &again, &rescan]);
    let digest = digest(&journal_text(Path::new(&one)));
    assert!(
        refused.code == Some(2)
            && refused.err.contains("continues_sha256 of ")
            && refused.err.contains(&digest),
        "{refused:?}"
    );
    // A file of facts cannot turn one tank into another.
    bench.file("facts.toml", "[inspection]\ntank_id = \"T-10\"\n");
    let draft = bench.tankops(&["report", &one, "-o", "d.json", "--inspection", "facts.toml"]);
    let text = std::fs::read_to_string(bench.path().join("d.json")).unwrap();
    assert!(draft.code == Some(0) && text.contains("inspection.identity_corrected"), "{draft:?}");
}

#[test]
fn verify_and_runs_name_every_signed_report_that_is_not_as_it_was() {
    let bench = Bench::new();
    let run = scanned(&bench);
    let signed = sign(&bench, &run, "a.html");
    assert_eq!(signed.code, Some(0), "{signed:?}");
    let (page, list) = (bench.path().join("a.html"), run.join("signed.json"));
    let (page_text, list_text) = (std::fs::read(&page).unwrap(), std::fs::read_to_string(&list).unwrap());
    let wrong = |why: &str| {
        let verified = bench.verify(&run, &["--from-journal"]);
        let listed = bench.tankops(&["runs"]);
        assert!(
            verified.code == Some(1)
                && verified.out.contains("NOT AS SIGNED: ")
                && verified.out.contains(why),
            "{why}: {verified:?}"
        );
        assert!(verified.out.contains("equal: "), "the run itself is as it was: {verified:?}");
        assert!(listed.out.contains(why), "{why}: {listed:?}");
    };
    let writable = || {
        let mut permissions = std::fs::metadata(&page).unwrap().permissions();
        #[expect(clippy::permissions_set_readonly_false, reason = "as a forger would")]
        permissions.set_readonly(false);
        std::fs::set_permissions(&page, permissions).unwrap();
    };
    writable();
    std::fs::write(&page, [&page_text[..], b" "].concat()).unwrap();
    wrong("signed revision A was changed after it was signed: ");
    std::fs::rename(&page, bench.path().join("moved.html")).unwrap();
    wrong("signed revision A cannot be read");
    std::fs::write(&page, &page_text).unwrap();
    let digest = list_text.split('"').find(|part| part.len() == 64).unwrap();
    let other = digest.replace(&digest[..1], if digest.starts_with('0') { "1" } else { "0" });
    std::fs::write(&list, list_text.replace(digest, &other)).unwrap();
    wrong("signed.json was changed: sha256 of revision A is ");
    std::fs::remove_file(&list).unwrap();
    wrong("signed.json is missing");
    std::fs::write(&list, "[]").unwrap();
    wrong("signed.json does not list it");
    std::fs::write(&list, "[{]").unwrap();
    wrong("signed.json is damaged");
    std::fs::write(&list, &list_text).unwrap();
    assert_eq!(bench.verify(&run, &["--from-journal"]).code, Some(0));
}

#[test]
fn empty_words_an_expired_certificate_and_sound_of_unknown_origin_are_not_signed() {
    let bench = Bench::new();
    let run = scanned(&bench);
    let open = |from: &str, to: &str| {
        assert!(FACTS.contains(from));
        bench.file("facts.toml", FACTS.replace(from, to));
        let refused = sign(&bench, &run, "a.html");
        assert!(refused.code == Some(2) && refused.err.contains("not signed: "), "{to}: {refused:?}");
        refused.err
    };
    let calibration = "2026-11-22 03:10, plate K1, passed, L. Kern";
    for words in ["n.a.", "none", "to be done", "unknown"] {
        let why = open(calibration, words);
        assert!(why.contains(&format!("inspection.calibration_before has no content: `{words}`")), "{why}");
    }
    let why = open("\"2099-05\"", "\"2019-05\"");
    assert!(why.contains("the certificate expired on 2019-05-31, before the inspection on 20"), "{why}");
    assert!(
        open("inspector_certificate_expires = \"2099-05\"\n", "").contains("inspector_certificate_expires")
    );
    assert!(
        open("UT-2 1234", "UT-2 1234, expired 2019")
            .contains("inspector_certificate states that the certificate is expired")
    );
    assert!(open("sound_speed = \"1180 m/s, gas oil, 14 deg\"\n", "").contains("inspection.sound_speed"));
    assert!(open("1180 m/s, gas oil, 14 deg", "1180 m/s").contains("how it was determined"));
    assert!(open("Port of <Rotterdam>", "n/a").contains("inspection.client has no content"));
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
    assert!(over.code == Some(2) && over.err.contains("is part of a run"), "{over:?}");
}
