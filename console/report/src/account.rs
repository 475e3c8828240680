//! The floor as an inspector accounts for it: what was scanned, what was missed and why, what nobody could reach.

mod areas;
mod evidence;

pub use evidence::Evidence;

use areas::areas;
use mission::event::RunOpened;
use serde::{Deserialize, Serialize};
use std::fmt;
use world::{Cell, CoverageGrid, PlateKind, PlateMap, Point};

/// Width of the critical zone along the shell, metres (API 653: 3 inches).
pub const CRITICAL_ZONE_M: f64 = 0.075;
/// Share of the critical zone above which it counts as done.
const CRITICAL_DONE: f64 = 0.995;

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
}

/// The zone along the shell, where the floor plate meets it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CriticalZone {
    /// Its width, metres.
    pub width_m: f64,
    /// Scanned share of it, 0 to 1; absent if no cell of the grid lies in it.
    pub scanned: Option<f64>,
    /// Whether it was scanned.
    pub done: bool,
    /// Why not, as a sentence; absent if it was.
    pub why: Option<String>,
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

/// Why floor in reach of the tool was not scanned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MissReason {
    /// The tool passed, but the position error was above the limit.
    PositionUncertain,
    /// Beside an obstacle that was found on the way.
    FoundObstacle,
    /// Outside the areas that the mission was to scan.
    NotAsked,
    /// No plan led there.
    NotPlanned,
    /// A plan led there, but the mission ended before.
    NotReached,
    /// A plan led there, but the robot passed beside it.
    PassedBeside,
}

/// Why floor is out of reach of the tool.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OutOfReach {
    /// The robot keeps its distance from the shell.
    ShellMargin,
    /// The robot keeps its distance from an obstacle.
    BesideObstacle,
    /// In a zone that the robot must not enter.
    NoGo,
    /// No way leads there that is wide enough for the robot.
    ClosedOff,
}

impl fmt::Display for MissReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::PositionUncertain => "passed, but the position error was above the limit",
            Self::FoundObstacle => "beside an obstacle that was found on the way",
            Self::NotAsked => "not among the areas to be scanned",
            Self::NotPlanned => "left out of the plan",
            Self::NotReached => "planned, but the mission ended before",
            Self::PassedBeside => "planned, but the robot passed beside it",
        })
    }
}

impl fmt::Display for OutOfReach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ShellMargin => "the robot keeps its distance from the shell",
            Self::BesideObstacle => "the robot keeps its distance from an obstacle",
            Self::NoGo => "in a no-go zone",
            Self::ClosedOff => "no way leads there that is wide enough",
        })
    }
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
        Shares {
            area_m2: cells as f64 * cell_m2,
            scanned: share(self.scanned),
            missed: share(self.missed),
            unreachable: share(self.unreachable),
            margin: share(self.margin),
        }
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
    let why_missed = |index: usize| {
        (floor.is_reachable(index) && !grid.is_covered(index)).then(|| evidence.why_missed(floor, index))
    };
    let why_out = |index: usize| if grid.is_covered(index) { None } else { out_of_reach(floor.kind(index)) };
    let (missed, slivers) = areas(floor, plates.as_ref(), why_missed);
    let (unreachable, _) = areas(floor, plates.as_ref(), why_out);
    Account {
        cell_m: floor.cell_m,
        swath_m: run.mission.swath_m,
        position_limit_m: run.mission.scan_limit_m(),
        whole: whole.shares(floor.cell_m2()),
        reachable: reachable.shares(floor.cell_m2()),
        critical_zone: critical_zone(run, grid),
        plates: plates.map_or_else(Vec::new, |map| plate_accounts(&map, &by_plate, floor.cell_m2())),
        missed,
        slivers,
        unreachable,
    }
}

fn plate_accounts(map: &PlateMap, by_plate: &[Tally], cell_m2: f64) -> Vec<PlateAccount> {
    let told = map.plates.iter().zip(by_plate);
    told.map(|(plate, tally)| PlateAccount {
        name: plate.name.clone(),
        kind: plate.kind,
        shares: tally.shares(cell_m2),
    })
    .collect()
}

fn out_of_reach(kind: Cell) -> Option<OutOfReach> {
    match kind {
        Cell::Outside | Cell::Reachable => None,
        Cell::Unreachable => Some(OutOfReach::ClosedOff),
        Cell::Margin => Some(OutOfReach::ShellMargin),
        Cell::Beside => Some(OutOfReach::BesideObstacle),
        Cell::NoGo => Some(OutOfReach::NoGo),
    }
}

fn critical_zone(run: &RunOpened, grid: &CoverageGrid) -> CriticalZone {
    let floor = grid.floor();
    let in_zone = |index: &usize| {
        floor.is_floor(*index) && run.world.boundary.wall_distance_m(floor.center(*index)) <= CRITICAL_ZONE_M
    };
    let zone: Vec<usize> = (0..floor.len()).filter(in_zone).collect();
    let covered = zone.iter().filter(|index| grid.is_covered(**index)).count();
    let scanned = (!zone.is_empty()).then(|| covered as f64 / zone.len() as f64);
    let done = scanned.is_some_and(|share| share >= CRITICAL_DONE);
    let gap_m = run.mission.room_m() - run.mission.swath_m / 2.0;
    let why = match scanned {
        _ if done => None,
        None => Some(format!("cells of {} m are too coarse to see it", floor.cell_m)),
        Some(_) if gap_m > 1e-3 => Some(format!("the tool ends {gap_m:.3} m before the shell")),
        Some(share) => Some(format!("{:.1} % of it scanned", 100.0 * share)),
    };
    CriticalZone { width_m: CRITICAL_ZONE_M, scanned, done, why }
}

#[cfg(test)]
mod tests;
