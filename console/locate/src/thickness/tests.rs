//! Files of readings on a straight way of 4 m in 10 s, with an instrument of four channels.

use super::*;
use nalgebra::Matrix3;
use planner_api::PoseEstimate;
use scenario::Scenario;
use std::fmt::Write as _;
use world::Point;

const SCENARIO: &str = r#"
name = "floor"
seed = 1
[tank]
radius_m = 4.0
[instrument]
kind = "ut"
dead_band_m = 0.0
dead_square_m = 0.0
channels = 4
pitch_m = 0.01
thickness_mm = 8.0
sigma_mm = 0.2
threshold = 0.2
[robot]
start_m = [-2.0, 0.0]
[ae]
stations = [
    { name = "A", at_m = [4.0, 0.0] },
    { name = "B", at_m = [0.0, 4.0] },
    { name = "C", at_m = [-4.0, 0.0] },
    { name = "D", at_m = [0.0, -4.0] },
]
noise = { model = "gaussian", sigma_ratio = 0.005 }
[mission]
kind = "cover"
swath_m = 0.4
overlap_m = 0.1
clearance_m = 0.1
cell_m = 0.05
[planner]
id = "tether-safe"
"#;

#[derive(Default)]
struct Kept {
    readings: Vec<Reading>,
    refused: Vec<(u64, String)>,
}

impl Sink for Kept {
    fn take(&mut self, reading: &Reading) -> anyhow::Result<()> {
        self.readings.push(*reading);
        Ok(())
    }

    fn refuse(&mut self, problem: &Problem, row: &[&str]) -> anyhow::Result<()> {
        self.refused.push((problem.line, row.join(",")));
        Ok(())
    }
}

fn read(text: &str, options: &Options<'_>) -> (Result<Placed, String>, Kept) {
    let scenario = Scenario::parse(SCENARIO, "floor.toml").map_err(|errors| errors.render()).unwrap();
    let floor = scenario.mission.floor(&scenario.sim.world);
    let mut track = Track::default();
    for k in 0..=100 {
        let position = Point::new(-2.0 + 0.04 * f64::from(k), 0.0);
        let covariance = Matrix3::from_diagonal(&nalgebra::Vector3::new(4e-4, 4e-4, 1e-6));
        track.push(0.1 * f64::from(k), &PoseEstimate { position, heading_rad: 0.0, covariance }, k > 0);
    }
    let run = Scanned {
        track: &track,
        floor: &floor,
        sampling: scenario.mission.instrument.as_ref().unwrap().sampling.unwrap(),
        swath_m: 0.4,
        began_s: Some(1_790_000_000.0),
    };
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("r.csv");
    std::fs::write(&file, text).unwrap();
    let mut kept = Kept::default();
    (place(&file, &run, options, &mut kept).map_err(|error| error.to_string()), kept)
}

/// A reading of every channel at every pitch: 8 mm, and 4 mm in a pit at (0, 0.05), 8 cm across.
fn rows(write: impl Fn(f64, u16, f64) -> String) -> String {
    let mut text = String::new();
    for k in 0..400 {
        let (t_s, x_m) = (0.025 * f64::from(k), -2.0 + 0.01 * f64::from(k));
        for channel in 0..4_u16 {
            let y_m = 0.4 * ((f64::from(channel) + 0.5) / 4.0 - 0.5);
            let off_m = (x_m * x_m + (y_m - 0.05) * (y_m - 0.05)).sqrt();
            let thickness_mm = if off_m < 0.04 { 4.0 } else { 8.0 };
            text += &write(t_s, channel, thickness_mm);
        }
    }
    text
}

fn long() -> String {
    "t_s,channel,thickness_mm\n".to_owned() + &rows(|t_s, channel, mm| format!("{t_s:.3},{channel},{mm}\n"))
}

fn placed(text: &str, options: &Options<'_>) -> (Placed, Kept) {
    let (placed, kept) = read(text, options);
    (placed.unwrap(), kept)
}

/// Faults of the rows of a file that begins well.
fn faults(rows: &str) -> Vec<String> {
    let (placed, kept) = placed(&(long() + rows), &Options::default());
    assert_eq!(placed.readings.count, 1600, "nothing else is lost: {:?}", placed.faults);
    assert_eq!(kept.refused.len() as u64, placed.faults.count(), "every faulty row is kept");
    placed.faults.listed
}

#[test]
fn every_reading_is_placed_and_the_pit_is_one_indication() {
    let (placed, kept) = placed(&long(), &Options::default());
    assert_eq!((placed.rows, placed.readings.count, placed.lost), (1600, 1600, 0));
    assert!(placed.gaps.is_empty() && placed.faults.count() == 0 && placed.readings.indications == 1);
    let deepest = placed.readings.deepest.unwrap();
    assert!((deepest.at - Point::new(0.0, 0.05)).norm() < 0.01 && (deepest.depth_mm - 4.0).abs() < 1e-9);
    let reading = kept.readings.iter().find(|r| r.channel == 3 && r.t_s > 4.99).unwrap();
    assert!((reading.at - Point::new(0.0, 0.15)).norm() < 1e-9, "{}", reading.at);
    assert!((reading.covariance[(1, 1)] - 4e-4).abs() < 1e-9);
}

#[test]
fn other_layouts_and_units_of_the_same_readings_give_the_same_result() {
    let (expected, _) = placed(&long(), &Options::default());
    let wide = "time [ms];ch1_mm;ch2_mm;ch3_mm;ch4_mm\n".to_owned()
        + &rows(|t_s, channel, mm| {
            let head =
                if channel == 0 { format!("{:.1}", 1e3 * t_s).replace('.', ",") } else { String::new() };
            format!("{head};{}{}", mm.to_string().replace('.', ","), if channel == 3 { "\n" } else { "" })
        });
    let inches = "t_s\tchannel\tThickness [in]\n".to_owned()
        + &rows(|t_s, channel, mm| format!("{t_s:.3}\t{channel}\t{:.6}\n", mm / 25.4));
    let share = "t_s,channel,depth [%]\n".to_owned()
        + &rows(|t_s, channel, mm| format!("{t_s:.3},{channel},{}\n", 100.0 * (1.0 - mm / 8.0)));
    let named = "t_us,channel,depth\n".to_owned()
        + &rows(|t_s, channel, mm| format!("{:.0},{},{}\n", 1e6 * t_s, 3 - channel, 8.0 - mm));
    let from_1 = Options { first_channel: 1, ..Options::default() };
    let mirrored = Options { unit: unit("mm"), from_left: true, ..Options::default() };
    for (text, options) in
        [(wide, from_1), (inches, Options::default()), (share, Options::default()), (named, mirrored)]
    {
        let (placed, _) = placed(&text, &options);
        assert_eq!(
            (placed.readings.count, placed.readings.indications, placed.lost),
            (1600, 1, 0),
            "{text:.40}"
        );
        let (at, as_before) =
            (placed.readings.deepest.unwrap().at, expected.readings.deepest.as_ref().unwrap().at);
        assert!((at - as_before).norm() < 1e-6, "{text:.40} {at}");
    }
}

#[test]
fn faulty_rows_are_named_by_line_and_the_others_are_placed() {
    let bad = "0.0,0,8.0\n\
               -3.0,0,8.0\n\
               25.0,1,8.0\n\
               5.001,0,-0.5\n\
               5.002,0,31.5\n\
               5.003,0,0.31in\n\
               5.004,4,8.0\n\
               5.005,0,7,9\n\
               5.006,0,\"7,9\"\n\
               soon,0,8.0\n\
               9.9,x,8.0\n\
               9.9,0,thick\n";
    insta::assert_snapshot!(faults(bad).join("\n"));
    let depth = "t_s,channel,depth_mm\n1.0,0,0.5\n2.0,0,-0.1\n3.0,0,8.5\n";
    insta::assert_snapshot!("depths", placed(depth, &Options::default()).0.faults.listed.join("\n"));
    let mixed = "t_s;channel;thickness;unit\n1.0;0;8.0;mm\n2,0;0;8,0;mm\n3.0;0;0.31;in\n4.0;0;7.9;furlong\n";
    insta::assert_snapshot!("mixed", placed(mixed, &Options::default()).0.faults.listed.join("\n"));
}

#[test]
fn a_file_that_cannot_be_understood_is_refused_with_what_would_be_right() {
    let refused = |text: &str| read(text, &Options::default()).0.unwrap_err();
    let inches = "t_s,channel,thickness_mm\n".to_owned()
        + &rows(|t_s, channel, mm| format!("{t_s:.3},{channel},{:.4}\n", mm / 25.4));
    let hours = "t_s,channel,thickness_mm\n".to_owned()
        + &rows(|t_s, channel, mm| format!("{:.3},{channel},{mm}\n", t_s + 7200.0));
    let files = [
        "channel,thickness_mm\n0,8.0\n",
        "t_s,channel\n0.1,0\n",
        "t_s,channel,thickness\n0.1,0,8.0\n",
        "t_s,thickness_mm,depth_mm\n0.1,8.0,0.0\n",
        "t_s,channel,ch0_mm\n0.1,0,8.0\n",
        "t_s,channel,thickness_mm\n",
        inches.as_str(),
        hours.as_str(),
    ];
    insta::assert_snapshot!(files.map(refused).join("\n\n"));
}

#[test]
fn the_clock_is_corrected_by_an_offset_by_marks_and_by_dates() {
    let shifted = |write: &dyn Fn(f64) -> String| {
        "time,channel,thickness_mm\n".to_owned()
            + &rows(|t_s, channel, mm| format!("{},{channel},{mm}\n", write(t_s)))
    };
    let number = |text: String| text.replacen("time", "t_s", 1);
    let offset = Options { clock_offset_s: Some(-7200.0), ..Options::default() };
    let (placed_, _) = placed(&number(shifted(&|t_s| format!("{:.4}", t_s + 7200.0))), &offset);
    assert_eq!((placed_.readings.count, placed_.readings.indications), (1600, 1));
    // The clock loses two seconds an hour.
    let slow = |t_s: f64| 50.0 + t_s / (1.0 + 2.0 / 3600.0);
    let marks = [("50".to_owned(), 0.0), (format!("{:.6}", slow(10.0)), 10.0)];
    let by_marks = Options { marks: &marks, ..Options::default() };
    let (placed_, kept) = placed(&number(shifted(&|t_s| format!("{:.6}", slow(t_s)))), &by_marks);
    assert!((placed_.clock_drift_s_per_h - 2.0).abs() < 0.01, "{}", placed_.clock_drift_s_per_h);
    let last = kept.readings.last().unwrap();
    assert!((last.t_s - 9.975).abs() < 1e-4 && placed_.faults.count() == 0, "{}", last.t_s);
    // 2026-09-21T14:13:20Z is 1,790,000,000 s after 1970.
    let dated = shifted(&|t_s| format!("2026-09-21T16:13:{:09.6}+02:00", 20.5 + t_s));
    let (placed_, kept) = placed(&dated, &Options::default());
    assert!((kept.readings[4].t_s - 0.025).abs() < 1e-4 && placed_.clock_sigma_s > 0.2);
    assert!(
        kept.readings[4].covariance[(0, 0)] > 4e-4 + 0.1_f64.powi(2),
        "an uncertain time is an uncertain place"
    );
}

#[test]
fn lost_readings_a_dead_channel_and_rows_out_of_order_are_named() {
    let mut lines: Vec<String> = long().lines().skip(1).map(str::to_owned).collect();
    // Channel 2 is dead from 3 to 6 s; one reading of channel 0 is lost; two rows change places.
    let t_s = |line: &str| line.split(',').next().unwrap().parse::<f64>().unwrap();
    lines.retain(|line| !(line.contains(",2,") && (3.0..6.0).contains(&t_s(line))));
    lines.retain(|line| !line.starts_with("8.000,0,"));
    let k = lines.iter().position(|line| line.starts_with("7.000,1,")).unwrap();
    let later = lines.remove(k);
    lines.insert(k + 9, later);
    let mut text = "t_s,channel,thickness_mm\n".to_owned();
    for line in &lines {
        writeln!(text, "{line}").unwrap();
    }
    let (placed, _) = placed(&text, &Options::default());
    assert_eq!((placed.lost, placed.out_of_order), (121, 1), "{:?}", placed.gaps);
    assert_eq!(placed.gaps.len(), 1);
    assert_eq!(placed.gaps[0].channels, [2]);
    assert!((placed.gaps[0].from_s - 2.975).abs() < 1e-9 && (placed.gaps[0].to_s - 6.0).abs() < 1e-9);
    let without_a_channel: String =
        long().lines().filter(|line| !line.contains(",3,")).map(|l| l.to_owned() + "\n").collect();
    let (placed, _) = self::placed(&without_a_channel, &Options::default());
    assert_eq!(placed.gaps[0].channels, [3]);
    assert!((placed.gaps[0].way_m - 4.0).abs() < 1e-9);
}
