//! `tankops check --vehicle`: tries a vehicle, and prints the result as a table or as JSON.

use crate::{cli::TrialArgs, stop_signal};
use command::json::pretty_json;
use flight::failure::{COMPLETE, ENDED_OTHERWISE, bad_input};
use remote::{Address, Trial, TrialOptions, try_vehicle};
use report::print::{say, warn_line};
use serde::Serialize;
use std::process::ExitCode;
use vehicle::{
    trial::{Figure, Row, Verdict},
    wire::message::Hello,
};

/// Width of a line of the table.
const WIDTH: usize = 100;

/// The result as JSON.
#[derive(Serialize)]
struct Told<'a> {
    at: String,
    /// Absent if no vehicle introduced itself.
    vehicle: Option<&'a Hello>,
    /// Whether the vehicle was allowed to move.
    driven: bool,
    passed: bool,
    interrupted: bool,
    checks: &'a [Row],
}

/// Runs `tankops check --vehicle`.
pub(crate) fn check(args: &TrialArgs, json: bool) -> anyhow::Result<ExitCode> {
    let Some(at) = &args.vehicle else { return Err(bad_input("--vehicle has no address")) };
    if *at == Address::Loopback {
        return Err(bad_input(
            "the simulator inside the console cannot be tried; write unix:PATH, tcp:HOST:PORT, \
                              udp:HOST:PORT or run:COMMAND",
        ));
    }
    let options = TrialOptions {
        network: args.vehicle_network,
        drive: args.drive,
        speed_m_per_s: args.speed,
        stop_max_s: args.stop_max,
    };
    let stop = stop_signal::listen();
    let tried = try_vehicle(at, &options, &warn_line, &|| stop.requested());
    let trial = match tried {
        Ok(trial) => trial,
        Err(error) => {
            let why = error.to_string();
            if json {
                let checks = &[Row::fail("connection", Vec::new(), why.clone())];
                let at = at.to_string();
                let told =
                    Told { at, vehicle: None, driven: false, passed: false, interrupted: false, checks };
                say(&json_of(&told)?)?;
            }
            return Err(bad_input(why));
        }
    };
    let passed = trial.is_passed();
    say(&if json {
        json_of(&Told {
            at: at.to_string(),
            vehicle: Some(&trial.hello),
            driven: args.drive,
            passed,
            interrupted: trial.interrupted,
            checks: &trial.rows,
        })?
    } else {
        table(&trial)
    })?;
    Ok(ExitCode::from(if passed { COMPLETE } else { ENDED_OTHERWISE }))
}

fn json_of(told: &Told<'_>) -> anyhow::Result<String> {
    pretty_json("the result of the trial", told)
}

fn table(trial: &Trial) -> String {
    let width = trial.rows.iter().map(|row| row.check.len()).max().unwrap_or_default();
    let rows: String = trial.rows.iter().map(|row| lines(row, width)).collect();
    format!("{rows}\n{}\n", conclusion(trial))
}

fn lines(row: &Row, width: usize) -> String {
    let verdict = match row.verdict {
        Verdict::Pass => "pass",
        Verdict::Fail => "FAIL",
        Verdict::NotMeasured => "-   ",
    };
    let head = format!("{verdict}  {:width$}  ", row.check);
    let figures: Vec<String> = row.figures.iter().map(figure).collect();
    let mut text = String::new();
    let parts: Vec<&str> = figures.iter().map(String::as_str).filter(|figure| !figure.is_empty()).collect();
    let told = [parts.join(", "), row.says.clone()];
    let mut lead = head.clone();
    for part in told.iter().filter(|part| !part.is_empty()) {
        for line in wrapped(part, WIDTH - head.len()) {
            text.push_str(format!("{lead}{line}").trim_end());
            text.push('\n');
            lead = " ".repeat(head.len());
        }
    }
    text
}

fn figure(Figure { name, value, unit, at_most }: &Figure) -> String {
    let number = |value: f64| {
        let places = if value.fract() == 0.0 || value.abs() >= 100.0 { 0 } else { 3 };
        format!("{value:.places$}")
    };
    let space = if unit.is_empty() { "" } else { " " };
    let most = at_most.map(|most| format!(" (at most {})", number(most))).unwrap_or_default();
    format!("{name} {}{space}{unit}{most}", number(*value))
}

/// A text in lines of at most `width` characters, broken between words.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.len() - 1;
        if lines[last].is_empty() {
            lines[last].push_str(word);
        } else if lines[last].chars().count() + 1 + word.chars().count() <= width {
            lines[last].push(' ');
            lines[last].push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}

fn conclusion(trial: &Trial) -> String {
    let count = |verdict| trial.rows.iter().filter(|row| row.verdict == verdict).count();
    let (failed, open) = (count(Verdict::Fail), count(Verdict::NotMeasured));
    let not_measured = if open == 0 { String::new() } else { format!(" {open} not measured.") };
    if trial.interrupted {
        return format!("INTERRUPTED: the vehicle was told to stop. {failed} failed.{not_measured}");
    }
    match failed {
        0 => format!("passed: {} checks.{not_measured}", count(Verdict::Pass)),
        _ => format!("FAILED: {failed} of {} checks.{not_measured}", trial.rows.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_readable_and_says_its_limit() {
        let figures = vec![Figure::new("time", 0.912_34, "s").at_most(1.2), Figure::new("lost", 0.0, "%")];
        let row = Row::fail("stop: link cut", figures, "word ".repeat(30).trim_end());
        let text = lines(&row, 20);
        assert!(
            text.starts_with("FAIL  stop: link cut        time 0.912 s (at most 1.200), lost 0 %\n"),
            "{text}"
        );
        assert!(text.lines().count() == 4 && text.lines().all(|line| line.len() <= WIDTH), "{text}");
    }
}
