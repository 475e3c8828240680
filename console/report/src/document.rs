//! The report that an inspector signs: one model, written as HTML, JSON, CSV, `GeoJSON` and DXF.

mod certificate;
mod charts;
pub mod csv;
mod decisions;
pub mod dxf;
mod gate;
pub mod geojson;
mod indications;
pub(crate) mod layers;
mod located;
mod maps;
mod marks;
mod page;
mod run_part;
mod sections;
mod shapes;
mod task;

pub use gate::GateItem;
pub use indications::Indication;
pub use located::{Located, Readings, located_json};
pub use maps::Figure;
pub use page::html;
pub use run_part::{Driver, Files, Recovered, RunPart, TetherPart};
pub use task::TaskPart;

use crate::{
    identity::{Stated, contradiction},
    joined::{Joined, PastRun, joined_or_located},
    record::Record,
};
use account::{Account, Coverage, Inspection, REPORT_VERSION};
use indications::{Flown, Ground};
use layers::Layers;
use serde::Serialize;
use shapes::Shapes;
use world::Point;

/// Input for a report in addition to the journals.
#[derive(Debug, Default)]
pub struct Context<'a> {
    /// The facts that only people know.
    pub inspection: Inspection,
    /// Indications as CSV, with the name of their file; `None` if there are none.
    pub indications_csv: Option<(&'a str, &'a str)>,
    /// Version of the program that makes the report.
    pub version: &'a str,
    /// Earlier signed reports on the same runs, oldest first.
    pub revisions: Vec<Revision>,
    /// The name of the signer and the time (UTC); `None` for a draft.
    pub signature: Option<Signature>,
}

/// A report that was signed earlier; it is never changed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, serde::Deserialize)]
pub struct Revision {
    /// The document number.
    #[serde(default)]
    pub number: String,
    /// The letter of the revision.
    pub revision: String,
    /// The signer, and the time of signing.
    #[serde(flatten)]
    pub signature: Signature,
    /// The name of the report file.
    pub file: String,
    /// SHA-256 of the report file, hexadecimal.
    pub sha256: String,
    /// The runs that the report covers.
    #[serde(default)]
    pub runs: Vec<SignedRun>,
}

/// The state of a run when a report on it was signed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, serde::Deserialize)]
pub struct SignedRun {
    /// Name of the run's folder when the run was closed.
    pub run: String,
    /// SHA-256 of its journal, hexadecimal.
    pub journal_sha256: Option<String>,
    /// SHA-256 of its recording, hexadecimal.
    pub recording_sha256: Option<String>,
}

impl SignedRun {
    /// The current state of a run.
    pub fn of(past: &PastRun) -> Self {
        let Files { journal_sha256, recording_sha256, closed_as, .. } = past.files.clone();
        Self { run: closed_as.unwrap_or_else(|| past.name.clone()), journal_sha256, recording_sha256 }
    }

    /// Returns the run under its current folder name, and under the name that the folder had when the run was closed.
    /// Another run may have taken the earlier name since then.
    pub fn names_of(past: &PastRun) -> [Self; 2] {
        let closed = Self::of(past);
        [Self { run: past.name.clone(), ..closed.clone() }, closed]
    }
}

impl Revision {
    /// Checks a run against the signed runs of the same name; returns the first mismatch as a sentence.
    pub fn doubt(&self, now: &SignedRun) -> Option<String> {
        let then = self.runs.iter().find(|then| then.run == now.run && *then != now)?;
        let (file, then, now) = if then.journal_sha256 == now.journal_sha256 {
            ("recording", &then.recording_sha256, &now.recording_sha256)
        } else {
            ("journal", &then.journal_sha256, &now.journal_sha256)
        };
        let digest = |sha256: &Option<String>| sha256.clone().unwrap_or_else(|| "none".into());
        Some(format!(
            "signed revision {} covers a different {file}: expected SHA-256 {}, found {}",
            self.revision,
            digest(then),
            digest(now)
        ))
    }
}

/// The signer, and the time of signing.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, serde::Deserialize)]
pub struct Signature {
    /// Name of the inspector.
    pub by: String,
    /// Time of signing, UTC, as `2026-11-22 04:01`.
    pub at: String,
}

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
    /// The readings that were located; absent for missions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub located: Option<Located>,
    /// The facts that only people know; a missing fact is `null`.
    pub inspection: Inspection,
    /// A sentence on how the inspector's facts about the floor contradict the scenario of the run; absent if they
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
    /// The items that must be answered before the report can be signed.
    pub gate: Vec<GateItem>,
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

/// The pictures of a report.
#[derive(Debug, Default)]
pub(crate) struct Pictures {
    pub(crate) coverage: Figure,
    /// Numbers of the missed areas that have a badge on the map.
    pub(crate) badges: Vec<usize>,
    pub(crate) accuracy: Figure,
    pub(crate) guaranteed: Figure,
    pub(crate) zone: Figure,
    /// Track, tether and incidents of each run.
    pub(crate) runs: Vec<[Option<Figure>; 3]>,
}

impl Pictures {
    /// Draws the pictures. The coverage map and the pictures of individual runs are drawn in a second thread; they
    /// take as long as all the others together.
    fn draw(layers: &Layers<'_>, floor: &Account, indications: &[Indication], past: &[PastRun]) -> Self {
        std::thread::scope(|scope| {
            let more = scope.spawn(|| {
                let runs = past.iter().map(|past| of_run(layers, past)).collect();
                (maps::coverage(layers, indications), runs)
            });
            let others = Self {
                accuracy: maps::accuracy(layers),
                guaranteed: maps::guaranteed(layers, &floor.whole),
                zone: charts::zone(layers.run, floor, &layers.shell()),
                ..Self::default()
            };
            let ((coverage, badges), runs) =
                more.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            Self { coverage, badges, runs, ..others }
        })
    }
}

impl Document {
    /// Builds the report on one or more runs on one floor.
    ///
    /// # Errors
    /// Those of [`crate::merged()`], and faults in the indications.
    pub fn new(past: &[PastRun], context: Context<'_>) -> Result<Self, String> {
        let all = joined_or_located(past)?;
        let located = Located::of(past);
        let Joined { run, scanned, evidence } = &all;
        let known = past.first().and_then(|only| only.summary.floor.as_ref()).filter(|_| past.len() == 1);
        let is_to_scan = past.iter().all(|past| past.fold.has_floor_to_scan());
        let floor = known.cloned().unwrap_or_else(|| all.account(past));
        let tool_is_known = located.as_ref().is_none_or(|located| located.tool_on_s.is_some());
        let floor = match &located {
            Some(_) => located::without_task(floor, tool_is_known),
            None if is_to_scan => floor,
            None => floor.of_no_scan(),
        };
        let places: Vec<Point> = floor.missed.iter().map(|area| area.at).collect();
        let layers = Layers::new(run, scanned, evidence, &places).of_scan(is_to_scan);
        let flown: Vec<Flown<'_>> = past.iter().map(flown).collect();
        let ground = Ground {
            thickness_mm: context.inspection.nominal_thickness_mm,
            nearest_solid: &|at| {
                let (name, off_m) = evidence.nearest_solid(at);
                (name.to_owned(), off_m)
            },
            plate_at: &|at| layers.plate_at(at),
        };
        let place = |file| indications::indications(file, &flown, &ground);
        let indications = context.indications_csv.map(place).transpose()?.unwrap_or_default();
        let contradiction = contradiction(&context.inspection, &Stated::by(run)?.inspection);
        let runs: Vec<RunPart> = past.iter().filter_map(RunPart::of).collect();
        let shapes = Shapes::of(&layers, &floor.missed);
        let mut pictures = Pictures::draw(&layers, &floor, &indications, past);
        if located.is_some() {
            pictures.coverage = located::map(&layers, past, &indications, tool_is_known);
        }
        let mut document = Self {
            report_version: REPORT_VERSION,
            number: number(past),
            revision: letter(context.revisions.len()),
            signature: context.signature,
            revisions: context.revisions,
            made_by: format!("tankops {}", context.version),
            is_simulation: located.is_none() && runs.iter().any(|run| run.positioning.is_some()),
            located,
            inspection: context.inspection,
            contradiction,
            coverage: scanned.coverage(is_to_scan),
            floor,
            runs,
            indications,
            gate: Vec::new(),
            pictures,
            scenario: past[0].fold.run().unwrap_or(run).scenario.clone(),
            size: gate::size(run),
            shapes,
            is_to_scan,
            task: past.last().and_then(TaskPart::of),
            is_whole_floor: evidence.asks_for_everything(),
        };
        document.gate = gate::gate(&document);
        Ok(document)
    }

    /// The open items of the gate; a report can be signed once there are none.
    pub fn open_items(&self) -> impl Iterator<Item = &GateItem> {
        self.gate.iter().filter(|item| !item.is_answered)
    }
}

/// The runs on whose tracks indications can be placed.
fn flown(past: &PastRun) -> Flown<'_> {
    let name = past.files.closed_as.as_deref().unwrap_or(&past.name);
    Flown {
        name: &past.name,
        record: &past.record,
        began: indications::began(name),
        reach_m: past.fold.run().map_or(f64::INFINITY, |run| run.mission.swath_m / 2.0),
    }
}

fn of_run(layers: &Layers<'_>, past: &PastRun) -> [Option<Figure>; 3] {
    let record: &Record = &past.record;
    let marks: Vec<(usize, f64)> = record
        .incidents()
        .iter()
        .enumerate()
        .filter(|(_, incident)| is_marked(incident))
        .map(|(index, incident)| (index + 1, incident.t_s))
        .collect();
    let over_time = past.fold.run().and_then(|run| charts::over_time(run, record, &marks));
    [maps::track(layers, record), maps::tether(layers, record), over_time]
}

/// Whether an incident has a number on the chart.
pub(crate) fn is_marked(incident: &crate::record::Incident) -> bool {
    incident.needs_review() || matches!(incident.kind, "obstacle" | "zone" | "end")
}

/// Builds the document number from the seed of the first run and the start time in its name.
fn number(past: &[PastRun]) -> String {
    let first = past.first();
    let name = first.map(|past| past.files.closed_as.as_ref().unwrap_or(&past.name));
    let began = name.map_or("", |name| name.split('-').next().unwrap_or_default());
    let seed = first.and_then(|past| past.fold.run()).map_or(0, |run| run.seed);
    format!("{began}-{seed}")
}

/// The letter of a revision, from the number of earlier revisions: A, B, ... Z, AA, AB.
fn letter(index: usize) -> String {
    let last = char::from(b'A' + (index % 26) as u8);
    if index < 26 { last.to_string() } else { letter(index / 26 - 1) + &last.to_string() }
}

#[cfg(test)]
mod tests;
