//! Builds a report from past runs.

use super::{
    charts, follow_up, gate,
    indications::{self, Flown, Ground, Indication},
    layers::Layers,
    located, maps,
    model::{Document, Pictures},
    readings::Located,
    run_part::RunPart,
    shapes::Shapes,
    signed::{Revision, Signature},
    survey,
    task::TaskPart,
    thickness,
};
use crate::{
    identity::{Stated, contradiction},
    joined::{Joined, joined_or_located},
    past_run::PastRun,
    record::Record,
};
use account::{Account, Inspection, REPORT_VERSION};
use maps::Figure;
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
    /// The name of the signer and the time of signing (UTC); `None` for a draft.
    pub signature: Option<Signature>,
}

impl Pictures {
    /// Draws the pictures. The coverage map and the pictures of individual runs are drawn in a second thread; they take
    /// as long as all other pictures together.
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
        let mut indications = context.indications_csv.map(place).transpose()?.unwrap_or_default();
        let (read, judge) = thickness::thickness(past, &layers).unzip();
        if let Some(read) = &read {
            let first = indications.len() + 1;
            indications.extend(thickness::indications(read, past, &layers, first));
        }
        let sampled_mm = run.mission.instrument.as_ref().and_then(|of| Some(of.sampling?.thickness_mm));
        let contradiction = contradiction(&context.inspection, &Stated::by(run)?.inspection, sampled_mm);
        let runs: Vec<RunPart> = past.iter().filter_map(RunPart::of).collect();
        let shapes = Shapes::of(&layers, &floor.missed);
        let mut pictures = Pictures::draw(&layers, &floor, &indications, past);
        if located.is_some() {
            pictures.coverage = located::map(&layers, past, &indications, tool_is_known);
        }
        let task = past.last().and_then(TaskPart::of);
        if let Some(TaskPart::Survey { map: Some(part) }) = &task {
            let map = past.last().and_then(|past| past.fold.map());
            pictures.coverage =
                map.and_then(|map| survey::picture(&layers, map, part)).unwrap_or(pictures.coverage);
        }
        if let Some((judge, read)) = judge.as_ref().zip(read.as_ref()) {
            pictures.corrosion = thickness::map(&layers, judge, read);
        }
        let mut document = Self {
            report_version: REPORT_VERSION,
            number: number(past),
            revision: letter(context.revisions.len()),
            signature: context.signature,
            revisions: context.revisions,
            made_by: format!("tankops {}", context.version),
            is_simulation: located.is_none() && runs.iter().any(|run| run.positioning.is_some()),
            live: past.iter().find_map(|past| past.summary.vehicle.clone()),
            located,
            inspection: context.inspection,
            contradiction,
            coverage: scanned.coverage(is_to_scan),
            floor,
            runs,
            follow_ups: follow_up::follow_ups(&layers, judge.as_ref(), &indications),
            indications,
            thickness: read,
            gate: Vec::new(),
            packed: Vec::new(),
            pictures,
            scenario: past[0].fold.run().unwrap_or(run).scenario.clone(),
            size: gate::size(run),
            shapes,
            is_to_scan,
            task,
            is_whole_floor: evidence.asks_for_everything(),
        };
        document.gate = gate::gate(&document);
        Ok(document)
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
        .filter(|(_, incident)| charts::is_marked(incident))
        .map(|(index, incident)| (index + 1, incident.t_s))
        .collect();
    let over_time = past.fold.run().and_then(|run| charts::over_time(run, record, &marks));
    [maps::track(layers, record), maps::tether(layers, record), over_time]
}

/// Builds the document number from the start time in the name of the first run and from the seed of that run.
fn number(past: &[PastRun]) -> String {
    let first = past.first();
    let name = first.map(|past| past.files.closed_as.as_ref().unwrap_or(&past.name));
    let began = name.map_or("", |name| name.split('-').next().unwrap_or_default());
    let seed = first.and_then(|past| past.fold.run()).map_or(0, |run| run.seed);
    format!("{began}-{seed}")
}

/// The letter of a revision, from the number of earlier revisions: A, B, ... Z, AA, AB.
pub(super) fn letter(index: usize) -> String {
    let last = char::from(b'A' + (index % 26) as u8);
    if index < 26 { last.to_string() } else { letter(index / 26 - 1) + &last.to_string() }
}
