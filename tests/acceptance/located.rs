//! Readings of a run, located as if a real system had measured them; plans and runs as files for other programs.

use crate::bench::{Bench, scenario, workspace};
use serde_json::Value;

/// The estimates and the positions from ranges that a journal holds.
fn positions(bench: &Bench, run: usize) -> Vec<Value> {
    let events = crate::bench::journal(&bench.runs()[run]);
    let located = |event: &&Value| ["estimated", "fixed"].contains(&event["event"].as_str().unwrap());
    let place = |event: &Value| match event["event"].as_str() {
        Some("fixed") => event["fix"].clone(),
        _ => event["pose"].clone(),
    };
    events.iter().filter(located).map(place).collect()
}

#[test]
fn readings_of_a_run_are_located_where_the_mission_believed_to_be() {
    let bench = Bench::new();
    let demo = scenario("demo.toml");
    let flown = bench.fly(&demo, &["--set", "mission.time_limit_s=40"]).json();
    let run = bench.runs().pop().unwrap();
    let run = run.to_str().unwrap();
    let exported = bench.tankops(&["export", run, "--ranges", "r.csv"]);
    assert_eq!(exported.code, Some(0), "{exported:?}");
    let again = bench.tankops(&["export", run, "--ranges", "r.csv"]);
    assert!(again.code == Some(2) && again.err.contains("already exists"), "{again:?}");

    let demo = demo.to_str().unwrap();
    let located = bench.tankops(&["locate", "r.csv", "--scenario", demo, "--json", "-o", "fixes.csv"]);
    let figures = located.json();
    assert_eq!(bench.runs().len(), 2);
    assert_eq!(positions(&bench, 0), positions(&bench, 1), "the same readings give the same positions");
    let (ours, theirs) = (&figures["track_error_m"][0], &flown["positioning"]["mean_error_m"]);
    let (ours, theirs) = (ours.as_f64().unwrap(), theirs.as_f64().unwrap());
    assert!((ours / theirs - 1.0).abs() < 0.02, "{ours} m, in the run {theirs} m");
    let table = std::fs::read_to_string(bench.path().join("fixes.csv")).unwrap();
    assert_eq!(table.lines().count() as u64, 1 + figures["emissions"].as_u64().unwrap());

    // Both may have begun in the same second: their names differ.
    let is_located = |run: &std::path::PathBuf| run.to_string_lossy().contains("-located-");
    let located = bench.runs().into_iter().find(is_located).unwrap();
    let verified = bench.verify(&located, &[]);
    assert!(verified.code == Some(2) && verified.err.contains("nothing was flown"), "{verified:?}");
    let report = bench.tankops(&["report", located.to_str().unwrap(), "--json"]).json();
    assert_eq!((&report["coverage"], &report["collisions"]), (&Value::Null, &Value::Null));
}

#[test]
fn the_samples_are_located() {
    let bench = Bench::new();
    let demo = scenario("demo.toml");
    for (file, more) in [
        ("demo-ranges.csv", &[][..]),
        ("demo-arrivals.csv", &["--sound-speed", "1200", "--find", "sound-speed", "--find", "clock-offset"]),
        ("demo-differences.csv", &["--sound-speed", "1200"]),
    ] {
        let file = workspace().join("scenarios/readings").join(file);
        let mut command = bench.command();
        command
            .arg("locate")
            .arg(&file)
            .arg("--scenario")
            .arg(&demo)
            .args(["--no-record", "--json"])
            .args(more);
        let figures = crate::bench::Ended::from(command.output().unwrap()).json();
        let error_m = figures["fix_error_m"][0].as_f64().unwrap();
        assert!(error_m < 0.05, "{}: {error_m} m", file.display());
        assert!(figures["failed"].as_object().unwrap().is_empty(), "{figures}");
    }
    assert!(bench.runs().is_empty());
}

#[test]
fn bad_rows_are_refused_by_line_and_column() {
    let bench = Bench::new();
    bench.file("r.csv", "t_s,station,range_m\n0,A,4.1\n0,H,4\n0,B,abc\n");
    let demo = scenario("demo.toml");
    let refused = bench.tankops(&["locate", "r.csv", "--scenario", demo.to_str().unwrap()]);
    assert_eq!(refused.code, Some(2));
    let wanted = [
        "r.csv, line 3, station: the scenario has no station `H`",
        "r.csv, line 4, range_m: `abc` is not a number",
    ];
    assert!(wanted.iter().all(|text| refused.err.contains(text)), "{refused:?}");
    assert!(bench.runs().is_empty());
}

#[test]
fn a_run_becomes_messages_and_a_plan_becomes_files() {
    let bench = Bench::new();
    bench.fly(&scenario("demo.toml"), &["--set", "mission.time_limit_s=20"]);
    let run = bench.runs().pop().unwrap();
    let exported = bench.tankops(&["export", run.to_str().unwrap(), "--mcap", "r.mcap"]);
    assert_eq!(exported.code, Some(0), "{exported:?}");
    let bytes = std::fs::read(bench.path().join("r.mcap")).unwrap();
    let magic = b"\x89MCAP0\r\n";
    assert!(bytes.starts_with(magic) && bytes.ends_with(magic));

    let cover = scenario("cover-circle.toml");
    let cover = cover.to_str().unwrap();
    for file in ["p.csv", "p.geojson", "p.dxf"] {
        assert_eq!(bench.tankops(&["plan", cover, "-o", file]).code, Some(0), "{file}");
    }
    let read = |file: &str| std::fs::read_to_string(bench.path().join(file)).unwrap();
    assert!(read("p.csv").starts_with("leg,tag,x_m,y_m,along_m\n1,"));
    let map: Value = serde_json::from_str(&read("p.geojson")).unwrap();
    let legs =
        map["features"].as_array().unwrap().iter().filter(|f| f["properties"]["layer"] == "path").count();
    assert_eq!(read("p.dxf").matches("POLYLINE\n8\nPATH").count(), legs);
    let again = bench.tankops(&["plan", cover, "-o", "p.csv"]);
    assert!(again.code == Some(2) && again.err.contains("already exists"), "{again:?}");
    let refused = bench.tankops(&["plan", cover, "-o", "p.gcode"]);
    assert!(refused.code == Some(2) && refused.err.contains(".csv, .geojson or .dxf"), "{refused:?}");
}
