//! The queries of `rerun.md`, run as they stand there on a recording of a run.

use crate::bench::{Bench, Ended, scenario, workspace};
use std::process::Command;

/// The Python programs of a document.
fn programs(document: &str) -> Vec<&str> {
    document.split("```python\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
}

fn python(bench: &Bench, program: &str) -> Option<Ended> {
    let output = Command::new("python3").current_dir(bench.path()).args(["-c", program]).output();
    output.ok().map(Ended::from)
}

#[test]
fn the_queries_of_the_document_run_on_a_recording() {
    let bench = Bench::new();
    let has_library = "import rerun, datafusion, pandas; assert rerun.__version__ == '0.36.3'";
    if python(&bench, has_library).is_none_or(|ended| ended.code != Some(0)) {
        eprintln!("skipped: python3 has no rerun-sdk[catalog] 0.36.3");
        return;
    }
    let flown = bench.fly(&scenario("cover-circle.toml"), &[]).json();
    let document = std::fs::read_to_string(workspace().join("console/docs/rerun.md")).unwrap();
    let ended: Vec<Ended> =
        programs(&document).iter().filter_map(|program| python(&bench, program)).collect();
    assert!(ended.len() == 3 && ended.iter().all(|ended| ended.code == Some(0)), "{ended:#?}");
    let scanned = &flown["floor"]["reachable"]["percent"]["scanned"];
    assert!(ended[0].out.contains(&format!("reachable_scanned_percent {scanned}\n")), "{ended:#?}");
    assert!(ended[1].out.starts_with("worst "), "{ended:#?}");
    assert_eq!(ended[2].out.lines().filter(|line| line.starts_with("station ")).count(), 5, "{ended:#?}");
}
