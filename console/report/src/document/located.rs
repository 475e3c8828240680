//! A report on located readings: the track with its errors and, if the readings state when the tool was on, the floor
//! that the tool passed over. Located readings are not a mission: no floor had to be scanned, and none was missed.

mod front;
pub(super) mod gate;
mod map;
mod sections;

pub(super) use front::as_located;
pub(super) use gate::{decisions, equipment, missed, plates, scope, tether, unreachable};
pub(super) use map::map;
pub(super) use sections::sections;

use super::model::Document;
use crate::past_run::PastRun;
use account::{Account, Slivers};
use serde_json::{Value, json};
use world::Point;

/// Minimum distance between two positions in `GeoJSON`, metres.
const POSITIONS_M: f64 = 0.25;

/// The account of the floor for located readings: without missed or unreachable floor.
pub(super) fn without_task(floor: Account, tool_is_known: bool) -> Account {
    let mut critical_zone = floor.critical_zone;
    let mut plates = floor.plates;
    if !tool_is_known {
        critical_zone.arcs.clear();
        critical_zone.plates.clear();
        for plate in &mut plates {
            (plate.error_p95_m, plate.error_max_m) = (None, None);
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
