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
}
