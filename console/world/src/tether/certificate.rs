//! The certificate of a path.

use super::{own_gap::OwnGap, pull::Pull};
use serde::{Deserialize, Serialize};

/// The results of certifying a path.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Certificate {
    /// Whether the path may be run with a tether.
    pub certified: bool,
    /// The reasons for a refusal, as sentences; empty if certified.
    pub reasons: Vec<String>,
    /// What is close to a limit, as sentences; a path with warnings can be certified.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// Longest cable on the path, metres.
    pub tether_length_max_m: f64,
    /// Largest distance from the anchor to any point of the path, measured along the shortest path, metres: the length
    /// of the shortest tether that would suffice.
    pub eccentricity_m: f64,
    /// Largest wrap on one obstacle at any time, radians.
    pub wrap_max_rad: f64,
    /// Largest total wrap at any time, radians.
    pub wrap_total_max_rad: f64,
    /// Cable still out after the return to the anchor, metres; absent for a path that need not return.
    pub end_length_m: Option<f64>,
    /// The number of ray crossings that are not undone on return; 0 means that the cable can be reeled in.
    pub crossings_left: usize,
    /// Number of segments of the path that are closer to something solid than the hull allows.
    pub collisions: usize,
    /// Least distance from the path to anything solid, metres; never more than the required clearance.
    pub clearance_min_m: f64,
    /// Number of times that the path crosses a cut.
    pub cut_crossings: usize,
    /// Area of the floor that is sealed off by cuts, square metres.
    pub sealed_m2: f64,
    /// The pull that the path needs; `None` if it was not checked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pull: Option<Pull>,
    /// The least distance between the hull and its own taut cable on the way in; `None` if the scenario does not describe the
    /// reel, or if the cable bends nowhere on the way in.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub own_gap: Option<OwnGap>,
}

impl Certificate {
    /// Returns the pull as text, or a statement that it was not checked.
    ///
    /// ```
    /// let certificate = world::tether::Certificate::default();
    /// assert_eq!(certificate.pull_text(), "pull not checked: the scenario does not describe the reel");
    /// ```
    pub fn pull_text(&self) -> String {
        self.pull.map_or_else(
            || "pull not checked: the scenario does not describe the reel".into(),
            |pull| format!("pull {}", pull.text()),
        )
    }

    /// Returns the certificate of a path that could not be evaluated at all.
    ///
    /// ```
    /// let refused = world::tether::Certificate::refused("the plan has no path".into());
    /// assert!(!refused.certified && refused.reasons.len() == 1);
    /// ```
    pub fn refused(reason: String) -> Self {
        Self { reasons: vec![reason], ..Self::default() }
    }
}
