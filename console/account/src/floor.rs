//! The account of the floor for an inspector: scanned floor, missed floor with reasons, and unreachable floor.

mod areas;
mod evidence;
mod left_out;
mod measure;
mod reason;
mod reasons;
mod updated;
mod zone;

pub use areas::{Area, Cause, Explained, Slivers, area_of, areas, together};
pub use evidence::{Evidence, Solid};
pub use left_out::{LeftOut, Resumption};
pub use measure::Measure;
pub use reason::{MissReason, OutOfReach};
pub use reasons::Reasons;
pub use updated::updated_floor;
use zone::rim;
pub use zone::{CriticalZone, ZoneArc, ZoneOfPlate};

use crate::{accuracy::nearest_rank, scanned::Scanned};
use mission::event::RunOpened;
use serde::{Deserialize, Serialize};
use world::{
    Cell, Counts, Floor, PlateKind, PlateMap, Point,
    coverage::{percent, percents},
};

/// The account of a floor according to the estimated position: a cell counts as scanned where the position error was
/// within the mission's limit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Account {
    /// Edge of a cell of the grid, metres.
    pub cell_m: f64,
    /// Width of floor scanned in one pass, metres.
    pub swath_m: f64,
    /// Limit of the 95 % position error above which nothing counted as scanned, metres.
    pub position_limit_m: f64,
    /// The whole floor.
    pub whole: Shares,
    /// The floor that the tool can reach, which is either scanned or missed.
    pub reachable: Shares,
    /// The part of the reachable floor that the mission had to scan; absent if that was all of it, and in older reports.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub requested: Option<Shares>,
    /// Scanned share of the reachable floor, from the exact area that the tool swept instead of from cells, 0 to 1.
    #[serde(default)]
    pub exact: Option<f64>,
    /// The critical zone along the shell.
    pub critical_zone: CriticalZone,
    /// All plates, including those on which nothing was scanned; empty if the plate layout is not known.
    pub plates: Vec<PlateAccount>,
    /// Reachable floor that was not scanned, the largest area first.
    pub missed: Vec<Area<MissReason>>,
    /// Missed areas that are too small to be listed.
    pub slivers: Slivers<MissReason>,
    /// Floor that the tool cannot reach, the largest area first.
    pub unreachable: Vec<Area<OutOfReach>>,
    /// Unreachable areas that are too small to be listed.
    #[serde(default)]
    pub unreachable_slivers: Slivers<OutOfReach>,
}

impl Account {
    /// The account of a floor that no mission had to scan: it has no missed floor and no requirement along the shell.
    #[must_use]
    pub fn of_no_scan(self) -> Self {
        Self {
            whole: Shares::default(),
            reachable: Shares::default(),
            requested: None,
            exact: None,
            critical_zone: CriticalZone::default(),
            plates: Vec::new(),
            missed: Vec::new(),
            slivers: Slivers::default(),
            unreachable: Vec::new(),
            unreachable_slivers: Slivers::default(),
            ..self
        }
    }

    /// The floor that the mission had to scan: the requested part of the reachable floor, or all of it.
    pub fn due(&self) -> &Shares {
        self.requested.as_ref().unwrap_or(&self.reachable)
    }

    /// Reachable floor that was neither requested nor scanned, square metres.
    pub fn not_asked_m2(&self) -> f64 {
        let areas = self.missed.iter().filter(|area| area.reason == MissReason::NotAsked);
        let specks = self.slivers.causes.iter().filter(|cause| cause.reason == MissReason::NotAsked);
        areas.map(|area| area.area_m2).chain(specks.map(|cause| cause.area_m2)).sum()
    }

    /// Requested floor that was not scanned, in the order in which lists and maps number it: largest area first; areas
    /// that were not reached because the mission ended come last.
    pub fn listed(&self) -> Vec<&Area<MissReason>> {
        let requested = || self.missed.iter().filter(|area| area.reason != MissReason::NotAsked);
        let was_ahead = |area: &&Area<MissReason>| area.reason == MissReason::NotReached;
        requested().filter(|area| !was_ahead(area)).chain(requested().filter(was_ahead)).collect()
    }

    /// Whether this is the account of a floor that no mission had to scan.
    pub fn is_of_no_scan(&self) -> bool {
        self.whole.area_m2 <= 0.0
    }
}

/// The division of a floor. The shares are shares of the floor's area and add up to 1.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Shares {
    /// Area, square metres.
    pub area_m2: f64,
    /// Scanned share.
    pub scanned: f64,
    /// Share that the tool can reach, but that was not scanned.
    pub missed: f64,
    /// Unreachable share: closed off, beside obstacles, or in no-go zones.
    pub unreachable: f64,
    /// Share that is unreachable because the robot keeps its distance from the shell.
    pub margin: f64,
    /// Share that the tool cannot test because of the welds.
    #[serde(default, skip_serializing_if = "is_none")]
    pub untestable: f64,
    /// Share that was scanned for every position of the robot within the 95 % error; part of the scanned share. Absent
    /// during a mission.
    #[serde(default)]
    pub guaranteed: Option<f64>,
    /// The shares above, as printed.
    #[serde(default)]
    pub percent: Percent,
}

/// Shares in per cent, rounded to one decimal so that they add up to 100.0; all 0 for an empty floor.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Percent {
    /// Scanned share.
    pub scanned: f64,
    /// Share that the tool can reach, but that was not scanned.
    pub missed: f64,
    /// Unreachable share.
    pub unreachable: f64,
    /// Share that is unreachable along the shell.
    pub margin: f64,
    /// Share that the tool cannot test because of the welds.
    #[serde(default, skip_serializing_if = "is_none")]
    pub untestable: f64,
    /// Share that was scanned for every position of the robot within the 95 % error; part of the scanned share.
    #[serde(default)]
    pub guaranteed: Option<f64>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "signature required by serde")]
fn is_none(share: &f64) -> bool {
    *share <= 0.0
}

/// The account of one plate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlateAccount {
    /// Name of the plate.
    pub name: String,
    /// Kind of the plate.
    pub kind: PlateKind,
    /// The 95 % position error that 95 % of the scanned cells do not exceed, taking the best pass over each cell,
    /// metres; absent if none of the plate was scanned.
    #[serde(default)]
    pub error_p95_m: Option<f64>,
    /// The largest 95 % position error of the scanned cells, taking the best pass over each cell, metres; absent if
    /// none of the plate was scanned, and in older reports.
    #[serde(default)]
    pub error_max_m: Option<f64>,
    /// The true position error that 95 % of the cells passed by the tool do not exceed, taking the worst pass over each
    /// cell, metres; absent if the true position is not known, and in older reports.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub true_error_p95_m: Option<f64>,
    /// The largest true position error with which the tool passed the plate, metres; absent if the true position is not
    /// known, and in older reports.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub true_error_max_m: Option<f64>,
    /// The division of the plate's floor.
    #[serde(flatten)]
    pub shares: Shares,
}

impl Shares {
    /// The division of a floor, from counts of its cells; each cell has the given area in square metres.
    pub fn of(counts: Counts, cell_m2: f64) -> Self {
        let Counts { floor, reachable, covered, covered_reachable, margin, untestable } = counts;
        let missed = reachable - covered_reachable;
        let unreachable = floor - covered - missed - margin - untestable;
        let share = |part: usize| if floor == 0 { 0.0 } else { part as f64 / floor as f64 };
        let shares = [covered, missed, unreachable, margin, untestable].map(share);
        let [scanned, missed, unreachable, margin, untestable] = percents(shares);
        let percent = Percent { scanned, missed, unreachable, margin, untestable, guaranteed: None };
        let [scanned, missed, unreachable, margin, untestable] = shares;
        let area_m2 = floor as f64 * cell_m2;
        Shares { area_m2, scanned, missed, unreachable, margin, untestable, guaranteed: None, percent }
    }

    /// This division with the number of guaranteed cells.
    fn with_guaranteed(mut self, cells: usize, cell_m2: f64) -> Self {
        let share = if self.area_m2 > 0.0 { cells as f64 * cell_m2 / self.area_m2 } else { 0.0 };
        self.guaranteed = Some(share);
        self.percent.guaranteed = Some(percent(share).min(self.percent.scanned));
        self
    }
}

/// Cell counts of a part of the floor.
#[derive(Debug, Clone, Copy, Default)]
struct Tally {
    counts: Counts,
    guaranteed: usize,
}

impl Tally {
    fn count(&mut self, kind: Cell, is_scanned: bool, is_guaranteed: bool) {
        self.counts.add(kind, is_scanned);
        self.guaranteed += usize::from(is_guaranteed && kind.is_testable());
    }

    fn shares(self, cell_m2: f64) -> Shares {
        Shares::of(self.counts, cell_m2).with_guaranteed(self.guaranteed, cell_m2)
    }
}

/// Computes the account of a floor. Visits every cell once.
pub fn account(run: &RunOpened, scanned: &Scanned, evidence: &Evidence) -> Account {
    let grid = scanned.believed();
    let floor = grid.floor();
    let plates = plate_map(run, floor);
    let (mut whole, mut reachable, mut requested) = (Tally::default(), Tally::default(), Tally::default());
    let mut by_plate = vec![Tally::default(); plates.as_ref().map_or(0, |map| map.plates.len())];
    let covered: Vec<bool> = (0..floor.len()).map(|index| grid.is_covered(index)).collect();
    for (index, is_scanned) in covered.iter().copied().enumerate() {
        let kind = floor.kind(index);
        let is_guaranteed = is_scanned && scanned.passes().is_guaranteed(index);
        whole.count(kind, is_scanned, is_guaranteed);
        if kind == Cell::Reachable {
            reachable.count(kind, is_scanned, is_guaranteed);
            if evidence.is_asked(index) {
                requested.count(kind, is_scanned, is_guaranteed);
            }
        }
        if let Some(plate) = plates.as_ref().and_then(|map| map.plate_of(index)) {
            by_plate[plate].count(kind, is_scanned, is_guaranteed);
        }
    }
    let reasons = evidence.reasons(run);
    let why_missed = |index: usize| {
        let is_missed = floor.is_reachable(index) && !covered[index];
        is_missed.then(|| reasons.why_missed(floor.center(index), index))
    };
    let why_out = |index: usize| OutOfReach::of(floor.kind(index)).filter(|_| !covered[index]);
    let (missed, slivers) =
        areas(floor, plates.as_ref(), why_missed, |why, cells| reasons.measure(grid, why, cells));
    let (unreachable, unreachable_slivers) =
        areas(floor, plates.as_ref(), why_out, |why, cells| reasons.measure_out_of_reach(grid, why, cells));
    let plate_at = |place: Point| plate_beside(floor, plates.as_ref()?, place);
    Account {
        cell_m: floor.cell_m,
        swath_m: run.mission.swath_m,
        position_limit_m: run.mission.scan_limit_m(),
        whole: whole.shares(floor.cell_m2()),
        reachable: reachable.shares(floor.cell_m2()),
        requested: (!evidence.asks_for_everything()).then(|| requested.shares(floor.cell_m2())),
        exact: evidence.exact_share(&updated_floor(run, floor, evidence, run.mission.swath_m)),
        critical_zone: CriticalZone::of(&evidence.shell(), &rim(&run.mission), plate_at),
        plates: plates
            .as_ref()
            .map_or_else(Vec::new, |map| plate_accounts(map, &by_plate, scanned, &covered)),
        missed,
        slivers,
        unreachable,
        unreachable_slivers,
    }
}

/// The plates of a floor, if their layout is known.
pub fn plate_map(run: &RunOpened, floor: &Floor) -> Option<PlateMap> {
    run.plates.as_ref().map(|layout| layout.map(&run.world.boundary, floor))
}

/// The plate of the floor next to a point on the wall.
fn plate_beside(floor: &Floor, map: &PlateMap, place: Point) -> Option<String> {
    let near = floor.cells_near(place, place, 2.0 * floor.cell_m).into_iter();
    let off_m = |cell: &usize| (floor.center(*cell) - place).norm();
    let nearest =
        near.filter(|cell| map.plate_of(*cell).is_some()).min_by(|a, b| off_m(a).total_cmp(&off_m(b)));
    Some(map.plates[map.plate_of(nearest?)?].name.clone())
}

/// A plate with its cell counts, and its errors according to the estimate and to the truth, millimetres.
type Tallied<'a> = ((&'a world::Plate, &'a Tally), (Vec<u16>, Vec<u16>));

fn plate_accounts(
    map: &PlateMap,
    by_plate: &[Tally],
    scanned: &Scanned,
    covered: &[bool],
) -> Vec<PlateAccount> {
    let mut errors_mm: Vec<Vec<u16>> =
        by_plate.iter().map(|tally| Vec::with_capacity(tally.counts.covered)).collect();
    let mut true_errors_mm = vec![Vec::new(); by_plate.len()];
    for (cell, is_scanned) in covered.iter().enumerate() {
        let Some(plate) = map.plate_of(cell) else { continue };
        let error_mm = scanned.passes().error_mm(cell).filter(|_| *is_scanned);
        errors_mm[plate].extend(error_mm);
        true_errors_mm[plate].extend(scanned.true_error_mm(cell));
    }
    let metres = |mm: u16| f64::from(mm) / 1000.0;
    let tallied = map.plates.iter().zip(by_plate).zip(errors_mm.into_iter().zip(true_errors_mm));
    let plate = |((plate, tally), (mut errors_mm, mut true_errors_mm)): Tallied| {
        errors_mm.sort_unstable();
        true_errors_mm.sort_unstable();
        PlateAccount {
            name: plate.name.clone(),
            kind: plate.kind,
            error_p95_m: nearest_rank(&errors_mm, 0.95).map(metres),
            error_max_m: errors_mm.last().copied().map(metres),
            true_error_p95_m: nearest_rank(&true_errors_mm, 0.95).map(metres),
            true_error_max_m: true_errors_mm.last().copied().map(metres),
            shares: tally.shares(scanned.believed().floor().cell_m2()),
        }
    };
    tallied.map(plate).collect()
}

#[cfg(test)]
mod tests;
