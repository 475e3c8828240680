//! A report on located readings: the track with its errors and, if the readings state when the tool was on, the floor
//! that the tool passed over. Located readings are not a mission: no floor had to be scanned, and none was missed.

mod front;
mod gate;
mod map;
mod sections;

pub(super) use front::as_located;
pub(super) use gate::{accuracy_how, decisions, equipment, missed, plates, scope, tether, unreachable};
pub(super) use map::map;
pub(super) use sections::sections;

use super::Document;
use crate::joined::PastRun;
use account::{Account, Slivers};
use serde::Serialize;
use serde_json::{Value, json};
use world::Point;

/// Minimum distance between two positions in `GeoJSON`, metres.
const POSITIONS_M: f64 = 0.25;

/// The readings file of a run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Readings {
    /// Name of the run's folder.
    pub run: String,
    /// Name of the readings file.
    pub file: String,
    /// SHA-256 of that file, hexadecimal.
    pub sha256: String,
}

/// The located readings that replace the mission in a report.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Located {
    /// The readings of each run.
    pub readings: Vec<Readings>,
    /// Time from the first reading to the last, seconds, summed over all runs.
    pub time_s: f64,
    /// Time for which the tool was on, seconds, summed over all runs. Absent if the readings of any run do not
    /// contain it; then no coverage is stated.
    pub tool_on_s: Option<f64>,
    /// Number of estimated positions.
    pub positions: usize,
}

impl Located {
    /// The located readings of some runs; `None` if the runs were missions.
    pub(super) fn of(past: &[PastRun]) -> Option<Self> {
        let measured = |past: &PastRun| past.fold.run()?.measured.clone();
        let all: Vec<_> = past.iter().map(measured).collect::<Option<_>>()?;
        let of_run = |(past, measured): (&PastRun, &mission::event::Measured)| Readings {
            run: past.name.clone(),
            file: measured.file.clone(),
            sha256: measured.sha256.clone(),
        };
        Some(Self {
            readings: past.iter().zip(&all).map(of_run).collect(),
            time_s: past.iter().filter_map(|past| past.summary.mission_time_s).sum(),
            tool_on_s: all.iter().map(mission::event::Measured::on_for_s).sum(),
            positions: past.iter().map(|past| past.record.track.len()).sum(),
        })
    }

    /// The names of the readings files, for people.
    pub(super) fn files(&self) -> String {
        self.readings.iter().map(|readings| readings.file.as_str()).collect::<Vec<_>>().join(", ")
    }
}

/// The account of the floor for located readings: without missed or unreachable floor.
pub(super) fn without_task(floor: Account, tool_is_known: bool) -> Account {
    let mut critical_zone = floor.critical_zone;
    let mut plates = floor.plates;
    if !tool_is_known {
        critical_zone.arcs.clear();
        critical_zone.plates.clear();
        for plate in &mut plates {
            plate.error_p95_m = None;
        }
    }
    Account {
        critical_zone,
        plates,
        exact: None,
        missed: Vec::new(),
        slivers: Slivers::default(),
        unreachable: Vec::new(),
        unreachable_slivers: Slivers::default(),
        ..floor
    }
}

/// A report on located readings as JSON, without the fields that only a mission has. A value that the readings do not
/// contain is `null`, never zero.
///
/// # Errors
/// A number that JSON cannot represent.
pub fn located_json(document: &Document) -> serde_json::Result<Value> {
    let mut all = serde_json::to_value(document)?;
    let is_known = document.located.as_ref().is_some_and(|located| located.tool_on_s.is_some());
    let floor = &document.floor;
    all["floor"] = json!({
        "cell_m": floor.cell_m,
        "swath_m": floor.swath_m,
        "position_limit_m": floor.position_limit_m,
        "critical_zone": if is_known { serde_json::to_value(&floor.critical_zone)? } else { Value::Null },
        "whole": passed(&floor.whole, is_known),
        "plates": floor.plates.iter().map(|plate| {
            let mut row = passed(&plate.shares, is_known);
            row["name"] = json!(plate.name);
            row["kind"] = json!(plate.kind);
            row["error_p95_m"] = json!(plate.error_p95_m);
            row
        }).collect::<Vec<_>>(),
    });
    all["coverage"] = if is_known {
        json!({ "whole": document.coverage.whole, "overlap": document.coverage.overlap })
    } else {
        Value::Null
    };
    if let Some(object) = all.as_object_mut() {
        object.remove("is_whole_floor");
    }
    for run in all["runs"].as_array_mut().into_iter().flatten().filter_map(Value::as_object_mut) {
        for of_mission in [
            "seed",
            "parameters",
            "drivers",
            "pre_flight",
            "clearance_m",
            "clearance_min_m",
            "collisions",
            "tether",
        ] {
            run.remove(of_mission);
        }
    }
    Ok(all)
}

/// How much of a floor the tool passed over.
fn passed(shares: &account::Shares, is_known: bool) -> Value {
    json!({
        "area_m2": shares.area_m2,
        "scanned": is_known.then_some(shares.scanned),
        "guaranteed": shares.guaranteed.filter(|_| is_known),
        "scanned_percent": is_known.then_some(shares.percent.scanned),
        "guaranteed_percent": shares.percent.guaranteed.filter(|_| is_known),
    })
}

/// The located positions with their 95 % error: position, run, time, error; thinned to a minimum distance.
pub(super) fn positions(past: &[PastRun]) -> impl Iterator<Item = (Point, Value)> {
    past.iter().flat_map(|past| {
        let mut last: Option<Point> = None;
        past.record.track.iter().filter_map(move |point| {
            let here = point.position();
            if last.is_some_and(|last| (here - last).norm() < POSITIONS_M) {
                return None;
            }
            last = Some(here);
            let thousandths = |value: f32| (1000.0 * f64::from(value)).round() / 1000.0;
            let properties = json!({
                "layer": "positions", "run": past.name, "t_s": thousandths(point.t_s), "error_95_m": thousandths(point.error_m),
            });
            Some((here, properties))
        })
    })
}
