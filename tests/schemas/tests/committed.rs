//! The schemas in `console/docs` match the types.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use schemas::{Document, Root, Sources};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// The crates with the written types.
const CRATES: [(&str, &str); 13] = [
    ("geometry", "console/geometry/src"),
    ("world", "console/world/src"),
    ("positioning", "console/positioning/src"),
    ("sim", "console/sim/src"),
    ("planner_api", "plugins/planner-api/src"),
    ("mission", "console/mission/src"),
    ("account", "console/account/src"),
    ("report", "console/report/src"),
    ("runs", "console/runs/src"),
    ("exploration", "console/exploration/src"),
    ("perception", "console/perception/src"),
    ("vehicle", "console/vehicle/src"),
    ("review", "console/review/src"),
];

fn project() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn sources() -> Sources {
    let folders = CRATES.map(|(name, folder)| (name, project().join(folder)));
    Sources::read(&folders.each_ref().map(|(name, folder)| (*name, folder.as_path())))
}

/// A constant in the sources, found by its declaration.
fn version(file: &str, name: &str) -> u32 {
    let text = fs::read_to_string(project().join(file)).unwrap();
    let declared = text.split(&format!("pub const {name}: u32 = ")).nth(1).unwrap();
    declared.split(';').next().unwrap().parse().unwrap()
}

/// Compares a schema with the committed file, or renews the file.
fn is_committed(file: &str, schema: &serde_json::Value) {
    let path = project().join("console/docs").join(file);
    let text = serde_json::to_string_pretty(schema).unwrap() + "\n";
    if std::env::var_os("SCHEMA_UPDATE").is_some() {
        fs::write(&path, &text).unwrap();
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    let first = text.lines().zip(committed.lines()).position(|(new, old)| new != old);
    assert!(
        text == committed,
        "console/docs/{file} is not that of the types (line {:?}); `SCHEMA_UPDATE=1 cargo test --release -p schemas` renews \
         it. If something that existed before is now written differently, raise the version.",
        first.map(|line| line + 1)
    );
}

#[test]
fn the_schema_of_reports_is_that_of_the_types() {
    let version = version("console/account/src/summary.rs", "REPORT_VERSION");
    let roots = [
        Root {
            of_crate: "runs",
            name: "ReportFile",
            about: "The figures of one run, as `report.json` in its folder.",
        },
        Root {
            of_crate: "account",
            name: "Summary",
            about: "The figures of one run, as `tankops run --json` and `tankops report RUN --json` print them.",
        },
        Root {
            of_crate: "report",
            name: "Document",
            about: "The inspection report: `tankops report RUN... -o FILE.json`.",
        },
    ];
    let id = format!("urn:tankops:report:{version}");
    is_committed("report-schema.json", &Document::of(&sources(), "Reports of tankops", &id, &roots));
}

#[test]
fn the_schema_of_events_is_that_of_the_types() {
    let version = version("console/mission/src/event.rs", "JOURNAL_VERSION");
    let about = "One line of a journal: `events.jsonl.zst` in the folder of a run, decompressed, or `tankops events RUN`. The \
                 first line is the event `run_opened`, whose `journal_version` is the version of this schema.";
    let of_stream = "A line of `tankops events RUN --follow` that is not an event of the run.";
    let roots = [
        Root { of_crate: "mission", name: "Event", about },
        Root { of_crate: "review", name: "StreamLine", about: of_stream },
    ];
    let id = format!("urn:tankops:events:{version}");
    is_committed("events-schema.json", &Document::of(&sources(), "Events of tankops", &id, &roots));
}

#[test]
fn the_schema_of_the_vehicle_protocol_is_that_of_the_types() {
    let version = version("console/vehicle/src/wire.rs", "PROTOCOL");
    let roots = [
        Root {
            of_crate: "vehicle",
            name: "FromVehicle",
            about: "One line from the vehicle. Keys that are not named here are ignored.",
        },
        Root {
            of_crate: "vehicle",
            name: "ToVehicle",
            about: "One line to the vehicle. Keys that are not named here are ignored.",
        },
    ];
    let id = format!("urn:tankops:vehicle:{version}");
    is_committed(
        "vehicle-schema.json",
        &Document::of(&sources(), "Vehicle protocol of tankops", &id, &roots),
    );
}
