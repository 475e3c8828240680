//! One account of the floor: whoever prints a share prints the same one, to the last digit.

use crate::bench::{Bench, scenario};
use recording::{JOURNAL_FILE, JournalReader, RECORDING_FILE};
use report::account::{Percent, Shares};
use serde_json::Value;
use std::path::Path;
use tui::model::Run;

const COVER: [&str; 3] = ["cover-circle.toml", "cover-square.toml", "cover-unknown-columns.toml"];

/// The four parts of a floor and what is guaranteed of it, as they are printed.
type Printed = [String; 5];

fn of_json(percent: &Value) -> Printed {
    let part = |part: &str| format!("{:.1}", percent[part].as_f64().unwrap());
    ["scanned", "missed", "unreachable", "margin", "guaranteed"].map(part)
}

/// What a line of the text says; parts without anything are left out there.
fn of_text(text: &str, floor: &str) -> Printed {
    let line =
        text.lines().find(|line| line.contains(&format!(" {floor} ")) && line.contains(" m²: ")).unwrap();
    let part = |word: &str| {
        let before = line.split(&format!(" % {word}")).next().filter(|before| before.len() < line.len());
        before.map_or_else(|| "0.0".to_owned(), |before| before.rsplit([' ', '(']).next().unwrap().to_owned())
    };
    ["scanned", "missed", "unreachable", "shell margin", "guaranteed"].map(part)
}

/// The cells of the row of a table of HTML that begins with a name.
fn of_html(html: &str, floor: &str) -> Printed {
    let row = html
        .split("<tr")
        .find(|row| row.contains(&format!(">{floor}</td>")) && row.contains("100.0"))
        .unwrap();
    let cells: Vec<&str> = row
        .split("<td")
        .skip(1)
        .map(|cell| cell.split_once('>').unwrap().1.split('<').next().unwrap())
        .collect();
    [2, 3, 4, 5, 7].map(|cell| cells[cell].to_owned())
}

fn of_csv(csv: &str, floor: &str) -> Printed {
    let row: Vec<&str> =
        csv.lines().find(|line| line.starts_with(&format!("{floor},"))).unwrap().split(',').collect();
    [3, 5, 6, 7, 4].map(|cell| row[cell].to_owned())
}

/// The properties of the recording.
fn of_recording(run: &Path, floor: &str) -> Printed {
    let figures = recording::inspect(&run.join(RECORDING_FILE)).unwrap().figures;
    // The reachable floor has neither of the other two.
    let part = |part: &str| format!("{:.1}", figures.get(&format!("{floor}_{part}_percent")).unwrap_or(&0.0));
    ["scanned", "missed", "unreachable", "margin", "guaranteed"].map(part)
}

/// What the console's pane shows when the run is over.
fn of_pane(run: &Path) -> [Percent; 2] {
    let mut model = Run::default();
    for event in JournalReader::open(&run.join(JOURNAL_FILE)).unwrap() {
        model.fold(&event.unwrap());
    }
    let raster = model.coverage.unwrap();
    [raster.whole(), raster.reachable()].map(|Shares { percent, .. }| percent)
}

#[test]
fn console_text_json_html_csv_and_recording_have_the_same_shares_of_every_cover_scenario() {
    for name in COVER {
        let bench = Bench::new();
        let flown = bench.fly(&scenario(name), &[]).json();
        let run = bench.runs().pop().unwrap();
        let path = run.to_str().unwrap();
        let text = bench.tankops(&["report", path]).out;
        for file in ["a.html", "a.json", "a.csv"] {
            let written = bench.tankops(&["report", path, "-o", file]);
            assert_eq!(written.code, Some(0), "{written:?}");
        }
        let read = |file: &str| std::fs::read_to_string(bench.path().join(file)).unwrap();
        let (html, csv, json) = (read("a.html"), read("a.csv"), read("a.json"));
        let json: Value = serde_json::from_str(&json).unwrap();
        for (key, floor, pane) in [("whole", "whole floor", 0), ("reachable", "reachable floor", 1)]
            .map(|(k, f, i)| (k, f, of_pane(&run)[i]))
        {
            let printed = of_json(&flown["floor"][key]["percent"]);
            let parts: f64 = printed[..4].iter().map(|part| part.parse::<f64>().unwrap()).sum();
            assert!((parts - 100.0).abs() < 1e-9, "{name} {floor}: {printed:?}");
            assert_eq!(of_json(&json["floor"][key]["percent"]), printed, "{name} {floor}, JSON");
            assert_eq!(of_text(&text, floor), printed, "{name} {floor}, text");
            assert_eq!(of_recording(&run, key), printed, "{name} {floor}, recording");
            let capital = floor.replacen(['w', 'r'], if key == "whole" { "W" } else { "R" }, 1);
            assert_eq!(of_html(&html, &capital), printed, "{name} {floor}, HTML");
            assert_eq!(of_csv(&csv, floor), printed, "{name} {floor}, CSV");
            let shown =
                [pane.scanned, pane.missed, pane.unreachable, pane.margin].map(|part| format!("{part:.1}"));
            assert_eq!(shown[..], printed[..4], "{name} {floor}, console");
        }
        // Every gap says why with a number, and what is guaranteed was scanned.
        for area in flown["floor"]["missed"].as_array().unwrap() {
            for cause in area["causes"].as_array().unwrap() {
                assert!(
                    cause["measure"]["value_m"].is_number() || cause["reason"] == "not_asked",
                    "{name}: {area}"
                );
            }
        }
        let truly = flown["coverage"]["by_truth"]["guaranteed_truly"].as_f64().unwrap();
        assert!(truly >= 0.95, "{name}: {truly}");
    }
}
