//! The part of a report on each of its runs.

use super::model::Document;
use crate::{
    guarantee::Rule,
    human::pre_flight,
    past_run::PastRun,
    record::{Incident, StationRecord},
};
use account::{Accuracy, Calibration, Positioning, PulseRecord, Summary, TakenBack, Tether, not_as_surveyed};
use mission::Outcome;
use serde::{Deserialize, Serialize};
use std::fmt;
use world::tether::OwnGap;

/// The recovery of a run that its recording process did not close. The digests in the report identify the files of the run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Recovered {
    /// The person who recovered the run.
    pub by: String,
    /// Time of the recovery, UTC, as `2026-11-22 04:01`.
    pub at: String,
    /// The missing parts, each as a phrase.
    pub missing: Vec<String>,
}

impl fmt::Display for Recovered {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "by {}, {} UTC; ", self.by, self.at)?;
        if self.missing.is_empty() {
            return f.write_str("nothing is missing");
        }
        write!(f, "missing: {}", self.missing.join("; "))
    }
}

/// The files of a run and their digests.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct Files {
    /// SHA-256 of the journal, hexadecimal.
    pub journal_sha256: Option<String>,
    /// Length of the journal, bytes.
    pub journal_bytes: Option<u64>,
    /// SHA-256 of the recording, hexadecimal.
    pub recording_sha256: Option<String>,
    /// SHA-256 of the file with the readings, hexadecimal; absent without such a file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub readings_sha256: Option<String>,
    /// Length of the recording, bytes.
    pub recording_bytes: Option<u64>,
    /// SHA-256 of the scenario in the journal, hexadecimal.
    pub scenario_sha256: Option<String>,
    /// Whether the digests match those in the report that was written when the run ended; absent if there is no such
    /// report.
    pub are_as_reported: Option<bool>,
    /// The problems found with the files.
    pub doubts: Vec<String>,
    /// Name of the run's folder when the run was closed; absent if it is not recorded.
    pub closed_as: Option<String>,
    /// The recovery of a killed run; absent for a run that was closed at its end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recovered: Option<Recovered>,
}

/// A planner that was active.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Driver {
    /// Name, version and interface of the planner.
    pub name: String,
    /// SHA-256 of the planner's plugin, hexadecimal.
    pub sha256: String,
}

/// The tether according to the estimated position.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TetherPart {
    /// Greatest length paid out, metres.
    pub length_max_m: f64,
    /// Mission time at which the greatest length was paid out, seconds.
    pub length_max_at_s: f64,
    /// Length of the reel, metres.
    pub reel_length_m: f64,
    /// Largest wrap on one obstacle, radians.
    pub wrap_max_rad: f64,
    /// Largest wrap allowed, radians.
    pub wrap_limit_rad: f64,
    /// Largest total wrap, radians.
    pub wrap_total_max_rad: f64,
    /// Mission time at which the total wrap was largest, seconds.
    pub wrap_total_max_at_s: f64,
    /// Largest total wrap allowed, radians.
    pub wrap_total_limit_rad: f64,
    /// Length paid out at the end, metres.
    pub end_length_m: f64,
    /// Largest factor by which the wraps multiplied the pull.
    pub pull_factor_max: f64,
    /// Pull that reeling in needed; absent if the scenario does not describe the reel, so the pull was not checked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pull: Option<PullPart>,
    /// How near the last certified plan leads the hull to its own taut tether on the way in; absent if that was not computed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub own_gap: Option<OwnGap>,
    /// Assumed coefficient of friction between tether and steel.
    pub friction: f64,
    /// Largest difference between the length at the reel and the length according to the map, metres; absent without
    /// an encoder.
    pub reel_off_max_m: Option<f64>,
    /// The tether record according to the true position; absent outside simulation.
    pub truth: Option<Tether>,
}

/// The pull that reeling in needed, computed from the taut tether.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PullPart {
    /// Largest pull, newtons.
    pub max_n: f64,
    /// Mission time of the largest pull, seconds.
    pub max_at_s: f64,
    /// Pull of the reel, newtons.
    pub reel_n: f64,
}

/// One of the runs of a report.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunPart {
    /// Name of the run's folder.
    pub run: String,
    /// Start time, UTC, as `2026-11-22 04:01`; absent if the folder name does not contain it.
    pub began: Option<String>,
    /// Version of the program that carried out the run.
    pub tankops_version: String,
    /// Version of the run's journal.
    pub journal_version: u32,
    /// Name of the run's scenario.
    pub scenario: String,
    /// Seed for all random numbers.
    pub seed: u64,
    /// How the run ended; absent if the journal was cut off.
    pub outcome: Option<Outcome>,
    /// The reason why the run ended, as a sentence.
    pub reason: Option<String>,
    /// The checks before the start: the number passed, and every warning; absent for a run without an operator.
    pub pre_flight: Option<String>,
    /// Mission time, seconds.
    pub mission_time_s: f64,
    /// Length of the true path, metres.
    pub path_length_m: Option<f64>,
    /// Minimum distance of the hull from any solid object, metres; absent outside simulation.
    pub clearance_min_m: Option<f64>,
    /// The required clearance, metres.
    pub clearance_m: f64,
    /// Collisions; absent outside simulation.
    pub collisions: Option<u64>,
    /// Parameters of the first active planner.
    pub parameters: Vec<String>,
    /// The planners that were active.
    pub drivers: Vec<Driver>,
    /// Accuracy of the position according to its covariance.
    pub accuracy: Option<Accuracy>,
    /// Accuracy of the position compared with the true position.
    pub positioning: Option<Positioning>,
    /// Floor whose guarantee was taken back, because a station was found wrong.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub taken_back: Vec<TakenBack>,
    /// The tether record.
    pub tether: Option<TetherPart>,
    /// The fixes, station by station.
    pub stations: Vec<StationRecord>,
    /// The speed of sound and the wrong stations that the session calibration found; absent without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibration: Option<Calibration>,
    /// The pulse tests of the stations.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pulse_tests: Vec<PulseRecord>,
    /// The incidents of the run.
    pub incidents: Vec<Incident>,
    /// The files of the run.
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
        // A located run has only a position, and no data on the vehicle.
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
            taken_back: summary.taken_back.clone(),
            tether: tether(past, summary),
            stations: record.stations(),
            calibration: summary.calibration.clone(),
            pulse_tests: summary.pulse_tests.clone(),
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
        pull: tether.most_pulled.zip(tether.reel_pull_n).map(|(most, reel_n)| PullPart {
            max_n: f64::from(most.pull_n),
            max_at_s: f64::from(most.t_s),
            reel_n,
        }),
        own_gap: tether.own_gap,
        friction: tether.friction,
        reel_off_max_m: tether.reel_off_max_m,
        truth: summary.tether,
    })
}

/// The rule by which the runs guarantee floor.
pub(super) fn rule(document: &Document) -> Rule {
    Rule::of(document.runs.iter().map(|run| run.accuracy.as_ref()))
}

/// The errors of the ranges that the session calibration of each run found, as sentences with full stops.
pub(super) fn calibrations(document: &Document) -> impl Iterator<Item = String> {
    document.runs.iter().filter_map(|run| {
        let sentences = run.calibration.as_ref()?.sentences().join("; ");
        let of = if document.runs.len() > 1 { format!(" of {}", run.run) } else { String::new() };
        Some(format!("Session calibration{of}: {sentences}."))
    })
}

/// Whether every run measured the speed of sound: by a session calibration, or by pulses that agree with the survey.
pub(super) fn is_sound_known(document: &Document) -> bool {
    let is_known = |run: &RunPart| {
        let by_session = run.calibration.as_ref().is_some_and(|calibration| calibration.first.is_some());
        by_session || run.pulse_tests.iter().any(|test| test.agrees)
    };
    !document.runs.is_empty() && document.runs.iter().all(is_known)
}

/// Whether the stations of every run sent pulses that agree with the survey.
pub(super) fn is_pulse_tested(document: &Document) -> bool {
    let is_tested =
        |run: &RunPart| !run.pulse_tests.is_empty() && run.pulse_tests.iter().all(|test| test.agrees);
    !document.runs.is_empty() && document.runs.iter().all(is_tested)
}

/// For each run whose stations were known not to be as surveyed: when, as a sentence.
pub(super) fn survey_warnings(document: &Document) -> impl Iterator<Item = String> {
    document.runs.iter().filter_map(|run| {
        let warning = not_as_surveyed(&run.pulse_tests)?;
        let of = if document.runs.len() > 1 { format!("run {}: ", run.run) } else { String::new() };
        Some(format!("Warning: {of}{warning}."))
    })
}

/// The pulse tests of all runs.
pub(super) fn pulse_tests(document: &Document) -> impl Iterator<Item = &PulseRecord> {
    document.runs.iter().flat_map(|run| &run.pulse_tests)
}
