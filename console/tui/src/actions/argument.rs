//! The arguments of commands.

use std::fmt;

/// The kind of value that an argument takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(test, derive(strum::EnumCount))]
pub enum Kind {
    /// A speed of the simulation.
    Speed,
    /// The id of a planner.
    Planner,
    /// A parameter of the planner, with its value.
    Parameter,
    /// The name of a scenario.
    Scenario,
    /// The name of a past run, a unique prefix of it, or `latest`.
    Run,
    /// A layer of the map.
    Layer,
    /// The name of a station or an obstacle.
    Place,
    /// An event severity.
    Severity,
    /// A theme.
    Theme,
    /// A screen.
    Screen,
    /// The name of a preset.
    Preset,
    /// A duration.
    Duration,
    /// A moment of a run.
    Moment,
    /// An alarm.
    Alarm,
    /// The name of an AE station.
    Station,
    /// A range fault of a station.
    Fault,
    /// A corner of a box: x and y, metres.
    Corner,
    /// Any text.
    Text,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Speed => "speed",
            Self::Planner => "planner",
            Self::Parameter => "parameter",
            Self::Scenario => "scenario",
            Self::Run => "run",
            Self::Layer => "layer",
            Self::Place => "place",
            Self::Severity => "severity",
            Self::Theme => "theme",
            Self::Screen => "screen",
            Self::Preset => "preset",
            Self::Duration => "duration",
            Self::Moment => "moment",
            Self::Alarm => "alarm",
            Self::Station => "station",
            Self::Fault => "fault",
            Self::Corner => "corner",
            Self::Text => "text",
        })
    }
}

impl Kind {
    /// Whether the valid values depend on the open run or on files found on the disk.
    pub(crate) fn depends_on_run(self) -> bool {
        matches!(
            self,
            Self::Planner
                | Self::Parameter
                | Self::Scenario
                | Self::Run
                | Self::Place
                | Self::Preset
                | Self::Alarm
                | Self::Station
        )
    }
}

/// An argument of a command, given by position or by name: `planner=navfn`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Arg {
    /// The argument's name.
    pub name: &'static str,
    /// The kind of its value.
    pub kind: Kind,
    /// Whether the command requires the argument.
    pub is_required: bool,
}

pub(super) const fn must(name: &'static str, kind: Kind) -> Arg {
    Arg { name, kind, is_required: true }
}

pub(super) const fn may(name: &'static str, kind: Kind) -> Arg {
    Arg { name, kind, is_required: false }
}

impl Arg {
    /// The argument as it appears in the usage line.
    pub(super) fn usage(&self) -> String {
        let value = match self.kind {
            Kind::Parameter => "KEY=VALUE".to_owned(),
            _ => self.name.to_uppercase(),
        };
        if self.is_required { value } else { format!("[{value}]") }
    }
}

/// The longest duration, 1000 hours, seconds.
const LONGEST_S: f64 = 3.6e6;

/// Parses a duration such as `20s`, `15m` or `1h30m`; returns seconds.
///
/// # Errors
/// Returns a message with the expected format, or with the longest duration.
pub fn duration_s(text: &str) -> Result<f64, String> {
    let wrong = || format!("invalid duration `{text}`; write 20s, 15m or 1h30m");
    let mut total_s = 0.0;
    let mut rest = text;
    while !rest.is_empty() {
        let end = rest.find(|letter: char| !letter.is_ascii_digit() && letter != '.').ok_or_else(wrong)?;
        let number: f64 = rest[..end].parse().map_err(|_| wrong())?;
        let unit_s = match rest.get(end..=end).unwrap_or_default() {
            "s" => 1.0,
            "m" => 60.0,
            "h" => 3600.0,
            _ => return Err(wrong()),
        };
        total_s += number * unit_s;
        rest = &rest[end + 1..];
    }
    if total_s > LONGEST_S {
        return Err(format!("duration `{text}` is too long; at most 1000h"));
    }
    if total_s > 0.0 { Ok(total_s) } else { Err(wrong()) }
}

/// Parses a moment of a run such as `01:12:30`, `12:30`, `T+00:12:30`, `12m30s` or `46` (seconds, as in a filter); returns
/// seconds of mission time.
///
/// # Errors
/// Returns a message with the expected format.
pub fn moment_s(text: &str) -> Result<f64, String> {
    let wrong = || format!("invalid time `{text}`; write 01:12:30, 12:30, 12m30s or seconds");
    let text = text.strip_prefix("T+").unwrap_or(text);
    if let Ok(seconds) = text.parse::<f64>() {
        return Some(seconds).filter(|seconds| seconds.is_finite() && *seconds >= 0.0).ok_or_else(wrong);
    }
    if !text.contains(':') {
        return duration_s(text).map_err(|_| wrong());
    }
    let parts: Vec<&str> = text.split(':').collect();
    let is_number = |part: &&str| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit() || b == b'.');
    if parts.len() > 3 || !parts.iter().all(is_number) {
        return Err(wrong());
    }
    let mut numbers = parts.iter().map(|part| part.parse::<f64>());
    let total_s = numbers.try_fold(0.0, |sum_s, number| number.map(|number| 60.0 * sum_s + number));
    total_s.map_err(|_| wrong())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use strum::EnumCount;

    #[test]
    fn moments_are_clock_times_or_spans() {
        for (text, seconds) in
            [("01:12:30", 4350.0), ("12:30", 750.0), ("T+00:00:05.5", 5.5), ("2m", 120.0), ("46", 46.0)]
        {
            assert_eq!(moment_s(text), Ok(seconds), "{text}");
        }
        for wrong in ["", "-12", "inf", "1:2:3:4", ":", "1:-2", "1:x", "T+"] {
            assert!(moment_s(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn durations_have_units() {
        for (text, seconds) in [("20s", 20.0), ("15m", 900.0), ("1h30m", 5400.0), ("0.5s", 0.5)] {
            assert_eq!(duration_s(text), Ok(seconds), "{text}");
        }
        for wrong in ["", "20", "s", "1d", "-5s", "0s", "1.2.3s", "5\u{e9}"] {
            assert!(duration_s(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn every_kind_has_a_word_of_its_own() {
        let all: [Kind; Kind::COUNT] = [
            Kind::Speed,
            Kind::Planner,
            Kind::Parameter,
            Kind::Scenario,
            Kind::Run,
            Kind::Layer,
            Kind::Place,
            Kind::Severity,
            Kind::Theme,
            Kind::Screen,
            Kind::Preset,
            Kind::Duration,
            Kind::Moment,
            Kind::Alarm,
            Kind::Station,
            Kind::Fault,
            Kind::Corner,
            Kind::Text,
        ];
        let words: BTreeSet<String> = all.iter().map(ToString::to_string).collect();
        assert_eq!(words.len(), all.len(), "{words:?}");
        assert!(words.iter().all(|word| !word.is_empty() && !word.contains('_')), "{words:?}");
    }
}
