//! The floor as an inspector accounts for it: what was scanned, what was missed and why, what nobody could reach.

pub(crate) mod areas;
mod evidence;
mod reason;
mod zone;

pub use areas::{Area, Slivers};
pub use evidence::{Evidence, Reasons};
pub use reason::{MissReason, OutOfReach};
pub use zone::CriticalZone;

use areas::areas;
use mission::event::RunOpened;
use serde::{Deserialize, Serialize};
use world::{Cell, CoverageGrid, PlateKind, PlateMap, coverage::percents};

/// The account of a floor, by the estimated position: a cell counts as scanned where the position error was within
/// the mission's limit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Account {
    /// Edge of a cell of the grid, metres.
    pub cell_m: f64,
    /// Width of floor scanned in one pass, metres.
    pub swath_m: f64,
    /// Half width of the 95 % position error above which nothing counted, metres.
    pub position_limit_m: f64,
    /// All floor.
    pub whole: Shares,
    /// The floor that the tool can reach: scanned and missed alone.
    pub reachable: Shares,
    /// The zone along the shell.
    pub critical_zone: CriticalZone,
    /// Every plate, also those of which nothing was scanned; empty if the layout of the plates is not known.
    pub plates: Vec<PlateAccount>,
    /// Reachable floor that was not scanned, the largest area first.
    pub missed: Vec<Area<MissReason>>,
    /// Missed areas that are too small to be listed.
    pub slivers: Slivers,
    /// Floor that the tool cannot reach, the largest area first.
    pub unreachable: Vec<Area<OutOfReach>>,
    /// Areas out of reach that are too small to be listed.
    #[serde(default)]
    pub unreachable_slivers: Slivers,
}

/// How a floor divides. The shares are of its area and sum to 1.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Shares {
    /// Area, square metres.
    pub area_m2: f64,
    /// Scanned.
    pub scanned: f64,
    /// In reach of the tool, but not scanned.
    pub missed: f64,
    /// Out of reach: closed off, beside obstacles, in zones that the robot must not enter.
    pub unreachable: f64,
    /// Out of reach because the robot keeps its distance from the shell.
    pub margin: f64,
    /// The same shares as they are printed.
    #[serde(default)]
    pub percent: Percent,
}

/// Shares in per cent, rounded to one decimal so that they sum to 100.0; all 0 of an empty floor.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Percent {
    /// Scanned.
    pub scanned: f64,
    /// In reach of the tool, but not scanned.
    pub missed: f64,
    /// Out of reach.
    pub unreachable: f64,
    /// Out of reach along the shell.
    pub margin: f64,
}

/// One plate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlateAccount {
    /// Its name.
    pub name: String,
    /// What kind of plate.
    pub kind: PlateKind,
    /// How it divides.
    #[serde(flatten)]
    pub shares: Shares,
}

/// Cells of some part of the floor.
#[derive(Debug, Clone, Copy, Default)]
struct Tally {
    scanned: usize,
    missed: usize,
    unreachable: usize,
    margin: usize,
}

impl Tally {
    fn count(&mut self, kind: Cell, is_scanned: bool) {
        match kind {
            Cell::Outside => {}
            _ if is_scanned => self.scanned += 1,
            Cell::Reachable => self.missed += 1,
            Cell::Margin => self.margin += 1,
            Cell::Unreachable | Cell::Beside | Cell::NoGo => self.unreachable += 1,
        }
    }

    fn shares(self, cell_m2: f64) -> Shares {
        let cells = self.scanned + self.missed + self.unreachable + self.margin;
        let share = |part: usize| if cells == 0 { 0.0 } else { part as f64 / cells as f64 };
        let shares = [self.scanned, self.missed, self.unreachable, self.margin].map(share);
        let [scanned, missed, unreachable, margin] = percents(shares);
        let percent = Percent { scanned, missed, unreachable, margin };
        let [scanned, missed, unreachable, margin] = shares;
        Shares { area_m2: cells as f64 * cell_m2, scanned, missed, unreachable, margin, percent }
    }
}

/// Accounts for a floor. Costs one look at every cell.
pub fn account(run: &RunOpened, grid: &CoverageGrid, evidence: &Evidence) -> Account {
    let floor = grid.floor();
    let plates = run.plates.map(|layout| layout.map(&run.world.boundary, floor));
    let (mut whole, mut reachable) = (Tally::default(), Tally::default());
    let mut by_plate = vec![Tally::default(); plates.as_ref().map_or(0, |map| map.plates.len())];
    for index in 0..floor.len() {
        let (kind, is_scanned) = (floor.kind(index), grid.is_covered(index));
        whole.count(kind, is_scanned);
        if kind == Cell::Reachable {
            reachable.count(kind, is_scanned);
        }
        if let Some(plate) = plates.as_ref().and_then(|map| map.plate_of(index)) {
            by_plate[plate].count(kind, is_scanned);
        }
    }
    let reasons = evidence.reasons(run);
    let why_missed = |index: usize| {
        (floor.is_reachable(index) && !grid.is_covered(index)).then(|| reasons.why_missed(floor, index))
    };
    let why_out =
        |index: usize| if grid.is_covered(index) { None } else { OutOfReach::of(floor.kind(index)) };
    let (missed, slivers) = areas(floor, plates.as_ref(), why_missed);
    let (unreachable, unreachable_slivers) = areas(floor, plates.as_ref(), why_out);
    Account {
        cell_m: floor.cell_m,
        swath_m: run.mission.swath_m,
        position_limit_m: run.mission.scan_limit_m(),
        whole: whole.shares(floor.cell_m2()),
        reachable: reachable.shares(floor.cell_m2()),
        critical_zone: CriticalZone::of(evidence.shell()),
        plates: plates.map_or_else(Vec::new, |map| plate_accounts(&map, &by_plate, floor.cell_m2())),
        missed,
        slivers,
        unreachable,
        unreachable_slivers,
    }
}

fn plate_accounts(map: &PlateMap, by_plate: &[Tally], cell_m2: f64) -> Vec<PlateAccount> {
    let tallied = map.plates.iter().zip(by_plate);
    tallied
        .map(|(plate, tally)| PlateAccount {
            name: plate.name.clone(),
            kind: plate.kind,
            shares: tally.shares(cell_m2),
        })
        .collect()
}

#[cfg(test)]
mod tests;
