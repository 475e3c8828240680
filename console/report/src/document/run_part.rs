//! What a report says of each of its runs.

use crate::{
    human::pre_flight,
    joined::PastRun,
    record::{Incident, StationRecord},
};
use account::{Accuracy, Positioning, Summary, Tether};
use mission::Outcome;
use serde::{Deserialize, Serialize};
use std::fmt;

/// How a run was closed whose writer was killed: what was there was fixed by digests.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Recovered {
    /// Who did it.
    pub by: String,
    /// When, UTC, as `2026-11-22 04:01`.
    pub at: String,
    /// What is missing, each as a phrase.
    pub missing: Vec<String>,
}

impl fmt::Display for Recovered {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "by {}, {} UTC; missing: {}", self.by, self.at, self.missing.join("; "))
    }
}

/// The files of a run and their digests.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct Files {
    /// SHA-256 of the journal, hexadecimal.
    pub journal_sha256: Option<String>,
    /// Its length, bytes.
    pub journal_bytes: Option<u64>,
    /// SHA-256 of the recording, hexadecimal.
    pub recording_sha256: Option<String>,
    /// Its length, bytes.
    pub recording_bytes: Option<u64>,
    /// SHA-256 of the scenario in the journal, hexadecimal.
    pub scenario_sha256: Option<String>,
    /// Whether the digests are those in the report that was written when the run ended; absent if there is none.
    pub are_as_reported: Option<bool>,
    /// What speaks against them.
    pub doubts: Vec<String>,
    /// Name of the run's folder when the run was closed; absent if nothing says it.
    pub closed_as: Option<String>,
    /// How the run was closed if its writer was killed; absent for a run that was closed at its end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recovered: Option<Recovered>,
}

/// A planner that drove.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Driver {
    /// Its name, version and interface.
    pub name: String,
    /// SHA-256 of its plugin, hexadecimal.
    pub sha256: String,
}

/// How the tether lay by the estimated position.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TetherPart {
    /// Most of it out, metres, and when, seconds.
    pub length_max_m: f64,
    /// When most of it was out, seconds.
    pub length_max_at_s: f64,
    /// Length of the reel, metres.
    pub reel_length_m: f64,
    /// Largest wrap on one obstacle, radians.
    pub wrap_max_rad: f64,
    /// Largest wrap allowed, radians.
    pub wrap_limit_rad: f64,
    /// Largest sum of all wraps, radians.
    pub wrap_total_max_rad: f64,
    /// When the sum was largest, seconds.
    pub wrap_total_max_at_s: f64,
    /// Largest sum allowed, radians.
    pub wrap_total_limit_rad: f64,
    /// Out at the end, metres.
    pub end_length_m: f64,
    /// Largest factor by which wraps multiplied the pull.
    pub pull_factor_max: f64,
    /// Friction of tether on steel that this assumes.
    pub friction: f64,
    /// Largest difference between reel and map, metres; absent without an encoder.
    pub reel_off_max_m: Option<f64>,
    /// The same by the true position; absent outside simulation.
    pub truth: Option<Tether>,
}

/// One of the runs of a report.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunPart {
    /// Name of its folder.
    pub run: String,
    /// When it began, UTC, as `2026-11-22 04:01`; absent if the name of its folder does not say.
    pub began: Option<String>,
    /// Version of the program that flew it.
    pub tankops_version: String,
    /// Version of its journal.
    pub journal_version: u32,
    /// Name of its scenario.
    pub scenario: String,
    /// Seed of every random choice.
    pub seed: u64,
    /// How it ended; absent if it was cut off.
    pub outcome: Option<Outcome>,
    /// Why, as a sentence.
    pub reason: Option<String>,
    /// What was checked before the start: how much passed, and every warning; absent for a run without an operator.
    pub pre_flight: Option<String>,
    /// Mission time, seconds.
    pub mission_time_s: f64,
    /// Way by the true position, metres.
    pub path_length_m: Option<f64>,
    /// Least distance of the hull to anything solid, metres; absent outside simulation.
    pub clearance_min_m: Option<f64>,
    /// The clearance to be kept, metres.
    pub clearance_m: f64,
    /// Collisions; absent outside simulation.
    pub collisions: Option<u64>,
    /// Parameters of the planner that drove first.
    pub parameters: Vec<String>,
    /// The planners that drove.
    pub drivers: Vec<Driver>,
    /// How good the position was by its covariance.
    pub accuracy: Option<Accuracy>,
    /// How good it was by the truth.
    pub positioning: Option<Positioning>,
    /// How the tether lay.
    pub tether: Option<TetherPart>,
    /// What the fixes say of each station.
    pub stations: Vec<StationRecord>,
    /// What happened.
    pub incidents: Vec<Incident>,
    /// Its files.
    pub files: Files,
}

impl RunPart {
    pub(super) fn of(past: &PastRun) -> Option<Self> {
        let run = past.fold.run()?;
        let summary = &past.summary;
        let record = &past.record;
        let driver = |info: &mission::PlannerInfo| Driver {
            name: format!("{} {}, plugin {}, interface {}", info.name, info.version, info.plugin, info.abi),
            sha256: info.sha256.clone(),
        };
        let parameters = summary.parameters.iter().flatten();
        // Where something was located, and nothing of what moved it.
        let is_flown = run.measured.is_none();
        Some(Self {
            run: past.name.clone(),
            began: past.began.clone(),
            tankops_version: run.tankops_version.clone(),
            journal_version: run.journal_version,
            scenario: run.scenario.clone(),
            seed: run.seed,
            outcome: summary.outcome,
            reason: summary.reason.clone(),
            pre_flight: pre_flight(&summary.checks),
            mission_time_s: summary.mission_time_s.unwrap_or(0.0),
            path_length_m: summary.path_length_m,
            clearance_min_m: summary.clearance_min_m.filter(|_| is_flown),
            clearance_m: run.mission.clearance_m,
            collisions: summary.collisions,
            parameters: parameters.map(|(key, value)| format!("{key} {}", plainly(value))).collect(),
            drivers: record.planners.iter().map(driver).collect(),
            accuracy: summary.accuracy,
            positioning: summary.positioning,
            tether: tether(past, summary),
            stations: record.stations(),
            incidents: record.incidents(),
            files: past.files.clone(),
        })
    }
}

fn plainly(value: &mission::ParamValue) -> String {
    match value {
        mission::ParamValue::Float(number) => number.to_string(),
        mission::ParamValue::Int(number) => number.to_string(),
        mission::ParamValue::Flag(flag) => flag.to_string(),
        mission::ParamValue::Word(word) => word.clone(),
    }
}

fn tether(past: &PastRun, summary: &Summary) -> Option<TetherPart> {
    let tether = past.record.tether.as_ref()?;
    let last = tether.points.last()?;
    let (longest, wrapped) = (tether.longest.point, tether.most_wrapped.point);
    Some(TetherPart {
        length_max_m: f64::from(longest.length_m),
        length_max_at_s: f64::from(longest.t_s),
        reel_length_m: tether.limits.reel_length_m,
        wrap_max_rad: tether.wrap_max_rad,
        wrap_limit_rad: tether.limits.wrap_max_rad,
        wrap_total_max_rad: f64::from(wrapped.wrap_total_rad),
        wrap_total_max_at_s: f64::from(wrapped.t_s),
        wrap_total_limit_rad: tether.limits.wrap_total_max_rad,
        end_length_m: f64::from(last.length_m),
        pull_factor_max: tether.pull_factor_max,
        friction: tether.friction,
        reel_off_max_m: tether.reel_off_max_m,
        truth: summary.tether,
    })
}
