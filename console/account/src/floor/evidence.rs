//! Evidence of why floor was missed: where plans led, where the robot went, and where its position was uncertain.

use super::{reasons::Reasons, zone::CRITICAL_ZONE_M};
use crate::sampled::sampled;
use mission::{Channels, TaskConfig, event::RunOpened};
use world::{
    Boundary, Cell, CellRun, Floor, FloorMaker, KindRun, Obstacle, ObstacleId, Point, Pose, Shape,
    ShellStretch, ShellZone, SweptArea, Tool, ToolPart, ZoneKind, tether::Reach,
};

/// Maximum length of the pieces in which a plan is drawn on the floor, metres.
const PIECE_M: f64 = 0.5;
/// The error stored for a cell that no uncounted pass covers.
const NEVER: u16 = u16::MAX;
/// The zone index of a cell that no zone made unreachable.
const OF_NONE: u16 = u16::MAX;
/// Distances along a plan that differ by less count as equal, metres.
const NEARLY_M: f64 = 0.01;

/// A cell-by-cell record of the plan and its execution.
#[derive(Debug, Clone)]
pub struct Evidence {
    grid: Floor,
    tool: Tool,
    /// Distance from a found obstacle within which the obstacle counts as a cause, metres.
    beside_m: f64,
    /// The current plan.
    plan: Planned,
    /// The plan before the latest plan. It is kept until the latest plan is started, because that plan may still be
    /// refused.
    before: Option<Box<Planned>>,
    /// Cells that a plan led to and that the robot passed while following the plan.
    passed: Vec<bool>,
    /// The smallest 95 % error of an uncounted pass of the tool, millimetres; [`NEVER`] if there was none.
    uncertain_mm: Vec<u16>,
    /// The parts of the tool whose channels work.
    live: Vec<ToolPart>,
    /// The dead channels, each with the part of the tool beside it.
    blind: Vec<(u16, ToolPart)>,
    /// The dead channel that passed a cell while the position was known well enough; [`NEVER`] if there was none.
    passed_blind: Vec<u16>,
    /// The current 95 % error, metres.
    error_m: f64,
    /// The floor that had to be scanned; `None` for all of it.
    asked: Option<Vec<bool>>,
    found: Vec<(ObstacleId, Solid)>,
    drawn: Vec<Solid>,
    /// The no-go zones: those of the scenario, and those drawn later.
    no_go: Vec<Solid>,
    /// The zone that made a cell unreachable when it was drawn; [`OF_NONE`] if there is none.
    shut_by: Vec<u16>,
    boundary: Boundary,
    shell: ShellZone,
    area: SweptArea,
    last: Pose,
}

impl Evidence {
    /// Evidence of a run without plans and movement.
    pub fn new(run: &RunOpened) -> Self {
        let none = vec![false; run.floor.len()];
        Self {
            grid: run.floor.clone(),
            tool: run.mission.tool(),
            beside_m: run.mission.room_m() + run.mission.swath_m / 2.0,
            plan: Planned::none(run.floor.len()),
            before: None,
            passed: none,
            uncertain_mm: vec![NEVER; run.floor.len()],
            live: vec![ToolPart::whole(run.mission.tool())],
            blind: Vec::new(),
            passed_blind: vec![NEVER; run.floor.len()],
            error_m: 0.0,
            asked: asked(run),
            found: Vec::new(),
            no_go: no_go_zones(run),
            shut_by: vec![OF_NONE; run.floor.len()],
            drawn: run.world.obstacles.iter().filter(|o| o.known).map(Solid::of).collect(),
            boundary: run.world.boundary.clone(),
            shell: ShellZone::new(&run.world.boundary, CRITICAL_ZONE_M),
            area: SweptArea::new(&run.world.boundary),
            last: run.mission.start,
        }
    }

    /// Adds a plan for the remaining floor; it replaces the previous plan.
    pub fn plan(&mut self, path: &[Point], cuts: &[Vec<Point>], is_whole: bool) {
        self.leave_behind();
        let path = sampled(path, PIECE_M);
        let stations_m = world::polyline::stations_m(&path);
        let mut plan = Planned {
            length_m: stations_m.last().copied().unwrap_or(0.0),
            flown_m: self.plan.flown_m + self.plan.along_m,
            is_whole,
            cuts: cuts.to_vec(),
            ..Planned::none(self.grid.len())
        };
        for (pair, end_m) in
            path.windows(2).zip(stations_m.iter().skip(1)).filter(|(pair, _)| pair[0] != pair[1])
        {
            let ahead = pair[1] - pair[0];
            let at = |position| Pose { position, heading_rad: ahead.y.atan2(ahead.x) };
            for index in self.grid.cells_under(self.tool, at(pair[0]), at(pair[1])) {
                plan.due_m[index] = *end_m as f32;
            }
        }
        self.before = Some(Box::new(std::mem::replace(&mut self.plan, plan)));
    }

    /// Drops the latest plan because it is not run; the previous plan remains valid.
    pub fn refuse_plan(&mut self) {
        if let Some(before) = self.before.take() {
            self.plan = *before;
        }
    }

    /// Sets the robot's progress along the plan, metres.
    pub fn fly(&mut self, along_m: f64) {
        self.before = None;
        self.plan.along_m = self.plan.along_m.max(along_m);
    }

    /// Sets the progress, given as a share of the distance driven before this plan plus the length of this plan.
    pub fn fly_share(&mut self, done: f64) {
        let Planned { length_m, flown_m, .. } = self.plan;
        self.fly(done * (flown_m + length_m) - flown_m);
    }

    /// Records that the mission is complete: the robot has driven to the end of the plan, to within the mission's tolerance.
    pub fn complete(&mut self) {
        self.fly(self.plan.length_m);
    }

    /// Cells that the robot passed while following a plan stay marked when a new plan is made.
    fn leave_behind(&mut self) {
        for (passed, due_m) in self.passed.iter_mut().zip(&self.plan.due_m) {
            *passed |= self.plan.is_past(*due_m);
        }
    }

    /// Adds the estimated position with its 95 % error, metres, and whether the floor that the tool has passed over
    /// since the last position counts as scanned.
    pub fn visit(&mut self, here: Pose, error_m: f64, counts: bool) {
        let before = std::mem::replace(&mut self.last, here);
        self.error_m = error_m;
        if counts {
            for part in &self.live {
                self.shell.pass(part.tool(), part.at(before), part.at(here));
                self.area.pass(part.tool(), part.at(before), part.at(here));
            }
            for (channel, part) in &self.blind {
                for index in self.grid.cells_under(part.tool(), part.at(before), part.at(here)) {
                    self.passed_blind[index] = self.passed_blind[index].min(*channel);
                }
            }
        }
    }

    /// Forgets where the tool went, so that it can go there again; plans and other evidence stay.
    pub(crate) fn begin_again(&mut self, start: Pose) {
        self.live = vec![ToolPart::whole(self.tool)];
        self.blind.clear();
        self.passed_blind.fill(NEVER);
        self.shell = ShellZone::new(&self.boundary, CRITICAL_ZONE_M);
        self.area = SweptArea::new(&self.boundary);
        self.last = start;
    }

    /// From now on, these channels of the tool are dead.
    pub fn test_with(&mut self, channels: &Channels) {
        self.live = channels.live(0.0);
        self.blind = channels.blind(self.grid.rim_m());
    }

    /// The dead channel that passed a cell; `None` if there was none.
    pub(crate) fn dead_channel(&self, index: usize) -> Option<u16> {
        Some(self.passed_blind[index]).filter(|channel| *channel != NEVER)
    }

    /// The scanned state of the critical zone, stretch by stretch along the shell.
    pub fn shell(&self) -> Vec<ShellStretch> {
        let solid: Vec<&Solid> = self.solids().filter(|solid| self.shell.is_beside(&solid.shape)).collect();
        self.shell.profile(|point| solid.iter().any(|solid| solid.shape.distance_m(point) < 0.0))
    }

    /// The scanned share of the reachable floor, from the exact area that the tool swept, 0 to 1; `None` if there is
    /// no reachable floor.
    pub fn exact_share(&self, floor: &FloorMaker) -> Option<f64> {
        let shapes: Vec<Shape> = self.solids().map(|solid| solid.shape.clone()).collect();
        self.area.share_of(floor, &self.boundary, &shapes)
    }

    /// The no-go zones.
    pub fn no_go(&self) -> impl Iterator<Item = &Solid> {
        self.no_go.iter()
    }

    /// All solid objects on the floor, as known.
    fn solids(&self) -> impl Iterator<Item = &Solid> {
        self.drawn.iter().chain(self.found.iter().map(|(_, solid)| solid))
    }

    /// Adds a pass of the tool that did not count.
    pub fn leave_uncounted(&mut self, runs: &[CellRun]) {
        let error_mm = (1000.0 * self.error_m).ceil().min(f64::from(NEVER - 1)) as u16;
        for CellRun(first, count) in runs {
            let first = (*first as usize).min(self.uncertain_mm.len());
            let end = first.saturating_add(*count as usize).min(self.uncertain_mm.len());
            self.uncertain_mm[first..end].iter_mut().for_each(|mm| *mm = (*mm).min(error_mm));
        }
    }

    /// Adds a found obstacle, or corrects its position.
    pub fn find(&mut self, obstacle: &Obstacle) {
        self.found.retain(|(id, _)| *id != obstacle.id);
        self.found.push((obstacle.id, Solid::of(obstacle)));
    }

    /// Adds a no-go zone that was drawn; `words` describe it.
    pub fn forbid(&mut self, words: String, outline: &Shape) {
        self.no_go.push(Solid { name: words, shape: outline.clone() });
    }

    /// Marks cells whose class was changed by the zone that was drawn last.
    pub fn shut(&mut self, changes: &[KindRun]) {
        let zone = u16::try_from(self.no_go.len().saturating_sub(1)).unwrap_or(OF_NONE);
        for KindRun(kind, first, count) in changes {
            let first = (*first as usize).min(self.shut_by.len());
            let end = first.saturating_add(*count as usize).min(self.shut_by.len());
            if *kind != Cell::Reachable {
                self.shut_by[first..end].fill(zone);
            }
        }
    }

    /// The zone that made a cell unreachable when it was drawn; `None` if there is none.
    pub(super) fn shut_by(&self, index: usize) -> Option<&Solid> {
        self.no_go.get(usize::from(self.shut_by[index]))
    }

    /// The no-go zone nearest to a position and its distance, metres; `None` without zones.
    pub(super) fn nearest_no_go(&self, place: Point) -> Option<(&Solid, f64)> {
        let all = self.no_go.iter().map(|zone| (zone, zone.shape.distance_m(place)));
        all.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Adds the plans and movements of another run on the same floor.
    pub fn join(&mut self, other: &Self) {
        let or = |own: &mut [bool], others: &[bool]| own.iter_mut().zip(others).for_each(|(a, b)| *a |= b);
        for (index, due_m) in self.plan.due_m.iter_mut().enumerate() {
            self.passed[index] |= other.is_passed(index);
            if let Some(ahead_m) = other.ahead_m(index).filter(|_| due_m.is_nan()) {
                *due_m = (self.plan.along_m + ahead_m) as f32;
            }
        }
        self.plan.is_whole &= other.plan.is_whole;
        self.plan.cuts.extend(other.plan.cuts.iter().cloned());
        for (own, other) in self.uncertain_mm.iter_mut().zip(&other.uncertain_mm) {
            *own = (*own).min(*other);
        }
        for (own, other) in self.passed_blind.iter_mut().zip(&other.passed_blind) {
            *own = (*own).min(*other);
        }
        self.asked = match (self.asked.take(), &other.asked) {
            (Some(mut asked), Some(others)) => {
                or(&mut asked, others);
                Some(asked)
            }
            _ => None,
        };
        self.found.extend(other.found.iter().cloned());
        self.join_zones(other);
        self.shell.join(&other.shell);
        self.area.join(&other.area);
    }

    /// Adds the zones of another run; zones of a scenario that both runs share have the same names.
    fn join_zones(&mut self, other: &Self) {
        let mut index_of = Vec::new();
        for zone in &other.no_go {
            let known = self.no_go.iter().position(|own| own.shape == zone.shape);
            index_of.push(known.unwrap_or(self.no_go.len()));
            if known.is_none() {
                self.no_go.push(zone.clone());
            }
        }
        for (own, theirs) in self.shut_by.iter_mut().zip(&other.shut_by).filter(|(own, _)| **own == OF_NONE) {
            let index = index_of.get(usize::from(*theirs)).and_then(|index| u16::try_from(*index).ok());
            *own = index.unwrap_or(OF_NONE);
        }
    }

    /// Renames the found obstacles.
    pub fn name_found(&mut self, name: impl Fn(&str) -> String) {
        for (_, solid) in &mut self.found {
            solid.name = name(&solid.name);
        }
    }

    /// The obstacles found during the run.
    pub fn found(&self) -> impl Iterator<Item = (ObstacleId, &Solid)> {
        self.found.iter().map(|(id, solid)| (*id, solid))
    }

    /// Whether the whole floor had to be scanned.
    pub fn asks_for_everything(&self) -> bool {
        self.asked.is_none()
    }

    /// Whether a cell had to be scanned.
    pub fn is_asked(&self, index: usize) -> bool {
        self.asked.as_ref().is_none_or(|asked| asked[index])
    }

    /// The reasons for the missed cells of this run.
    pub fn reasons(&self, run: &RunOpened) -> Reasons<'_> {
        let cable = run.mission.cable_reach().filter(|_| !self.plan.is_whole);
        let reach = cable.map(|(anchor, reach_m)| {
            let shapes: Vec<Shape> = self.solids().map(|solid| solid.shape.clone()).collect();
            Reach::new(anchor, &run.world.boundary, &shapes, reach_m)
        });
        let mission = &run.mission;
        Reasons {
            evidence: self,
            reach,
            has_tether: mission.tether.is_some(),
            lane_m: mission.lane_m(),
            room_m: mission.room_m(),
            limit_m: mission.scan_limit_m(),
        }
    }

    /// The smallest 95 % error of an uncounted pass over a cell, metres; `None` if there was none.
    pub(super) fn uncertain_m(&self, index: usize) -> Option<f64> {
        Some(self.uncertain_mm[index]).filter(|mm| *mm != NEVER).map(|mm| f64::from(mm) / 1000.0)
    }

    /// Name and distance of the nearest solid object, including the shell, metres.
    pub fn nearest_solid(&self, place: Point) -> (&str, f64) {
        let obstacles = self.solids().map(|solid| (solid.name.as_str(), solid.shape.distance_m(place)));
        let shell = ("the shell", self.boundary.wall_distance_m(place));
        obstacles.fold(shell, |least, other| if other.1 < least.1 { other } else { least })
    }

    /// Like [`Self::nearest_solid`], but includes no-go zones, from which the robot keeps the same distance.
    pub(super) fn nearest_kept_from(&self, place: Point) -> (&str, f64) {
        let solid = self.nearest_solid(place);
        let zone = self.nearest_no_go(place).map(|(zone, m)| (zone.name.as_str(), m));
        zone.filter(|(_, m)| *m < solid.1).unwrap_or(solid)
    }

    /// Name and distance of the found obstacle nearest to a position, metres; `None` without found obstacles.
    pub(super) fn nearest_found(&self, place: Point) -> Option<(&str, f64)> {
        let all = self.found.iter().map(|(_, solid)| (solid.name.as_str(), solid.shape.distance_m(place)));
        all.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Whether a found obstacle is a cause of missed floor at a position.
    pub(super) fn is_beside_found(&self, place: Point) -> bool {
        self.found.iter().any(|(_, solid)| solid.shape.distance_m(place) <= self.beside_m)
    }

    /// The cuts of the plan: lines that the tethered robot does not cross.
    pub(super) fn cuts(&self) -> &[Vec<Point>] {
        &self.plan.cuts
    }

    /// Distance along the plan to a cell ahead, metres; `None` if the cell is not ahead.
    pub(super) fn ahead_m(&self, index: usize) -> Option<f64> {
        self.is_ahead(index).then(|| f64::from(self.plan.due_m[index]) - self.plan.along_m)
    }

    /// Whether a plan led to a cell and the robot passed the cell while following the plan.
    pub(super) fn is_passed(&self, index: usize) -> bool {
        self.passed[index] || self.plan.is_past(self.plan.due_m[index])
    }

    /// Whether there was ever a plan.
    pub(super) fn has_plan(&self) -> bool {
        self.plan.length_m > 0.0 || self.plan.flown_m > 0.0 || self.passed.contains(&true)
    }

    /// Whether the plan leads to a cell beyond the robot's progress.
    pub(super) fn is_ahead(&self, index: usize) -> bool {
        !self.plan.due_m[index].is_nan() && !self.plan.is_past(self.plan.due_m[index])
    }
}

/// A solid object on the floor.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Human-readable name of the object.
    pub name: String,
    /// Outline of the object, tank frame.
    pub shape: Shape,
}

impl Solid {
    fn of(obstacle: &Obstacle) -> Self {
        Self { name: obstacle.name.clone(), shape: obstacle.shape.clone() }
    }
}

/// A plan and the progress along it.
#[derive(Debug, Clone)]
struct Planned {
    /// For each cell, the distance along the plan at which the plan last passes over the cell, metres; NaN for cells
    /// that the plan does not pass near.
    due_m: Vec<f32>,
    /// Length of the plan, metres.
    length_m: f64,
    /// The robot's progress along the plan, metres.
    along_m: f64,
    /// Distance driven along earlier plans, metres.
    flown_m: f64,
    /// Whether the plan was for all remaining floor.
    is_whole: bool,
    /// The cuts: lines that the tethered robot does not cross.
    cuts: Vec<Vec<Point>>,
}

impl Planned {
    fn none(cells: usize) -> Self {
        let due_m = vec![f32::NAN; cells];
        Self { due_m, length_m: 0.0, along_m: 0.0, flown_m: 0.0, is_whole: true, cuts: Vec::new() }
    }

    /// Whether the robot passed a cell while following the plan; never true for a cell that the plan does not pass
    /// near.
    fn is_past(&self, due_m: f32) -> bool {
        f64::from(due_m) <= self.along_m + NEARLY_M
    }
}

/// The no-go zones of a scenario.
fn no_go_zones(run: &RunOpened) -> Vec<Solid> {
    let zones = run.world.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo);
    zones.map(|zone| Solid { name: format!("no-go zone {}", zone.name), shape: zone.shape.clone() }).collect()
}

fn asked(run: &RunOpened) -> Option<Vec<bool>> {
    match &run.mission.task {
        TaskConfig::Cover { regions, .. } => world::coverage::regions::cells_within(&run.floor, regions),
        TaskConfig::Goto { .. } | TaskConfig::Follow { .. } | TaskConfig::Survey { .. } => None,
    }
}
