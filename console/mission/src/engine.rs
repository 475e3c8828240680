//! The engine: what is sensed and ordered goes in, what the robot does and everything that happened comes out.

mod driving;
mod orders;
mod planning;
mod scanning;
mod tethering;

use crate::{
    chart::Chart,
    config::{MissionConfig, PlannerChoice},
    event::{Event, EventKind, HoldReason, Outcome, TetherAlarm},
    follower::Follower,
    locate::Locator,
    order::Order,
    planner::{PlannerInfo, PlannerLink},
    task::{StuckWatch, Task},
    tether::Tether,
};
use planner_api::{Drive, Reason};
use tethering::{Caught, Cuts};
use world::{CoverageGrid, Floor, FloorMaker, Point, Readings, World};

/// A robot that is stuck again within this distance is stuck in the same place, metres.
const SAME_PLACE_M: f64 = 1.0;

/// What enters the engine in one tick.
#[derive(Debug, Clone, Copy)]
pub struct Input<'a> {
    /// What was sensed since the last tick.
    pub readings: &'a Readings,
    /// What the operator said since the last tick, oldest first.
    pub orders: &'a [Order],
}

/// What leaves the engine in one tick.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// How the robot shall move until the next tick, within its limits and in its own way of moving.
    pub drive: Drive,
    /// Everything that happened, in order.
    pub events: Vec<Event>,
}

/// A mission under way.
///
/// Costs per tick: one planner call, one position update, and work that grows with the obstacles in sensing range and
/// the cells under the swath. Memory grows by one point per decimetre flown.
pub struct Mission {
    config: MissionConfig,
    tick: u64,
    phase: Phase,
    locator: Locator,
    chart: Chart,
    task: Task,
    coverage: CoverageGrid,
    /// Makes the floor anew when an obstacle was found; made for the first one.
    surveyor: Option<FloorMaker>,
    /// `None` without a tether, or if its anchor cannot be.
    tether: Option<Tether>,
    /// What the plan keeps to.
    cuts: Cuts,
    /// What the cable reached in this tick.
    cable_trouble: Option<TetherAlarm>,
    /// For how long the robot has been held because it has no way home, seconds; `None` if that is not why.
    waits_for_home_s: Option<f64>,
    planner: Seat,
    /// When the planner answered a step too late the last time, seconds.
    late_at_s: Option<f64>,
    stuck: StuckWatch,
    lost_s: f64,
    /// For how long the planner has said that it is stuck, seconds.
    blocked_s: f64,
    /// For how long an operator has let the mission wait, seconds.
    waited_s: f64,
    /// Where it said so last, and how often there.
    blocked_at: Option<(Point, usize)>,
    /// Where the cable held the robot last.
    caught: Option<Caught>,
    /// Where the robot was stuck last and got another plan.
    replanned_at: Option<Point>,
    trail: Vec<Point>,
    plan: Option<Follower>,
    /// Whether the plan under way was for all that is left of the task.
    plan_is_whole: bool,
    last_drive: Drive,
    happened: Vec<EventKind>,
    /// Told when everything else of the tick has been told.
    ending: Option<EventKind>,
}

/// What the mission is doing.
#[derive(Debug, Clone, PartialEq)]
pub enum Phase {
    /// Nothing has been started.
    Waiting,
    /// The robot moves.
    Running,
    /// The robot moves for this one tick.
    Stepping,
    /// The robot stands still and may go on.
    Held(HoldReason),
    /// It is over.
    Ended(Outcome),
}

/// The planner that drives.
struct Seat {
    choice: PlannerChoice,
    info: Option<PlannerInfo>,
    /// Whether it is loaded, configured and has not failed since.
    fit: bool,
    /// Whether the automatic replacement after a fault has been used.
    fallback_used: bool,
    /// Whether its last plan was refused because of the tether.
    refused: bool,
    /// Whether its plan is still to be made, or made for a map that has changed since.
    plan_due: Option<Reason>,
}

impl Mission {
    /// A mission that waits for [`Order::Start`].
    ///
    /// `drawing` is the tank as drawn, `floor` its grid; `seed` is handed to planners for their random choices.
    pub fn new(config: MissionConfig, drawing: World, floor: Floor, seed: u64) -> Self {
        let start = config.start.position;
        Self {
            tick: 0,
            tether: config
                .tether
                .as_ref()
                .and_then(|tether| Tether::new(tether, config.limits.radius_m, &drawing, start).ok()),
            cuts: Cuts::default(),
            cable_trouble: None,
            waits_for_home_s: None,
            phase: Phase::Waiting,
            locator: Locator::new(&config, &drawing),
            chart: Chart::new(drawing, &config, seed),
            task: Task::new(&config.task, start),
            coverage: CoverageGrid::new(floor),
            surveyor: None,
            planner: Seat {
                choice: config.planner.clone(),
                info: None,
                fit: false,
                fallback_used: false,
                refused: false,
                plan_due: Some(Reason::Start),
            },
            late_at_s: None,
            stuck: StuckWatch::new(config.stuck_s),
            lost_s: 0.0,
            blocked_s: 0.0,
            waited_s: 0.0,
            blocked_at: None,
            caught: None,
            replanned_at: None,
            trail: vec![start],
            plan: None,
            plan_is_whole: true,
            last_drive: Drive::STILL,
            happened: Vec::new(),
            ending: None,
            config,
        }
    }

    /// What the mission is doing.
    pub fn phase(&self) -> &Phase {
        &self.phase
    }

    /// One tick.
    pub fn step(&mut self, input: &Input<'_>, planner: &mut dyn PlannerLink) -> Step {
        for order in input.orders {
            self.obey(order, planner);
        }
        let before = self.locator.pose();
        let located = self.locator.take(input.readings);
        self.happened.extend(located);
        let map_changed = self.look_around(input.readings);
        self.scan_from(before);
        self.drag_tether(map_changed, input.readings.paid_out_m);
        self.apply_rules(input.readings, planner);
        let drive = match self.phase {
            Phase::Running | Phase::Stepping => self.drive(planner),
            Phase::Waiting | Phase::Held(_) | Phase::Ended(_) => Drive::STILL,
        };
        if self.phase == Phase::Stepping {
            self.hold(HoldReason::Stepped);
        }
        self.finish_tick(drive)
    }

    fn finish_tick(&mut self, drive: Drive) -> Step {
        let (tick, t_s) = (self.tick, self.now_s());
        let mut happened = std::mem::take(&mut self.happened);
        happened.extend(self.ending.take());
        let events = happened.into_iter().map(|kind| Event { tick, t_s, kind }).collect();
        self.tick += 1;
        self.last_drive = drive;
        Step { drive, events }
    }

    fn now_s(&self) -> f64 {
        self.tick as f64 * self.config.tick_s
    }

    /// The rules that hold the robot, let it go on, or end the mission.
    fn apply_rules(&mut self, readings: &Readings, planner: &mut dyn PlannerLink) {
        // While somebody looks after a mission that is held, its time does not run out.
        if self.config.attended && matches!(self.phase, Phase::Held(_)) {
            self.waited_s += self.config.tick_s;
        }
        match self.phase.clone() {
            Phase::Waiting | Phase::Ended(_) => {}
            _ if readings.contact => self.end(Outcome::Collision, "the bumper touched something"),
            _ if self.now_s() - self.waited_s >= self.config.time_limit_s => {
                let reason = format!("time is up after {:.0} s", self.config.time_limit_s);
                self.end(Outcome::TimeLimit, &reason);
            }
            Phase::Running | Phase::Stepping => self.watch_moving(),
            Phase::Held(reason) => self.watch_held(&reason, planner),
        }
    }

    fn watch_moving(&mut self) {
        let here = self.locator.position();
        let (lost, alarmed) = (self.locator.is_lost(), self.locator.is_alarmed());
        self.lost_s = if lost || alarmed { self.lost_s + self.config.tick_s } else { 0.0 };
        if self.lost_s >= self.config.lost_hold_s && (lost || alarmed) {
            self.hold(if lost { HoldReason::PositionLost } else { HoldReason::PositionAlarmed });
        } else if self.task.is_done(here) {
            self.end_done();
        } else if self.watch_tether() {
            // Told and done.
        } else if self.stuck.is_stuck(&self.task, here, self.config.tick_s) {
            if !self.tries_another_plan(here) {
                self.stop_stuck(here);
            }
        } else {
            self.task.wait(self.config.tick_s);
        }
    }

    /// A robot that is stuck in its lanes gets another plan from where it stands, once at each place.
    fn tries_another_plan(&mut self, here: Point) -> bool {
        let tried = self.replanned_at.is_some_and(|at| (here - at).norm() < SAME_PLACE_M);
        if tried || !matches!(self.task, Task::Cover(_)) {
            return false;
        }
        self.replanned_at = Some(here);
        self.planner.plan_due.get_or_insert(Reason::Blocked);
        self.stuck.reset();
        true
    }

    /// An operator may know a way on; without one the mission is over.
    fn stop_stuck(&mut self, here: Point) {
        let done = self.task.done() * 100.0;
        let message = format!("no progress at {:.2}, {:.2} m, {done:.0} % done", here.x, here.y);
        if self.config.attended {
            self.hold(HoldReason::Stuck { message });
        } else {
            self.end(Outcome::Stuck, &message);
        }
    }

    fn watch_held(&mut self, reason: &HoldReason, planner: &mut dyn PlannerLink) {
        match reason {
            HoldReason::PositionLost | HoldReason::PositionAlarmed
                if !self.locator.is_lost() && !self.locator.is_alarmed() =>
            {
                self.go_on(Phase::Running);
            }
            HoldReason::PlannerFault { message } | HoldReason::PlanRefused { message } => {
                self.replace_failed_planner(message, planner);
            }
            HoldReason::PositionLost
            | HoldReason::PositionAlarmed
            | HoldReason::Operator
            | HoldReason::Stuck { .. }
            | HoldReason::Stepped => {}
            HoldReason::Tether { .. } => self.watch_way_home(),
        }
    }

    fn hold(&mut self, by: HoldReason) {
        if !matches!(by, HoldReason::Tether { .. }) {
            self.waits_for_home_s = None;
        }
        self.happened.push(EventKind::Held { by: by.clone() });
        self.phase = Phase::Held(by);
    }

    fn go_on(&mut self, how: Phase) {
        self.lost_s = 0.0;
        self.waits_for_home_s = None;
        self.stuck.reset();
        self.happened.push(EventKind::Resumed);
        self.phase = how;
    }

    fn end(&mut self, outcome: Outcome, reason: &str) {
        self.ending = Some(EventKind::Ended { outcome, reason: reason.into() });
        self.phase = Phase::Ended(outcome);
    }
}

#[cfg(test)]
mod tests;
