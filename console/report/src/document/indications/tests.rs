#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::record::TrackPoint;

fn record() -> Record {
    let point = |k: u16| TrackPoint {
        t_s: f32::from(k),
        x_m: f32::from(k),
        y_m: 0.0,
        heading_rad: 0.0,
        error_m: 0.05,
        true_error_m: f32::NAN,
    };
    let mut record = Record::new();
    record.track = (0..10).map(point).collect();
    record
}

/// A tank of radius 12 m with a column of radius 0.3 m at (5, 0.25).
fn nearest_solid(at: Point) -> (String, f64) {
    let (wall_m, column_m) = (12.0 - at.coords.norm(), (at - Point::new(5.0, 0.25)).norm() - 0.3);
    if wall_m < column_m { ("the shell".into(), wall_m) } else { ("column C1".into(), column_m) }
}

fn read(text: &str, names: &[&str]) -> Result<Vec<Indication>, String> {
    let record = record();
    let run = |name| Flown { name, record: &record, began: began(name), reach_m: 0.3 };
    let runs: Vec<Flown<'_>> = names.iter().copied().map(run).collect();
    let ground =
        Ground { thickness_mm: Some(8.0), nearest_solid: &nearest_solid, plate_at: &|_| Some("R-01".into()) };
    indications(("found.csv", text), &runs, &ground)
}

fn one(text: &str) -> Indication {
    let found = read(text, &["20261122T040100Z-a"]).unwrap();
    assert_eq!(found.len(), 1, "{found:?}");
    found.into_iter().next().unwrap()
}

fn refused(text: &str) -> String {
    read(text, &["20261122T040100Z-a"]).unwrap_err()
}

#[test]
fn an_indication_lies_beside_the_robot_at_its_time_with_the_error_of_then() {
    let pit = one("t_s, left_m, kind, depth_mm\n 4.3, 0.2, pit, 2.5\n");
    assert!((pit.at - Point::new(4.0, 0.2)).norm() < 1e-6 && (pit.error_m.unwrap() - 0.05).abs() < 1e-6);
    assert_eq!((pit.kind.as_str(), pit.depth_mm, pit.plate.as_deref()), ("pit", Some(2.5), Some("R-01")));
}

#[test]
fn semicolons_tabs_and_decimal_commas_are_read_as_other_programs_write_them() {
    for text in [
        "t_s;left_m;depth_mm\n4,3;0,2;2,4\n",
        "\u{feff}T_S\tleft_m\tdepth_mm\n4,3\t0,2\t2,4\n",
        "t_s,left_m,depth_mm\n\"4,3\",\"0,2\",\"2,4\"\n",
    ] {
        let pit = one(text);
        assert_eq!((pit.t_s, pit.depth_mm), (Some(4.3), Some(2.4)), "{text}");
    }
    let mixed = refused("t_s;left_m\n1,5;0\n2.5;0\n");
    assert!(mixed.contains("decimal comma (line 2) and with a decimal point (line 3)"), "{mixed}");
    let thousands = refused("t_s;size_mm\n1;1.234,5\n");
    assert!(thousands.contains("found.csv: line 2, size_mm: `1.234,5` is not a number"), "{thousands}");
}

#[test]
fn times_of_day_and_coordinates_place_as_well() {
    for time in ["2026-11-22T04:01:04.3Z", "04:01:04.3", "2026-11-22 05:01:04.3+01:00"] {
        let pit = one(&format!("time,kind\n{time},pit\n"));
        assert!((pit.at - Point::new(4.0, 0.0)).norm() < 1e-6, "{time}: {pit:?}");
    }
    let pit = one("x;y;kind\n-3,5;1,25;pit\n");
    assert_eq!((pit.at, pit.t_s, pit.error_m), (Point::new(-3.5, 1.25), None, None));
    assert_eq!(pit.run.as_deref(), Some("20261122T040100Z-a"));
}

#[test]
fn what_lies_beyond_the_tool_outside_the_tank_or_in_a_column_is_refused_all_of_it_at_once() {
    let all = refused("t_s,ahead_m,left_m\n1,40,0\n2,0,0.9\n3,0,0.25\n5,0,0.25\n99,0,0\nsoon,0,0\n");
    let expected = [
        "found.csv: line 2, ahead_m: 40 is beyond the tool, which extends 0.3 m (half the swath) from its centre",
        "found.csv: line 3, left_m: 0.9 is beyond the tool, which extends 0.3 m (half the swath) from its centre",
        "found.csv: line 5, t_s: 5.000, 0.250 m is 0.300 m inside column C1, where no floor can be scanned",
        "found.csv: line 6, t_s: 99: the run covers 0 to 9.0 s",
        "found.csv: line 7, t_s: `soon` is not a number; write 12.5 or 12,5, without thousands separators or units",
    ];
    assert_eq!(all.lines().collect::<Vec<_>>(), expected);
    let outside = refused("x_m,y_m\n35.58,17.29\n");
    assert!(outside.contains("line 2, x_m: 35.580, 17.290 m is 27.559 m outside the tank"), "{outside}");
}

#[test]
fn every_fault_has_its_line_and_column() {
    assert_eq!(refused("t_s,size_mm\n1,0\n"), "found.csv: line 2, size_mm: 0: must be above 0");
    assert!(
        refused("t_s,depth_mm\n1,9\n")
            .contains("line 2, depth_mm: 9: must be at most 8, the plate thickness")
    );
    assert!(refused("t_s,note\n1,\"two\nlines\"\nsoon,\n").contains("line 4, t_s: `soon` is not a number"));
    assert_eq!(refused("t_s,left_m\n1,nan\n"), "found.csv: line 2, left_m: `nan`: must be a finite number");
    let odd = refused("t_s,kind\n1,\u{202E}pit\n");
    assert_eq!(odd, "found.csv: line 2, kind: must be plain text, without U+202E");
    assert!(refused("when\n1\n").contains("line 1: unknown column `when`; known columns: run, t_s, time"));
    assert!(refused("t_s,left_m\n1,2,4\n").contains("line 2: 3 cells, but the first line has 2"));
    assert!(refused("t_s,x,y\n1,2,3\n").contains("gives both a time and a position"));
    assert!(refused("t_s,x,y\n,2,\n").contains("line 2, y_m: missing; x_m and y_m must be given together"));
    assert!(refused("kind\npit\n").contains("line 1: no column gives the position"));
    assert!(
        refused("time\n2026-13-01T00:00:00Z\n")
            .contains("line 2, time: `2026-13-01T00:00:00Z` is not a time")
    );
}

#[test]
fn with_several_runs_each_indication_names_its_own() {
    let two = |text: &str| read(text, &["a", "b"]);
    assert!(two("t_s\n1\n").unwrap_err().contains("line 1: there are several runs: add a column `run`"));
    assert_eq!(two("run,t_s\nc,1\n").unwrap_err(), "found.csv: line 2, run: c: must be one of a, b");
    assert_eq!(two("run,t_s\nb,1\n").unwrap()[0].run.as_deref(), Some("b"));
    assert_eq!(two("x,y\n1,1\n").unwrap()[0].run, None);
    assert!(
        two("run,time\nb,04:01:02\n")
            .unwrap_err()
            .contains("line 2, time: the folder name of run b does not contain its start time")
    );
}

#[test]
fn of_many_faults_the_first_are_listed_and_the_rest_counted() {
    let all = refused(&("t_s\n".to_owned() + &"never\n".repeat(50)));
    assert_eq!((all.lines().count(), all.ends_with("faults not listed: 30")), (21, true), "{all}");
}
