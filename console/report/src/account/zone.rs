//! The critical zone along the shell.

use serde::{Deserialize, Serialize};
use world::ShellFigures;

/// Width of the critical zone along the shell, metres (API 653: 3 inches).
pub(crate) const CRITICAL_ZONE_M: f64 = 0.075;
/// Share of the shell along which the whole zone is scanned when it counts as done.
const CRITICAL_DONE: f64 = 0.995;

/// The zone along the shell, where the floor plate meets it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CriticalZone {
    /// Its width, metres.
    pub width_m: f64,
    /// Length of the shell beside free floor, metres.
    #[serde(default)]
    pub length_m: f64,
    /// Length along which its whole width was scanned, metres.
    #[serde(default)]
    pub done_m: f64,
    /// Scanned share of its area, 0 to 1; absent if there is no free floor at the shell.
    pub scanned: Option<f64>,
    /// Distance from the shell to where the scanned floor begins, the median along the shell where the zone is not
    /// done, metres; its width if nothing of it was scanned.
    #[serde(default)]
    pub gap_m: f64,
    /// Whether it was scanned: its whole width along 99.5 % of the shell.
    pub done: bool,
    /// Why not, as a sentence; absent if it was.
    pub why: Option<String>,
}

impl CriticalZone {
    /// The zone as the shell was scanned.
    pub(crate) fn of(shell: ShellFigures) -> Self {
        let ShellFigures { length_m, done_m, scanned, gap_m } = shell;
        let has_floor = length_m > 0.0;
        let done = has_floor && done_m >= CRITICAL_DONE * length_m;
        let why = match gap_m {
            _ if done => None,
            _ if !has_floor => Some("no free floor at the shell".to_owned()),
            _ if scanned <= 0.0 => Some("none of it scanned".to_owned()),
            gap_m => {
                let rest = if gap_m >= CRITICAL_ZONE_M - 1e-9 {
                    "the rest mostly unscanned".to_owned()
                } else {
                    format!("the rest from {:.0} mm off the shell (median)", 1000.0 * gap_m)
                };
                Some(format!("full width on {done_m:.1} of {length_m:.1} m, {rest}"))
            }
        };
        let scanned = has_floor.then_some(scanned);
        Self { width_m: CRITICAL_ZONE_M, length_m, done_m, scanned, gap_m, done, why }
    }
}
