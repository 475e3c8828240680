//! What is known of the sensor that scans.

use serde::{Deserialize, Serialize};
use world::Scanner;

/// What is known of a scanner. A real vehicle states only its distances.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sensor {
    /// Standard deviation of a distance, metres.
    pub sigma_m: f64,
    /// Greatest distance that is measured, metres; `None` if it is unknown, so that a ray without an echo says nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range_m: Option<f64>,
    /// Number of rays of a scan; `None` to expect as many as in the first scan.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rays: Option<u32>,
}

impl Sensor {
    /// A sensor of which nothing is known.
    pub const UNKNOWN: Self = Self { sigma_m: 0.03, range_m: None, rays: None };

    /// Whether the noise is known: it is that of a scenario.
    pub fn is_known(&self) -> bool {
        self.rays.is_some()
    }

    /// A sensor that is as a scenario describes it.
    pub fn of(scanner: &Scanner) -> Self {
        Self { sigma_m: scanner.sigma_m, range_m: Some(scanner.range_m), rays: Some(scanner.rays) }
    }
}
