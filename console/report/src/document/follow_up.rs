//! The places that need a test with another method: untestable floor and indications, in order of travel.

use super::{indications::Indication, layers::Layers};
use account::Judge;
use serde::Serialize;
use std::collections::BTreeMap;
use world::{FloorClass, Point};

/// Why floor is on the list.
const NOT_TESTABLE: &str = "not testable by this tool";
const NO_READING: &str = "no reading, though scanned";

/// A place that needs a test with another method, such as a hand-held ultrasonic probe.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FollowUp {
    /// Number in the order of travel, from 1.
    pub number: usize,
    /// Why the place needs a test.
    pub what: String,
    /// The plate; absent if the layout of the plates is not known.
    pub plate: Option<String>,
    /// The place, tank frame, metres; for untestable floor, the cell nearest to its middle.
    pub at: Point,
    /// The untestable floor, square metres; absent for an indication.
    pub area_m2: Option<f64>,
    /// The largest loss that a reading shows, millimetres; absent for untestable floor.
    pub depth_mm: Option<f64>,
}

/// Lists the untestable floor of each plate, the scanned floor of each plate without readings, and every indication. From the start of the mission, each place is the
/// nearest one that is left. Empty without an instrument.
pub(super) fn follow_ups(
    layers: &Layers<'_>,
    judge: Option<&Judge>,
    indications: &[Indication],
) -> Vec<FollowUp> {
    if layers.run.mission.instrument.is_none() {
        return Vec::new();
    }
    let of_indication = |found: &Indication| FollowUp {
        number: 0,
        what: format!("indication I{}", found.number),
        plate: found.plate.clone(),
        at: found.at,
        area_m2: None,
        depth_mm: found.depth_mm,
    };
    let untestable = by_plate(layers, NOT_TESTABLE, |cell| layers.is(cell, FloorClass::Untestable));
    let unread = judge.map(|judge| by_plate(layers, NO_READING, |cell| layers.is_unread(cell, judge)));
    let areas = untestable.into_iter().chain(unread.into_iter().flatten());
    let mut left: Vec<FollowUp> = areas.chain(indications.iter().map(of_indication)).collect();
    let (mut here, mut ordered) = (layers.run.mission.start.position, Vec::with_capacity(left.len()));
    let off_m = |place: &FollowUp, here: Point| (place.at - here).norm();
    while let Some(next) =
        (0..left.len()).min_by(|a, b| off_m(&left[*a], here).total_cmp(&off_m(&left[*b], here)))
    {
        let place = FollowUp { number: ordered.len() + 1, ..left.swap_remove(next) };
        here = place.at;
        ordered.push(place);
    }
    ordered
}

/// The floor of each plate of which a condition is true.
fn by_plate(layers: &Layers<'_>, what: &str, is_in: impl Fn(usize) -> bool) -> Vec<FollowUp> {
    let floor = layers.floor();
    let mut by_plate: BTreeMap<Option<usize>, Vec<usize>> = BTreeMap::new();
    for cell in (0..floor.len()).filter(|cell| is_in(*cell)) {
        by_plate.entry(layers.plate_map().and_then(|map| map.plate_of(cell))).or_default().push(cell);
    }
    let place = |(_, cells): (Option<usize>, Vec<usize>)| {
        let sum = cells.iter().fold(world::Vector::zeros(), |sum, cell| sum + floor.center(*cell).coords);
        let middle = Point::from(sum / cells.len() as f64);
        let off_m = |cell: &usize| (floor.center(*cell) - middle).norm();
        let at = floor.center(cells.iter().copied().min_by(|a, b| off_m(a).total_cmp(&off_m(b)))?);
        Some(FollowUp {
            number: 0,
            what: what.to_owned(),
            plate: layers.plate_at(at),
            at,
            area_m2: Some(cells.len() as f64 * floor.cell_m2()),
            depth_mm: None,
        })
    };
    by_plate.into_iter().filter_map(place).collect()
}
