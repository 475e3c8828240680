//! The errors of the stations in words: the pulse test, and biases.

use super::ClockOffset;
use positioning::{Estimated, Integrity, PulseError, PulseTest};
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;
use world::{Station, StationId};

/// The part of a run in which the stations sent their pulses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PulsePhase {
    /// Before the first range of the robot.
    Before,
    /// Between two ranges of the robot, as during a hold.
    Held,
    /// After the last range of the robot.
    After,
}

impl PulsePhase {
    /// The phase in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Before => "before the run",
            Self::Held => "during the run",
            Self::After => "after the run",
        }
    }
}

/// A pulse test as a sentence: when, the speed of sound, the clocks, and whether the pulses agree with the survey.
pub fn pulse_text(phase: PulsePhase, test: &PulseTest, stations: &[Station]) -> String {
    let PulseTest { scale, integrity, pulses, .. } = test;
    let name =
        |id: StationId| stations.iter().find(|s| s.id == id).map_or("?", |station| station.name.as_str());
    let clocks = test.offsets_m.iter().map(|(_, offset)| offset.value.abs()).fold(0.0, f64::max);
    let mut text = format!(
        "pulse test {}: {pulses} pulses, ranges {:.2} ± {:.2} % too {}, clocks within {clocks:.2} m of sound",
        phase.words(),
        100.0 * scale.value.abs(),
        200.0 * scale.sigma,
        long_or_short(scale.value),
    );
    let (sender, receiver, off_m) = test.worst;
    let found = match (integrity, test.suspect) {
        (Integrity::Alarm, Some(id)) => {
            format!("; STATION {} CONTRADICTS THE OTHERS: check its place and its sensor", name(id))
        }
        (Integrity::Alarm, None) => {
            let (sender, receiver) = (name(sender), name(receiver));
            let (length_m, long) = (off_m.abs(), long_or_short(off_m));
            format!("; NOT AS SURVEYED: from {sender} to {receiver}, {length_m:.2} m too {long}")
        }
        (Integrity::Untestable, _) => "; too few pulses to check the survey".into(),
        (Integrity::Ok | Integrity::Suspect, _) => "; as surveyed".into(),
    };
    // Writing to a String cannot fail.
    let _ = write!(text, "{found}");
    let took_part = |station: &&Station| test.offsets_m.iter().any(|(id, _)| *id == station.id);
    let absent: Vec<&str> =
        stations.iter().filter(|station| !took_part(station)).map(|station| station.name.as_str()).collect();
    if !(absent.is_empty() || test.offsets_m.is_empty()) {
        let _ = write!(text, "; {} took no part", absent.join(", "));
    }
    text
}

/// Why a pulse test failed, as text with the names of the stations.
pub fn pulse_error_text(why: PulseError, stations: &[Station]) -> String {
    let name = |id: StationId| {
        let known = stations.iter().find(|station| station.id == id);
        known.map_or_else(|| id.0.to_string(), |station| station.name.clone())
    };
    match why {
        PulseError::Impossible { sender, receiver, length_m, most_m } => format!(
            "the pulse from station {} to station {} is {length_m:.2} m long, but only lengths from 0 to {most_m:.2} m are \
             possible; check its unit, and the clocks of both stations",
            name(sender),
            name(receiver)
        ),
        other => other.to_string(),
    }
}

/// A failed pulse test as a sentence.
pub fn pulse_failure_text(phase: PulsePhase, why: PulseError, stations: &[Station]) -> String {
    format!("pulse test {} failed: {}", phase.words(), pulse_error_text(why, stations))
}

/// The clocks that changed between two tests, as a sentence.
pub fn clocks_changed_text(changes: &[ClockOffset], stations: &[Station]) -> String {
    let one = |ClockOffset { station, offset_m }: &ClockOffset| {
        let known = stations.iter().find(|known| known.id == *station);
        let name = known.map_or_else(|| station.0.to_string(), |known| known.name.clone());
        format!("{name} by {}", bias_text(offset_m))
    };
    let all: Vec<String> = changes.iter().map(one).collect();
    format!(
        "CLOCKS CHANGED since the test before, as lengths that sound travels: {}; positions since then may be wrong, check \
         the stations",
        all.join(", ")
    )
}

/// What the change of the speed of sound between two tests means, as a sentence; `None` if the tests agree.
pub fn change_text(before: &PulseTest, test: &PulseTest) -> Option<String> {
    let change = test.change_since(before)?;
    Some(format!(
        "THE SPEED OF SOUND CHANGED: ranges became {:.2} ± {:.2} % {}er since the test before; check the temperature, \
         and let the stations exchange pulses more often",
        100.0 * change.value.abs(),
        200.0 * change.sigma,
        long_or_short(change.value),
    ))
}

/// The length by which the ranges of a station are too long, metres, with its 95 % error.
///
/// ```
/// use positioning::Estimated;
/// let bias_m = Estimated { value: 0.17, sigma: 0.022 };
/// assert_eq!(mission::event::bias_text(&bias_m), "+0.17 ± 0.04 m");
/// ```
pub fn bias_text(bias_m: &Estimated) -> String {
    format!("{:+.2} ± {:.2} m", bias_m.value, 2.0 * bias_m.sigma)
}

/// The word for the sign of an error of a length.
fn long_or_short(error: f64) -> &'static str {
    if error < 0.0 { "short" } else { "long" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::Point;

    #[test]
    fn a_length_is_too_long_or_too_short_and_never_negative() {
        let station =
            |id, name: &str| Station { id: StationId(id), name: name.into(), position: Point::origin() };
        let stations = [station(1, "A"), station(2, "B")];
        let test = |value, off_m| PulseTest {
            scale: Estimated { value, sigma: 0.000_6 },
            offsets_m: Vec::new(),
            integrity: Integrity::Alarm,
            suspect: None,
            worst: (StationId(1), StationId(2), off_m),
            pulses: 30,
        };
        let before = test(0.02, 0.37);
        assert_eq!(
            pulse_text(PulsePhase::Before, &before, &stations),
            "pulse test before the run: 30 pulses, ranges 2.00 ± 0.12 % too long, clocks within 0.00 m of sound; \
             NOT AS SURVEYED: from A to B, 0.37 m too long"
        );
        let after = test(-0.01, -0.37);
        let text = pulse_text(PulsePhase::After, &after, &stations);
        assert!(
            text.contains("ranges 1.00 ± 0.12 % too short,") && text.ends_with("0.37 m too short"),
            "{text}"
        );
        let change = change_text(&before, &after).expect("a change of 3 %");
        assert!(change.contains("ranges became 3.00 ± 0.17 % shorter since"), "{change}");
    }
}
