//! The engine. Its inputs are sensor readings, orders and answers from planners; its outputs are commands to the robot,
//! asks to planners, and events.
//!
//! A tick is [`Mission::sense`], any number of [`Mission::poll_ask`] and [`Mission::answer`], and [`Mission::act`]. The
//! mission never waits: an ask that is still open when [`Mission::act`] is called may be answered in any later tick. The
//! same inputs and answers in the same ticks produce the same events.

mod answers;
mod asks;
mod back;
mod better_plan;
mod candidate;
mod checking;
mod course;
mod driving;
mod finishing;
mod floor;
mod fork;
mod governing;
mod happened;
mod holding;
mod known;
mod orders;
mod planning;
mod preparing;
mod requests;
mod role;
mod rules;
mod scanning;
mod shadow;
mod stepping;
mod surveying;
mod tethering;
mod worker;
mod workers;
mod zones;

use crate::{
    ask::WorkerId,
    config::MissionConfig,
    event::{Event, EventKind, TetherAlarm},
    order::Order,
    phase::{Gait, HoldReason, Phase},
    standing::Standing,
    tether::Tether,
};
pub use driving::Sending;
use driving::{Driving, LeftPlan, Prepare};
pub use fork::Fork;
pub(crate) use governing::guarding::side;
use happened::Happened;
use known::Known;
use planner_api::{Drive, Reason};
use role::Preparing;
use rules::{Rules, Seen};
use shadow::Shadow;
use stepping::PlaceOnPlan;
use worker::Worker;
use workers::Workers;
use world::{CoverageGrid, Floor, Readings, World};

/// The inputs at the start of a tick.
#[derive(Debug, Clone, Copy)]
pub struct Input<'a> {
    /// Sensor readings since the last tick.
    pub readings: &'a Readings,
    /// Age of the newest readings of a real vehicle, seconds; 0 in a simulation.
    pub age_s: f64,
    /// Orders from the operator since the last tick, oldest first.
    pub orders: &'a [Order],
    /// The reason why a real vehicle must not be driven now, as a clause; `None` if it may be driven, and in a simulation.
    pub trouble: Option<&'a str>,
}

/// The outputs at the end of a tick.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The robot's motion until the next tick, within the robot's limits and in a form that it can execute.
    pub drive: Drive,
    /// All events of the tick, in order.
    pub events: Vec<Event>,
}

/// A mission in progress.
///
/// Cost per tick: one position update, plus work that grows with the number of obstacles in sensing range and of cells
/// under the swath. Memory grows by one point per decimetre driven.
#[derive(Clone)]
pub struct Mission {
    known: Known,
    rules: Rules,
    driving: Driving,
    /// A planner that is being prepared in the background.
    preparing: Option<Preparing>,
    /// The planner in shadow, if any.
    shadow: Option<Shadow>,
    /// Mission time at which the search for a better plan than the repaired one is to begin, seconds.
    better_plan_due_s: Option<f64>,
    /// The plan that was in use when the active planner took over.
    left: Option<LeftPlan>,
    workers: Workers,
    /// Where the robot was when it was ordered to move until something happens.
    stepped_from: Option<PlaceOnPlan>,
    happened: Happened,
}

impl Mission {
    /// Creates a mission that waits for [`Order::Start`].
    ///
    /// `drawing` is the tank as drawn, and `floor` its grid; planners receive `seed` for their random choices.
    pub fn new(config: MissionConfig, drawing: World, floor: Floor, seed: u64) -> Self {
        Self {
            rules: Rules::new(&config),
            driving: Driving::new(Worker::new(config.planner.clone()), Reason::Start, Prepare::No),
            preparing: None,
            shadow: None,
            better_plan_due_s: None,
            left: None,
            workers: Workers::default(),
            stepped_from: None,
            happened: Happened::default(),
            known: Known::new(config, drawing, floor, seed),
        }
    }

    /// The phase of the mission.
    pub fn phase(&self) -> &Phase {
        &self.known.phase
    }

    /// The floor, with the part that has been scanned so far.
    pub fn scanned(&self) -> &CoverageGrid {
        &self.known.floor.coverage
    }

    /// The estimated heading of the robot, radians.
    pub fn heading_rad(&self) -> f64 {
        self.known.locator.pose().heading_rad
    }

    /// The active planner or, before there is one, the planner that will be active first.
    pub fn planner_id(&self) -> &str {
        self.driving.id()
    }

    /// The conversion that a command would now undergo on its way to the robot.
    pub fn sending(&self) -> Sending {
        self.known.sending()
    }

    /// Those workers of the active planner and of the planner in shadow that have nothing to do; the console watches
    /// their processes.
    pub fn idle_workers(&self) -> impl Iterator<Item = WorkerId> {
        let shadow = self.shadow.as_ref().and_then(|shadow| shadow.worker.idle());
        self.driving.worker.idle().into_iter().chain(shadow)
    }

    /// Everything that decides whether an order is accepted now.
    pub fn standing(&self) -> Standing<'_> {
        Standing {
            phase: &self.known.phase,
            position: self.known.position_trust(),
            planner: self.driving.worker.seen(),
            shadow: self.shadow.as_ref().map(Shadow::standing),
            offer: self.offer_stage(),
            readiness: self.driving.readiness(&self.known),
            trouble: self.known.trouble.as_deref(),
            is_live: self.known.config.live,
            is_survey: self.known.config.task.is_survey(),
            from_plan_m: self.driving.course.first_from_m(&self.known),
        }
    }

    /// Begins a tick: carries out the orders, processes the sensor readings, and applies the rules. Call it once per
    /// tick, first.
    pub fn sense(&mut self, input: &Input<'_>) {
        self.known.trouble = input.trouble.map(ToOwned::to_owned);
        for order in input.orders {
            self.obey(order);
        }
        let before = self.known.locator.pose();
        let judged = self.known.channels.judge(input.readings.dead_channels.as_deref());
        self.happened.extend(judged.map(EventKind::ChannelsJudged));
        let located = self.known.locator.take(input.readings, self.known.now_s());
        self.happened.extend(located);
        self.note_last_pulses();
        self.happened.extend(self.known.take_pressure(input.readings.pressure_pa));
        self.known.take_scan(input.readings, input.age_s);
        let map_changed = self.look_around(input.readings);
        self.happened.extend(self.known.note_scan_fault());
        self.known.scan_from(before, &mut self.happened);
        self.known.explore(input.readings, &mut self.happened);
        let reached = self.known.drag_tether(map_changed, input.readings, &mut self.happened);
        self.watch_tether(map_changed);
        if map_changed {
            self.doubt_way_back();
        }
        let breached = self.known.watch_zones(&mut self.happened);
        self.apply_rules(input.readings, reached.as_ref(), breached.as_deref());
        if let Some(shadow) = &mut self.shadow {
            shadow.lead(&self.known, self.driving.id());
            self.promote_if_due();
        }
        self.lead_better_plan();
    }

    /// Ends a tick: returns the robot's motion until the next one, and all events. Call it once per tick, last.
    pub fn act(&mut self) -> Step {
        self.happened.extend(self.known.update_mode());
        let drive = self.drive();
        self.known.follow_drive(drive);
        self.end_step();
        let events = self.happened.report(self.known.tick, self.known.now_s());
        self.known.tick += 1;
        self.known.last_drive = drive;
        Step { drive, events }
    }

    /// Requests a new plan if the current one is no longer permitted with the tether as it lies now.
    fn watch_tether(&mut self, map_changed: bool) {
        if map_changed {
            self.driving.course.doubt_for_tether(&self.known);
        }
        if !self.known.phase.is_return() && self.driving.course.has_strayed(&self.known) {
            self.happened.push(EventKind::TetherAlarmRaised { alarm: TetherAlarm::Strayed, reached: false });
        }
    }

    /// Applies the rules that hold the robot, let it resume, or end the mission; the first rule that returns a verdict
    /// decides.
    fn apply_rules(&mut self, readings: &Readings, reached: Option<&TetherAlarm>, breached: Option<&str>) {
        if matches!(self.known.phase, Phase::Waiting | Phase::Ended(_)) {
            return;
        }
        if !readings.contact && (self.hold_in_trouble() || self.hold_by_guard()) {
            return;
        }
        let here = self.known.position();
        let back = self.known.back.as_ref().filter(|_| self.known.phase.is_return());
        let plan = self.driving.course.follower.as_ref();
        let seen = Seen {
            config: &self.known.config,
            now_s: self.known.now_s(),
            here,
            position: self.known.position_trust(),
            task: &self.known.task,
            plan_left_m: back.map_or_else(|| self.known.way_left_m(plan), |back| Some(back.left_m(here))),
            is_back: back.is_some_and(|back| back.is_done(here)),
            is_finishing: self.known.finishing.is_some(),
            breached,
            in_zone: self.known.breached.first().map(String::as_str),
            scanned: self.known.floor.coverage.fraction_reachable(),
            touched: readings.contact,
            reached,
            beside: self.known.tether.as_ref().filter(|_| back.is_some()).and_then(Tether::beside_lying),
            left_ahead_m: self.known.cable_left_ahead_m(),
            can_replan: self.known.plans_ways_home(),
            can_go_home: self.can_go_home(),
            planner: self.driving.seen(&self.known, self.robot_waits()),
        };
        match self.rules.update(&seen, &self.known.phase) {
            Some(verdict) => self.carry_out(verdict),
            None => self.go_on_or_help(),
        }
    }

    /// Does the remaining work of a tick in which no rule stops a running robot or lets a held robot resume.
    fn go_on_or_help(&mut self) {
        match &self.known.phase {
            Phase::Running(Gait::Back) => {}
            // While the robot waits for its planner, the time limit for reaching a corner must not run.
            Phase::Running(_) if self.robot_waits() => {}
            Phase::Running(_) => self.known.task.wait(self.known.config.tick_s * self.known.briskness()),
            Phase::Held(hold)
                if hold.by.blames_planner()
                    || matches!(
                        hold.by,
                        HoldReason::Stuck { .. } | HoldReason::Vehicle { .. } | HoldReason::Guard { .. }
                    ) =>
            {
                self.replace_failed_planner();
            }
            Phase::Waiting | Phase::Held(_) | Phase::Ended(_) => {}
        }
    }

    /// Whether the robot stands still because it has no plan or planner yet, or because the pressure sensor has not
    /// reached a decision yet.
    fn robot_waits(&self) -> bool {
        !self.known.knows_medium()
            || self.driving.worker.is_being_prepared()
            || self.preparing.as_ref().is_some_and(Preparing::robot_waits)
    }
}

#[cfg(test)]
mod tests;
