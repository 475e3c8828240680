//! The part of a report on each of its runs.

use super::model::Document;
use crate::{
    human::pre_flight,
    past_run::PastRun,
    record::{Incident, StationRecord},
};
use account::{Accuracy, Positioning, Summary, TakenBack, Tether};
use mission::{
    Outcome,
    event::{PulsePhase, change_text, pulse_text},
};
use positioning::{Integrity, PulseError, PulseTest};
use serde::{Deserialize, Serialize};
use std::fmt;
use world::Station;

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
    /// The pulse tests of the stations.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pulse_tests: Vec<PulseRecord>,
    /// The incidents of the run.
    pub incidents: Vec<Incident>,
    /// The files of the run.
    pub files: Files,
}

/// A pulse test of the stations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PulseRecord {
    /// The result as a sentence.
    pub found: String,
    /// Whether the pulses agree with the survey of the stations.
    pub agrees: bool,
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
            pulse_tests: pulse_records(&record.pulses, &run.world.stations),
            incidents: record.incidents(),
            files: past.files.clone(),
        })
    }
}

/// The pulse tests as sentences, each with the change of the speed of sound since the usable one before it.
fn pulse_records(
    tests: &[(PulsePhase, Result<PulseTest, PulseError>)],
    stations: &[Station],
) -> Vec<PulseRecord> {
    let mut before = None;
    let mut record = |(phase, test): &(PulsePhase, Result<PulseTest, PulseError>)| {
        let test = match test {
            Ok(test) => test,
            Err(why) => {
                let found = format!("pulse test {} failed: {why}", phase.words());
                return PulseRecord { found, agrees: false };
            }
        };
        let mut found = pulse_text(*phase, test, stations);
        if test.is_usable() {
            let change = before.replace(test.clone()).and_then(|before| change_text(&before, test));
            if let Some(change) = change {
                found = format!("{found}; {change}");
            }
        }
        PulseRecord { found, agrees: matches!(test.integrity, Integrity::Ok | Integrity::Suspect) }
    };
    tests.iter().map(&mut record).collect()
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
        friction: tether.friction,
        reel_off_max_m: tether.reel_off_max_m,
        truth: summary.tether,
    })
}

/// The pulse tests of all runs.
pub(super) fn pulse_tests(document: &Document) -> impl Iterator<Item = &PulseRecord> {
    document.runs.iter().flat_map(|run| &run.pulse_tests)
}
