//! The floor as an inspector accounts for it: what was scanned, what was missed and why, what nobody could reach.

pub(crate) mod areas;
mod evidence;

pub use evidence::{Evidence, Reasons};

use areas::areas;
use mission::event::RunOpened;
use serde::{Deserialize, Serialize};
use std::fmt;
use world::{Cell, CoverageGrid, PlateKind, PlateMap, Point, ShellFigures, coverage::percents};

/// Width of the critical zone along the shell, metres (API 653: 3 inches).
pub const CRITICAL_ZONE_M: f64 = 0.075;
/// Share of the shell along which the whole zone is scanned when it counts as done.
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

/// The zone along the shell, where the floor plate meets it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CriticalZone {
    /// Its width, metres.
    pub width_m: f64,
    /// Length of the shell beside free floor, metres.
    #[serde(default)]
    pub length_m: f64,
    /// Length along which its whole width was scanned, metres.
    #[serde(default)]
    pub done_m: f64,
    /// Scanned share of its area, 0 to 1; absent if there is no free floor at the shell.
    pub scanned: Option<f64>,
    /// Distance from the shell to where the scanned floor begins, the median along the shell where the zone is not
    /// done, metres; its width if nothing of it was scanned.
    #[serde(default)]
    pub gap_m: f64,
    /// Whether it was scanned: its whole width along 99.5 % of the shell.
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
    /// No plan led there, because the cable does not.
    BeyondReel,
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

impl<R: fmt::Display> fmt::Display for Area<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { at, area_m2, plate, reason, .. } = self;
        let plate = plate.as_ref().map(|name| format!(", plate {name}")).unwrap_or_default();
        write!(f, "{area_m2:.2} m² at {:.1}, {:.1} m{plate}: {reason}", at.x, at.y)
    }
}

impl fmt::Display for MissReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::PositionUncertain => "passed, but the position error was above the limit",
            Self::FoundObstacle => "beside an obstacle that was found on the way",
            Self::NotAsked => "not among the areas to be scanned",
            Self::NotPlanned => "left out of the plan",
            Self::BeyondReel => "left out of the plan, beyond the reel",
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
    let why_out = |index: usize| if grid.is_covered(index) { None } else { out_of_reach(floor.kind(index)) };
    let (missed, slivers) = areas(floor, plates.as_ref(), why_missed);
    let (unreachable, unreachable_slivers) = areas(floor, plates.as_ref(), why_out);
    Account {
        cell_m: floor.cell_m,
        swath_m: run.mission.swath_m,
        position_limit_m: run.mission.scan_limit_m(),
        whole: whole.shares(floor.cell_m2()),
        reachable: reachable.shares(floor.cell_m2()),
        critical_zone: critical_zone(evidence.shell()),
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

fn out_of_reach(kind: Cell) -> Option<OutOfReach> {
    match kind {
        Cell::Outside | Cell::Reachable => None,
        Cell::Unreachable => Some(OutOfReach::ClosedOff),
        Cell::Margin => Some(OutOfReach::ShellMargin),
        Cell::Beside => Some(OutOfReach::BesideObstacle),
        Cell::NoGo => Some(OutOfReach::NoGo),
    }
}

fn critical_zone(shell: ShellFigures) -> CriticalZone {
    let ShellFigures { length_m, done_m, scanned, gap_m } = shell;
    let has_floor = length_m > 0.0;
    let done = has_floor && done_m >= CRITICAL_DONE * length_m;
    let why = match gap_m {
        _ if done => None,
        _ if !has_floor => Some("there is no free floor at the shell".to_owned()),
        _ if scanned <= 0.0 => Some("nothing of it was scanned".to_owned()),
        gap_m => {
            let rest = if gap_m >= CRITICAL_ZONE_M - 1e-9 {
                "not at all on most of the rest".to_owned()
            } else {
                format!("from {:.0} mm off the shell on the rest (median)", 1000.0 * gap_m)
            };
            Some(format!("whole on {done_m:.1} of {length_m:.1} m, {rest}"))
        }
    };
    let scanned = has_floor.then_some(scanned);
    CriticalZone { width_m: CRITICAL_ZONE_M, length_m, done_m, scanned, gap_m, done, why }
}

#[cfg(test)]
mod tests;
