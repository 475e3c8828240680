//! The instrument that tests the floor.

use serde::{Deserialize, Serialize};
use std::fmt;
use world::DeadBands;

/// The method of an instrument.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InstrumentKind {
    /// Magnetic flux leakage.
    Mfl,
    /// Ultrasonic thickness.
    Ut,
}

impl fmt::Display for InstrumentKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Mfl => "magnetic flux leakage (MFL)",
            Self::Ut => "ultrasonic testing (UT)",
        })
    }
}

/// The instrument that the robot carries.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct InstrumentConfig {
    /// The method.
    pub kind: InstrumentKind,
    /// The floor that the instrument cannot test because of the welds; `None` if welds do not matter to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dead_bands: Option<DeadBands>,
    /// How the instrument reads thickness; `None` if it only marks floor as scanned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sampling: Option<Sampling>,
}

/// How an instrument reads the thickness of the floor while it moves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sampling {
    /// Number of channels, evenly spaced across the swath.
    pub channels: u16,
    /// Distance along the way between two readings of a channel, metres.
    pub pitch_m: f64,
    /// Nominal thickness of the floor, from which loss is measured, millimetres.
    pub thickness_mm: f64,
    /// Standard deviation of a reading, millimetres.
    pub sigma_mm: f64,
    /// Loss from which a reading belongs to an indication, as a share of the nominal thickness.
    pub threshold: f64,
}

impl Sampling {
    /// Distance of a channel from the middle of the tool, metres; positive to the left. Channel 0 is on the right.
    ///
    /// ```
    /// let sampling =
    ///     mission::Sampling { channels: 3, pitch_m: 0.01, thickness_mm: 8.0, sigma_mm: 0.2, threshold: 0.2 };
    /// assert!((sampling.offset_m(0, 0.6) + 0.2).abs() < 1e-9 && sampling.offset_m(1, 0.6).abs() < 1e-9);
    /// ```
    pub fn offset_m(&self, channel: u16, swath_m: f64) -> f64 {
        swath_m * ((f64::from(channel) + 0.5) / f64::from(self.channels.max(1)) - 0.5)
    }

    /// Loss from which a reading belongs to an indication, millimetres.
    pub fn threshold_mm(&self) -> f64 {
        self.threshold * self.thickness_mm
    }
}
