//! The figures of one run, as `run --json` prints them.

use crate::{Account, drawn::DrawnZone};
use mission::{Check, Outcome, Parameters, Sandbox};
use serde::{Deserialize, Serialize};

/// Version of the form of reports as JSON, of one run and of several; raised when an old reader could not read a new one.
pub const REPORT_VERSION: u32 = 1;

/// Everything that is reported about a run when it is over. What is not known is `None`, in JSON `null`, never zero.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Summary {
    /// Version of the form, `REPORT_VERSION`; absent in reports of before there were any.
    #[serde(default)]
    pub report_version: Option<u32>,
    /// Name of the scenario.
    pub scenario: Option<String>,
    /// File of the readings that were located; absent for a run that was flown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub located: Option<String>,
    /// Id of the planner that drove first.
    pub planner: Option<String>,
    /// Version of its plugin.
    pub planner_version: Option<String>,
    /// Its parameters, defaults included, as they were last.
    pub parameters: Option<Parameters>,
    /// Every planner that drove, in order, each once.
    pub planners: Vec<String>,
    /// How far the processes of its planners were closed off: the weakest of them. Absent if no planner was loaded, and in
    /// older reports.
    #[serde(default)]
    pub sandbox: Option<Sandbox>,
    /// Start of every random choice.
    pub seed: Option<u64>,
    /// How the run ended; absent if it was cut off.
    pub outcome: Option<Outcome>,
    /// Why, as a sentence.
    pub reason: Option<String>,
    /// Ticks that passed.
    pub ticks: Option<u64>,
    /// Mission time that passed, seconds.
    pub mission_time_s: Option<f64>,
    /// Time it took to compute, seconds.
    pub wall_time_s: Option<f64>,
    /// Way that the robot truly went, metres.
    pub path_length_m: Option<f64>,
    /// Changes of heading above 30 degrees within half a metre of the true way.
    #[serde(default)]
    pub turns: Option<u64>,
    /// Sum of the true heading changes as whole turns.
    #[serde(default)]
    pub rotation_turns: Option<f64>,
    /// Smallest true distance from the hull to anything solid, metres; negative after a collision.
    pub clearance_min_m: Option<f64>,
    /// How often the hull began to touch something.
    pub collisions: Option<u64>,
    /// Obstacles found that are not on the drawing.
    pub obstacles_found: u64,
    /// No-go zones that were drawn before or during the mission, in order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub zones_drawn: Vec<DrawnZone>,
    /// What was checked before the start, by the console and by hand; empty for a run without an operator.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub checks: Vec<Check>,
    /// How often the robot was held.
    pub holds: u64,
    /// How often a planner failed; one that the console refused has not.
    pub planner_faults: u64,
    /// The first faults of planners, with their times, as sentences; those of a planner in shadow begin with "shadow".
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<String>,
    /// Bounds of the scenario's `[expect]` that the run did not keep, as sentences; absent if nobody compared.
    #[serde(default)]
    pub violations: Option<Vec<String>>,
    /// How much of the floor was scanned.
    pub coverage: Option<Coverage>,
    /// The account of the floor for inspectors; absent for missions that are not to scan it.
    #[serde(default)]
    pub floor: Option<Account>,
    /// How closely a preset path was followed; absent for other missions.
    pub tracking: Option<Tracking>,
    /// How good the position was by its own covariance, as a real robot can state it.
    #[serde(default)]
    pub accuracy: Option<Accuracy>,
    /// How good the position was by the truth; absent outside simulation.
    pub positioning: Option<Positioning>,
    /// How the tether lay; absent without one.
    pub tether: Option<Tether>,
    /// How long planners took; set by the app.
    pub planner_calls: Option<PlannerCalls>,
    /// How long stopping took; absent for runs that were not stopped by an operator. Set by the app.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stops: Option<Stops>,
    /// SHA-256 of the journal, hexadecimal; set by the app.
    pub events_sha256: Option<String>,
    /// SHA-256 of the recording, hexadecimal; set by the app.
    #[serde(default)]
    pub recording_sha256: Option<String>,
    /// The files of the run; set by the app.
    pub logs: Option<Logs>,
}

/// How long it took from a key or signal that stops the robot, as the console read it, to the command that stops it, by the
/// wall clock.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Stops {
    /// How many there were.
    pub count: u64,
    /// Half of them took at most this long, milliseconds.
    pub p50_ms: f64,
    /// Ninety-nine of a hundred took at most this long, milliseconds.
    pub p99_ms: f64,
    /// The longest, milliseconds.
    pub max_ms: f64,
}

impl Stops {
    /// The figures of some stops, each in milliseconds; `None` without any.
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

/// How much of the floor was scanned. Shares are 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Coverage {
    /// Share of the reachable floor, as the mission believes.
    pub reachable: f64,
    /// Share of the whole floor (excluding the footprint of obstacles), as the mission believes.
    pub whole: f64,
    /// Share of the scanned floor that was scanned more than once, by the estimated path: the tool came back to it after
    /// more than two swaths of way. Absent if nothing was scanned.
    pub overlap: Option<f64>,
    /// Reachable floor that was not scanned, as the mission believes, square metres; absent for missions that were not to
    /// scan it.
    pub missed_area_m2: Option<f64>,
    /// The same shares by where the robot truly was; absent without the truth.
    pub by_truth: Option<CoverageByTruth>,
}

/// What was scanned by where the robot truly was. Shares are 0 to 1.
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

/// The 95 % error of the position: the longer half axis of the 95 % ellipse of its covariance, over all ticks. It contains
/// neither errors of the survey and of the sound speed nor the offset of the tool.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Accuracy {
    /// Mean, metres.
    pub mean_m: f64,
    /// Not exceeded in 95 % of the ticks, metres.
    pub p95_m: f64,
    /// Largest, metres.
    pub max_m: f64,
    /// Above this nothing counts as scanned, metres.
    pub limit_m: f64,
    /// Share of the way with a larger error, 0 to 1.
    pub over_limit: f64,
    /// Positions from ranges.
    pub fixes: u64,
    /// Stations used for one, on average; absent without any.
    pub stations_mean: Option<f64>,
    /// Stations used for one, at least; absent without any.
    pub stations_min: Option<u64>,
}

/// How closely the true path keeps to the preset path. "Near" is within [`Tracking::NEAR_M`].
///
/// The true path is sampled every 0.05 m of way, so that standing still counts nothing. Each sample is paired with
/// the nearest point of the preset path that lies ahead of the pair before, at most 1 m ahead of it or of the
/// mission's own progress: a robot that loses an arc is not paired with the neighbouring turn of a spiral.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tracking {
    /// Share of the samples that are near to their pair, 0 to 1.
    pub precision: f64,
    /// Share of the preset points that the true path passes near to, at any time, 0 to 1.
    pub recall: f64,
    /// Root mean square distance of the preset points from the piece of true path that was paired with their place,
    /// metres: an arc cut short counts in full. Points never reached are left to `recall`; absent if there are none.
    pub rmse_m: Option<f64>,
    /// Root mean square distance of the samples from their pairs, metres.
    pub cross_track_rmse_m: f64,
}

impl Tracking {
    /// Within this distance counts as on the path, metres (T0 of Wang et al. 2023).
    pub const NEAR_M: f64 = 0.2;
}

/// Distance between the estimated and the true position, over all ticks that have both.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Positioning {
    /// Mean, metres.
    pub mean_error_m: f64,
    /// Median, metres; by nearest rank, as `p95_m`.
    pub p50_m: f64,
    /// Not exceeded in 95 % of the ticks, metres.
    pub p95_m: f64,
    /// Largest, metres.
    pub max_m: f64,
    /// Share of the ticks in which the truth lay in the 95 % ellipse, 0 to 1.
    pub in_95_ellipse: f64,
    /// Time for which the position counted as lost, seconds.
    pub position_lost_s: f64,
}

/// How the tether lay.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tether {
    /// Greatest length out, metres.
    pub tether_length_max_m: f64,
    /// Greatest angle about one obstacle, radians.
    pub wrap_max_rad: f64,
    /// Greatest sum of angles, radians.
    pub wrap_total_max_rad: f64,
    /// Loops at the end.
    pub loops: u64,
    /// Length out at the end, metres.
    pub end_length_m: f64,
    /// Whether it could not be pulled in.
    pub entangled: bool,
    /// How often the mission found that it had snagged on something unseen.
    #[serde(default)]
    pub snags: u64,
    /// Whether it had when the run ended.
    #[serde(default)]
    pub snagged: bool,
}

/// How long planners took to answer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PlannerCalls {
    /// Plans asked for.
    pub plan: u64,
    /// Steps asked for.
    pub step: u64,
    /// Median time of a step, microseconds; absent without steps.
    pub p50_us: Option<f64>,
    /// Not exceeded by 99 % of the steps, microseconds; absent without steps.
    pub p99_us: Option<f64>,
    /// Calls that failed.
    pub faults: u64,
}

/// The files of a run.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Logs {
    /// The journal.
    pub journal: Option<String>,
    /// The recording.
    pub recording: Option<String>,
    /// What went wrong while they were written; absent if they are whole.
    pub error: Option<String>,
    /// Whether somebody is still writing them.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_open: bool,
}
