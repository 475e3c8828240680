//! The engine: what is sensed, ordered and answered goes in; what the robot does, what is asked of planners and everything
//! that happened comes out.
//!
//! A tick is [`Mission::sense`], any number of [`Mission::poll_ask`] and [`Mission::answer`], and [`Mission::act`]. The
//! mission never waits: an ask that is not answered when [`Mission::act`] is called may be answered in any later tick. The
//! same inputs and answers in the same ticks give the same events.

mod answers;
mod asks;
mod better_plan;
mod candidate;
mod checking;
mod course;
mod driving;
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
mod rules;
mod scanning;
mod shadow;
mod stepping;
mod tethering;
mod worker;
mod workers;
mod zones;

use crate::{
    config::MissionConfig,
    event::{Event, EventKind, TetherAlarm},
    order::Order,
    phase::{HoldReason, Phase},
    standing::Standing,
    tether::Tether,
};
pub use driving::Sending;
use driving::{Driving, LeftPlan, Prepare};
pub use fork::Fork;
use happened::Happened;
use known::Known;
use planner_api::{Drive, Reason};
use preparing::Preparing;
use rules::{Rules, Seen};
use shadow::Shadow;
use stepping::PlaceOnPlan;
use worker::Worker;
use workers::Workers;
use world::{Floor, Readings, World};

/// What enters the engine at the top of a tick.
#[derive(Debug, Clone, Copy)]
pub struct Input<'a> {
    /// What was sensed since the last tick.
    pub readings: &'a Readings,
    /// What the operator said since the last tick, oldest first.
    pub orders: &'a [Order],
}

/// What leaves the engine at the end of a tick.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// How the robot shall move until the next tick, within its limits and in its own way of moving.
    pub drive: Drive,
    /// Everything that happened, in order.
    pub events: Vec<Event>,
}

/// A mission under way.
///
/// Costs per tick: one position update, and work that grows with the obstacles in sensing range and the cells under the
/// swath. Memory grows by one point per decimetre flown.
#[derive(Clone)]
pub struct Mission {
    known: Known,
    rules: Rules,
    driving: Driving,
    /// What is prepared beside it.
    preparing: Option<Preparing>,
    /// A planner that flies beside the one that drives, and moves nothing.
    shadow: Option<Shadow>,
    /// Mission time from which on a better plan than the repaired one is looked for, seconds.
    better_plan_due_s: Option<f64>,
    /// The plan that was flown when the planner that drives took over.
    left: Option<LeftPlan>,
    workers: Workers,
    /// Where the robot was let go that moves until something happens.
    stepped_from: Option<PlaceOnPlan>,
    happened: Happened,
}

impl Mission {
    /// A mission that waits for [`Order::Start`].
    ///
    /// `drawing` is the tank as drawn, `floor` its grid; `seed` is handed to planners for their random choices.
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

    /// What the mission is doing.
    pub fn phase(&self) -> &Phase {
        &self.known.phase
    }

    /// The planner that drives, or that will drive first.
    pub fn planner_id(&self) -> &str {
        self.driving.id()
    }

    /// What a command would become now on its way to the robot.
    pub fn sending(&self) -> Sending {
        self.known.sending()
    }

    /// Everything that decides whether an order is accepted now.
    pub fn standing(&self) -> Standing<'_> {
        Standing {
            phase: &self.known.phase,
            position: self.known.position_trust(),
            planner: self.driving.worker.seen(),
            shadow: self.shadow.as_ref().map(|shadow| shadow.tally),
            has_offer: self.has_offer(),
            readiness: self.driving.readiness(&self.known),
        }
    }

    /// Begins a tick: obeys the orders, takes in what was sensed, applies the rules. To be called once, first.
    pub fn sense(&mut self, input: &Input<'_>) {
        for order in input.orders {
            self.obey(order);
        }
        let before = self.known.locator.pose();
        let located = self.known.locator.take(input.readings);
        self.happened.extend(located);
        self.happened.extend(self.known.take_pressure(input.readings.pressure_pa));
        let map_changed = self.look_around(input.readings);
        self.known.scan_from(before, &mut self.happened);
        let reached = self.known.drag_tether(map_changed, input.readings.paid_out_m, &mut self.happened);
        self.watch_tether(map_changed);
        self.apply_rules(input.readings, reached.as_ref());
        if let Some(shadow) = &mut self.shadow {
            shadow.lead(&self.known, self.driving.id());
            self.promote_if_due();
        }
        self.lead_better_plan();
    }

    /// Ends a tick: what the robot does until the next one, and everything that happened. To be called once, last.
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

    /// Has the plan made again that the tether, or the way it lies, no longer permits.
    fn watch_tether(&mut self, map_changed: bool) {
        if map_changed {
            self.driving.course.doubt_for_tether(&self.known);
        }
        if self.driving.course.has_strayed(&self.known) {
            self.happened.push(EventKind::TetherAlarmRaised { alarm: TetherAlarm::Strayed, reached: false });
        }
    }

    /// The rules that hold the robot, let it go on, or end the mission; the first that has something to say wins.
    fn apply_rules(&mut self, readings: &Readings, reached: Option<&TetherAlarm>) {
        if matches!(self.known.phase, Phase::Waiting | Phase::Ended(_)) {
            return;
        }
        let here = self.known.position();
        let seen = Seen {
            config: &self.known.config,
            now_s: self.known.now_s(),
            here,
            position: self.known.position_trust(),
            task: &self.known.task,
            plan_left_m: self.driving.course.follower.as_ref().map(|plan| plan.left_m(here)),
            scanned: self.known.floor.coverage.fraction_reachable(),
            touched: readings.contact,
            reached,
            can_replan: self.known.plans_ways_home(),
            can_go_home: self.known.tether.as_ref().is_none_or(Tether::can_go_home),
            planner: self.driving.seen(&self.known, self.robot_waits()),
        };
        match self.rules.update(&seen, &self.known.phase) {
            Some(verdict) => self.carry_out(verdict),
            None => self.go_on_or_help(),
        }
    }

    /// Nothing stops the robot, or nothing lets a held one go on.
    fn go_on_or_help(&mut self) {
        match &self.known.phase {
            // A robot that stands for its planner is kept from no corner.
            Phase::Running(_) if self.robot_waits() => {}
            Phase::Running(_) => self.known.task.wait(self.known.config.tick_s * self.known.briskness()),
            Phase::Held(hold) if hold.by.blames_planner() || matches!(hold.by, HoldReason::Stuck { .. }) => {
                self.replace_failed_planner();
            }
            Phase::Waiting | Phase::Held(_) | Phase::Ended(_) => {}
        }
    }

    /// Whether the robot stands because it has no plan, or no planner, yet, or does not know whether to walk or to swim.
    fn robot_waits(&self) -> bool {
        !self.known.knows_medium()
            || self.driving.worker.is_being_prepared()
            || self.preparing.as_ref().is_some_and(Preparing::robot_waits)
    }
}

#[cfg(test)]
mod tests;
