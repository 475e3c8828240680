//! Cells that lie together, as areas with a place and a reason.

use serde::{Deserialize, Serialize};
use std::fmt;
use world::{Floor, PlateMap, Point, Vector};

/// Areas smaller than this are not listed but only summed, square metres.
const LEAST_M2: f64 = 0.01;

/// Cells that lie together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Area<R> {
    /// A place in it, metres: the cell nearest to its middle.
    pub at: Point,
    /// South west corner of the box around it, metres.
    pub low: Point,
    /// North east corner of the box around it, metres.
    pub high: Point,
    /// Area, square metres.
    pub area_m2: f64,
    /// The plate that it lies on; absent if the layout of the plates is not known.
    pub plate: Option<String>,
    /// Why.
    pub reason: R,
}

/// What is too small to be listed.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Slivers {
    /// How many.
    pub count: usize,
    /// Their area together, square metres.
    pub area_m2: f64,
}

impl<R: fmt::Display> fmt::Display for Area<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { at, area_m2, plate, reason, .. } = self;
        let plate = plate.as_ref().map(|name| format!(", plate {name}")).unwrap_or_default();
        // Rounded before it is written: a coordinate near zero has no sign.
        let [x, y] = [at.x, at.y].map(|m| (10.0 * m).round() / 10.0 + 0.0);
        write!(f, "{area_m2:.2} m² at {x:.1}, {y:.1} m{plate}: {reason}")
    }
}

/// The areas of the cells that have a reason, the largest first, and what is too small to be listed. Cells lie
/// together if they touch, be it at a corner, and have the same reason and plate.
pub(crate) fn areas<R: Copy + PartialEq>(
    floor: &Floor,
    plates: Option<&PlateMap>,
    reason_of: impl Fn(usize) -> Option<R>,
) -> (Vec<Area<R>>, Slivers) {
    let plate_of = |index| plates.and_then(|map| map.plate_of(index));
    let mut reasons: Vec<Option<(R, Option<usize>)>> =
        (0..floor.len()).map(|index| Some((reason_of(index)?, plate_of(index)))).collect();
    let (mut listed, mut slivers) = (Vec::new(), Slivers::default());
    for first in 0..floor.len() {
        let Some(((reason, plate), cells)) = take_together(floor, &mut reasons, first) else { continue };
        let plate = plates.zip(plate).map(|(map, plate)| map.plates[plate].name.clone());
        let area = area_of(floor, plate, reason, &cells);
        if area.area_m2 < LEAST_M2 {
            slivers.count += 1;
            slivers.area_m2 += area.area_m2;
        } else {
            listed.push(area);
        }
    }
    // Equal areas stay in the order of their first cell.
    listed.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2));
    (listed, slivers)
}

/// Takes the cells that lie together with the first one out of the reasons.
fn take_together<R: Copy + PartialEq>(
    floor: &Floor,
    reasons: &mut [Option<R>],
    first: usize,
) -> Option<(R, Vec<usize>)> {
    let reason = reasons[first].take()?;
    let mut queue = vec![first];
    let mut at = 0;
    while let Some(index) = queue.get(at).copied() {
        at += 1;
        let (column, row) = (index % floor.width, index / floor.width);
        for y in row.saturating_sub(1)..=(row + 1).min(floor.height - 1) {
            for x in column.saturating_sub(1)..=(column + 1).min(floor.width - 1) {
                let next = y * floor.width + x;
                if reasons[next].take_if(|other| *other == reason).is_some() {
                    queue.push(next);
                }
            }
        }
    }
    Some((reason, queue))
}

/// Some cells as an area.
pub(crate) fn area_of<R>(floor: &Floor, plate: Option<String>, reason: R, cells: &[usize]) -> Area<R> {
    let centers = || cells.iter().map(|index| floor.center(*index));
    let half = Vector::new(floor.cell_m, floor.cell_m) / 2.0;
    let start = floor.center(cells[0]);
    let (low, high) = centers().fold((start, start), |(low, high), p| (low.inf(&p), high.sup(&p)));
    let middle = Point::from(centers().map(|p| p.coords).sum::<Vector>() / cells.len() as f64);
    let off_m = |index: usize| (floor.center(index) - middle).norm();
    let nearest = cells.iter().copied().min_by(|a, b| off_m(*a).total_cmp(&off_m(*b)));
    let nearest = nearest.unwrap_or(cells[0]);
    Area {
        at: floor.center(nearest),
        low: low - half,
        high: high + half,
        area_m2: cells.len() as f64 * floor.cell_m2(),
        plate,
        reason,
    }
}
