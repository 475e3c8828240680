//! Cells that lie together, as areas with a place and causes.

use super::measure::Measure;
use serde::{Deserialize, Serialize};
use std::{collections::BTreeMap, fmt};
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
    /// The plate on which most of it lies; absent if the layout of the plates is not known.
    pub plate: Option<String>,
    /// Every plate on which it lies, the one with most of it first.
    #[serde(default)]
    pub plates: Vec<String>,
    /// The reason for most of it.
    pub reason: R,
    /// Why, cause by cause, the one for most of it first.
    #[serde(default = "Vec::new")]
    pub causes: Vec<Cause<R>>,
}

/// Why some part of an area was not scanned.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cause<R> {
    /// The reason.
    pub reason: R,
    /// How much of the area it holds for, square metres.
    pub area_m2: f64,
    /// The number behind it; absent where there is none.
    pub measure: Option<Measure>,
    /// The same as a sentence.
    pub text: String,
}

/// What is too small to be listed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Slivers<R> {
    /// How many.
    pub count: usize,
    /// Their area together, square metres.
    pub area_m2: f64,
    /// Why, cause by cause, the one for most of it first.
    #[serde(default = "Vec::new")]
    pub causes: Vec<Cause<R>>,
}

impl<R> Default for Slivers<R> {
    fn default() -> Self {
        Self { count: 0, area_m2: 0.0, causes: Vec::new() }
    }
}

impl<R> Slivers<R> {
    /// Why, as one sentence; several causes carry their areas.
    pub fn why(&self) -> String {
        why(&self.causes)
    }
}

fn why<R>(causes: &[Cause<R>]) -> String {
    match causes {
        [only] => only.text.clone(),
        several => {
            let part = |cause: &Cause<R>| format!("{} ({:.3} m²)", cause.text, cause.area_m2);
            several.iter().map(part).collect::<Vec<_>>().join("; ")
        }
    }
}

/// A reason that can be said with a number.
pub trait Explained: Copy + Ord {
    /// The reason as a sentence.
    fn sentence(self, measure: Option<&Measure>) -> String;
}

impl<R> Area<R> {
    /// Why, as one sentence; parts of areas with several causes carry their areas.
    pub fn why(&self) -> String {
        why(&self.causes)
    }
}

impl<R> fmt::Display for Area<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { at, area_m2, plate, .. } = self;
        let plate = plate.as_ref().map(|name| format!(", plate {name}")).unwrap_or_default();
        // Rounded before it is written: a coordinate near zero has no sign.
        let [x, y] = [at.x, at.y].map(|m| (10.0 * m).round() / 10.0 + 0.0);
        // So fine that an area does not look as large as the limit below which it is.
        let decimals = if *area_m2 < 0.1 { 3 } else { 2 };
        write!(f, "{area_m2:.decimals$} m² at {x:.1}, {y:.1} m{plate}: {}", self.why())
    }
}

/// The areas of the cells that have a reason, the largest first, and what is too small to be listed. Cells lie
/// together if they touch, be it at a corner, whatever their plates and reasons.
pub fn areas<R: Explained>(
    floor: &Floor,
    plates: Option<&PlateMap>,
    reason_of: impl Fn(usize) -> Option<R>,
    measure: impl Fn(R, &[usize]) -> Option<Measure>,
) -> (Vec<Area<R>>, Slivers<R>) {
    let reasons: Vec<Option<R>> = (0..floor.len()).map(reason_of).collect();
    let reason = |cell: usize| reasons[cell].expect("only cells with a reason lie together");
    let (mut listed, mut slivers, mut specks) = (Vec::new(), Slivers::default(), Vec::new());
    for cells in together(floor, (0..floor.len()).filter(|cell| reasons[*cell].is_some())) {
        let area_m2 = cells.len() as f64 * floor.cell_m2();
        if area_m2 < LEAST_M2 {
            slivers.count += 1;
            slivers.area_m2 += area_m2;
            specks.extend(cells);
        } else {
            listed.push(area_of(floor, plates, &cells, reason, &measure));
        }
    }
    // Equal areas stay in the order of their first cell.
    listed.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2));
    slivers.causes = causes(floor, &specks, reason, &measure);
    (listed, slivers)
}

/// Some cells, in order of their index, in groups of those that touch, be it at a corner; in the order of their first cells.
pub fn together(floor: &Floor, cells: impl IntoIterator<Item = usize>) -> Vec<Vec<usize>> {
    let all: Vec<usize> = cells.into_iter().collect();
    let mut is_open = vec![false; floor.len()];
    for cell in &all {
        is_open[*cell] = true;
    }
    let mut groups = Vec::new();
    for first in all {
        if !std::mem::take(&mut is_open[first]) {
            continue;
        }
        let mut cells = vec![first];
        let mut at = 0;
        while let Some(cell) = cells.get(at).copied() {
            at += 1;
            cells.extend(around(floor, cell).filter(|next| std::mem::take(&mut is_open[*next])));
        }
        groups.push(cells);
    }
    groups
}

/// The cells that touch a cell, and itself.
pub(crate) fn around(floor: &Floor, cell: usize) -> impl Iterator<Item = usize> + use<> {
    let (column, row, width) = (cell % floor.width, cell / floor.width, floor.width);
    let columns = column.saturating_sub(1)..=(column + 1).min(width - 1);
    (row.saturating_sub(1)..=(row + 1).min(floor.height - 1))
        .flat_map(move |y| columns.clone().map(move |x| y * width + x))
}

/// Some cells as an area.
pub fn area_of<R: Explained>(
    floor: &Floor,
    plates: Option<&PlateMap>,
    cells: &[usize],
    reason_of: impl Fn(usize) -> R,
    measure: impl Fn(R, &[usize]) -> Option<Measure>,
) -> Area<R> {
    let centers = || cells.iter().map(|index| floor.center(*index));
    let half = Vector::new(floor.cell_m, floor.cell_m) / 2.0;
    let start = floor.center(cells[0]);
    let (low, high) = centers().fold((start, start), |(low, high), p| (low.inf(&p), high.sup(&p)));
    let middle = Point::from(centers().map(|p| p.coords).sum::<Vector>() / cells.len() as f64);
    let off_m = |index: usize| (floor.center(index) - middle).norm();
    let nearest = cells.iter().copied().min_by(|a, b| off_m(*a).total_cmp(&off_m(*b)));
    let causes = causes(floor, cells, reason_of, measure);
    let on = plates.map_or_else(Vec::new, |map| {
        let by_plate = by_size(cells, |cell| map.plate_of(cell));
        by_plate.into_iter().filter_map(|(plate, _)| Some(map.plates[plate?].name.clone())).collect()
    });
    Area {
        at: floor.center(nearest.unwrap_or(cells[0])),
        low: low - half,
        high: high + half,
        area_m2: cells.len() as f64 * floor.cell_m2(),
        plate: on.first().cloned(),
        plates: on,
        reason: causes[0].reason,
        causes,
    }
}

/// Why some cells were not scanned, cause by cause.
fn causes<R: Explained>(
    floor: &Floor,
    cells: &[usize],
    reason_of: impl Fn(usize) -> R,
    measure: impl Fn(R, &[usize]) -> Option<Measure>,
) -> Vec<Cause<R>> {
    let cause = |(reason, cells): (R, Vec<usize>)| {
        let measure = measure(reason, &cells);
        let text = reason.sentence(measure.as_ref());
        Cause { reason, area_m2: cells.len() as f64 * floor.cell_m2(), measure, text }
    };
    by_size(cells, reason_of).into_iter().map(cause).collect()
}

/// Cells by some key, the key of most cells first; of equal ones the first in their order.
fn by_size<K: Copy + Ord>(cells: &[usize], key_of: impl Fn(usize) -> K) -> Vec<(K, Vec<usize>)> {
    let mut groups: BTreeMap<K, Vec<usize>> = BTreeMap::new();
    for cell in cells {
        groups.entry(key_of(*cell)).or_default().push(*cell);
    }
    let mut groups: Vec<(K, Vec<usize>)> = groups.into_iter().collect();
    groups.sort_by_key(|(_, cells)| std::cmp::Reverse(cells.len()));
    groups
}
