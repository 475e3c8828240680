//! Readings of a run, located as if a real system had measured them; plans and runs as files for other programs.

use crate::bench::{Bench, scenario, workspace};
use serde_json::Value;

/// The estimates in a journal, and its positions from ranges.
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

    // Both runs may have begun in the same second, so only their names differ.
    let is_located = |run: &std::path::PathBuf| run.to_string_lossy().contains("-located-");
    let located = bench.runs().into_iter().find(is_located).unwrap();
    let verified = bench.verify(&located, &[]);
    assert!(verified.code == Some(0) && verified.out.contains("not a mission"), "{verified:?}");
    let report = bench.tankops(&["report", located.to_str().unwrap(), "--json"]).json();
    assert_eq!((&report["coverage"], &report["collisions"]), (&Value::Null, &Value::Null));
}

/// Locates readings of a short run, with the tool on for a while or without information about the tool; returns the
/// folder of the run.
fn located_run(bench: &Bench, tool_on: Option<&str>) -> String {
    let cover = scenario("cover-circle.toml");
    bench.fly(&cover, &["--set", "mission.time_limit_s=120"]);
    let run = bench.runs().pop().unwrap();
    assert_eq!(bench.tankops(&["export", run.to_str().unwrap(), "--ranges", "r.csv"]).code, Some(0));
    std::fs::remove_dir_all(&run).unwrap();
    let mut arguments = vec!["locate", "r.csv", "--scenario", cover.to_str().unwrap()];
    if let Some(stretches) = tool_on {
        bench.file("on.csv", stretches);
        arguments.extend(["--tool-on", "on.csv"]);
    }
    let located = bench.tankops(&arguments);
    assert_eq!(located.code, Some(0), "{located:?}");
    bench.runs().pop().unwrap().to_str().unwrap().to_owned()
}

#[test]
fn readings_are_reported_as_what_they_are_and_what_they_do_not_say_is_not_zero() {
    let bench = Bench::new();
    let run = located_run(&bench, None);
    for file in ["d.html", "d.json", "d.csv", "d.geojson", "d.dxf"] {
        let written = bench.tankops(&["report", &run, "-o", file]);
        assert_eq!(written.code, Some(0), "{file}: {written:?}");
    }
    let read = |file: &str| std::fs::read_to_string(bench.path().join(file)).unwrap();
    let page = read("d.html");
    for wanted in [
        "LOCATED FROM READINGS",
        "positions located from readings",
        "coverage not stated",
        "inspection.coverage_waiver",
    ] {
        assert!(page.contains(wanted), "{wanted}");
    }
    for unwanted in ["SIMULATION", "Missed areas", "Mission time", "missed_accepted", "planner"] {
        assert!(!page.contains(unwanted), "{unwanted}");
    }
    let report: Value = serde_json::from_str(&read("d.json")).unwrap();
    assert_eq!((&report["coverage"], &report["floor"]["whole"]["scanned"]), (&Value::Null, &Value::Null));
    assert_eq!(report["located"]["tool_on_s"], Value::Null);
    assert!(
        report["runs"][0].get("collisions").is_none() && report["runs"][0]["accuracy"]["p95_m"].is_number()
    );
    let plates = read("d.csv");
    assert!(
        plates.lines().nth(1).unwrap().starts_with("whole floor,base,") && plates.contains(",,,,,"),
        "{plates}"
    );
    assert!(!plates.contains("reachable floor"), "{plates}");
    let track = read("d-track.csv");
    assert!(track.lines().count() > 1000, "{}", track.lines().count());
    let map: Value = serde_json::from_str(&read("d.geojson")).unwrap();
    let of = |layer: &str| {
        map["features"].as_array().unwrap().iter().filter(|f| f["properties"]["layer"] == layer).count()
    };
    assert!(of("positions") > 20 && of("track") == 1 && of("missed") == 0, "{}", of("positions"));
    let text = bench.tankops(&["report", &run]).out;
    assert!(text.contains("located from the readings in r.csv") && !text.contains("0 turns"), "{text}");
}

#[test]
fn readings_with_the_tool_on_state_coverage_and_are_signed_as_located() {
    let bench = Bench::new();
    let run = located_run(&bench, Some("from_s,to_s\n20,60\n"));
    let facts = crate::report_file::FACTS;
    let sign = |facts: &str| {
        bench.file("facts.toml", facts);
        bench.file("found.csv", "t_s,kind\n30,pit\n");
        bench.tankops(&[
            "report",
            &run,
            "-o",
            "a.html",
            "--inspection",
            "facts.toml",
            "--indications",
            "found.csv",
            "--sign",
            "L. Kern",
        ])
    };
    let open = sign(facts);
    assert!(open.code == Some(2) && open.err.contains("inspection.inspected_on"), "{open:?}");
    let signed = sign(&format!("{facts}inspected_on = \"2026-11-24\"\n"));
    assert!(signed.code == Some(0) && signed.out.contains("signed as revision A"), "{signed:?}");
    let page = std::fs::read_to_string(bench.path().join("a.html")).unwrap();
    assert!(page.contains("The tool was on for 00:00:40") && page.contains("LOCATED FROM READINGS"));
    let report = bench.tankops(&["report", &run, "-o", "d.json"]);
    assert_eq!(report.code, Some(0), "{report:?}");
    let report: Value =
        serde_json::from_str(&std::fs::read_to_string(bench.path().join("d.json")).unwrap()).unwrap();
    let scanned = report["floor"]["whole"]["scanned"].as_f64().unwrap();
    assert!(scanned > 0.01 && scanned < 0.2 && report["located"]["tool_on_s"] == 40.0, "{scanned}");
    let run = std::path::PathBuf::from(run);
    let verified = bench.verify(&run, &[]);
    assert!(verified.code == Some(0) && verified.out.contains("signed: revision A"), "{verified:?}");
    assert!(verified.out.contains("events recomputed from the readings, byte for byte"), "{verified:?}");
    std::fs::remove_file(bench.path().join("a.html")).unwrap();
    let verified = bench.verify(&run, &[]);
    assert!(verified.code == Some(1) && verified.out.contains("NOT AS SIGNED"), "{verified:?}");
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

/// The sample's ranges are too long by 2 %, and every station has a clock of its own: offsets of up to 35 cm of sound.
#[test]
fn pulses_of_the_stations_correct_the_readings_and_are_in_the_report() {
    let bench = Bench::new();
    let (demo, file) = (scenario("demo.toml"), workspace().join("scenarios/readings/demo-pulses.csv"));
    let locate = |file: &std::path::Path, more: &[&str]| {
        let paths = [file.to_str().unwrap(), "--scenario", demo.to_str().unwrap()];
        bench.tankops(&[&["locate"][..], &paths[..], more].concat())
    };
    let figures = locate(&file, &["--json"]).json();
    assert_eq!(figures["fixes"], serde_json::json!({ "ok": 5 }), "{figures}");
    assert!(figures["fix_error_m"][0].as_f64().unwrap() < 0.05, "{figures}");
    let tests = figures["pulse_tests"].as_array().unwrap();
    assert_eq!(tests.iter().map(|test| &test["phase"]).collect::<Vec<_>>(), ["before", "after"]);
    for test in tests {
        assert_eq!(test["survey"], "ok", "{test}");
        let scale = test["range_scale"][0].as_f64().unwrap();
        assert!((scale - 0.02).abs() < 0.01, "{test}");
        let late_m = test["clock_offsets_m"]["A"][0].as_f64().unwrap();
        assert!((late_m - 0.35).abs() < 0.08, "{test}");
    }
    let run = bench.runs().pop().unwrap();
    let report = bench.tankops(&["report", run.to_str().unwrap(), "-o", "r.html"]);
    assert_eq!(report.code, Some(0), "{report:?}");
    let page = std::fs::read_to_string(bench.path().join("r.html")).unwrap();
    assert!(page.contains("pulse test before the run: 20 pulses"), "the report states the test");
    // Without the pulses, the ranges contradict each other in every fix.
    let text = std::fs::read_to_string(&file).unwrap();
    let is_pulse = |line: &&str| line.split(',').nth(2).is_some_and(|sender| sender.len() == 1);
    let without: Vec<&str> = text.lines().filter(|line| !is_pulse(line)).collect();
    let without = bench.file("without.csv", without.join("\n"));
    let figures = locate(&without, &["--json", "--no-record"]).json();
    assert_eq!(figures["fixes"], serde_json::json!({ "alarm": 5 }), "{figures}");
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
