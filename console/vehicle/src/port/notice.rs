//! Facts about a real vehicle that its operator must know.

use super::VehicleInfo;
use serde::{Deserialize, Serialize};

/// A fact about a real vehicle that is reported when it is found, and again when it changes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "notice")]
pub enum Notice {
    /// A vehicle with a different description has introduced itself on the same connection. It is not driven.
    OtherVehicle {
        /// The new description.
        vehicle: Box<VehicleInfo>,
        /// The differences from the vehicle of this run, each as a clause.
        differs: Vec<String>,
    },
    /// Faulty messages have arrived and were ignored.
    FaultyMessages {
        /// Their number so far.
        count: u64,
        /// The field and the fault of the first one.
        first: String,
        /// The field and the fault of the last one.
        last: String,
    },
    /// The rate of the vehicle's clock has begun or ceased to differ from the console's by more than 1 %.
    ClockRate {
        /// The field with the stamps.
        field: String,
        /// Seconds of the vehicle's clock for each second of the console's.
        rate: f64,
        /// Whether the difference is more than 1 %.
        is_off: bool,
    },
}
