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
mod driving;
mod floor;
mod fork;
mod governing;
mod holding;
mod orders;
mod planning;
mod rules;
mod scanning;
mod shadow;
mod slot;
mod stepping;
mod tethering;
mod workers;
mod zones;

use crate::{
    chart::Chart,
    config::MissionConfig,
    event::{Event, EventKind, TetherAlarm},
    locate::Locator,
    order::Order,
    phase::{HoldReason, Phase},
    standing::{PositionTrust, Standing},
    task::Task,
    tether::Tether,
};
pub use driving::Sending;
use floor::ScannedFloor;
pub use fork::Fork;
use governing::Governor;
use planner_api::{Drive, Reason};
use rules::{PlannerSeen, Rules, Seen};
use shadow::Shadow;
use slot::{LeftPlan, PlannerSlot};
use stepping::PlaceOnPlan;
use workers::Workers;
use world::{Floor, Point, Readings, World};

/// A robot that turns at least this fast turns about in the time that it is given at a corner, radians per second.
const BRISK_RAD_PER_S: f64 = 0.75;

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
    config: MissionConfig,
    tick: u64,
    phase: Phase,
    locator: Locator,
    chart: Chart,
    task: Task,
    floor: ScannedFloor,
    /// `None` without a tether, or if its anchor cannot be.
    tether: Option<Tether>,
    /// The path flown, a point each decimetre.
    trail: Vec<Point>,
    rules: Rules,
    /// The planner that drives.
    active: PlannerSlot,
    /// A planner that is being prepared to take over.
    candidate: Option<PlannerSlot>,
    /// A planner that flies beside the one that drives, and moves nothing.
    shadow: Option<Shadow>,
    /// Mission time from which on a better plan than the repaired one is looked for, seconds.
    better_plan_due_s: Option<f64>,
    /// The plan that was flown when the planner that drives took over.
    left: Option<LeftPlan>,
    workers: Workers,
    /// What limits the commands.
    governor: Governor,
    /// Where the robot was let go that moves until something happens.
    stepped_from: Option<PlaceOnPlan>,
    happened: Happened,
}

/// What has happened in this tick so far, and the command at the end of the last one.
#[derive(Clone)]
struct Happened {
    events: Vec<EventKind>,
    /// What came of the answers of the planner in shadow: reported last, in whatever order answers arrive.
    of_shadow: Vec<EventKind>,
    /// The end of the mission, reported after all other events of the tick.
    ending: Option<EventKind>,
    last_drive: Drive,
}

impl Happened {
    fn push(&mut self, kind: EventKind) {
        self.events.push(kind);
    }

    fn extend(&mut self, kinds: impl IntoIterator<Item = EventKind>) {
        self.events.extend(kinds);
    }
}

impl Mission {
    /// A mission that waits for [`Order::Start`].
    ///
    /// `drawing` is the tank as drawn, `floor` its grid; `seed` is handed to planners for their random choices.
    pub fn new(config: MissionConfig, drawing: World, floor: Floor, seed: u64) -> Self {
        let start = config.start.position;
        let governor = Governor::new(&config, &drawing.zones);
        Self {
            tick: 0,
            tether: config
                .tether
                .as_ref()
                .and_then(|tether| Tether::new(tether, config.limits.radius_m, &drawing, start).ok()),
            phase: Phase::Waiting,
            locator: Locator::new(&config, &drawing),
            chart: Chart::new(drawing, &config, seed),
            task: Task::new(&config.task, start),
            floor: ScannedFloor::new(floor),
            trail: vec![start],
            rules: Rules::new(&config),
            active: PlannerSlot::new(config.planner.clone(), Reason::Start),
            candidate: None,
            shadow: None,
            better_plan_due_s: None,
            left: None,
            workers: Workers::default(),
            governor,
            stepped_from: None,
            happened: Happened {
                events: Vec::new(),
                of_shadow: Vec::new(),
                ending: None,
                last_drive: Drive::STILL,
            },
            config,
        }
    }

    /// What the mission is doing.
    pub fn phase(&self) -> &Phase {
        &self.phase
    }

    fn is_running(&self) -> bool {
        matches!(self.phase, Phase::Running(_))
    }

    /// The planner that drives, or that will drive first.
    pub fn planner_id(&self) -> &str {
        &self.active.choice.id
    }

    /// Everything that decides whether an order is accepted now.
    pub fn standing(&self) -> Standing<'_> {
        Standing {
            phase: &self.phase,
            position: self.position_trust(),
            planner: self.active.known(),
            shadow: self.shadow.as_ref().map(|shadow| shadow.tally),
            has_offer: self.has_offer(),
            readiness: self.readiness(),
        }
    }

    fn position_trust(&self) -> PositionTrust {
        if self.locator.is_lost() {
            PositionTrust::Lost { limit_m: self.config.position_limit_m }
        } else if self.locator.is_alarmed() {
            PositionTrust::Alarmed
        } else {
            PositionTrust::Good
        }
    }

    /// Begins a tick: obeys the orders, takes in what was sensed, applies the rules. To be called once, first.
    pub fn sense(&mut self, input: &Input<'_>) {
        for order in input.orders {
            self.obey(order);
        }
        let before = self.locator.pose();
        let located = self.locator.take(input.readings);
        self.happened.extend(located);
        self.take_pressure(input.readings.pressure_pa);
        let map_changed = self.look_around(input.readings);
        self.scan_from(before);
        let reached = self.drag_tether(map_changed, input.readings.paid_out_m);
        self.apply_rules(input.readings, reached.as_ref());
        self.lead_shadow();
        self.lead_better_plan();
    }

    /// Ends a tick: what the robot does until the next one, and everything that happened. To be called once, last.
    pub fn act(&mut self) -> Step {
        self.update_mode();
        let drive = self.drive();
        self.follow_drive(drive);
        self.end_step();
        let (tick, t_s) = (self.tick, self.now_s());
        // What it has grown to is kept for the next tick.
        let happened = self.happened.events.drain(..).chain(self.happened.of_shadow.drain(..));
        let happened = happened.chain(self.happened.ending.take());
        let events = happened.map(|kind| Event { tick, t_s, kind }).collect();
        self.tick += 1;
        self.happened.last_drive = drive;
        Step { drive, events }
    }

    fn now_s(&self) -> f64 {
        self.tick as f64 * self.config.tick_s
    }

    /// The rules that hold the robot, let it go on, or end the mission; the first that has something to say wins.
    fn apply_rules(&mut self, readings: &Readings, reached: Option<&TetherAlarm>) {
        if matches!(self.phase, Phase::Waiting | Phase::Ended(_)) {
            return;
        }
        let here = self.locator.position();
        let seen = Seen {
            config: &self.config,
            now_s: self.now_s(),
            here,
            position: self.position_trust(),
            task: &self.task,
            plan_left_m: self.active.follower.as_ref().map(|plan| plan.left_m(here)),
            scanned: self.floor.coverage.fraction_reachable(),
            touched: readings.contact,
            reached,
            can_replan: self.plans_ways_home(),
            can_go_home: self.tether.as_ref().is_none_or(Tether::can_go_home),
            planner: PlannerSeen {
                id: &self.active.choice.id,
                is_waited_for: self.robot_waits(),
                owes: self.active.pending.is_some(),
                owed_s: self.active.owed_ticks(self.tick).map(|ticks| ticks as f64 * self.config.tick_s),
            },
        };
        match self.rules.update(&seen, &self.phase) {
            Some(verdict) => self.carry_out(verdict),
            None => self.go_on_or_help(),
        }
    }

    /// Nothing stops the robot, or nothing lets a held one go on.
    fn go_on_or_help(&mut self) {
        match &self.phase {
            // A robot that stands for its planner is kept from no corner.
            Phase::Running(_) if self.robot_waits() => {}
            Phase::Running(_) => self.task.wait(self.config.tick_s * self.briskness()),
            Phase::Held(hold) if hold.by.blames_planner() || matches!(hold.by, HoldReason::Stuck { .. }) => {
                self.replace_failed_planner();
            }
            Phase::Waiting | Phase::Held(_) | Phase::Ended(_) => {}
        }
    }

    /// How fast time passes for a robot at a corner: one that turns slowly is given longer to come round.
    fn briskness(&self) -> f64 {
        (self.config.limits.w_max_rad_per_s / BRISK_RAD_PER_S).min(1.0)
    }

    /// Whether the robot stands because it has no plan, or no planner, yet, or does not know whether to walk or to swim.
    fn robot_waits(&self) -> bool {
        !self.knows_medium()
            || self.active.is_being_prepared()
            || self.candidate.as_ref().is_some_and(|slot| slot.robot_waits)
    }
}

#[cfg(test)]
mod tests;
