//! The pulse test of the stations.

use positioning::{Integrity, PulseTest};
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
        "pulse test {}: {pulses} pulses, ranges too long by {:+.2} ± {:.2} %, clocks within {clocks:.2} m of sound",
        phase.words(),
        100.0 * scale.value,
        200.0 * scale.sigma,
    );
    let (sender, receiver, off_m) = test.worst;
    let found = match (integrity, test.suspect) {
        (Integrity::Alarm, Some(id)) => {
            format!("; STATION {} CONTRADICTS THE OTHERS: check its place and its sensor", name(id))
        }
        (Integrity::Alarm, None) => {
            let (sender, receiver) = (name(sender), name(receiver));
            format!("; NOT AS SURVEYED: from {sender} to {receiver}, {off_m:+.2} m too long")
        }
        (Integrity::Untestable, _) => "; too few pulses to check the survey".into(),
        (Integrity::Ok | Integrity::Suspect, _) => "; as surveyed".into(),
    };
    // Writing to a String cannot fail.
    let _ = write!(text, "{found}");
    text
}

/// What the change of the speed of sound between two tests means, as a sentence; `None` if the tests agree.
pub fn change_text(before: &PulseTest, test: &PulseTest) -> Option<String> {
    let change = test.change_since(before)?;
    Some(format!(
        "THE SPEED OF SOUND CHANGED: ranges became {:+.2} ± {:.2} % longer since the test before; check the temperature, \
         and let the stations exchange pulses more often",
        100.0 * change.value,
        200.0 * change.sigma,
    ))
}
