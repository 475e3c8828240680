//! Past runs: listed, verified, exported.

use crate::bench::{Bench, change_journal, journal, journal_text, scenario};

#[test]
fn a_run_is_listed_verified_and_exported() {
    let bench = Bench::new();
    assert_eq!(bench.fly(&scenario("goto-single-obstacle.toml"), &[]).code, Some(0));
    let run = bench.runs().remove(0);
    let name = run.file_name().unwrap().to_str().unwrap();

    let listed = bench.tankops(&["runs", "--json"]).json();
    assert_eq!(listed[0]["name"], name);
    assert_eq!(listed[0]["end"], "complete");

    let verified = bench.tankops(&["verify", name]);
    assert_eq!(verified.code, Some(0), "{verified:?}");
    assert!(verified.out.starts_with("equal: "), "{verified:?}");
    let ticks = bench.tankops(&["report", name, "--json"]).json()["ticks"].as_u64().unwrap();
    assert!(verified.out.contains(&format!("from tick 0 to tick {ticks};")), "{verified:?}");

    let exported = bench.tankops(&["export", name, "--rrd", "again.rrd"]);
    assert_eq!(exported.code, Some(0), "{exported:?}");
    let again = bench.tankops(&["export", name, "--rrd", "again.rrd"]);
    assert_eq!(again.code, Some(2), "{again:?}");
    assert!(again.err.contains("already exists; choose another name"), "{again:?}");
}

#[test]
fn a_changed_journal_is_reported_from_its_first_difference_on() {
    let bench = Bench::new();
    bench.fly(&scenario("goto-single-obstacle.toml"), &[]);
    let run = bench.runs().remove(0);
    let text = journal_text(&run);
    let events = journal(&run);
    let at = (200..events.len()).find(|i| events[*i]["event"] == "truth").unwrap();
    let tick = events[at]["tick"].as_u64().unwrap();
    let changed: Vec<String> =
        text.lines()
            .enumerate()
            .map(|(i, line)| {
                if i == at { line.replacen("\"clearance_m\":", "\"clearance_m\":9", 1) } else { line.into() }
            })
            .collect();
    change_journal(&run, &(changed.join("\n") + "\n"));
    let verified = bench.tankops(&["verify", run.to_str().unwrap()]);
    assert_eq!(verified.code, Some(1), "{verified:?}");
    assert!(verified.out.contains(&format!("different from tick {tick} on")), "{verified:?}");
}

#[test]
fn the_error_for_a_missing_run_says_how_to_find_others() {
    let bench = Bench::new();
    let verified = bench.tankops(&["verify", "yesterday"]);
    assert_eq!(verified.code, Some(2));
    assert!(verified.err.contains("tankops runs"), "{verified:?}");
}

#[test]
fn an_export_that_fails_leaves_nothing_behind() {
    let bench = Bench::new();
    bench.fly(&scenario("goto-single-obstacle.toml"), &[]);
    let run = bench.runs().remove(0);
    let text = journal_text(&run);
    let damaged: Vec<&str> =
        text.lines().enumerate().map(|(i, line)| if i == 300 { "{]" } else { line }).collect();
    change_journal(&run, &(damaged.join("\n") + "\n"));
    let exported = bench.tankops(&["export", run.to_str().unwrap(), "--rrd", "again.rrd"]);
    assert_eq!(exported.code, Some(2), "{exported:?}");
    assert!(exported.err.contains("301"), "{exported:?}");
    for command in [vec!["verify"], vec!["report"], vec!["export", "--rrd", "again.rrd"]] {
        let failed = bench.tankops(&[&command[..], &[run.to_str().unwrap()]].concat());
        assert_eq!(failed.err.matches("events.jsonl").count(), 1, "{command:?}: {failed:?}");
    }
    assert!(!bench.path().join("again.rrd").exists());
}

#[test]
fn events_says_when_the_journal_has_no_end_or_nothing_at_all() {
    let bench = Bench::new();
    assert_eq!(bench.fly(&scenario("goto-single-obstacle.toml"), &[]).code, Some(0));
    let run = bench.runs().remove(0);
    let (name, path) = (run.to_str().unwrap(), run.join("events.jsonl.zst"));
    let part = bench.tankops(&["events", name, "--from", "1", "--to", "1.5", "--kind", "truth"]);
    assert_eq!((part.code, part.out.lines().count(), part.err.as_str()), (Some(0), 6, ""), "{part:?}");
    let refused = bench.tankops(&["events", name, "--from", "-5"]);
    assert!(
        refused.code == Some(2) && refused.err.contains("seconds, for example 0 or 125.5"),
        "{refused:?}"
    );

    let whole = std::fs::read(&path).unwrap();
    std::fs::write(&path, &whole[..whole.len() - 30]).unwrap();
    let cut = bench.tankops(&["events", name]);
    assert!(cut.code == Some(0) && cut.out.lines().count() > 10, "{cut:?}");
    assert!(cut.err.starts_with("note: the journal is incomplete"), "{cut:?}");

    std::fs::write(&path, "").unwrap();
    let empty = bench.tankops(&["events", name]);
    assert!(empty.code == Some(2) && empty.err.contains("events.jsonl.zst"), "{empty:?}");
}
