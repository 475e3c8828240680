//! Evidence of why floor was missed: where plans led, where the robot went, where its position was uncertain.

use super::{reason::MissReason, zone::CRITICAL_ZONE_M};
use crate::sampled::sampled;
use mission::{TaskConfig, event::RunOpened};
use world::{
    CellRun, Floor, Obstacle, ObstacleId, Point, Pose, Shape, ShellFigures, ShellZone, Tool, tether::Reach,
};

/// Plans are laid out on the floor in pieces no longer than this, metres.
const PIECE_M: f64 = 0.5;
/// Ways along a plan that differ by less are the same, metres.
const NEARLY_M: f64 = 0.01;

/// What was planned and done, cell by cell.
#[derive(Debug, Clone)]
pub struct Evidence {
    grid: Floor,
    tool: Tool,
    /// Distance from a found obstacle within which it is to blame, metres.
    beside_m: f64,
    /// The plan under way.
    plan: Planned,
    /// The plan before the one that was made last, until that one is flown: it may be refused.
    before: Option<Box<Planned>>,
    /// A plan led there, and was flown past there.
    passed: Vec<bool>,
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
            plan: Planned::none(run.floor.len()),
            before: None,
            passed: none.clone(),
            uncertain: none,
            asked: asked(run),
            found: Vec::new(),
            drawn: run.world.obstacles.iter().filter(|o| o.known).map(|o| o.shape.clone()).collect(),
            shell: ShellZone::new(&run.world.boundary, CRITICAL_ZONE_M),
            last: run.mission.start,
        }
    }

    /// A plan was made for what is left; it takes the place of the one before.
    pub fn plan(&mut self, path: &[Point], is_whole: bool) {
        self.leave_behind();
        let path = sampled(path, PIECE_M);
        let stations_m = world::polyline::stations_m(&path);
        let mut plan = Planned {
            length_m: stations_m.last().copied().unwrap_or(0.0),
            flown_m: self.plan.flown_m + self.plan.along_m,
            is_whole,
            ..Planned::none(self.grid.len())
        };
        for (pair, end_m) in
            path.windows(2).zip(stations_m.iter().skip(1)).filter(|(pair, _)| pair[0] != pair[1])
        {
            let ahead = pair[1] - pair[0];
            let at = |position| Pose { position, heading_rad: ahead.y.atan2(ahead.x) };
            for index in self.grid.cells_under(self.tool, at(pair[0]), at(pair[1])) {
                plan.due_m[index] = Some(*end_m as f32);
            }
        }
        self.before = Some(Box::new(std::mem::replace(&mut self.plan, plan)));
    }

    /// The plan that was made last does not fly: the one before still holds.
    pub fn refuse_plan(&mut self) {
        if let Some(before) = self.before.take() {
            self.plan = *before;
        }
    }

    /// The robot is this far along the plan, metres.
    pub fn fly(&mut self, along_m: f64) {
        self.before = None;
        self.plan.along_m = self.plan.along_m.max(along_m);
    }

    /// So much of the way is flown, as a share of the way flown before this plan and the whole of this plan.
    pub fn fly_share(&mut self, done: f64) {
        let Planned { length_m, flown_m, .. } = self.plan;
        self.fly(done * (flown_m + length_m) - flown_m);
    }

    /// What the plan was flown past stays so when another plan is made.
    fn leave_behind(&mut self) {
        for (passed, due_m) in self.passed.iter_mut().zip(&self.plan.due_m) {
            *passed |= due_m.is_some_and(|due_m| self.plan.is_past(due_m));
        }
    }

    /// The robot believed to be here, and what its tool passed since the last time counts or does not.
    pub fn visit(&mut self, here: Pose, counts: bool) {
        let before = std::mem::replace(&mut self.last, here);
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
        for (index, due_m) in self.plan.due_m.iter_mut().enumerate() {
            self.passed[index] |= other.is_passed(index);
            if due_m.is_none() && other.is_ahead(index) {
                *due_m = Some(f32::INFINITY);
            }
        }
        self.plan.is_whole &= other.plan.is_whole;
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

    /// Why cells were missed in this run.
    pub fn reasons(&self, run: &RunOpened) -> Reasons<'_> {
        let cable = run.mission.cable_reach().filter(|_| !self.plan.is_whole);
        let reach = cable.map(|(anchor, reach_m)| {
            let found = self.found.iter().map(|(_, shape)| shape);
            let shapes: Vec<Shape> = self.drawn.iter().chain(found).cloned().collect();
            Reach::new(anchor, &run.world.boundary, &shapes, reach_m)
        });
        Reasons { evidence: self, reach }
    }

    /// Whether a plan led to a cell and was flown past there.
    fn is_passed(&self, index: usize) -> bool {
        self.passed[index] || self.plan.due_m[index].is_some_and(|due_m| self.plan.is_past(due_m))
    }

    /// Whether the plan leads to a cell further on than it was flown.
    fn is_ahead(&self, index: usize) -> bool {
        self.plan.due_m[index].is_some_and(|due_m| !self.plan.is_past(due_m))
    }
}

/// Why floor was missed.
pub struct Reasons<'a> {
    evidence: &'a Evidence,
    /// Where the cable leads; `None` if no plan left floor out because of it.
    reach: Option<Reach>,
}

impl Reasons<'_> {
    /// Why a cell was missed.
    pub fn why_missed(&self, floor: &Floor, index: usize) -> MissReason {
        let (evidence, center) = (self.evidence, floor.center(index));
        if evidence.uncertain[index] {
            MissReason::PositionUncertain
        } else if self.is_left_beyond_reel(index, center) {
            MissReason::BeyondReel
        } else if evidence.found.iter().any(|(_, shape)| shape.distance_m(center) <= evidence.beside_m) {
            MissReason::FoundObstacle
        } else if !evidence.is_asked(index) {
            MissReason::NotAsked
        } else if evidence.is_passed(index) {
            MissReason::PassedBeside
        } else if evidence.is_ahead(index) {
            MissReason::NotReached
        } else {
            MissReason::NotPlanned
        }
    }

    /// Whether a cell was to be scanned, and no plan led there, because the cable does not.
    fn is_left_beyond_reel(&self, index: usize, center: Point) -> bool {
        let evidence = self.evidence;
        let is_left = evidence.is_asked(index) && !evidence.is_passed(index) && !evidence.is_ahead(index);
        is_left && self.reach.as_ref().is_some_and(|reach| reach.is_beyond(center))
    }
}

/// A plan, and how far it was flown.
#[derive(Debug, Clone)]
struct Planned {
    /// Way along the plan by which it has led over each cell for the last time, metres; `None` where it leads nowhere near.
    due_m: Vec<Option<f32>>,
    /// Its length, metres.
    length_m: f64,
    /// How far it was flown, metres.
    along_m: f64,
    /// Way flown along the plans before, metres.
    flown_m: f64,
    /// Whether it was for everything that was left.
    is_whole: bool,
}

impl Planned {
    fn none(cells: usize) -> Self {
        Self { due_m: vec![None; cells], length_m: 0.0, along_m: 0.0, flown_m: 0.0, is_whole: true }
    }

    fn is_past(&self, due_m: f32) -> bool {
        f64::from(due_m) <= self.along_m + NEARLY_M
    }
}

fn asked(run: &RunOpened) -> Option<Vec<bool>> {
    match &run.mission.task {
        TaskConfig::Cover { regions, .. } => world::coverage::regions::cells_within(&run.floor, regions),
        TaskConfig::Goto { .. } | TaskConfig::Follow { .. } => None,
    }
}
