//! The queries of `rerun.md`, run exactly as printed on recordings of runs.

use crate::{
    bench::{Bench, Ended, passed_over, scenario, workspace},
    killed::{begin_and_kill, slow_scenario},
};
use std::{path::Path, process::Command};

/// The Python programs of a document.
fn programs(document: &str) -> Vec<&str> {
    document.split("```python\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
}

fn python(bench: &Bench, program: &str) -> Option<Ended> {
    let output = Command::new("python3").current_dir(bench.path()).args(["-c", program]).output();
    output.ok().map(Ended::from)
}

/// Whether the recording of a run in progress contains fixes; each entity has one row for the style of its plot.
/// Whether the recording holds fixes from all three stations.
fn has_fixes(run: &Path) -> bool {
    let is_fixed = |(entity, rows): (&String, &u64)| entity.starts_with("scalars/residual/") && *rows > 2;
    recording::inspect(&run.join("recording.rrd"))
        .is_ok_and(|has| has.entities.iter().filter(|entity| is_fixed(*entity)).count() >= 3)
}

#[test]
fn the_queries_of_the_document_run_on_a_recording() {
    let bench = Bench::new();
    let has_library = "import rerun, datafusion, pandas; assert rerun.__version__ == '0.36.3'";
    if python(&bench, has_library).is_none_or(|ended| ended.code != Some(0)) {
        passed_over("python3 has no rerun-sdk[catalog] 0.36.3");
        return;
    }
    let flown = bench.fly(&scenario("cover-circle.toml"), &[]).json();
    for other in ["goto-single-obstacle.toml", "spiral-paper.toml"] {
        bench.fly(&scenario(other), &[]);
    }
    begin_and_kill(&bench, &slow_scenario(&bench), 11, has_fixes);
    let document = std::fs::read_to_string(workspace().join("console/docs/rerun.md")).unwrap();
    let ended: Vec<Ended> =
        programs(&document).iter().filter_map(|program| python(&bench, program)).collect();
    assert!(ended.len() == 3 && ended.iter().all(|ended| ended.code == Some(0)), "{ended:#?}");
    let names: Vec<String> =
        bench.runs().iter().map(|run| run.file_name().unwrap().to_string_lossy().into_owned()).collect();
    assert_eq!(names.len(), 4);
    let begins = |line: &&str| names.iter().any(|name| line.starts_with(name.as_str()));
    assert_eq!(ended[0].out.lines().filter(begins).count(), 4, "{ended:#?}");
    assert_eq!(ended[0].out.matches("no end: its writer was killed").count(), 1, "{ended:#?}");
    assert_eq!(ended[0].out.matches("missed_m2").count(), 1, "only one mission was to scan: {ended:#?}");
    let scanned = 100.0 * flown["coverage"]["reachable"].as_f64().unwrap();
    let printed = ended[0].out.split("reachable_scanned_percent ").nth(1).unwrap().lines().next().unwrap();
    assert!((printed.parse::<f64>().unwrap() - scanned).abs() < 1e-3, "{printed} {scanned}");
    assert!(ended[1].out.lines().filter(begins).count() >= 3, "{ended:#?}");
    assert!(ended[1].out.lines().all(|line| begins(&line) && line.contains(" worst ")), "{ended:#?}");
    assert!(ended[2].out.lines().filter(begins).count() >= 3, "{ended:#?}");
    assert!(ended[2].out.lines().filter(|line| line.starts_with("  station ")).count() >= 15, "{ended:#?}");
}
