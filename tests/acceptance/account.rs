//! One account of the floor: every output prints the same shares, to the last digit.

use crate::bench::{Bench, scenario};
use account::{Fold, Percent, Shares};
use mission::{EventKind, Phase};
use recording::{JOURNAL_FILE, JournalReader, RECORDING_FILE};
use serde_json::Value;
use std::path::{Path, PathBuf};
use tui::model::Run;
use world::FloorClass;

/// The shipped scenarios that scan floor.
fn cover() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(scenario("")).unwrap().map(|entry| entry.unwrap().path());
    let scans = |file: &PathBuf| {
        file.extension().is_some_and(|end| end == "toml")
            && std::fs::read_to_string(file).unwrap().contains("kind = \"cover\"")
    };
    let mut files: Vec<PathBuf> = entries.filter(scans).collect();
    files.sort();
    assert!(files.len() >= 5, "{files:?}");
    files
}

/// The five parts of a floor and its guaranteed part, as printed.
type Printed = [String; 6];

fn of_json(percent: &Value) -> Printed {
    // Untestable floor is stated only if the scenario has an instrument with dead bands.
    let part = |part: &str| match &percent[part] {
        Value::Null if part == "untestable" => "0.0".to_owned(),
        value => format!("{:.1}", value.as_f64().unwrap()),
    };
    ["scanned", "missed", "unreachable", "margin", "untestable", "guaranteed"].map(part)
}

/// The shares in a line of the text, which omits empty parts.
fn of_text(text: &str, floor: &str) -> Printed {
    let line =
        text.lines().find(|line| line.contains(&format!(" {floor} ")) && line.contains(" m²: ")).unwrap();
    let part = |word: &str| {
        let before = line.split(&format!(" % {word}")).next().filter(|before| before.len() < line.len());
        before.map_or_else(|| "0.0".to_owned(), |before| before.rsplit([' ', '(']).next().unwrap().to_owned())
    };
    ["scanned", "missed", "unreachable", "shell margin", "not testable by this tool", "guaranteed"].map(part)
}

/// The cells of the row of an HTML table that begins with a name.
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
    // With untestable floor, there is a column for it before the sum.
    match cells.len() {
        8 => [cells[2], cells[3], cells[4], cells[5], "0.0", cells[7]],
        _ => [cells[2], cells[3], cells[4], cells[5], cells[6], cells[8]],
    }
    .map(str::to_owned)
}

fn of_csv(csv: &str, floor: &str) -> Printed {
    let row: Vec<&str> =
        csv.lines().find(|line| line.starts_with(&format!("{floor},"))).unwrap().split(',').collect();
    let untestable = row.get(9).copied().unwrap_or("0.0");
    [row[3], row[5], row[6], row[7], untestable, row[4]].map(str::to_owned)
}

/// The properties of the recording.
fn of_recording(run: &Path, floor: &str) -> Printed {
    let figures = recording::inspect(&run.join(RECORDING_FILE)).unwrap().figures;
    // The reachable floor has neither unreachable floor nor shell margin.
    let part = |part: &str| format!("{:.1}", figures.get(&format!("{floor}_{part}_percent")).unwrap_or(&0.0));
    ["scanned", "missed", "unreachable", "margin", "untestable", "guaranteed"].map(part)
}

/// The contents of the console's pane after the end of the run.
fn of_pane(run: &Path) -> [Percent; 2] {
    let mut model = Run::default();
    for event in JournalReader::open(&run.join(JOURNAL_FILE)).unwrap() {
        model.fold(&event.unwrap());
    }
    let raster = model.coverage.unwrap();
    [raster.whole(), raster.reachable()].map(|Shares { percent, .. }| percent)
}

/// The shares of a floor in every file format of a report.
struct Files {
    text: String,
    json: Value,
    html: String,
    csv: String,
}

impl Files {
    fn of(bench: &Bench, run: &str) -> Self {
        let text = bench.tankops(&["report", run]).out;
        for file in ["a.html", "a.json", "a.csv"] {
            let written = bench.tankops(&["report", run, "-o", file, "--force"]);
            assert_eq!(written.code, Some(0), "{written:?}");
        }
        let read = |file: &str| std::fs::read_to_string(bench.path().join(file)).unwrap();
        Self {
            text,
            json: serde_json::from_str(&read("a.json")).unwrap(),
            html: read("a.html"),
            csv: read("a.csv"),
        }
    }

    /// Checks that all outputs print the same shares, which sum to 100.0, and returns them. `name` is the name of the
    /// floor in text and CSV.
    fn agree(&self, name: &str, of: &Value, json: &Value) -> Printed {
        let printed = of_json(&of["percent"]);
        let parts: f64 = printed[..5].iter().map(|part| part.parse::<f64>().unwrap()).sum();
        assert!((parts - 100.0).abs() < 1e-9, "{name}: {printed:?}");
        assert_eq!(of_json(&json["percent"]), printed, "{name}, JSON");
        assert_eq!(of_text(&self.text, name), printed, "{name}, text");
        assert_eq!(of_csv(&self.csv, name), printed, "{name}, CSV");
        printed
    }
}

fn assert_explained(of: &Value, causes: &Value) {
    for cause in causes.as_array().unwrap() {
        assert!(cause["measure"]["value_m"].is_number(), "a reason without a number: {of}");
    }
}

#[test]
fn console_text_json_html_csv_and_recording_have_the_same_shares_of_every_cover_scenario() {
    for file in cover() {
        let bench = Bench::new();
        let flown = bench.fly(&file, &[]).json();
        let run = bench.runs().pop().unwrap();
        let files = Files::of(&bench, run.to_str().unwrap());
        let file = file.display();
        for (key, floor, pane) in [("whole", "whole floor", 0), ("reachable", "reachable floor", 1)]
            .map(|(k, f, i)| (k, f, of_pane(&run)[i]))
        {
            let printed = files.agree(floor, &flown["floor"][key], &files.json["floor"][key]);
            assert_eq!(of_recording(&run, key), printed, "{file} {floor}, recording");
            let capital = floor.replacen(['w', 'r'], if key == "whole" { "W" } else { "R" }, 1);
            assert_eq!(of_html(&files.html, &capital), printed, "{file} {floor}, HTML");
            let shown = [pane.scanned, pane.missed, pane.unreachable, pane.margin, pane.untestable]
                .map(|part| format!("{part:.1}"));
            assert_eq!(shown[..], printed[..5], "{file} {floor}, console");
        }
        let plates = flown["floor"]["plates"].as_array().unwrap();
        for (plate, json) in plates.iter().zip(files.json["floor"]["plates"].as_array().unwrap()) {
            let name = plate["name"].as_str().unwrap();
            let [scanned, missed, unreachable, margin, untestable, guaranteed] =
                files.agree(name, plate, json);
            let mut cells = vec![scanned, guaranteed, missed, unreachable, margin];
            cells.extend(flown["floor"]["whole"].get("untestable").map(|_| untestable));
            let cells: Vec<String> =
                cells.iter().map(|cell| format!("<td class=\"r\">{cell}</td>")).collect();
            let row = cells.concat();
            // The table of the critical zone names plates, too.
            let is_of_plates =
                |row: &&str| ["annular", "sketch", "rectangular"].iter().any(|kind| row.contains(kind));
            let mut rows = files.html.split("<tr").filter(is_of_plates);
            let html = rows.find(|row| row.contains(&format!(">{name}</td>")));
            assert!(html.unwrap().contains(&row), "{file} {name}, HTML: {html:?} has not {row}");
        }
        // A refused plan leaves the whole floor missed, and no measure of an area explains it.
        if flown["outcome"] == "aborted" && flown["floor"]["whole"]["scanned"] == 0.0 {
            assert_eq!(flown["floor"]["missed"][0]["reason"], "no_plan", "{file}");
            continue;
        }
        // Every missed area has a reason with a number, and all guaranteed floor was scanned.
        let floor = &flown["floor"];
        for kind in ["missed", "unreachable"] {
            floor[kind].as_array().unwrap().iter().for_each(|area| assert_explained(area, &area["causes"]));
        }
        for kind in ["slivers", "unreachable_slivers"] {
            assert_explained(&floor[kind], &floor[kind]["causes"]);
        }
        let truly = flown["coverage"]["by_truth"]["guaranteed_truly"].as_f64().unwrap();
        assert!(truly >= 0.95, "{file}: {truly}");
    }
}

/// Runs a scan that is held several times, each time until the robot stands still, and then ended early; returns its
/// run.
fn held_scan(bench: &Bench) -> PathBuf {
    let holds: Vec<String> = (1..=4)
        .map(|percent| {
            format!(
                "speed 16\nwait until coverage >= {percent} within 2m\nhold\nwait until phase held within 1m\n\
                 wait until text \"0.00 m/s\" within 1m\nresume\nkey enter\nwait until phase running within 1m\n"
            )
        })
        .collect();
    let holds = holds.concat();
    let script = format!("start\nkey enter\n{holds}end\nkey enter\nwait until phase aborted within 1m\n");
    let (file, tank) = (bench.file("holds.txt", script), scenario("cover-circle.toml"));
    let ended = bench.tankops(&["console", tank.to_str().unwrap(), "--script", file.to_str().unwrap()]);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    bench.runs().pop().unwrap()
}

#[test]
fn floor_that_a_held_robot_passes_while_it_brakes_has_an_error_in_the_account_and_counts_on_the_screen() {
    let bench = Bench::new();
    let run = held_scan(&bench);
    let (mut screen, mut fold, mut while_held) = (Run::default(), Fold::new(), 0);
    for event in JournalReader::open(&run.join(JOURNAL_FILE)).unwrap() {
        let event = event.unwrap();
        screen.fold(&event);
        fold.apply(&event);
        let is_held = matches!(screen.phase(), Phase::Held(_));
        while_held += usize::from(is_held && matches!(event.kind, EventKind::Covered { .. }));
    }
    assert!(while_held > 0, "nothing was scanned while the robot braked");
    let (screen, account) = (screen.coverage.unwrap(), fold.scanned().unwrap());
    let floor = screen.floor();
    for cell in (0..floor.len()).filter(|cell| screen.is_scanned(*cell)) {
        let at = floor.center(cell);
        assert!(account.passes().error_mm(cell).is_some(), "no error at {at}");
        let class = screen.class_at(at, false).map_or(FloorClass::Outside, |(class, _)| class);
        assert_eq!(class, account.class(cell), "at {at}");
    }
    let figures = recording::inspect(&run.join(RECORDING_FILE)).unwrap().figures;
    let guaranteed = fold.summary().floor.unwrap().whole.percent.guaranteed.unwrap();
    assert!((figures["whole_guaranteed_percent"] - guaranteed).abs() < 1e-9);
}
