//! The open run, and the communication between the operator and its mission.

use super::{
    Combination, Earlier, Health, Plans, Preflight, Raster, Replay, Run, Speed, Together, WhatIf, together,
};
use account::{Account, Area, Estimate, InDoubt, LeftOut, MissReason, Shares, Summary, TakenBack};
use mission::{AskId, Order, Phase, WayBack, ZoneCost};
use serde::{Deserialize, Serialize};
use world::{CellRun, Point, StationId};

/// The id of a run opened since the console was started; 0 means none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
pub struct RunId(pub u32);

/// What the console can do with the open run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Access {
    /// Give orders to the mission.
    #[default]
    Control,
    /// Watch the run through the journal that another console writes or has written.
    LookOnly,
    /// Replay a past run.
    Replay,
}

/// The source of a scenario.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Source {
    /// The built-in demo, with the changes made on the command line.
    Demo,
    /// A scenario file.
    File(String),
    /// A re-scan of what past runs missed; the names of their folders.
    Rescan(Vec<String>),
}

/// Long work by a planner; meanwhile ticks continue and HOLD works.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Busy {
    /// The kind of work, such as `Planning (rpf)`.
    pub work: String,
    /// The time limit, seconds; `None` for short work.
    pub limit_s: Option<f64>,
    /// When the work began, on the console's own clock, seconds.
    pub since_mono_s: f64,
    /// Progress: the share done, 0 to 1, and the current activity; `None` if it is not reported.
    #[serde(default)]
    pub at: Option<(f64, String)>,
}

impl Busy {
    /// The work and its progress: `Planning (rpf) 23 %`.
    pub fn how_far(&self) -> String {
        // 100 % is shown only at the very end.
        let percent = |share: f64| format!(" {} %", (100.0 * share).floor().clamp(0.0, 99.0));
        let share = self.at.as_ref().map_or_else(String::new, |(share, _)| percent(*share));
        format!("{}{share}", self.work)
    }
}

/// What remains of a run that has ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunResult {
    /// The report of the run.
    pub summary: Box<Summary>,
    /// The name of the run's folder; `None` if the run was not recorded.
    pub name: Option<String>,
    /// The message that says where the run is stored, or why it is not stored.
    pub kept: String,
    /// Whether the run is stored.
    pub is_kept: bool,
}

/// The open run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Live {
    /// The id of the run.
    pub id: RunId,
    /// Whether orders can be given.
    #[serde(default)]
    pub access: Access,
    /// The source of the scenario; `None` until one is opened.
    pub source: Option<Source>,
    /// Whether the scenario is being read and its floor is being laid out.
    pub is_opening: bool,
    /// Why the scenario could not be opened, with file, line and key.
    pub failure: Option<String>,
    /// The previously open run, while this one is being opened; the previous run stays open if opening fails.
    #[serde(default)]
    pub before: Option<Box<Live>>,
    /// The run, folded from its events.
    pub run: Run,
    /// The plans before the start.
    pub plans: Plans,
    /// The pre-flight check.
    pub preflight: Preflight,
    /// Forecasts of how the held mission would continue; `None` until they are requested.
    pub what_if: Option<WhatIf>,
    /// The way back, computed before the robot is ordered to take it, or the reason why there is none, as a sentence;
    /// `None` until either is known.
    #[serde(default)]
    pub way_back: Option<Result<WayBack, String>>,
    /// The floor whose guarantee was taken back so far, oldest first, as the engine states it.
    #[serde(default)]
    pub in_doubt: Vec<InDoubt>,
    /// The cost of the no-go zone that was drawn; `None` until it is known.
    #[serde(default)]
    pub zone_cost: Option<ZoneCost>,
    /// Whether the console that runs the mission has exited, so no more events will come.
    #[serde(default)]
    pub is_cut_off: bool,
    /// The requested speed of the mission.
    pub speed: Speed,
    /// The speed to which the mission returns when the better plan on offer has been decided; `None` if the mission was
    /// not slowed down for that plan.
    #[serde(default)]
    pub slowed_from: Option<Speed>,
    /// The health of the engine.
    pub health: Health,
    /// The work that a planner is doing.
    pub busy: Option<Busy>,
    /// An order that makes the robot move and that the mission has not answered yet.
    pub asked: Option<Order>,
    /// Whether HOLD was sent but has not been answered yet.
    pub hold_asked: bool,
    /// When the last events arrived, on the console's own clock, seconds.
    pub heard_mono_s: f64,
    /// The result of the run, once it has ended and its files are closed.
    pub result: Option<RunResult>,
    /// For a re-scan: the names of the runs before it, oldest first; empty until they are known, and for any other run.
    #[serde(default)]
    pub earlier: Vec<String>,
    /// For a re-scan: what the runs before it have scanned, until the floor of this run is known.
    #[serde(default)]
    pub read_before: Option<Box<Combination>>,
    /// For a re-scan: the floor that the runs before it have scanned, once it is known.
    #[serde(default)]
    pub scanned_before: Option<Box<Earlier>>,
    /// For a re-scan: where the last run before it left the robot, metres, tank frame; `None` if this place is not
    /// known.
    #[serde(default)]
    pub left_at: Option<Point>,
    /// For a re-scan: the floor that this run and the runs before it have scanned together, or why this floor cannot be
    /// computed.
    #[serde(default)]
    pub combined: Option<Result<Box<Together>, String>>,
    /// The replay, if the run is a replay.
    #[serde(default)]
    pub replay: Option<Box<Replay>>,
}

impl Live {
    /// Whether this console cannot give orders, because it is view-only or replays a past run.
    pub fn is_look_only(&self) -> bool {
        self.access != Access::Control
    }

    /// Whether a past run is being replayed.
    pub fn is_replay(&self) -> bool {
        self.access == Access::Replay
    }

    /// Whether the robot moves or may start to move: automatically, or because of an order that was confirmed or sent
    /// but not yet answered.
    pub fn may_move(&self) -> bool {
        let may_move = self.run.phase().may_move() || self.asked.is_some() || self.preflight.is_starting;
        may_move && !self.is_look_only()
    }

    /// The estimate for the plan that would run now; `None` if the estimate is not known yet.
    pub fn estimate(&self) -> Option<&Estimate> {
        let (ask, estimate) = self.plans.estimate.as_ref()?;
        (self.run.planning.plan.as_ref()?.ask == *ask).then_some(estimate)
    }

    /// The figures promised for the plan that would run now or, once the mission has started, for the plan with which
    /// it started; `None` if the figures are not known.
    pub fn promised(&self) -> Option<&Estimate> {
        let started = *self.run.phase() != Phase::Waiting;
        self.estimate().or_else(|| Some(&self.plans.estimate.as_ref().filter(|_| started)?.1))
    }

    /// Estimated remaining mission time, seconds: from the pace so far or, until that is known, from the promise of the
    /// plan; `None` if neither is known, or the run has ended.
    pub fn left_s(&self) -> Option<f64> {
        let done = self.run.progress.as_ref().map_or(0.0, |progress| progress.done);
        let to_do = 1.0 - done.clamp(0.0, 1.0);
        // A plan made on the way has no estimate; it is driven at the pace promised for the plan with which the mission
        // began.
        let at_pace = || {
            let (estimate, plan) = (self.promised()?, self.run.planning.plan.as_ref()?);
            let pace_s_per_m = estimate.time_s / estimate.length_m;
            (estimate.length_m > 0.0).then_some(pace_s_per_m * to_do * (plan.driven_m + plan.length_m))
        };
        let promised = || self.estimate().map(|estimate| estimate.time_s * to_do).or_else(at_pace);
        self.run.left_s().or_else(|| promised().filter(|_| !self.run.has_ended()))
    }

    /// The requested floor that stays out with the current plan or, until that is known, with the plan of the start;
    /// `None` if it is not known, or nothing is to be scanned.
    pub fn left_out(&self) -> Option<&LeftOut> {
        self.left_out_by_plan().or_else(|| self.left_out_at_start())
    }

    /// The requested floor that stays out with the current plan; `None` if it is not known.
    pub fn left_out_by_plan(&self) -> Option<&LeftOut> {
        let current = self.run.planning.plan.as_ref()?.ask;
        let known = [&self.plans.left_out_now, &self.plans.left_out].into_iter().flatten();
        known.filter(|(ask, _)| *ask == current).map(|(_, left_out)| left_out).next()
    }

    /// The requested floor that the plan of the start leaves out; `None` before the start, or if it is not known.
    pub fn left_out_at_start(&self) -> Option<&LeftOut> {
        let (_, left_out) = self.plans.left_out.as_ref()?;
        (*self.run.phase() != Phase::Waiting).then_some(left_out)
    }

    /// Takes the figures that a plan promises.
    pub(crate) fn promises(&mut self, ask: Option<AskId>, estimate: Estimate) {
        let plan = self.run.planning.plan.as_ref().filter(|plan| plan.ask == ask);
        self.plans.lanes = plan.map_or(0, |plan| plan.lanes.len());
        self.plans.planner = self.run.planner_id().map(ToOwned::to_owned);
        self.plans.estimate = Some((ask, estimate));
    }

    /// Takes the floor that a plan leaves out; the first of a mission under way is that of the start.
    pub(crate) fn leaves_out(&mut self, ask: Option<AskId>, left_out: LeftOut) {
        let is_first = *self.run.phase() == Phase::Waiting || self.plans.left_out.is_none();
        let slot = if is_first { &mut self.plans.left_out } else { &mut self.plans.left_out_now };
        *slot = Some((ask, left_out));
    }

    /// The planner that promised the figures, if a different one drives now.
    pub fn promised_by_other(&self) -> Option<&str> {
        let promised = self.plans.planner.as_deref()?;
        (self.run.planner_id()? != promised).then_some(promised)
    }

    /// Whether the plan was made on the way, so that the promised figures are those of an earlier one.
    pub fn is_plan_of_the_way(&self) -> bool {
        let first = self.plans.left_out.as_ref().map(|(ask, _)| *ask);
        let now = self.run.planning.plan.as_ref().map(|plan| plan.ask);
        first.zip(now).is_some_and(|(first, now)| first != now)
    }

    /// Requested floor that was not scanned, in the order in which it is numbered.
    pub fn missed(&self) -> Vec<&Area<MissReason>> {
        self.floor().map(Account::listed).unwrap_or_default()
    }

    /// The floor whose guarantee was taken back until the moment that is shown, oldest first. The report of a replayed run
    /// does not state the places.
    pub fn in_doubt(&self) -> Vec<InDoubt> {
        let reported = || self.result.iter().flat_map(|result| &result.summary.taken_back);
        let until_now = |floor: &&TakenBack| floor.until_s <= self.run.clock.t_s;
        match &self.in_doubt[..] {
            [] => {
                let listed =
                    |floor: &TakenBack| InDoubt { floor: floor.clone(), at: None, cells: Vec::new() };
                reported().filter(until_now).map(listed).collect()
            }
            floor => floor.to_vec(),
        }
    }

    /// The area of the floor in doubt, square metres, and the stations that were wrong, by name; `None` if no floor is in
    /// doubt. Floor that a later pass guarantees counts until the run has ended. After a re-scan, the floor of all runs together
    /// counts.
    pub fn doubt(&self) -> Option<(f64, String)> {
        let all = self.in_doubt();
        let own_m2 = all.iter().map(|doubt| doubt.floor.left_m2.unwrap_or(doubt.floor.area_m2)).sum();
        let of_all = self.together().and_then(|all| all.taken_back.as_ref());
        let area_m2: f64 = of_all.map_or(own_m2, |floor| (floor.area_m2 - floor.again_m2).max(0.0));
        let mut stations: Vec<&str> = all.iter().map(|doubt| doubt.floor.station.as_str()).collect();
        stations.dedup();
        (area_m2 > 0.0).then(|| (area_m2, stations.join(" ")))
    }

    /// The middle of the largest floor that a station has put in doubt, metres, tank frame; `None` if the station has put none
    /// in doubt.
    pub fn place_in_doubt(&self, station: StationId) -> Option<Point> {
        let name = self.run.station_name(station);
        let own = self.in_doubt.iter().filter(|doubt| doubt.floor.station == name && doubt.at.is_some());
        own.max_by(|a, b| a.floor.area_m2.total_cmp(&b.floor.area_m2))?.at
    }

    /// For each cell of a floor with `len` cells, whether it is in doubt. Empty if no floor is, and for a replay, whose
    /// report states only the areas.
    pub fn doubtful(&self, len: usize) -> Vec<bool> {
        let runs: Vec<CellRun> = self.in_doubt.iter().flat_map(|doubt| doubt.cells.clone()).collect();
        let mut marked = vec![false; if runs.is_empty() { 0 } else { len }];
        together::mark(&runs, &mut marked);
        marked
    }

    /// The part of the reachable floor that was requested of this run. `None` if all of it was requested, or if the
    /// account is not known.
    pub fn requested(&self) -> Option<&Shares> {
        self.result.as_ref()?.summary.floor.as_ref()?.requested.as_ref()
    }

    /// Whether the mission continues earlier runs.
    pub fn is_rescan(&self) -> bool {
        !self.earlier.is_empty() || self.scanned_before.is_some()
    }

    /// Whether the run has ended and did not have to scan, so that its result says nothing about the floor.
    pub fn is_without_scan(&self) -> bool {
        let has_floor = self.floor().is_some_and(|floor| !floor.is_of_no_scan());
        self.result.is_some() && !self.run.covers() && !has_floor
    }

    /// Reachable floor that was neither requested nor scanned, square metres.
    pub fn not_requested_m2(&self) -> f64 {
        self.floor().map_or(0.0, Account::not_asked_m2)
    }

    /// The account of the floor; for a re-scan, the account over all runs as soon as it is known.
    pub fn floor(&self) -> Option<&Account> {
        let combined = self.together().map(|together| &together.floor);
        combined.or_else(|| self.result.as_ref()?.summary.floor.as_ref())
    }

    /// The combined scan of this re-scan and the runs before it, as soon as it is known.
    pub fn together(&self) -> Option<&Together> {
        self.combined.iter().flatten().map(|together| &**together).next()
    }

    /// Prepares the floor that earlier runs have scanned, as soon as both it and the floor of this run are known.
    pub(crate) fn lay_before(&mut self) {
        let (Some(own), Some(about)) = (&self.run.coverage, &self.run.about) else { return };
        if let Some(read) = self.read_before.take() {
            self.scanned_before = Some(Box::new(Earlier::new(&read, own, &about.mission)));
        }
    }

    /// The scanned floor; for a re-scan that has ended, the floor scanned by all runs as soon as it is known.
    pub fn scanned(&self) -> Option<&Raster> {
        let together = self.together().and_then(|together| together.raster.as_ref());
        together.or(self.run.coverage.as_ref())
    }

    /// The names of the runs that this run re-scans, followed by its own; `None` if `run` names a different run, or
    /// this run is not a re-scan or has not ended.
    pub fn with_earlier(&self, run: &str) -> Option<Vec<String>> {
        let is_open = self.result.as_ref().is_some_and(|result| result.name.as_deref() == Some(run));
        let earlier = Some(&self.earlier).filter(|earlier| is_open && !earlier.is_empty())?;
        Some(earlier.iter().cloned().chain([run.to_owned()]).collect())
    }

    /// The missed area at a place.
    pub fn missed_area(&self, at: Point) -> Option<&Area<MissReason>> {
        smallest_at(self.areas(), at)
    }

    /// The area at a place that the promised plan leaves out.
    pub fn left_out_area(&self, at: Point) -> Option<&Area<MissReason>> {
        smallest_at(self.left_out()?.areas.iter(), at)
    }

    fn areas(&self) -> impl Iterator<Item = &Area<MissReason>> {
        self.floor().into_iter().flat_map(|floor| &floor.missed)
    }

    /// Whether the scenario is still being read.
    pub fn is_loading(&self) -> bool {
        self.source.is_some() && self.run.about.is_none() && self.failure.is_none()
    }

    /// Whether the first plan was ordered and has not arrived.
    pub fn awaits_plan(&self) -> bool {
        self.plans.is_asked && self.run.planning.plan.is_none() && self.run.planning.fault.is_none()
    }

    /// Whether the mission is waiting for its start.
    pub fn waits(&self) -> bool {
        self.run.about.is_some() && *self.run.phase() == Phase::Waiting && !self.is_look_only()
    }

    /// Whether leaving would abort a mission: one that has started but not ended, or one whose start was requested.
    pub fn is_under_way(&self) -> bool {
        let is_open = *self.run.phase() != Phase::Waiting || self.may_move();
        is_open && !self.run.has_ended() && !self.is_look_only()
    }

    /// Records that the mission accepted or refused an order. Only this ends the wait for an answer: events from an
    /// earlier tick may arrive after the order was sent.
    pub(crate) fn answered(&mut self, order: &Order) {
        if self.asked.as_ref() == Some(order) {
            self.asked = None;
        }
        if *order == Order::Hold {
            self.hold_asked = false;
        }
        if *order == Order::Plan {
            self.plans.is_asked = false;
        }
    }
}

/// The smallest of the areas whose bounding box contains a place.
fn smallest_at<'a>(
    areas: impl Iterator<Item = &'a Area<MissReason>>,
    at: Point,
) -> Option<&'a Area<MissReason>> {
    let is_inside = |area: &&Area<MissReason>| {
        let within = |low: f64, value: f64, high: f64| low <= value && value <= high;
        within(area.low.x, at.x, area.high.x) && within(area.low.y, at.y, area.high.y)
    };
    areas.filter(is_inside).min_by(|one, other| one.area_m2.total_cmp(&other.area_m2))
}
