//! Reads logs of laser scans in the format of the CARMEN toolkit, in which many public data sets are published.
//!
//! A line is a message: its name, its values, separated by spaces, and times. Two messages contain scans, both with distances
//! in metres and the corrected pose of the scanner:
//!
//! ```text
//! FLASER n r1 ... rn x y theta odom_x odom_y odom_theta time host logger_time
//! ROBOTLASER1 type first fov step range accuracy mode n r1 ... rn m e1 ... em x y theta ... time host logger_time
//! ```
//!
//! `FLASER` covers half a turn, from right to left. Other messages and comments are skipped.

use crate::{error::ImportError, input::Input, text::decoded};
use std::f64::consts::{FRAC_PI_2, PI};
use world::{Pose, Scan, scan::RangesMm};

/// The most rays of a scan.
const MOST_RAYS: usize = 8192;
/// Time between two scans of a log without times, seconds.
const STEP_S: f64 = 0.2;
/// Values of a `ROBOTLASER1` message before the distances, and after those of the echoes until the time.
const BEFORE_RANGES: usize = 8;
const UNTIL_TIME: usize = 11;

/// A scan of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct LoggedScan {
    /// The line, from 1.
    pub line: usize,
    /// Time since the first scan, seconds.
    pub t_s: f64,
    /// Pose of the scanner in the frame of the log.
    pub pose: Pose,
    /// The distances, in the frame of the scanner.
    pub scan: Scan,
}

/// The scans of a log in their order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ScanLog {
    /// The scans.
    pub scans: Vec<LoggedScan>,
    /// What the reader has assumed or left out.
    pub notes: Vec<String>,
}

/// A scan as a line states it.
struct Message {
    line: usize,
    first_rad: f64,
    step_rad: f64,
    ranges_m: Vec<f64>,
    pose: Pose,
    time_s: f64,
}

/// Reads a log. A distance of `range_m` metres or more is a ray without an echo.
///
/// # Errors
/// The input is not text, a scan in it is damaged (with its line), or it contains no scans.
pub fn read(input: &Input, range_m: f64) -> Result<ScanLog, ImportError> {
    let text = decoded(&input.bytes, None);
    let mut messages = Vec::new();
    for (line, words) in (1..).zip(text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>())) {
        let message = match words.split_first() {
            Some((&"FLASER", values)) => front(values),
            Some((&"ROBOTLASER1", values)) => robot(values),
            _ => continue,
        };
        let wrong = |(key, what): (String, String)| ImportError {
            file: input.name.clone(),
            line: Some(line),
            key: Some(key),
            what,
        };
        messages.push(Message { line, ..message.map_err(wrong)? });
    }
    if messages.is_empty() {
        let what =
            "contains no scans; a log of the CARMEN toolkit has lines that begin with FLASER or ROBOTLASER1";
        return Err(ImportError::of_input(input, what));
    }
    Ok(log(messages, range_m))
}

fn log(messages: Vec<Message>, range_m: f64) -> ScanLog {
    let mut notes = Vec::new();
    let first_s = messages.first().map_or(0.0, |message| message.time_s);
    let has_times = messages.iter().any(|message| (message.time_s - first_s).abs() > 0.0);
    if !has_times && messages.len() > 1 {
        notes.push(format!("the log has no times; {STEP_S} s are assumed between two scans"));
    }
    let (mut latest_s, mut n_back) = (0.0, 0);
    let mut scans = Vec::with_capacity(messages.len());
    for (n, message) in messages.into_iter().enumerate() {
        let t_s = if has_times { message.time_s - first_s } else { n as f64 * STEP_S };
        n_back += usize::from(t_s < latest_s);
        latest_s = f64::max(latest_s, t_s);
        let ranges = message.ranges_m.iter().map(|m| Scan::stored(Some(*m).filter(|m| *m < range_m)));
        let scan = Scan {
            first_rad: message.first_rad,
            step_rad: message.step_rad,
            range_max_m: Some(range_m),
            ranges_mm: RangesMm(ranges.collect()),
            ..Scan::default()
        };
        scans.push(LoggedScan { line: message.line, t_s: latest_s, pose: message.pose, scan });
    }
    if n_back > 0 {
        notes.push(format!(
            "{n_back} scans are earlier than the scan before them; they count as made at its time"
        ));
    }
    ScanLog { scans, notes }
}

/// A value and its problem.
type Wrong = (String, String);

fn front(values: &[&str]) -> Result<Message, Wrong> {
    let (ranges_m, rest) = ranges("FLASER", values)?;
    let n = ranges_m.len();
    // An odd number of rays includes both ends of the half turn.
    let n_steps = if n % 2 == 1 { n - 1 } else { n };
    Ok(Message {
        line: 0,
        first_rad: -FRAC_PI_2,
        step_rad: PI / n_steps.max(1) as f64,
        pose: pose(rest)?,
        time_s: number("time", rest.get(6))?,
        ranges_m,
    })
}

fn robot(values: &[&str]) -> Result<Message, Wrong> {
    let rest = values.get(BEFORE_RANGES - 1..).unwrap_or_default();
    let (ranges_m, rest) = ranges("ROBOTLASER1", rest)?;
    let n_echoes = count("number of remissions", rest.first())?;
    let rest = rest.get(1 + n_echoes..).unwrap_or_default();
    Ok(Message {
        line: 0,
        first_rad: number("first angle", values.get(1))?,
        step_rad: number("angle between two rays", values.get(3))?,
        pose: pose(rest)?,
        time_s: number("time", rest.get(UNTIL_TIME))?,
        ranges_m,
    })
}

/// The distances that follow on their number, and the values after them.
fn ranges<'a, 'b>(name: &str, values: &'a [&'b str]) -> Result<(Vec<f64>, &'a [&'b str]), Wrong> {
    let n = count("number of rays", values.first())?;
    let given = values.get(1..=n).ok_or_else(|| {
        let what = format!(
            "{n} rays are announced, but the line has only {} values after this number",
            values.len() - 1
        );
        (name.to_owned(), what)
    })?;
    let metres = (1..).zip(given).map(|(ray, word): (usize, _)| {
        let key = format!("ray {ray}");
        let metres = number(&key, Some(word))?;
        if metres < 0.0 { Err((key, format!("{metres} m; a distance is not negative"))) } else { Ok(metres) }
    });
    Ok((metres.collect::<Result<_, _>>()?, &values[1 + n..]))
}

fn pose(values: &[&str]) -> Result<Pose, Wrong> {
    let value = |key: &str, at: usize| number(key, values.get(at));
    Ok(Pose::new(value("x", 0)?, value("y", 1)?, value("theta", 2)?))
}

fn count(key: &str, word: Option<&&str>) -> Result<usize, Wrong> {
    let word = word.ok_or_else(|| missing(key))?;
    let count = word.parse::<usize>().ok().filter(|n| *n <= MOST_RAYS);
    count.ok_or_else(|| {
        (key.to_owned(), format!("`{}` is not a whole number up to {MOST_RAYS}", foreign::seen(word)))
    })
}

fn number(key: &str, word: Option<&&str>) -> Result<f64, Wrong> {
    let word = word.ok_or_else(|| missing(key))?;
    let number = word.parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| (key.to_owned(), format!("`{}` is not a number", foreign::seen(word))))
}

fn missing(key: &str) -> Wrong {
    (key.to_owned(), "is missing; the line is cut off".into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use world::scan::NO_ECHO;

    fn input(text: &str) -> Input {
        Input::of_bytes("test.log", text.as_bytes())
    }

    const TWO: &str = "# a comment\nPARAM laser_front_laser_max 81.9\nODOM 0 0 0 0 0 0 1 host 1\n\
                       FLASER 4 1.0 2.0 30.0 81.9 0.5 -0.5 0.1 9 9 9 12.5 host 12.6\n\
                       ROBOTLASER1 0 -1.0 2.0 0.5 50.0 0.01 0 2 1.5 60.0 1 7 1 2 0.3 9 9 9 0 0 0 0 0 13.0 host 13.1\n";

    #[test]
    fn scans_of_both_messages_are_read() {
        let log = read(&input(TWO), 20.0).unwrap();
        let [front, robot] = &log.scans[..] else { panic!("{log:?}") };
        assert_eq!(front.scan.ranges_mm.0, [1000, 2000, NO_ECHO, NO_ECHO]);
        assert_eq!((front.scan.first_rad, front.scan.step_rad), (-FRAC_PI_2, PI / 4.0));
        assert_eq!((front.pose, front.t_s), (Pose::new(0.5, -0.5, 0.1), 0.0));
        assert_eq!(robot.scan.ranges_mm.0, [1500, NO_ECHO]);
        assert_eq!((robot.scan.first_rad, robot.scan.step_rad), (-1.0, 0.5));
        assert_eq!((robot.pose, robot.t_s), (Pose::new(1.0, 2.0, 0.3), 0.5));
        assert!(log.notes.is_empty());
    }

    #[test]
    fn a_damaged_scan_is_named_with_its_line_and_value() {
        let message = |text: &str| read(&input(text), 20.0).unwrap_err().to_string();
        for (text, said) in [
            ("ODOM 0 0 0", "contains no scans"),
            ("\nFLASER x", "line 2, number of rays: `x` is not a whole number up to 8192"),
            ("FLASER 3 1 2", "line 1, FLASER: 3 rays are announced, but the line has only 2 values"),
            ("FLASER 2 1 nan 0 0 0 0 0 0 1", "line 1, ray 2: `nan` is not a number"),
            ("FLASER 2 1 -3 0 0 0 0 0 0 1", "line 1, ray 2: -3 m; a distance is not negative"),
            ("FLASER 1 1 0 0", "line 1, theta: is missing; the line is cut off"),
            ("ROBOTLASER1 0 -1", "line 1, number of rays: is missing"),
        ] {
            assert!(message(text).contains(said), "{text}: {}", message(text));
        }
    }

    #[test]
    fn times_never_go_back_and_missing_times_are_assumed() {
        let line = |time: f64| format!("FLASER 1 1 0 0 0 0 0 0 {time} host 0\n");
        let times = |times: &[f64]| {
            let log = read(&input(&times.iter().map(|time| line(*time)).collect::<String>()), 20.0).unwrap();
            (log.scans.iter().map(|scan| scan.t_s).collect::<Vec<_>>(), log.notes.len())
        };
        assert_eq!(times(&[5.0, 7.0, 6.0, 8.0]), (vec![0.0, 2.0, 2.0, 3.0], 1));
        assert_eq!(times(&[0.0, 0.0, 0.0]), (vec![0.0, 0.2, 0.4], 1));
        assert_eq!(times(&[2.0, 1.0]), (vec![0.0, 0.0], 1));
    }

    proptest! {
        #[test]
        fn damaged_text_never_panics(cut in 0..TWO.len(), word in "[ -~]{0,6}") {
            let text = format!("{}{word}{}", &TWO[..cut], &TWO[cut..]);
            let _ = read(&input(&text), 20.0);
        }
    }
}
