//! What commands take.

/// What a value of a command is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A speed of the simulation.
    Speed,
    /// Id of a planner.
    Planner,
    /// A parameter of the planner and its value.
    Parameter,
    /// Name of a scenario.
    Scenario,
    /// Name of a past run, the unique beginning of one, or `latest`.
    Run,
    /// A layer of the map.
    Layer,
    /// Name of a station or an obstacle.
    Place,
    /// A severity of events.
    Severity,
    /// A theme.
    Theme,
    /// A screen.
    Screen,
    /// Name of a preset.
    Preset,
    /// A span of time.
    Duration,
    /// A moment of a run.
    Moment,
    /// An alarm.
    Alarm,
    /// Name of an AE station.
    Station,
    /// What is wrong with a station.
    Fault,
    /// A corner of a box: x and y, metres.
    Corner,
    /// Any text.
    Text,
}

impl Kind {
    /// Whether a run that is open, or what was found on the disk, decides which values there are.
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

/// What a command takes: in the order of the table, or by its name: `planner=navfn`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Arg {
    /// Its name.
    pub name: &'static str,
    /// What its value is.
    pub kind: Kind,
    /// Whether the command does not run without it.
    pub is_required: bool,
}

pub(super) const fn must(name: &'static str, kind: Kind) -> Arg {
    Arg { name, kind, is_required: true }
}

pub(super) const fn may(name: &'static str, kind: Kind) -> Arg {
    Arg { name, kind, is_required: false }
}

impl Arg {
    /// How it is written.
    pub(super) fn usage(&self) -> String {
        let value = match self.kind {
            Kind::Parameter => "KEY=VALUE".to_owned(),
            _ => self.name.to_uppercase(),
        };
        if self.is_required { value } else { format!("[{value}]") }
    }
}

/// Reads a span of time such as `20s`, `15m`, `1h30m`; seconds.
///
/// # Errors
/// How it is written.
pub fn duration_s(text: &str) -> Result<f64, String> {
    let wrong = || format!("no duration `{text}`; write 20s, 15m or 1h30m");
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
    if total_s > 0.0 { Ok(total_s) } else { Err(wrong()) }
}

/// Reads a moment of a run such as `01:12:30`, `12:30`, `T+00:12:30` or `12m30s`; seconds of mission time.
///
/// # Errors
/// How it is written.
pub fn moment_s(text: &str) -> Result<f64, String> {
    let wrong = || format!("no moment `{text}`; write 01:12:30, 12:30 or 12m30s");
    let text = text.strip_prefix("T+").unwrap_or(text);
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

    #[test]
    fn moments_are_clock_times_or_spans() {
        for (text, seconds) in [("01:12:30", 4350.0), ("12:30", 750.0), ("T+00:00:05.5", 5.5), ("2m", 120.0)]
        {
            assert_eq!(moment_s(text), Ok(seconds), "{text}");
        }
        for wrong in ["", "12", "1:2:3:4", ":", "1:-2", "1:x", "T+"] {
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
}
