//! The figures of one run, as `run --json` prints them.

use crate::{
    Account, Calibration, Figure, PulseRecord, StationClock, TakenBack, VehicleRecord, drawn::DrawnZone,
    readings::ReadingsSummary,
};
use mission::{Check, Outcome, Parameters, Sandbox};
use positioning::Risk;
use serde::{Deserialize, Serialize};

/// Version of the format of JSON reports on one run or several; increased if older readers cannot read the new format.
pub const REPORT_VERSION: u32 = 1;

/// All figures that are reported about a run at its end. An unknown figure is `None`, in JSON `null`, never zero.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Summary {
    /// Version of the format, `REPORT_VERSION`; absent from reports that predate it.
    #[serde(default)]
    pub report_version: Option<u32>,
    /// Name of the scenario.
    pub scenario: Option<String>,
    /// Name of the file with the located readings; absent for a mission.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub located: Option<String>,
    /// The real vehicle that was driven; absent for a simulation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vehicle: Option<VehicleRecord>,
    /// Id of the first active planner.
    pub planner: Option<String>,
    /// Version of that planner's plugin.
    pub planner_version: Option<String>,
    /// Final parameters of that planner, including defaults.
    pub parameters: Option<Parameters>,
    /// Every planner that was active, in order, without duplicates.
    pub planners: Vec<String>,
    /// The weakest sandbox of the run's planners. Absent if no planner was loaded, and in older reports.
    #[serde(default)]
    pub sandbox: Option<Sandbox>,
    /// Seed for all random numbers.
    pub seed: Option<u64>,
    /// How the run ended; absent if it was cut off.
    pub outcome: Option<Outcome>,
    /// The reason for that end, as a sentence.
    pub reason: Option<String>,
    /// Number of ticks.
    pub ticks: Option<u64>,
    /// Mission time, seconds.
    pub mission_time_s: Option<f64>,
    /// Wall time taken to compute the run, seconds.
    pub wall_time_s: Option<f64>,
    /// Length of the robot's true path, metres.
    pub path_length_m: Option<f64>,
    /// Number of changes of the true heading above 30 degrees within half a metre of path.
    #[serde(default)]
    pub turns: Option<u64>,
    /// Sum of the true heading changes, in full turns.
    #[serde(default)]
    pub rotation_turns: Option<f64>,
    /// Smallest true distance from the hull to any solid object, metres; negative after a collision.
    pub clearance_min_m: Option<f64>,
    /// Number of collisions of the hull.
    pub collisions: Option<u64>,
    /// Number of found obstacles that are not on the drawing.
    pub obstacles_found: u64,
    /// Share of the floor within the wall that a survey has seen, 0 to 1; absent for other missions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub explored: Option<f64>,
    /// The figures that have a worst value: that value with its time and place, the last value, and the limit; empty for
    /// located readings.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub extremes: Vec<Figure>,
    /// No-go zones that were drawn before or during the mission, in order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub zones_drawn: Vec<DrawnZone>,
    /// Floor whose guarantee was taken back, because a station was found wrong; in order of time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub taken_back: Vec<TakenBack>,
    /// The speed of sound and the wrong stations that the session calibration found; absent without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibration: Option<Calibration>,
    /// The clocks of the stations; empty if they share one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub clocks: Vec<StationClock>,
    /// The pulse tests of the stations, in order of time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pulse_tests: Vec<PulseRecord>,
    /// The checks before the start, by the console and by the operator; empty for a run without an operator.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub checks: Vec<Check>,
    /// Number of holds.
    pub holds: u64,
    /// Number of planner faults; a planner that the console refused does not count.
    pub planner_faults: u64,
    /// The first planner faults with their times, as sentences; those of a planner in shadow begin with "shadow".
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<String>,
    /// Bounds of the scenario's `[expect]` that the run did not meet, as sentences; absent if the bounds were not
    /// compared.
    #[serde(default)]
    pub violations: Option<Vec<String>>,
    /// Coverage of the floor.
    pub coverage: Option<Coverage>,
    /// The account of the floor for inspectors; absent for missions without a scan.
    #[serde(default)]
    pub floor: Option<Account>,
    /// How closely a preset path was followed; absent for other missions.
    pub tracking: Option<Tracking>,
    /// Accuracy of the position according to its own covariance, as a real robot can state it.
    #[serde(default)]
    pub accuracy: Option<Accuracy>,
    /// Accuracy of the position compared with the true position; absent outside simulation.
    pub positioning: Option<Positioning>,
    /// The tether record; absent without a tether.
    pub tether: Option<Tether>,
    /// Response times of the planners; set by the app.
    pub planner_calls: Option<PlannerCalls>,
    /// Times from a stop order to the command that stops the robot; absent for runs that no operator stopped. Set by
    /// the app.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stops: Option<Stops>,
    /// SHA-256 of the journal, hexadecimal; set by the app.
    pub events_sha256: Option<String>,
    /// SHA-256 of the recording, hexadecimal; set by the app.
    #[serde(default)]
    pub recording_sha256: Option<String>,
    /// The readings of the instrument; absent if it reads no thickness.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub readings: Option<ReadingsSummary>,
    /// SHA-256 of the file with the readings, hexadecimal; set by the recorder.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub readings_sha256: Option<String>,
    /// The files of the run; set by the app.
    pub logs: Option<Logs>,
}

/// Wall time from the key press or signal that stops the robot, as read by the console, to the command that stops it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Stops {
    /// Number of stops.
    pub count: u64,
    /// Median time, milliseconds.
    pub p50_ms: f64,
    /// Time that 99 % of the stops do not exceed, milliseconds.
    pub p99_ms: f64,
    /// Longest time, milliseconds.
    pub max_ms: f64,
}

impl Stops {
    /// The figures of some stops, each in milliseconds; `None` if there are none.
    pub fn of(times_ms: &[f64]) -> Option<Self> {
        let mut sorted = times_ms.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let rank = (share * sorted.len() as f64).ceil() as usize;
            sorted.get(rank.saturating_sub(1)).copied()
        };
        Some(Self { count: sorted.len() as u64, p50_ms: at(0.5)?, p99_ms: at(0.99)?, max_ms: at(1.0)? })
    }
}

/// Coverage of the floor. Shares are 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Coverage {
    /// Share of the reachable floor, according to the estimated position.
    pub reachable: f64,
    /// Share of the whole floor (excluding the footprint of obstacles), according to the estimated position.
    pub whole: f64,
    /// Share of the scanned floor that was scanned more than once, according to the estimated path: the tool came
    /// back to it after more than two swaths of path. Absent if nothing was scanned.
    pub overlap: Option<f64>,
    /// Reachable floor that was not scanned, according to the estimated position, square metres; absent for missions
    /// without a scan.
    pub missed_area_m2: Option<f64>,
    /// Coverage according to the true position; absent where the true position is not known.
    pub by_truth: Option<CoverageByTruth>,
    /// The floor whose guarantee was taken back; absent if no floor lost its guarantee.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub taken_back: Option<Regained>,
}

/// Floor whose guarantee was taken back, and what later passes made of it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Regained {
    /// All of this floor, square metres.
    pub area_m2: f64,
    /// The part that a later pass guarantees again, square metres.
    pub again_m2: f64,
}

impl std::fmt::Display for Regained {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { area_m2, again_m2 } = self;
        write!(f, "of {area_m2:.1} m² that lost the guarantee, later passes guarantee {again_m2:.1} m²")?;
        let left_m2 = area_m2 - again_m2;
        if left_m2 > 0.0 { write!(f, "; {left_m2:.2} m² stay in doubt") } else { Ok(()) }
    }
}

/// Coverage according to the true position. Shares are 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CoverageByTruth {
    /// Share of the reachable floor.
    pub reachable: f64,
    /// Share of the whole floor.
    pub whole: f64,
    /// Share of the floor claimed as scanned that truly was; absent if nothing is claimed.
    #[serde(default)]
    pub scanned_truly: Option<f64>,
    /// Share of the floor claimed as guaranteed that truly was scanned; absent if nothing is claimed.
    #[serde(default)]
    pub guaranteed_truly: Option<f64>,
}

/// The 95 % error of the position: the longer semi-axis of the 95 % ellipse of its covariance, over all ticks. It
/// does not include errors in the survey or in the speed of sound, or the offset of the tool.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Accuracy {
    /// Mean error, metres.
    pub mean_m: f64,
    /// Error that is not exceeded in 95 % of the ticks, metres.
    pub p95_m: f64,
    /// Largest error, metres.
    pub max_m: f64,
    /// Limit above which nothing counts as scanned, metres.
    pub limit_m: f64,
    /// Share of the path with an error above the limit, 0 to 1.
    pub over_limit: f64,
    /// Number of positions from ranges.
    pub fixes: u64,
    /// Mean number of stations per position; absent without positions.
    pub stations_mean: Option<f64>,
    /// Minimum number of stations per position; absent without positions.
    pub stations_min: Option<u64>,
    /// The protection levels; absent if the scenario states no risk.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub protection: Option<Protection>,
}

/// The protection levels of a run, tick by tick.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Protection {
    /// Median level, metres; absent if the position was never protected.
    pub p50_m: Option<f64>,
    /// Level that is not exceeded in 95 % of the protected ticks, metres.
    pub p95_m: Option<f64>,
    /// Largest level, metres.
    pub max_m: Option<f64>,
    /// Share of the ticks in which the position was not protected, 0 to 1.
    pub unprotected: f64,
    /// Whether the level decides which floor is guaranteed; if not, the 95 % ellipse does.
    pub guarantees: bool,
    /// The accepted risk and the assumed rate of faults; absent in reports of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub risk: Option<Risk>,
}

/// How closely the true path follows the preset path. "Near" means within [`Tracking::NEAR_M`].
///
/// The true path is sampled every 0.05 m, so that a robot at rest adds no samples. Each sample is paired with the
/// nearest point of the preset path that is at most 1 m ahead of the previous pair or of the mission's own progress,
/// and not behind the previous pair. A robot that leaves an arc is therefore not paired with the adjacent turn of a
/// spiral.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tracking {
    /// Share of the samples that are near their paired point, 0 to 1.
    pub precision: f64,
    /// Share of the preset points that the true path ever passes near, 0 to 1.
    pub recall: f64,
    /// Root mean square distance of the preset points from the stretch of the true path that was paired with them,
    /// metres: an arc cut short counts in full. Points that were never reached count only in `recall`. Absent if no
    /// point was reached.
    pub rmse_m: Option<f64>,
    /// Root mean square distance of the samples from their paired points, metres.
    pub cross_track_rmse_m: f64,
}

impl Tracking {
    /// Distance, metres, within which a robot counts as being on the path (T0 in Wang et al. 2023).
    pub const NEAR_M: f64 = 0.2;
}

/// Distance between the estimated and the true position, over all ticks that have both.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Positioning {
    /// Mean error, metres.
    pub mean_error_m: f64,
    /// Median error, metres; by nearest rank, like `p95_m`.
    pub p50_m: f64,
    /// Error that is not exceeded in 95 % of the ticks, metres.
    pub p95_m: f64,
    /// Largest error, metres.
    pub max_m: f64,
    /// Share of the ticks in which the true position was inside the 95 % ellipse, 0 to 1.
    pub in_95_ellipse: f64,
    /// Time for which the position was lost, seconds.
    pub position_lost_s: f64,
}

/// The tether record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tether {
    /// Greatest length paid out, metres.
    pub tether_length_max_m: f64,
    /// Largest wrap on one obstacle, radians.
    pub wrap_max_rad: f64,
    /// Largest total wrap, radians.
    pub wrap_total_max_rad: f64,
    /// Number of loops at the end.
    pub loops: u64,
    /// Length paid out at the end, metres.
    pub end_length_m: f64,
    /// Whether the tether could not be reeled in.
    pub entangled: bool,
    /// Number of times that the mission found the tether snagged on an unmapped object.
    #[serde(default)]
    pub snags: u64,
    /// Whether the tether was snagged when the run ended.
    #[serde(default)]
    pub snagged: bool,
    /// Number of times that the robot truly drove over its own tether; absent for a tether that is always taut.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over_own: Option<u64>,
    /// Mission time at which the mission found the tether broken, seconds; absent for a whole tether.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub broken_at_s: Option<f64>,
    /// Whether the simulated tether was torn when the run ended, whether or not the mission had found it broken.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub torn_at_end: bool,
}

/// Response times of the planners.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PlannerCalls {
    /// Number of plans requested.
    pub plan: u64,
    /// Number of steps requested.
    pub step: u64,
    /// Median time of a step, microseconds; absent without steps.
    pub p50_us: Option<f64>,
    /// Time that 99 % of the steps do not exceed, microseconds; absent without steps.
    pub p99_us: Option<f64>,
    /// Number of failed calls.
    pub faults: u64,
}

/// The files of a run.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Logs {
    /// The journal.
    pub journal: Option<String>,
    /// The recording.
    pub recording: Option<String>,
    /// Errors while the files were written; absent if they are complete.
    pub error: Option<String>,
    /// Whether the files are still being written.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_open: bool,
}
