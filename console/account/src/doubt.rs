//! Floor whose guarantee was taken back, because a station was found wrong.

use serde::{Deserialize, Serialize};

/// Floor that lost its guarantee when a biased station was detected.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TakenBack {
    /// Name of the station.
    pub station: String,
    /// Length by which its ranges were too long, metres.
    pub bias_m: f64,
    /// Mission time at which the bias may have begun, seconds.
    pub since_s: f64,
    /// Mission time at which the bias was detected, seconds.
    pub until_s: f64,
    /// Area that was guaranteed only by passes between the two times, square metres.
    pub area_m2: f64,
}

impl std::fmt::Display for TakenBack {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { station, bias_m, since_s, until_s, area_m2 } = self;
        write!(
            f,
            "{area_m2:.1} m² scanned from {since_s:.0} s to {until_s:.0} s: the ranges of station {station} were \
             wrong by {bias_m:+.2} m"
        )
    }
}
