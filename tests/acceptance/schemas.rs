//! The JSON Schemas in `console/docs`, with an independent validator.

use crate::bench::{Bench, journal_text, passed_over, scenario, workspace};
use std::process::Command;

/// Validates a file of JSON lines; it must not contain anything that the schema does not name.
const PROGRAM: &str = r#"
import json, sys
from jsonschema import Draft202012Validator

def strict(node):
    if isinstance(node, dict):
        if "properties" in node:
            node.setdefault("additionalProperties", False)
        for part in node.values():
            strict(part)
    elif isinstance(node, list):
        for part in node:
            strict(part)

schema = json.load(open(sys.argv[1]))
Draft202012Validator.check_schema(schema)
strict(schema)
validator = Draft202012Validator(schema)
seen = {}
for line in open(sys.argv[2]):
    value = json.loads(line)
    kind = value.get("event", "report")
    seen[kind] = seen.get(kind, 0) + 1
    if seen[kind] > 20:
        continue
    for error in validator.iter_errors(value):
        def deepest(error):
            return max((deepest(part) for part in error.context or []), key=lambda e: len(e.absolute_path), default=error)
        error = deepest(error)
        print(kind, list(error.absolute_path), error.message[:300])
        sys.exit(1)
print(sum(seen.values()), "valid:", " ".join(sorted(seen)))
"#;

fn validated(bench: &Bench, schema: &str, file: &str) -> Option<(bool, String)> {
    let schema = workspace().join("console/docs").join(schema);
    let ended = Command::new("python3")
        .current_dir(bench.path())
        .args(["-c", PROGRAM])
        .arg(schema)
        .arg(file)
        .output();
    let ended = ended.ok()?;
    let told = String::from_utf8_lossy(&ended.stdout).into_owned() + &String::from_utf8_lossy(&ended.stderr);
    Some((ended.status.success(), told))
}

#[test]
fn shipped_runs_are_valid_by_their_schemas() {
    let has_library = Command::new("python3")
        .args(["-c", "import jsonschema.validators as v; v.Draft202012Validator"])
        .output();
    if !has_library.is_ok_and(|ended| ended.status.success()) {
        passed_over("python3 has no jsonschema");
        return;
    }
    for name in
        ["cover-circle.toml", "goto-single-obstacle.toml", "spiral-paper.toml", "tether-out-and-back.toml"]
    {
        let bench = Bench::new();
        let flown = bench.fly(&scenario(name), &[]).json();
        let run = bench.runs().pop().unwrap();
        bench.file("run.json", flown.to_string() + "\n");
        let stored = std::fs::read_to_string(run.join("report.json")).unwrap();
        let stored: serde_json::Value = serde_json::from_str(&stored).unwrap();
        assert_eq!(stored["report_version"], flown["report_version"]);
        let heartbeat = r#"{"event":"heartbeat","tick":3,"t_s":0.3}"#;
        bench.file("events.jsonl", journal_text(&run) + heartbeat + "\n");
        let mut files = vec![("report-schema.json", "run.json"), ("events-schema.json", "events.jsonl")];
        if name.starts_with("cover") {
            assert_eq!(bench.tankops(&["report", run.to_str().unwrap(), "-o", "r.json"]).code, Some(0));
            let report = std::fs::read_to_string(bench.path().join("r.json")).unwrap();
            let report: serde_json::Value = serde_json::from_str(&report).unwrap();
            bench.file("inspection.json", report.to_string() + "\n");
            files.push(("report-schema.json", "inspection.json"));
        }
        for (schema, file) in files {
            let (is_valid, told) = validated(&bench, schema, file).unwrap();
            assert!(is_valid, "{name}, {file}: {told}");
        }
    }
}
