//! Groups of adjacent cells as areas, each with a position and causes.

use super::measure::Measure;
use serde::{Deserialize, Serialize};
use std::{collections::BTreeMap, fmt};
use world::{Floor, PlateMap, Point, Vector};

/// Area, square metres, from which an area is listed; smaller areas are only added up.
const LEAST_M2: f64 = 0.01;

/// A group of adjacent cells.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Area<R> {
    /// A position in the area, metres: the cell nearest to its centre.
    pub at: Point,
    /// South-west corner of its bounding box, metres.
    pub low: Point,
    /// North-east corner of its bounding box, metres.
    pub high: Point,
    /// Area, square metres.
    pub area_m2: f64,
    /// The plate with most of the area; absent if the plate layout is not known.
    pub plate: Option<String>,
    /// All plates that the area touches, beginning with the plate that contains most of the area.
    #[serde(default)]
    pub plates: Vec<String>,
    /// The reason for most of the area.
    pub reason: R,
    /// The causes, beginning with the cause for most of the area.
    #[serde(default = "Vec::new")]
    pub causes: Vec<Cause<R>>,
}

/// The reason why part of an area was not scanned.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cause<R> {
    /// The reason.
    pub reason: R,
    /// The part of the area to which the reason applies, square metres.
    pub area_m2: f64,
    /// The value behind the reason; absent if the reason has none.
    pub measure: Option<Measure>,
    /// The reason with its value, as a sentence.
    pub text: String,
}

/// The areas that are too small to be listed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Slivers<R> {
    /// Number of areas.
    pub count: usize,
    /// Total area, square metres.
    pub area_m2: f64,
    /// The causes, beginning with the cause for most of the area.
    #[serde(default = "Vec::new")]
    pub causes: Vec<Cause<R>>,
}

impl<R> Default for Slivers<R> {
    fn default() -> Self {
        Self { count: 0, area_m2: 0.0, causes: Vec::new() }
    }
}

impl<R> Slivers<R> {
    /// The causes as one sentence; if there are several, each states its area.
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

/// A reason that can be stated with a value.
pub trait Explained: Copy + Ord {
    /// The reason as a sentence.
    fn sentence(self, measure: Option<&Measure>) -> String;

    /// Whether the cells with this reason form areas of their own, even where they touch others.
    fn is_apart(self) -> bool {
        false
    }
}

impl<R> Area<R> {
    /// The causes as one sentence; if there are several, each states its part of the area.
    pub fn why(&self) -> String {
        why(&self.causes)
    }
}

impl<R> fmt::Display for Area<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { at, area_m2, plate, .. } = self;
        let plate = plate.as_ref().map(|name| format!(", plate {name}")).unwrap_or_default();
        // Rounding comes before formatting, so that a coordinate near zero has no sign.
        let [x, y] = [at.x, at.y].map(|m| (10.0 * m).round() / 10.0 + 0.0);
        // Enough decimals to keep a listed area from being rounded up to the limit that it is below.
        let decimals = if *area_m2 < 0.1 { 3 } else { 2 };
        write!(f, "{area_m2:.decimals$} m² at {x:.1}, {y:.1} m{plate}: {}", self.why())
    }
}

/// Returns the areas of the cells that have a reason, the largest first, and the areas too small to be listed. Cells
/// are adjacent if they touch, even at a corner, regardless of their plates and reasons; only reasons that stand apart form
/// areas of their own.
pub fn areas<R: Explained>(
    floor: &Floor,
    plates: Option<&PlateMap>,
    reason_of: impl Fn(usize) -> Option<R>,
    measure: impl Fn(R, &[usize]) -> Option<Measure>,
) -> (Vec<Area<R>>, Slivers<R>) {
    let reasons: Vec<Option<R>> = (0..floor.len()).map(reason_of).collect();
    let reason = |cell: usize| reasons[cell].expect("only cells with a reason are grouped");
    let (mut listed, mut slivers, mut specks) = (Vec::new(), Slivers::default(), Vec::new());
    let group = |apart: bool| {
        let is_in = |cell: &usize| reasons[*cell].is_some_and(|reason| reason.is_apart() == apart);
        together(floor, (0..floor.len()).filter(is_in))
    };
    for cells in group(false).into_iter().chain(group(true)) {
        let area_m2 = cells.len() as f64 * floor.cell_m2();
        if area_m2 < LEAST_M2 {
            slivers.count += 1;
            slivers.area_m2 += area_m2;
            specks.extend(cells);
        } else {
            listed.push(area_of(floor, plates, &cells, reason, &measure));
        }
    }
    // Areas of equal size stay in the order of their first cells.
    listed.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2));
    slivers.causes = causes(floor, &specks, reason, &measure);
    (listed, slivers)
}

/// Groups cells by contact, even at a corner. The cells are given in ascending order; the groups are in order of
/// their first cells.
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

/// A cell and the cells that touch it.
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

/// The causes of unscanned cells.
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

/// Groups cells by a key, the key with the most cells first; keys with equal counts are in ascending order.
fn by_size<K: Copy + Ord>(cells: &[usize], key_of: impl Fn(usize) -> K) -> Vec<(K, Vec<usize>)> {
    let mut groups: BTreeMap<K, Vec<usize>> = BTreeMap::new();
    for cell in cells {
        groups.entry(key_of(*cell)).or_default().push(*cell);
    }
    let mut groups: Vec<(K, Vec<usize>)> = groups.into_iter().collect();
    groups.sort_by_key(|(_, cells)| std::cmp::Reverse(cells.len()));
    groups
}
