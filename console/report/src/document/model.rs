//! The model of a report, from which every output format is made.

use super::{
    follow_up::FollowUp,
    indications::Indication,
    maps::Figure,
    readings::Located,
    run_part::RunPart,
    shapes::Shapes,
    signed::{Revision, Signature},
    task::TaskPart,
    thickness::Thickness,
};
use account::{Account, Coverage, Inspection};
use serde::Serialize;

/// A report on one or more runs on one floor.
#[derive(Debug, Serialize)]
pub struct Document {
    /// Version of the report format, `REPORT_VERSION`.
    pub report_version: u32,
    /// The document number: start time and seed of the first run.
    pub number: String,
    /// Letter of the revision.
    pub revision: String,
    /// The signature; absent for a draft.
    pub signature: Option<Signature>,
    /// Earlier signed reports on the same runs.
    pub revisions: Vec<Revision>,
    /// Name and version of the program that made the report.
    pub made_by: String,
    /// Whether the runs were simulated; if so, no floor was inspected.
    pub is_simulation: bool,
    /// The real vehicle that was driven; absent for simulations and located readings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub live: Option<account::VehicleRecord>,
    /// The located readings that the report is about; absent for missions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub located: Option<Located>,
    /// The facts that only people know; a missing fact is `null`.
    pub inspection: Inspection,
    /// How the inspector's facts about the floor contradict the scenario of the run, as a sentence; absent if they
    /// agree.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contradiction: Option<String>,
    /// The coverage of all runs together.
    pub coverage: Coverage,
    /// The account of the floor over all runs; absent if scanning was not the task.
    #[serde(skip_serializing_if = "Account::is_of_no_scan")]
    pub floor: Account,
    /// The runs, in the order given.
    pub runs: Vec<RunPart>,
    /// Indications of the scanning instrument.
    pub indications: Vec<Indication>,
    /// What the readings of the instrument show; absent if it reads no thickness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thickness: Option<Thickness>,
    /// The places that need a test with another method, in order of travel; absent without an instrument.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub follow_ups: Vec<FollowUp>,
    /// The items that must be answered before the report can be signed.
    pub gate: Vec<GateItem>,
    /// The other files of a package of this report: names and SHA-256, hexadecimal. The page states them; empty if they
    /// are not known.
    #[serde(skip)]
    pub packed: Vec<(String, String)>,
    #[serde(skip)]
    pub(crate) pictures: Pictures,
    /// Name of the scenario of the first run.
    pub scenario: String,
    /// Shape and size of the tank.
    pub size: String,
    /// Whether the runs together had to scan the whole floor.
    pub is_whole_floor: bool,
    /// Whether scanning was the task of the runs. If not, no floor counts as missed and there is no account of the
    /// floor.
    pub is_to_scan: bool,
    /// The task and its figures, for a run whose task was not to scan.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub task: Option<TaskPart>,
    #[serde(skip)]
    pub(crate) shapes: Shapes,
}

impl Document {
    /// Whether the scanning instrument was part of the work: it had to scan, gave readings, or the file with indications
    /// is from it.
    pub(super) fn uses_instrument(&self) -> bool {
        self.task.is_none() || self.thickness.is_some() || !self.indications.is_empty()
    }

    /// The open items of the gate; a report can be signed once there are none.
    pub fn open_items(&self) -> impl Iterator<Item = &GateItem> {
        self.gate.iter().filter(|item| !item.is_answered)
    }
}

/// One of the thirteen items.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct GateItem {
    /// Number of the item, from 1.
    pub number: usize,
    /// The requirement of the item.
    pub what: &'static str,
    /// Whether the item is answered.
    pub is_answered: bool,
    /// The answer, or the known part of the answer.
    pub answer: String,
    /// The missing facts, as keys of `[inspection]`, or the actions that are still needed.
    pub missing: Vec<String>,
}

/// The pictures of a report.
#[derive(Debug, Default)]
pub(crate) struct Pictures {
    pub(crate) coverage: Figure,
    /// Numbers of the missed areas that have a badge on the map.
    pub(crate) badges: Vec<usize>,
    pub(crate) accuracy: Figure,
    pub(crate) guaranteed: Figure,
    pub(crate) zone: Figure,
    pub(crate) corrosion: Figure,
    /// Track, tether and incidents of each run.
    pub(crate) runs: Vec<[Option<Figure>; 3]>,
}
