//! The inspection report as a file: formats, refusals, signatures, digests.

use crate::bench::{Bench, scenario};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A short run with plates.
fn flown(bench: &Bench) -> (PathBuf, String) {
    bench.fly(&scenario("cover-circle.toml"), &["--set", "mission.time_limit_s=120"]);
    let run = bench.runs().pop().unwrap();
    let path = run.to_str().unwrap().to_owned();
    (run, path)
}

/// All facts that people must supply.
pub(crate) const FACTS: &str = r#"
[inspection]
client = "Port of <Rotterdam>"
site = "North yard"
tank_id = "T-07"
drawing = "D-112 rev. 3"
nominal_thickness_mm = 8.0
order = "4711"
procedure = "P-9"
code = "API 653, 5th edition"
inspector = "L. Kern"
inspector_certificate = "UT-2 1234"
inspector_certificate_expires = "2099-05"
operator = "M. Voss"
approver = "A. Maas"
robot = "crawler, no. 3"
instrument = "MFL, no. 17"
calibration_before = "2026-11-22 03:10, plate K1, passed, L. Kern"
calibration_after = "2026-11-22 06:40, plate K1, passed, L. Kern"
station_check = "2026-11-22 02:50, pulse test 2 cm, M. Voss"
sound_speed = "1180 m/s, gas oil, 14 deg"
events_reviewed_by = "L. Kern"
remarks = "No remarks"
partial_scope_accepted = "rest is scanned by hand"
critical_zone_accepted = "zone is scanned by hand"
missed_accepted = "inspected by hand"
"#;

#[test]
fn a_report_is_one_file_without_network_and_script_in_every_format_and_never_written_over() {
    let bench = Bench::new();
    let (_, run) = flown(&bench);
    for file in ["r.html", "r.json", "r.csv", "r.geojson", "r.dxf"] {
        let written = bench.tankops(&["report", &run, "-o", file]);
        assert_eq!(written.code, Some(0), "{written:?}");
    }
    let read = |file: &str| std::fs::read_to_string(bench.path().join(file)).unwrap();
    let html = read("r.html");
    for outside in ["<script", "http-equiv", "src=", "@import", "url(http"] {
        assert!(!html.contains(outside), "{outside}");
    }
    for wanted in
        ["[inspection.tank_id]", "Do not sign", "SIMULATION", "Coverage map", "Sheet \" counter(page)"]
    {
        assert!(html.contains(wanted), "{wanted}");
    }
    let map: Value = serde_json::from_str(&read("r.geojson")).unwrap();
    let layers: Vec<&str> = map["features"]
        .as_array()
        .unwrap()
        .iter()
        .map(|f| f["properties"]["layer"].as_str().unwrap())
        .collect();
    assert!(
        ["track", "shell", "obstacles", "missed"].iter().all(|layer| layers.contains(layer)),
        "{layers:?}"
    );
    let dxf = read("r.dxf");
    let layers = ["SHELL", "PLATES", "OBSTACLES", "MISSED", "TRACK"];
    assert!(layers.iter().all(|layer| dxf.contains(&format!("\n8\n{layer}\n"))) && dxf.ends_with("0\nEOF\n"));
    for table in ["r-missed.csv", "r-obstacles.csv", "r-indications.csv", "r-track.csv"] {
        assert!(read(table).lines().next().unwrap().contains("x_m"), "{table}");
    }
    let again = bench.tankops(&["report", &run, "-o", "r.html"]);
    assert!(again.code == Some(2) && again.err.contains("r.html already exists"), "{again:?}");
    assert_eq!(bench.tankops(&["report", &run, "-o", "r.html", "--force"]).code, Some(0));
    let other = bench.tankops(&["report", &run, "-o", "r.pdf"]);
    assert!(other.code == Some(2) && other.err.contains(".html, .json, .csv, .geojson, .dxf"), "{other:?}");
}

#[test]
fn a_report_is_signed_when_every_item_is_answered_and_the_next_one_is_another_revision() {
    let bench = Bench::new();
    let (_, run) = flown(&bench);
    let open = bench.tankops(&["report", &run, "-o", "a.html", "--sign", "L. Kern"]);
    assert!(open.code == Some(2) && open.err.contains("inspection.calibration_after"), "{open:?}");
    assert!(!bench.path().join("a.html").exists());
    bench.file("facts.toml", FACTS);
    bench.file("found.csv", "t_s,left_m,kind,depth_mm\n60,0.1,pit,2.5\n");
    let facts = ["--inspection", "facts.toml", "--indications", "found.csv"];
    let sign = |file: &str| {
        bench.tankops(&[&["report", &run, "-o", file, "--sign", "L. Kern"], &facts[..]].concat())
    };
    let lacks = sign("a.html");
    // A plate that was not scanned at all has no accuracy figure.
    assert!(lacks.code == Some(2) && lacks.err.contains("accuracy on plate"), "{lacks:?}");
    bench.fly(&scenario("cover-circle.toml"), &[]);
    let run = bench.runs().pop().unwrap();
    let path = run.to_str().unwrap();
    let sign = |file: &str| {
        bench.tankops(&[&["report", path, "-o", file, "--sign", "L. Kern"], &facts[..]].concat())
    };
    let signed = sign("a.html");
    assert!(signed.code == Some(0) && signed.out.contains("signed as revision A by L. Kern"), "{signed:?}");
    let html = std::fs::read_to_string(bench.path().join("a.html")).unwrap();
    assert!(
        html.contains("Signed by L. Kern") && html.contains("Port of &#60;Rotterdam&#62;"),
        "escaped facts"
    );
    assert!(!html.contains("Do not sign") && !html.contains("[inspection."), "nothing is missing");
    for more in [&["--force"][..], &[]] {
        let over = bench.tankops(&[&["report", path, "-o", "a.html"], more].concat());
        assert!(
            over.code == Some(2) && over.err.contains("signed revision A, which must not be changed"),
            "{over:?}"
        );
    }
    assert!(sign("b.html").out.contains("signed as revision B"));
    let draft = bench.tankops(&["report", path, "-o", "c.json"]);
    assert_eq!(draft.code, Some(0), "{draft:?}");
    let text = std::fs::read_to_string(bench.path().join("c.json")).unwrap();
    let draft: Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&draft["revision"], draft["revisions"].as_array().unwrap().len()), (&"C".into(), 2));
}

/// Report, list and verification of a run name the problem with its files, and signing is refused.
fn assert_doubted(bench: &Bench, run: &Path, path: &str, doubts: [&str; 2]) {
    let [doubt, listed] = doubts;
    let report = bench.tankops(&["report", path]);
    assert!(report.out.contains(doubt), "{report:?}");
    let runs = bench.tankops(&["runs"]);
    assert!(runs.out.contains(listed), "{runs:?}");
    let verified = bench.verify(run, &["--from-journal"]);
    assert!(verified.code == Some(1) && verified.out.contains(doubt), "{verified:?}");
    bench.file("facts.toml", FACTS);
    let signed =
        bench.tankops(&["report", path, "-o", "a.html", "--inspection", "facts.toml", "--sign", "L. Kern"]);
    assert!(signed.code == Some(2) && signed.err.contains(doubt), "{signed:?}");
}

#[test]
fn a_recording_that_was_changed_is_named_by_report_runs_and_verify_and_blocks_the_signature() {
    let bench = Bench::new();
    let (run, path) = flown(&bench);
    let file = run.join("recording.rrd");
    let mut bytes = std::fs::read(&file).unwrap();
    bytes.extend(b"junk");
    std::fs::write(&file, bytes).unwrap();
    assert_doubted(&bench, &run, &path, ["the recording is not the one"; 2]);
}

#[test]
fn a_figure_that_was_changed_is_named_by_report_runs_and_verify_and_blocks_the_signature() {
    let bench = Bench::new();
    let (run, path) = flown(&bench);
    let file = run.join("report.json");
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, text.replace("\"collisions\": 0", "\"collisions\": 1")).unwrap();
    let doubt = "report.json was changed: collisions is 1; the journal gives 0";
    assert_doubted(&bench, &run, &path, [doubt, "report.json was changed after the run ended"]);
    // Removing the digest that shows the change does not help, either.
    let unsealed = text.lines().filter(|line| !line.contains("\"report_sha256\""));
    let unsealed = unsealed.collect::<Vec<_>>().join("\n").replace(",\n}", "\n}");
    std::fs::write(&file, unsealed.replace("\"collisions\": 0", "\"collisions\": 1")).unwrap();
    let doubt = "report.json was changed after the run ended: its line report_sha256 is missing";
    assert_doubted(&bench, &run, &path, [doubt; 2]);
}
