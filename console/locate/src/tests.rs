#![allow(clippy::unwrap_used, reason = "tests")]

use crate::{Kind, MeasuredWriter, Survey, Tally, Task};
use mission::{Event, EventKind};
use scenario::Scenario;
use std::{collections::BTreeMap, fmt::Write as _, path::PathBuf};
use tempfile::TempDir;
use world::{Odometry, Point, Pose, RangeSet, Readings};

mod calibrated;
mod pulses;

const SCENARIO: &str = r#"
name = "bare"
seed = 1
[tank]
radius_m = 10.0
[robot]
start_m = [3.0, 0.0]
start_heading_deg = 90.0
[ae]
stations = [
    { name = "A", at_m = [10.0, 0.0] },
    { name = "B", at_m = [5.0, 8.66] },
    { name = "C", at_m = [-5.0, 8.66] },
    { name = "D", at_m = [-10.0, 0.0] },
    { name = "E", at_m = [-5.0, -8.66] },
    { name = "F", at_m = [5.0, -8.66] },
]
noise = { model = "gaussian", sigma_ratio = 0.005 }
[mission]
kind = "goto"
goal_m = [0.0, 5.0]
[planner]
id = "navfn"
"#;

fn scenario() -> Scenario {
    Scenario::parse(SCENARIO, "bare.toml").map_err(|errors| errors.render()).unwrap()
}

/// A file of readings in a folder of its own.
struct Readable {
    _dir: TempDir,
    file: PathBuf,
}

impl Readable {
    fn new(name: &str, bytes: impl AsRef<[u8]>) -> Self {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join(name);
        std::fs::write(&file, bytes).unwrap();
        Self { _dir: dir, file }
    }

    fn task<'a>(&'a self, scenario: &'a Scenario) -> Task<'a> {
        Task {
            file: &self.file,
            shown: self.file.to_str().unwrap(),
            scenario,
            sound_speed_m_s: None,
            finds_sound_speed: false,
            finds_clock_offset: false,
            skips_bad_rows: false,
            tool_on: None,
        }
    }

    /// The problem with the file; the folder of the file is left out of the text.
    fn refused(&self) -> String {
        let scenario = scenario();
        let error = self.task(&scenario).survey().unwrap_err().to_string();
        error.replace(&self.file.display().to_string(), "r.csv")
    }
}

fn located(task: &Task, survey: &Survey) -> (Tally, Vec<Event>) {
    let (mut tally, mut all) = (Tally::default(), Vec::new());
    task.locate(survey, |events| {
        tally.take(events);
        all.extend_from_slice(events);
    })
    .unwrap();
    (tally, all)
}

/// The k-th place on a walk around the middle.
fn place(k: u32) -> Point {
    let angle = f64::from(k) * 0.05;
    Point::new(3.0 * angle.cos(), 3.0 * angle.sin())
}

/// Ranges along a walk with errors that look random, in one row for each station: time, name, range, place.
fn walk(moments: u32) -> Vec<(f64, String, f64, Point)> {
    let stations = scenario().sim.world.stations;
    let error = |k: u32, i: usize| 0.005 * ((f64::from(k) * 12.9 + i as f64 * 78.2).sin() * 43_758.5).sin();
    let row = |k: u32, (i, station): (usize, &world::Station)| {
        let distance_m = (place(k) - station.position).norm();
        (f64::from(k) * 0.5, station.name.clone(), distance_m * (1.0 + error(k, i)), place(k))
    };
    (0..moments)
        .flat_map(|k| stations.iter().enumerate().map(move |station| row(k, station)).collect::<Vec<_>>())
        .collect()
}

#[test]
fn ranges_in_any_unit_and_form_are_the_same_readings() {
    let (mut metres, mut german) =
        (String::from("t_s,station,range_m\n"), String::from("\u{feff}# AE\nstation;range_mm;t_ms;dB\n"));
    for (t_s, station, range_m, _) in walk(20) {
        let _ = writeln!(metres, "{t_s},{station},{range_m:.6}");
        let _ = writeln!(
            german,
            "{}",
            format!("{station};{:.3};{};63.5", range_m * 1e3, t_s * 1e3).replace('.', ",")
        );
    }
    let (scenario, metres, german) =
        (scenario(), Readable::new("r.csv", metres), Readable::new("g.csv", german));
    let (one, other) = (metres.task(&scenario), german.task(&scenario));
    let survey = other.survey().unwrap();
    assert_eq!((survey.rows, survey.ignored.as_slice()), (120, &["dB".to_owned()][..]));
    let places = |events: &[Event]| -> Vec<Point> {
        let fix = |event: &Event| match &event.kind {
            EventKind::Fixed { fix } => Some(fix.position),
            _ => None,
        };
        events.iter().filter_map(fix).collect()
    };
    let (a, b) = (located(&one, &one.survey().unwrap()).1, located(&other, &survey).1);
    assert_eq!(places(&a).len(), 20);
    assert!(places(&a).iter().zip(places(&b)).all(|(a, b)| (a - b).norm() < 1e-5));
}

#[test]
fn bad_rows_are_named_by_line_and_column() {
    let bad = "t_s,station,range_m,repetitions\n0,A,5.1,1\n0.5,G,5,1\n0.5,B,x,1\n0.5,C,,1\n0.5,,4,1\n0.5,D,-3,1\n\
               0.5,E,3,0\n,F,3,1\n0.4,A,1\n-1,B,2,1\n";
    insta::assert_snapshot!(Readable::new("r.csv", bad).refused());
    let scenario = scenario();
    let file = Readable::new("r.csv", bad);
    let survey = Task { skips_bad_rows: true, ..file.task(&scenario) }.survey().unwrap();
    assert_eq!((survey.rows, survey.bad), (10, 8));
}

#[test]
fn times_that_no_file_covers_are_bad_rows() {
    let scenario = scenario();
    for (times, line, part) in [
        (["0", "1e308"], 3, "1e308 s is not a possible time"),
        (["-1e308", "0"], 2, "-1e308 s is not a possible time"),
        (
            ["0", "40000000"],
            3,
            "463 days after the first time, 0 s in line 2, but a file covers at most 366 days",
        ),
    ] {
        let rows: Vec<String> = times.iter().map(|t_s| format!("{t_s},A,5.0")).collect();
        let text = Readable::new("r.csv", format!("t_s,station,range_m\n{}\n", rows.join("\n"))).refused();
        assert!(text.contains(&format!("r.csv, line {line}, t_s: ")) && text.contains(part), "{text}");
    }
    let readable = Readable::new("r.csv", "t_s,station,range_m\n0,A,5.0\n31000000,A,5.0\n");
    assert_eq!(readable.task(&scenario).survey().unwrap().rows, 2);
}

/// If nearly every fix contradicts itself, the common cause is found all the same.
#[test]
fn ranges_that_are_all_too_long_are_said_to_be_although_no_fix_is_sound() {
    let scenario = scenario();
    let mut text = "t_s,station,range_m\n".to_owned();
    for k in 0..60_u32 {
        let at = place(k);
        for station in &scenario.sim.world.stations {
            let range_m = (station.position - at).norm() * 1.3;
            writeln!(text, "{k},{},{range_m}", station.name).unwrap();
        }
    }
    let survey = Readable::new("r.csv", text).task(&scenario).survey().unwrap();
    let scale = survey.verdict.scale.unwrap();
    assert!(scale.is_proven && (scale.value - 0.3).abs() < 0.05, "{:?}", survey.verdict);
}

#[test]
fn a_bad_row_in_the_middle_of_an_emission_does_not_divide_it() {
    let (mut good, mut bad) = (String::from("t_s,station,range_m\n"), String::new());
    for (t_s, station, range_m, _) in walk(5) {
        let _ = writeln!(good, "{t_s},{station},{range_m}");
        let middle = if station == "C" { format!("{t_s},G,1\n{t_s},A,x\n") } else { String::new() };
        let _ = writeln!(bad, "{middle}{t_s},{station},{range_m}");
    }
    let bad = "t_s,station,range_m\n".to_owned() + &bad;
    let (scenario, good, bad) = (scenario(), Readable::new("g.csv", good), Readable::new("b.csv", bad));
    let (whole, rest) = (good.task(&scenario), Task { skips_bad_rows: true, ..bad.task(&scenario) });
    let (survey, left) = (whole.survey().unwrap(), rest.survey().unwrap());
    assert_eq!((left.rows, left.bad), (survey.rows + 10, 10));
    let fixes = |task: &Task, survey: &Survey| located(task, survey).0.fixes;
    assert_eq!(fixes(&rest, &left), fixes(&whole, &survey));
}

#[test]
fn a_file_without_what_it_needs_is_refused_with_what_would_be_right() {
    let cases = [
        "",
        "t_s,range_m\n0,1\n",
        "t_s,station,rnage_m\n0,A,1\n",
        "station,range_m\nA,1\n",
        "t_s,station,arrival_us\n0,A,1\n",
        "t_s,station,range_m,range_mm\n0,A,1,1\n",
        "t_s,station,range_m\n",
    ];
    let all: Vec<String> = cases.iter().map(|text| Readable::new("r.csv", text).refused()).collect();
    insta::assert_snapshot!(all.join("\n"));
}

#[test]
fn arrivals_with_a_late_clock_and_slow_sound_are_located_once_both_are_found() {
    let mut text = String::from("t_s,station,emitted_us,arrival_us,true_x_m,true_y_m\n");
    for (t_s, station, range_m, at) in walk(600) {
        let emitted_us = t_s * 1e6;
        let arrival_us = emitted_us + range_m / 1176.0 * 1e6 + 850.0;
        let _ = writeln!(text, "{t_s},{station},{emitted_us},{arrival_us:.3},{},{}", at.x, at.y);
    }
    let (scenario, file) = (scenario(), Readable::new("r.csv", text));
    let task = Task { sound_speed_m_s: Some(1200.0), ..file.task(&scenario) };
    let asked = Task { finds_sound_speed: true, finds_clock_offset: true, ..task };
    let survey = asked.survey().unwrap();
    let calibration = survey.calibration.as_ref().unwrap();
    let ((scale, scale_sigma), (offset_m, offset_sigma_m)) = (calibration.scale(), calibration.offset_m());
    assert!((scale - (1200.0 / 1176.0 - 1.0)).abs() < 4.0 * scale_sigma, "{scale} ± {scale_sigma}");
    assert!((offset_m - 850e-6 * 1200.0).abs() < 4.0 * offset_sigma_m, "{offset_m} ± {offset_sigma_m}");
    let [found_m, _] = located(&asked, &survey).0.track_error_m.unwrap();
    let [unasked_m, _] = located(&task, &task.survey().unwrap()).0.track_error_m.unwrap();
    assert!(found_m < 0.05 && unasked_m > 0.2, "{found_m} {unasked_m}");
}

#[test]
fn arrivals_without_the_time_of_emission_are_located_by_their_differences() {
    let mut text = String::from("emission,station,arrival_s,true_x_m,true_y_m\n");
    for (t_s, station, range_m, at) in walk(100) {
        // The arrival time is by the clock of the stations, which counts from 1970, and lies a short time after the
        // robot's tick.
        let arrival_s = 1.7e9 + t_s + 0.013 + range_m / 1200.0;
        let _ = writeln!(text, "hit {t_s},{station},{arrival_s:.7},{},{}", at.x, at.y);
    }
    let (scenario, file) = (scenario(), Readable::new("r.csv", text));
    let task = Task { sound_speed_m_s: Some(1200.0), ..file.task(&scenario) };
    let survey = task.survey().unwrap();
    assert_eq!(survey.kind, Kind::Differences);
    let (tally, events) = located(&task, &survey);
    assert!(tally.fixes["ok"] > 95, "{:?}", tally.fixes);
    let [error_m, _] = tally.fix_error_m.unwrap();
    assert!(error_m < 0.06, "{error_m}");
    let last = events.last().unwrap();
    assert!((last.t_s - 49.5).abs() < 0.01, "mission time counts from the first row: {}", last.t_s);
}

#[test]
fn messages_of_json_are_rows() {
    let mut writer = mcap::Writer::new(std::io::Cursor::new(Vec::new())).unwrap();
    let channel = writer.add_channel(0, "/ranges", "json", &BTreeMap::new()).unwrap();
    let other = writer.add_channel(0, "/map", "cdr", &BTreeMap::new()).unwrap();
    let header =
        mcap::records::MessageHeader { channel_id: other, sequence: 0, log_time: 0, publish_time: 0 };
    writer.write_to_known_channel(&header, &[0, 1, 0, 0]).unwrap();
    let mut text = String::from("t_s,station,range_m\n");
    for (sequence, (t_s, station, range_m, _)) in (0..).zip(walk(30)) {
        let _ = writeln!(text, "{t_s},{station},{range_m}");
        let json = serde_json::json!({ "t_s": t_s, "station": station, "range_m": range_m }).to_string();
        let header =
            mcap::records::MessageHeader { channel_id: channel, sequence, log_time: 0, publish_time: 0 };
        writer.write_to_known_channel(&header, json.as_bytes()).unwrap();
    }
    writer.finish().unwrap();
    let (scenario, file) = (scenario(), Readable::new("r.mcap", writer.into_inner().into_inner()));
    let (csv, task) = (Readable::new("r.csv", text), file.task(&scenario));
    let (csv, survey) = (csv.task(&scenario), task.survey().unwrap());
    assert_eq!(survey.rows, 180);
    let kinds = |events: Vec<Event>| -> Vec<EventKind> {
        let inside = events.len() - 1;
        events.into_iter().take(inside).skip(1).map(|event| event.kind).collect()
    };
    assert_eq!(kinds(located(&task, &survey).1), kinds(located(&csv, &csv.survey().unwrap()).1));
}

#[test]
fn what_is_written_is_read_again() {
    let stations = scenario().sim.world.stations;
    let mut writer = MeasuredWriter::new(Vec::new(), &stations).unwrap();
    for k in 0..40 {
        let moved = Odometry { forward_m: 0.15, sideways_m: 0.0, turn_rad: 0.05 };
        let ranges = stations.iter().map(|station| RangeSet {
            station: station.id,
            ranges_m: vec![(place(k) - station.position).norm(); 3],
        });
        let readings = Readings {
            ranging_cycle: k % 4 == 0,
            ranges: if k % 4 == 0 { ranges.collect() } else { Vec::new() },
            odometry: if k == 0 { Odometry::default() } else { moved },
            ..Readings::default()
        };
        let truth = Pose { position: place(k), heading_rad: 1.57 + 0.05 * f64::from(k) };
        writer.write(f64::from(k) * 0.1, &readings, Some(truth)).unwrap();
    }
    let (scenario, file) = (scenario(), Readable::new("r.csv", writer.into_inner()));
    let task = file.task(&scenario);
    let survey = task.survey().unwrap();
    let (tally, events) = located(&task, &survey);
    let estimates = events.iter().filter(|event| matches!(event.kind, EventKind::Estimated { .. })).count();
    assert_eq!((survey.has_motion, tally.emissions, estimates), (true, 10, 40));
    assert!(tally.track_error_m.unwrap()[1] < 0.02, "{:?}", tally.track_error_m);
}

#[test]
fn tables_of_spreadsheets_with_units_in_brackets_are_readings() {
    let tabs = "Station\tT [s]\tRange [mm]\r\nA\t0,0\t7000,5\r\nB\t0,0\t8889,0\r\nC\t0\t11787\r\n";
    let (scenario, file) = (scenario(), Readable::new("r.csv", tabs));
    let survey = file.task(&scenario).survey().unwrap();
    assert_eq!((survey.rows, survey.bad, survey.ignored.len()), (3, 0, 0));
}

#[test]
fn what_is_no_text_ends_the_reading_even_where_bad_rows_are_left_out() {
    let refused = |bytes: &[u8]| Readable::new("r.csv", bytes).refused();
    assert_eq!(
        refused(&[0; 4096]),
        "r.csv: not text: contains a zero byte; save the readings as CSV, in UTF-8"
    );
    let wide: Vec<u8> = "\u{feff}t_s,station".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(refused(&wide).starts_with("r.csv: line 1: text in UTF-16 "), "{}", refused(&wide));
    let rows = "t_s,station,range_m\n0,A,7\n0,B,8.9\n1,A,7\n".to_owned() + &"1,B,8.9\n".repeat(20_000);
    let (scenario, file) =
        (scenario(), Readable::new("r.csv", [rows.as_bytes(), &vec![0; 100_000]].concat()));
    let task = Task { skips_bad_rows: true, ..file.task(&scenario) };
    let message = task.survey().unwrap_err().to_string();
    assert!(
        message.contains("not text: contains a zero byte") && message.ends_with("export the readings again"),
        "{message}"
    );
    let long = ["t_s,station,range_m\n".as_bytes(), &vec![b'1'; 200_000]].concat();
    assert!(refused(&long).contains("a line has more than 65,536 bytes"), "{}", refused(&long));
}

#[test]
fn folders_and_pipes_are_refused_and_not_waited_for() {
    let dir = tempfile::tempdir().unwrap();
    let pipe = dir.path().join("pipe.csv");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    for file in [dir.path(), &pipe] {
        let (scenario, other) = (scenario(), Readable::new("r.csv", ""));
        let error = Task { file, shown: file.to_str().unwrap(), ..other.task(&scenario) }
            .survey()
            .unwrap_err()
            .to_string();
        assert!(error.ends_with("it is not a regular file"), "{error}");
    }
}

#[test]
fn damaged_messages_are_refused_without_asking_for_their_length() {
    let magic = b"\x89MCAP0\r\n";
    let long = [&magic[..], &[5], &u64::MAX.to_le_bytes(), &[7; 64]].concat();
    let zeros = [&magic[..], &vec![0; 100_000]].concat();
    for bytes in [long, zeros, magic.to_vec()] {
        let (scenario, file) = (scenario(), Readable::new("r.mcap", bytes));
        let task = Task { skips_bad_rows: true, ..file.task(&scenario) };
        let message = task.survey().unwrap_err().to_string();
        assert!(message.contains("damaged MCAP"), "{message}");
    }
}

#[test]
fn lines_are_counted_behind_comments_and_empty_lines_and_however_they_end() {
    let text = "# a\r\nt_s,station,range_m\r\n0,A,4\r\n# b\r\n\r\n0,B,x\r\n0,C\r\n0,D,y";
    for text in [text.to_owned(), text.replace('\r', ""), text.replace('\n', "")] {
        let refused = Readable::new("r.csv", &text).refused();
        let lines: Vec<&str> = refused.lines().filter_map(|line| line.strip_prefix("r.csv, line ")).collect();
        assert_eq!(
            lines,
            [
                "6, range_m: `x` is not a number",
                "7: 2 cells; the first line has 3",
                "8, range_m: `y` is not a number"
            ]
        );
    }
}

/// Ranges and motion along a walk, with a column that says whether the tool is on.
fn walk_with_tool(tool_on: impl Fn(u32) -> &'static str) -> String {
    let mut text = String::from("t_s,station,range_m,forward_m,turn_rad,tool_on\n");
    for k in 0..200_u32 {
        let t_s = f64::from(k) * 0.5;
        let forward_m = if k == 0 { 0.0 } else { 2.0 * 3.0 * 0.025_f64.sin() };
        let turn_rad = if k == 0 { 0.0 } else { 0.05 };
        let _ = writeln!(text, "{t_s},,,{forward_m},{turn_rad},{}", tool_on(k));
        for station in scenario().sim.world.stations {
            let range_m = (place(k) - station.position).norm();
            let _ = writeln!(text, "{t_s},{},{range_m},,,", station.name);
        }
    }
    text
}

#[test]
fn floor_counts_as_scanned_only_while_the_tool_was_on() {
    let scenario = scenario();
    let covered = |text: &str| {
        let file = Readable::new("r.csv", text);
        let task = file.task(&scenario);
        let survey = task.survey().unwrap();
        let times: Vec<f64> = located(&task, &survey)
            .1
            .iter()
            .filter_map(|event| match event.kind {
                EventKind::Covered { .. } => Some(event.t_s),
                _ => None,
            })
            .collect();
        (survey.tool_on_s, times)
    };
    let (on_s, times) = covered(&walk_with_tool(|k| if (40..=80).contains(&k) { "1" } else { "0" }));
    assert_eq!(on_s, Some(vec![[20.0, 40.5]]));
    assert!(times.len() > 30 && times.iter().all(|t_s| (20.0..=40.5).contains(t_s)), "{times:?}");
    let (on_s, times) = covered(&walk_with_tool(|_| ""));
    assert_eq!((on_s, times), (None, vec![]), "a column without an entry says nothing");
    let (on_s, times) = covered(&walk_with_tool(|_| "0"));
    assert_eq!((on_s, times), (Some(vec![]), vec![]), "never on");
    let text = walk_with_tool(|_| "");
    let (on_s, times) = covered(&text.replace(",tool_on", ",other"));
    assert_eq!((on_s, times), (None, vec![]), "nothing says it");
    let bad = Readable::new("r.csv", walk_with_tool(|k| if k == 3 { "maybe" } else { "on" })).refused();
    assert!(bad.contains("tool_on: `maybe` is neither on nor off"), "{bad}");
}

#[test]
fn stretches_of_a_file_are_by_the_clock_of_the_readings() {
    let scenario = scenario();
    let text = walk_with_tool(|_| "").replace(",tool_on", ",other");
    let file = Readable::new("r.csv", &text);
    let on = Readable::new("on.csv", "from_s,to_s\n10,20\n30,32\n");
    let task = Task { tool_on: Some(&on.file), ..file.task(&scenario) };
    assert_eq!(task.survey().unwrap().tool_on_s, Some(vec![[10.0, 20.0], [30.0, 32.0]]));
    let both = Readable::new("r.csv", walk_with_tool(|_| "1"));
    let task = Task { tool_on: Some(&on.file), ..both.task(&scenario) };
    assert!(task.survey().unwrap_err().to_string().contains("remove one"));
}
