//! The proofs of `verify`, and the runs that it does not report as equal.

use crate::{
    bench::{Bench, change_journal, journal, journal_text, scenario},
    faults::compile,
};
use mission::event::JOURNAL_VERSION;
use std::path::PathBuf;

/// A short finished run.
fn flown(bench: &Bench) -> PathBuf {
    assert_eq!(bench.fly(&scenario("goto-single-obstacle.toml"), &[]).code, Some(0));
    bench.runs().remove(0)
}

/// The text with one line changed.
fn with_line(text: &str, number: usize, change: impl Fn(&str) -> String) -> String {
    let lines =
        text.lines().enumerate().map(|(i, line)| if i == number { change(line) } else { line.to_owned() });
    lines.map(|line| line + "\n").collect()
}

#[test]
fn a_journal_in_which_a_line_is_written_otherwise_is_different() {
    let bench = Bench::new();
    let run = flown(&bench);
    let text = journal_text(&run);
    let at = 150;
    let (tick, t_s) = (&journal(&run)[at]["tick"], &journal(&run)[at]["t_s"]);
    let (clock, longer) = (format!("\"t_s\":{t_s},"), format!("\"t_s\":{t_s}0,"));
    let opening = text.lines().next().unwrap();
    assert!(opening.contains("\"seed\":1,"));
    let changed = [
        ("white space", at, with_line(&text, at, |line| line.replacen(':', ": ", 1))),
        ("white space at the end", at, with_line(&text, at, |line| format!("{line} "))),
        ("another key", at, with_line(&text, at, |line| line.replacen('{', "{\"note\":1,", 1))),
        ("a number with a zero more", at, with_line(&text, at, |line| line.replacen(&clock, &longer, 1))),
        (
            "two keys in another order",
            at,
            with_line(&text, at, |line| {
                let (first, second) = (format!("\"tick\":{tick},"), format!("\"t_s\":{t_s},"));
                line.replacen(&format!("{first}{second}"), &format!("{second}{first}"), 1)
            }),
        ),
        ("a line twice", at, with_line(&text, at, |line| format!("{line}\n{line}"))),
        ("a key in the opening", 0, with_line(&text, 0, |line| line.replacen('{', "{\"note\":1,", 1))),
        (
            "a number in the opening",
            0,
            with_line(&text, 0, |line| line.replacen("\"seed\":1,", "\"seed\":1 ,", 1)),
        ),
    ];
    std::fs::rename(run.join("report.json"), run.join("report.kept")).unwrap();
    for (what, line, changed) in changed {
        assert_ne!(changed, text, "{what}");
        change_journal(&run, &changed);
        let tick = journal(&run)[line]["tick"].as_u64().unwrap();
        for more in [&[][..], &["--from-journal"]] {
            let verified = bench.verify(&run, more);
            let is_reported = verified.out.contains(&format!("different from tick {tick} on"));
            assert!(verified.code == Some(1) && is_reported, "{what}: {verified:?}");
        }
    }
    change_journal(&run, &text);
    std::fs::rename(run.join("report.kept"), run.join("report.json")).unwrap();
    bench.prove(&run);
}

#[test]
fn a_truncated_journal_differs_from_its_report() {
    let bench = Bench::new();
    let run = flown(&bench);
    let text = journal_text(&run);
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines.len() > 600, "{}", lines.len());
    let report = std::fs::read_to_string(run.join("report.json")).unwrap();
    let hash_of_another = report.replacen("\"events_sha256\": \"", "\"events_sha256\": \"0123", 1);
    assert_ne!(hash_of_another, report);
    for (what, kept) in
        [("the last line", lines.len() - 1), ("500 lines", lines.len() - 500), ("all but one", 1)]
    {
        change_journal(&run, &(lines[..kept].join("\n") + "\n"));
        // A report without the journal's hash still claims that the run has ended.
        for report in [report.clone(), report.replacen("events_sha256", "events", 1)] {
            std::fs::write(run.join("report.json"), report).unwrap();
            let verified = bench.verify(&run, &[]);
            let is_reported = verified.out.contains("different: ") && verified.out.contains("incomplete");
            assert!(verified.code == Some(1) && is_reported, "without {what}: {verified:?}");
        }
    }
    change_journal(&run, &text);
    std::fs::write(run.join("report.json"), hash_of_another).unwrap();
    let verified = bench.verify(&run, &[]);
    assert!(verified.code == Some(1) && verified.out.contains("SHA-256"), "{verified:?}");
}

#[test]
fn a_journal_without_an_end_is_compared_as_far_as_it_goes() {
    let bench = Bench::new();
    let run = flown(&bench);
    let text = journal_text(&run);
    std::fs::remove_file(run.join("report.json")).unwrap();
    // The journal as left by a killed process: cut off within a line, at the end of a line, or before a newline.
    let middle = text.len() / 2;
    let line_end = middle + text[middle..].find('\n').unwrap();
    for kept in [middle, line_end + 1, line_end] {
        change_journal(&run, &text[..kept]);
        for more in [&[][..], &["--from-journal"]] {
            let verified = bench.verify(&run, more);
            let is_equal =
                verified.out.contains("the journal is incomplete") && verified.out.contains("equal: ");
            assert!(verified.code == Some(0) && is_equal, "{kept} bytes: {verified:?}");
        }
    }
}

#[test]
fn nothing_may_follow_the_end_of_a_journal() {
    let bench = Bench::new();
    let run = flown(&bench);
    let text = journal_text(&run);
    std::fs::remove_file(run.join("report.json")).unwrap();
    let ending = text.lines().last().unwrap();
    let tick = journal(&run).last().unwrap()["tick"].as_u64().unwrap();
    let later = ending.replacen(&format!("\"tick\":{tick},"), &format!("\"tick\":{},", tick + 1), 1);
    assert_ne!(later, ending);
    for more in [ending, &later] {
        change_journal(&run, &format!("{text}{more}\n"));
        let verified = bench.verify(&run, &[]);
        assert!(verified.code == Some(1) && verified.out.contains("different"), "{verified:?}");
    }
}

#[test]
fn a_run_whose_planner_is_not_installed_is_proven_from_its_journal() {
    let bench = Bench::new();
    let plugins = bench.path().join("plugins-in-c");
    std::fs::create_dir(&plugins).unwrap();
    compile("direct.c", &plugins.join("libplanner_direct_c.so"));
    let with_it = ["--plugin-dir", plugins.to_str().unwrap()];
    let goto = scenario("goto-single-obstacle.toml");
    let flown = bench.fly(&goto, &[&["--planner", "direct-c"][..], &with_it].concat());
    assert!(flown.json()["ticks"].as_u64() > Some(50), "{flown:?}");
    let run = bench.runs().remove(0);
    let installed = bench.verify(&run, &with_it);
    assert!(
        installed.code == Some(0) && installed.out.contains("planner answers identical"),
        "{installed:?}"
    );
    let missing = bench.verify(&run, &[]);
    let is_reported = missing.out.contains("planner direct-c of the run is not installed");
    assert!(missing.code == Some(1) && is_reported && missing.out.contains("--from-journal"), "{missing:?}");
    let from_journal = bench.verify(&run, &["--from-journal"]);
    let is_noted = from_journal.out.contains("the planners were not asked");
    assert!(
        from_journal.code == Some(0) && is_noted && from_journal.out.starts_with("equal: "),
        "{from_journal:?}"
    );
}

#[test]
fn a_journal_of_another_version_is_refused_by_every_command_that_reads_it() {
    let bench = Bench::new();
    bench.fly(&scenario("goto-single-obstacle.toml"), &[]);
    let run = bench.runs().remove(0);
    for version in [JOURNAL_VERSION - 1, JOURNAL_VERSION + 1] {
        let text = journal_text(&run);
        let at = text.find("\"journal_version\":").unwrap() + "\"journal_version\":".len();
        let end = at + text[at..].find(',').unwrap();
        change_journal(&run, &[&text[..at], &version.to_string(), &text[end..]].concat());
        let commands: [&[&str]; 5] = [
            &["verify"],
            &["report"],
            &["export", "--mcap", "run.mcap"],
            &["events"],
            &["replay", "--script", "/dev/null"],
        ];
        for command in commands {
            let refused = bench.tankops(&[command, &[run.file_name().unwrap().to_str().unwrap()]].concat());
            assert_eq!(refused.code, Some(2), "{command:?} {refused:?}");
            let is_clear = refused.err.contains(&format!(" has version {version}, but this tankops"))
                && refused.err.contains(&format!("reads version {JOURNAL_VERSION}"));
            assert!(is_clear && refused.err.trim().lines().count() == 1, "{command:?} {refused:?}");
        }
        let listed = bench.tankops(&["runs"]);
        assert!(listed.code == Some(0) && listed.out.contains("goto-single-obstacle"), "{listed:?}");
    }
}

/// Replaces the text between two marks, in the first line that contains both.
fn with_part(text: &str, (from, to): (&str, &str), part: &str) -> String {
    let at = text.find(from).unwrap() + from.len();
    let end = at + text[at..].find(to).unwrap();
    [&text[..at], part, &text[end..]].concat()
}

#[test]
fn sizes_in_a_journal_that_was_changed_take_neither_memory_nor_time() {
    let bench = Bench::new();
    bench.fly(&scenario("cover-circle.toml"), &["--set", "mission.time_limit_s=20"]);
    let run = bench.runs().remove(0);
    let text = journal_text(&run);
    let path = ("\"path\":[", "],\"length_m\"");
    let changes = [
        ("no path", with_part(&text, path, "")),
        ("a point far away", with_part(&text, path, "[0.0,0.0],[1e12,0.0]")),
        ("a point beyond all numbers", with_part(&text, path, "[0.0,0.0],[1e300,0.0]")),
        ("a wide floor", with_part(&text, ("\"width\":", ","), "4294967295")),
        ("a long run of cells", with_part(&text, ("\"runs\":[[\"outside\",", "]"), "4294967295")),
    ];
    for (what, changed) in changes {
        change_journal(&run, &changed);
        let name = run.to_str().unwrap();
        for command in [&["verify", name][..], &["verify", name, "--from-journal"]] {
            let verified = bench.tankops(command);
            assert!(matches!(verified.code, Some(1 | 2)), "{what}: {command:?}: {verified:?}");
        }
        for command in [&["report", name][..], &["runs"], &["export", name, "--rrd", "again.rrd"]] {
            let read = bench.tankops(command);
            assert!(matches!(read.code, Some(0..=2)), "{what}: {command:?}: {read:?}");
            let _ = std::fs::remove_file(bench.path().join("again.rrd"));
        }
    }
}

#[test]
fn a_report_that_is_damaged_speaks_against_its_journal() {
    let bench = Bench::new();
    let run = flown(&bench);
    std::fs::write(run.join("report.json"), "{\"a\":").unwrap();
    let verified = bench.verify(&run, &[]);
    assert!(verified.code == Some(1) && verified.out.contains("report.json is damaged"), "{verified:?}");
}
