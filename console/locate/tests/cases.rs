//! Readings of other people's systems that were once located wrongly or refused for a wrong reason.

#![allow(clippy::unwrap_used, reason = "tests")]

use locate::{Doubts, Survey, Tally, Task};
use scenario::Scenario;
use std::fmt::Write as _;
use world::Point;

const AROUND: &str = r#"stations = [
  { name = "A0", at_m = [-3.4, 3.0] }, { name = "A1", at_m = [0.0, 3.0] }, { name = "A2", at_m = [3.6, 3.0] },
  { name = "A3", at_m = [3.6, 0.0] }, { name = "A4", at_m = [3.6, -3.0] }, { name = "A5", at_m = [0.0, -3.0] },
  { name = "A6", at_m = [-3.4, -3.0] }, { name = "A7", at_m = [-3.4, 0.0] },
]"#;
const ON_A_LINE: &str = r#"stations = [
  { name = "B1", at_m = [-6.0, 0.0] }, { name = "B2", at_m = [0.0, 0.0] }, { name = "B3", at_m = [5.9, 0.0] },
]"#;

fn scenario(stations: &str, start: [f64; 2]) -> Scenario {
    let text = format!(
        "name = \"case\"\n[tank]\nradius_m = 6.0\n[robot]\nstart_m = [{:?}, {:?}]\n[ae]\n{stations}\n\
         noise = {{ model = \"gaussian\", sigma_ratio = 0.02 }}\n[mission]\nkind = \"goto\"\ngoal_m = [1.0, 1.0]\n[planner]\nid = \"apf\"\n",
        start[0], start[1]
    );
    Scenario::parse(&text, "case.toml").map_err(|errors| errors.render()).unwrap()
}

struct Located {
    survey: Survey,
    tally: Tally,
    doubts: Doubts,
}

fn run(scenario: &Scenario, readings: &[u8], change: impl Fn(&mut Task)) -> Result<Located, String> {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("r.csv");
    std::fs::write(&file, readings).unwrap();
    let mut task = Task {
        file: &file,
        shown: "r.csv",
        scenario,
        sound_speed_m_s: None,
        finds_sound_speed: false,
        finds_clock_offset: false,
        skips_bad_rows: false,
        tool_on: None,
    };
    change(&mut task);
    let survey = task.survey().map_err(|error| error.to_string())?;
    let mut tally = Tally::default();
    let doubts = task.locate(&survey, |events| tally.take(events)).unwrap();
    Ok(Located { survey, tally, doubts })
}

fn located(scenario: &Scenario, readings: &str) -> Located {
    run(scenario, readings.as_bytes(), |_| {}).unwrap()
}

/// One row for each station and second, for a robot that starts at a place and drives this far every second.
fn ranges(scenario: &Scenario, from: Point, by: [f64; 2], seconds: u32) -> String {
    let mut text = String::from("t_s,station,range_m,true_x_m,true_y_m\n");
    for k in 0..seconds {
        let at = from + world::Vector::new(by[0], by[1]) * f64::from(k);
        for station in &scenario.sim.world.stations {
            let range_m = (at - station.position).norm();
            let _ = writeln!(text, "{k},{},{range_m:.4},{},{}", station.name, at.x, at.y);
        }
    }
    text
}

#[test]
fn a_word_for_nothing_heard_is_no_range_and_the_rest_gives_the_fix() {
    let scenario = scenario(AROUND, [0.2, 1.9]);
    for sentinel in ["7132.146", "0", "-1", "9999", "65535", "nan", "inf"] {
        let text = format!(
            "t_s,station,range_m\n0,A0,3.77\n0,A1,1.12\n0,A2,3.57\n0,A3,{sentinel}\n0,A4,5.96\n0,A5,4.9\n0,A6,6.09\n0,A7,4.07\n"
        );
        let Located { tally, doubts, .. } = located(&scenario, &text);
        assert_eq!(tally.fixes.get("ok"), Some(&1), "{sentinel}: {:?} {:?}", tally.fixes, tally.failed);
        assert!((tally.first_fix_m.unwrap() - Point::new(0.2, 1.9)).norm() < 0.1, "{sentinel}");
        let refused = doubts.impossible[&4];
        assert_eq!(refused.count, 1);
        assert!((9.0..12.0).contains(&refused.most_m), "{}", refused.most_m);
    }
}

#[test]
fn a_file_of_words_for_nothing_heard_has_no_fix() {
    let scenario = scenario(AROUND, [0.2, 1.9]);
    let rows: Vec<String> = (0..8).map(|k| format!("0,A{k},65535")).collect();
    let rows = rows.join("\n");
    let Located { tally, doubts, .. } = located(&scenario, &format!("t_s,station,range_m\n{rows}"));
    assert!(!tally.has_fix() && doubts.impossible.len() == 8);
}

#[test]
fn on_stations_on_a_line_the_right_start_decides() {
    let right = scenario(ON_A_LINE, [-2.0, -3.0]);
    let text = ranges(&right, Point::new(-2.0, -3.0), [0.1, 0.0], 28);
    let Located { tally, doubts, .. } = located(&right, &text);
    assert_eq!((tally.fixes.get("ok"), doubts.sides_by_track), (Some(&28), 28));
    assert!(tally.fix_error_m.unwrap()[1] < 0.05);
}

#[test]
fn on_stations_on_a_line_nothing_decides_if_the_start_is_wrong() {
    let (right, wrong) = (scenario(ON_A_LINE, [-2.0, -3.0]), scenario(ON_A_LINE, [0.0, 3.0]));
    let text = ranges(&right, Point::new(-2.0, -3.0), [0.1, 0.0], 28);
    let Located { tally, doubts, .. } = located(&wrong, &text);
    assert_eq!((tally.fixes.get("ok"), doubts.sides_open), (None, 28), "{:?}", tally.fixes);
    assert!(doubts.contradicts_start);
    // The 95 % error of the track covers both sides.
    assert!(tally.error_95_m.unwrap()[0] > 3.0);
}

#[test]
fn on_stations_on_a_line_the_wall_decides_where_the_image_lies_behind_it() {
    let chord = "stations = [{ name = \"B1\", at_m = [-4.0, -4.0] }, { name = \"B2\", at_m = [0.0, -4.0] }, { name = \"B3\", at_m = [4.0, -4.0] }]";
    let scenario = scenario(chord, [3.0, 3.0]);
    let text = ranges(&scenario, Point::new(-1.0, 2.0), [0.1, 0.0], 10);
    let Located { tally, doubts, .. } = located(&scenario, &text);
    assert_eq!(doubts.sides_by_walls, 10, "{doubts:?}");
    // The first three contradict the start; then they outweigh it.
    assert!(tally.fixes["ok"] >= 7 && tally.fix_error_m.unwrap()[1] < 0.05, "{:?}", tally.fixes);
}

#[test]
fn two_emissions_under_one_time_are_asked_about() {
    let scenario = scenario(AROUND, [0.0, 0.0]);
    let (one, other) = (
        ranges(&scenario, Point::new(0.0, 0.0), [0.1, 0.0], 20),
        ranges(&scenario, Point::new(0.25, 0.15), [0.1, 0.0], 20),
    );
    let mut lines: Vec<&str> = one.lines().skip(1).chain(other.lines().skip(1)).collect();
    lines.sort_by_key(|line| line.split(',').next().unwrap().parse::<u32>().unwrap());
    let text = format!("t_s,station,range_m,true_x_m,true_y_m\n{}\n", lines.join("\n"));
    let Located { survey, tally, .. } = located(&scenario, &text);
    assert!(survey.repeats.are_wide(), "{}", survey.repeats.factor());
    let worst = survey.repeats.worst.unwrap();
    assert!(worst.count == 2 && worst.apart_m > 0.15, "{worst:?}");
    assert_eq!(tally.fixes.get("ok"), None, "{:?}", tally.fixes);
}

#[test]
fn times_of_day_that_pass_midnight_ask_for_dates() {
    let scenario = scenario(AROUND, [0.0, 0.0]);
    let text = "time,station,range_m\n23:59:59.5,A0,4.5\n23:59:59.9,A1,3\n00:00:00,A0,4.5\n00:00:00.5,A1,3\n";
    let refused = run(&scenario, text.as_bytes(), |_| {}).err().unwrap();
    assert!(
        refused.contains("line 4, time: 00:00:00.000 comes after 23:59:59.900 in line 3: the time of day passes midnight here; write times with"),
        "{refused}"
    );
}

#[test]
fn time_that_goes_back_is_one_error_that_names_both_rows() {
    let scenario = scenario(AROUND, [0.0, 0.0]);
    let text =
        "t_s,station,range_m\n1,A0,4.5\n3,A0,4.5\n3,A1,3\n0.5,A0,4.5\n1,A1,3\n2.5,A1,3\n3,A2,4.7\n4,A0,4.5\n";
    let refused = run(&scenario, text.as_bytes(), |_| {}).err().unwrap();
    assert_eq!(
        refused,
        "r.csv, line 5, t_s: time goes backwards: 0.5 s follows 3 s in line 4; all 3 rows up to line 7 are too early; sort the \
         rows by time\ncorrect the rows, or leave them out with --skip-bad-rows"
    );
    let Located { survey, .. } = run(&scenario, text.as_bytes(), |task| task.skips_bad_rows = true).unwrap();
    assert_eq!((survey.rows, survey.bad), (8, 3));
}

#[test]
fn dates_are_times() {
    let scenario = scenario(AROUND, [0.0, 0.0]);
    let seconds = ranges(&scenario, Point::new(0.0, 0.0), [0.1, 0.0], 5);
    let dated = |line: &str| {
        let (t_s, rest) = line.split_once(',').unwrap();
        format!("2026-10-25T03:00:0{t_s}.000+01:00,{rest}\n")
    };
    let rows: String = seconds.lines().skip(1).map(dated).collect();
    for name in ["t_s", "time", "Timestamp"] {
        let text = format!("{name},station,range_m,true_x_m,true_y_m\n{rows}");
        let Located { survey, tally, .. } = located(&scenario, &text);
        assert_eq!(tally.fixes, located(&scenario, &seconds).tally.fixes);
        assert_eq!(survey.dates.unwrap(), ["2026-10-25T02:00:00Z", "2026-10-25T02:00:04Z"]);
    }
    let refused = run(&scenario, b"t_s,station,range_m\n2026-10-25T02:00:00,A0,4\n", |_| {}).err().unwrap();
    assert!(refused.contains("line 2, t_s: `2026-10-25T02:00:00` has no time zone"), "{refused}");
    let refused = run(&scenario, b"time,station,range_m\n5,A0,4\n", |_| {}).err().unwrap();
    assert!(refused.contains("line 2, time: `5` has no unit"), "{refused}");
}

#[test]
fn other_encodings_are_recognised_with_their_line_and_a_remedy() {
    let scenario = scenario(AROUND, [0.0, 0.0]);
    let refused = |bytes: &[u8]| run(&scenario, bytes, |_| {}).err().unwrap();
    let western = refused(b"t_s,station,range_m\n0,A0,4\n0,A\xfc1,3\n");
    assert!(western.contains("line 3") && western.contains("0xfc (`ü` in Windows-1252)"), "{western}");
    assert!(western.contains("iconv -f WINDOWS-1252"), "{western}");
    let text = "t_s,station,range_m\n0,A0,4\n";
    for (name, bytes) in [
        ("UTF-16LE", text.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<_>>()),
        ("UTF-16BE", text.encode_utf16().flat_map(u16::to_be_bytes).collect()),
    ] {
        let wide = refused(&bytes);
        assert!(wide.contains("line 1") && wide.contains(&format!("iconv -f {name} -t UTF-8")), "{wide}");
    }
}

#[test]
fn motion_that_was_not_measured_is_not_none() {
    let scenario = scenario(AROUND, [0.0, 0.0]);
    let mut text = String::from("t_s,station,range_m,forward_m,turn_rad\n");
    for k in 0..100 {
        let _ = writeln!(text, "{},,,{}", f64::from(k) / 10.0, if k < 50 { "0.01,0" } else { "," });
    }
    let Located { tally, .. } = located(&scenario, &text);
    let [_, most_m] = tally.error_95_m.unwrap();
    assert!((1.9..2.4).contains(&most_m), "5 s at 0.4 m/s: {most_m}");
    // Rows that are missing completely.
    let gap: Vec<&str> =
        text.lines().enumerate().filter(|(k, _)| !(20..=45).contains(k)).map(|(_, line)| line).collect();
    let gap = gap.join("\n");
    let most_m = located(&scenario, &gap).tally.error_95_m.unwrap()[1];
    assert!(most_m > 3.0, "{most_m}");
}

#[test]
fn the_forecast_says_which_floor_has_a_mirror_image_and_what_decides() {
    let warning = |stations: &str, start: [f64; 2]| {
        let scenario = scenario(stations, start);
        report::forecast::mirror_warning(&scenario.mission, &scenario.sim.world.as_drawn())
    };
    assert_eq!(warning(AROUND, [0.0, 0.0]), None);
    let decided = warning(ON_A_LINE, [0.0, 3.0]).unwrap();
    assert!(decided.contains("the line of stations B1, B2 and B3"), "{decided}");
    assert!(decided.contains("the side follows from robot.start_m, 3.00 m from that line"), "{decided}");
    let open = warning(ON_A_LINE, [0.0, 0.02]).unwrap();
    assert!(open.contains("the side is ambiguous: robot.start_m is 0.02 m from that line"), "{open}");
    // Three stations are also nearly on a line if two of them are almost in the same place; so are two stations.
    let twins = "stations = [{ name = \"A\", at_m = [-5.9, 0.0] }, { name = \"B\", at_m = [-5.9, 0.05] }, { name = \"C\", at_m = [5.9, 0.0] }]";
    assert!(warning(twins, [0.0, 3.0]).is_some());
    let pair = "stations = [{ name = \"A\", at_m = [-5.9, 0.0] }, { name = \"C\", at_m = [5.9, 0.0] }]";
    assert!(warning(pair, [0.0, 3.0]).unwrap().contains("the line of stations A and C"));
    // If the stations are on a chord near the wall, every mirror image lies behind the wall.
    let wall = "stations = [{ name = \"A\", at_m = [-1.5, -5.8] }, { name = \"B\", at_m = [0.0, -5.8] }, { name = \"C\", at_m = [1.5, -5.8] }]";
    let by_wall = warning(wall, [0.0, 3.0]).unwrap();
    assert!(by_wall.contains("can be ruled out"), "{by_wall}");
}
