//! The known properties of the scanner.

use serde::{Deserialize, Serialize};
use world::Scanner;

/// The known properties of a scanner. A real vehicle reports only the distances that it measures.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sensor {
    /// Standard deviation of a distance, metres.
    pub sigma_m: f64,
    /// Maximum distance that can be measured, metres; `None` if only the scans may state it. If neither states it, a ray
    /// without an echo contains no information.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range_m: Option<f64>,
    /// Number of rays of a scan; `None` to expect at least half as many as in the first scan.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rays: Option<u32>,
    /// Whether scans correct the estimated position, by the wall and the drawn obstacles.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub locates: bool,
}

impl Sensor {
    /// A scanner whose properties are not known.
    pub const UNKNOWN: Self = Self { sigma_m: 0.03, range_m: None, rays: None, locates: false };

    /// Whether the noise is known because a scenario describes the scanner.
    pub fn is_known(&self) -> bool {
        self.rays.is_some()
    }

    /// The scanner that a scenario describes.
    pub fn of(scanner: &Scanner) -> Self {
        Self {
            sigma_m: scanner.sigma_m,
            range_m: Some(scanner.range_m),
            rays: Some(scanner.rays),
            locates: false,
        }
    }
}
