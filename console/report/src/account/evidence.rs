//! What tells why floor was missed: where plans led, where the robot went, where its position was uncertain.

use super::{CRITICAL_ZONE_M, MissReason};
use mission::{TaskConfig, event::RunOpened};
use world::{CellRun, Floor, Obstacle, ObstacleId, Point, Pose, Shape, ShellFigures, ShellZone, Tool};

/// Plans are laid out on the floor in pieces no longer than this, metres.
const PIECE_M: f64 = 0.5;

/// What was planned and done, cell by cell.
#[derive(Debug, Clone)]
pub struct Evidence {
    grid: Floor,
    tool: Tool,
    /// Distance from a found obstacle within which it is to blame, metres.
    beside_m: f64,
    planned: Vec<bool>,
    /// Within a swath of where the robot believed to be: it was there, if not above it.
    visited: Vec<bool>,
    uncertain: Vec<bool>,
    /// What was to be scanned; `None` for everything.
    asked: Option<Vec<bool>>,
    found: Vec<(ObstacleId, Shape)>,
    /// What the drawing shows, for the zone along the shell.
    drawn: Vec<Shape>,
    shell: ShellZone,
    last: Pose,
}

impl Evidence {
    /// Nothing was planned or done yet.
    pub fn new(run: &RunOpened) -> Self {
        let none = vec![false; run.floor.len()];
        Self {
            grid: run.floor.clone(),
            tool: run.mission.tool(),
            beside_m: run.mission.room_m() + run.mission.swath_m / 2.0,
            planned: none.clone(),
            visited: none.clone(),
            uncertain: none,
            asked: asked(run),
            found: Vec::new(),
            drawn: run.world.obstacles.iter().filter(|o| o.known).map(|o| o.shape.clone()).collect(),
            shell: ShellZone::new(&run.world.boundary, CRITICAL_ZONE_M),
            last: run.mission.start,
        }
    }

    /// A plan was made.
    pub fn plan(&mut self, path: &[Point]) {
        let path = world::polyline::resampled(path, PIECE_M);
        for pair in path.windows(2).filter(|pair| pair[0] != pair[1]) {
            let ahead = pair[1] - pair[0];
            let at = |position| Pose { position, heading_rad: ahead.y.atan2(ahead.x) };
            for index in self.grid.cells_under(self.tool, at(pair[0]), at(pair[1])) {
                self.planned[index] = true;
            }
        }
    }

    /// The robot believed to be here, and what its tool passed since the last time counts or does not.
    pub fn visit(&mut self, here: Pose, counts: bool) {
        let before = std::mem::replace(&mut self.last, here);
        for index in self.grid.cells_near(before.position, here.position, self.tool.swath_m()) {
            self.visited[index] = true;
        }
        if counts {
            self.shell.pass(self.tool, before, here);
        }
    }

    /// How much of the zone along the shell was scanned.
    pub fn shell(&self) -> ShellFigures {
        let all = self.drawn.iter().chain(self.found.iter().map(|(_, shape)| shape));
        let solid: Vec<&Shape> = all.filter(|shape| self.shell.is_beside(shape)).collect();
        self.shell.figures(|point| solid.iter().any(|shape| shape.distance_m(point) < 0.0))
    }

    /// The tool passed, but nothing counted.
    pub fn leave_uncounted(&mut self, runs: &[CellRun]) {
        for CellRun(first, count) in runs {
            let first = (*first as usize).min(self.uncertain.len());
            let end = first.saturating_add(*count as usize).min(self.uncertain.len());
            self.uncertain[first..end].fill(true);
        }
    }

    /// An obstacle was found, or turned out to stand elsewhere.
    pub fn find(&mut self, obstacle: &Obstacle) {
        self.found.retain(|(id, _)| *id != obstacle.id);
        self.found.push((obstacle.id, obstacle.shape.clone()));
    }

    /// Takes in what another run on the same floor planned and did.
    pub fn join(&mut self, other: &Self) {
        let or = |own: &mut [bool], others: &[bool]| own.iter_mut().zip(others).for_each(|(a, b)| *a |= b);
        or(&mut self.planned, &other.planned);
        or(&mut self.visited, &other.visited);
        or(&mut self.uncertain, &other.uncertain);
        self.asked = match (self.asked.take(), &other.asked) {
            (Some(mut asked), Some(others)) => {
                or(&mut asked, others);
                Some(asked)
            }
            _ => None,
        };
        self.found.extend(other.found.iter().cloned());
        self.shell.join(&other.shell);
    }

    /// What was found on the way.
    pub fn found(&self) -> impl Iterator<Item = &(ObstacleId, Shape)> {
        self.found.iter()
    }

    /// Whether a cell was to be scanned at all.
    pub fn is_asked(&self, index: usize) -> bool {
        self.asked.as_ref().is_none_or(|asked| asked[index])
    }

    /// Why a cell was missed.
    pub fn why_missed(&self, floor: &Floor, index: usize) -> MissReason {
        let center = floor.center(index);
        if self.uncertain[index] {
            MissReason::PositionUncertain
        } else if self.found.iter().any(|(_, shape)| shape.distance_m(center) <= self.beside_m) {
            MissReason::FoundObstacle
        } else if !self.is_asked(index) {
            MissReason::NotAsked
        } else if !self.planned[index] {
            MissReason::NotPlanned
        } else if self.visited[index] {
            MissReason::PassedBeside
        } else {
            MissReason::NotReached
        }
    }
}

fn asked(run: &RunOpened) -> Option<Vec<bool>> {
    match &run.mission.task {
        TaskConfig::Cover { regions, .. } => world::coverage::regions::cells_within(&run.floor, regions),
        TaskConfig::Goto { .. } | TaskConfig::Follow { .. } => None,
    }
}
