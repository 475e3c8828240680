//! A planner in shadow: it has its own worker, plan and way along it, commands beside the planner that drives, and moves
//! nothing. Its faults end it and nothing else.

mod answers;
mod promotion;

use super::{
    Mission,
    course::Course,
    known::Known,
    requests::under_way,
    worker::{PendingKind, Worker},
    workers::Workers,
};
use crate::{
    ask::{Ask, What},
    event::{EventKind, ShadowTally},
    planner::PlannerChoice,
    task::Task,
};
use geometry::PathFollower;
use planner_api::{Plan, Reason};
use promotion::Promotion;
use world::{Point, Shape};

/// A robot further from the shadow's plan than this has left it, metres.
const NEAR_PLAN_M: f64 = 0.5;
/// A planner whose plan the robot has left plans again, so often at most, seconds.
const PLAN_AGAIN_S: f64 = 10.0;

/// A planner in shadow.
#[derive(Clone)]
pub(super) struct Shadow {
    pub worker: Worker,
    pub course: Course,
    /// The tick for which it was asked last to command.
    stepped_at: Option<u64>,
    /// How it does.
    pub tally: ShadowTally,
    /// The task along its own plan.
    pub task: Task,
    plan: Plan,
    /// Whether its plan begins at the anchor because one from where the robot was is refused for the tether.
    from_anchor: bool,
    /// How many points the path flown had when its plan was asked for.
    n_flown: usize,
    /// Mission time then, seconds.
    asked_at_s: f64,
    /// What it is asked in this tick depends on the readings alone, and on no other planner's answer.
    now: Now,
    /// Whether it is to take over.
    promotion: Promotion,
}

/// What a planner in shadow may be asked in a tick, as it stands when the tick begins.
#[derive(Debug, Clone, Copy, Default)]
struct Now {
    /// Whether the robot runs.
    is_running: bool,
    /// Whether there is anything to plan for: lanes are handed over once the planner that drives has some.
    may_plan: bool,
    /// How many points the path flown has.
    n_flown: usize,
}

impl Mission {
    /// A planner is to fly in shadow, in place of the one that does.
    pub(super) fn begin_shadow(&mut self, choice: PlannerChoice) {
        self.drop_shadow();
        let reason = Reason::Swap { from: self.driving.id().to_owned() };
        self.shadow = Some(Shadow::new(self.driving.worker.successor(choice), reason, &self.known));
    }

    /// Closes the planner in shadow without a word.
    pub(super) fn drop_shadow(&mut self) {
        if let Some(mut shadow) = self.shadow.take() {
            self.workers.close(shadow.worker.leave());
        }
    }

    /// No planner flies in shadow any more, by order.
    pub(super) fn end_shadow(&mut self) {
        if let Some(shadow) = &self.shadow {
            let (planner, why) = (shadow.worker.id().to_owned(), "ended by operator".into());
            self.happened.push(EventKind::ShadowEnded { planner, why });
        }
        self.drop_shadow();
    }

    /// The planner in shadow has failed.
    pub(super) fn close_shadow(&mut self, why: String) {
        if let Some(mut shadow) = self.shadow.take() {
            self.workers.close(shadow.worker.leave());
            let planner = shadow.worker.choice.id;
            self.happened.of_shadow.push(EventKind::ShadowEnded { planner, why });
        }
    }
}

impl Shadow {
    fn new(worker: Worker, reason: Reason, known: &Known) -> Self {
        Self {
            worker,
            course: Course::new(reason),
            stepped_at: None,
            tally: ShadowTally::default(),
            task: known.task.clone(),
            plan: Plan::default(),
            from_anchor: false,
            n_flown: known.trail.len(),
            asked_at_s: known.now_s(),
            now: Now::default(),
            promotion: Promotion::No,
        }
    }

    /// Follows its plan from where the robot is, beside the planner of this id, which drives.
    pub(super) fn lead(&mut self, known: &Known, driving: &str) {
        let here = known.position();
        self.advance(here, known);
        self.now = Now {
            is_running: known.is_running(),
            may_plan: !known.is_coverage() || known.task.lanes().is_some(),
            n_flown: known.trail.len(),
        };
        if self.now.is_running {
            self.task.wait(known.config.tick_s);
            let asked_s = known.now_s() - self.asked_at_s;
            if asked_s >= PLAN_AGAIN_S && !self.is_near(here) {
                self.course.want_plan(Reason::Swap { from: driving.to_owned() });
            }
        }
    }

    fn advance(&mut self, here: Point, known: &Known) {
        let (chart, room_m) = (&known.chart, known.config.room_m());
        self.task.advance(here, chart.map(), |at| chart.has_room(at, room_m));
        self.course.advance(here, chart.map());
    }

    /// The map has changed: what was found that planners have to know of, and whether it is in the way of its plan.
    pub(super) fn map_changed(&mut self, found: &[Shape], is_in_the_way: bool) {
        self.course.found_since.extend_from_slice(found);
        if is_in_the_way {
            self.course.want_plan(Reason::MapChanged);
        }
    }

    /// What it is asked next.
    pub(super) fn next_ask(&mut self, known: &Known, workers: &mut Workers) -> Option<Ask> {
        if self.worker.pending.is_some() {
            return None;
        }
        if !self.worker.is_ready() {
            return Some(self.worker.open(known, workers));
        }
        let tick = known.tick;
        if let Some(due) = &self.course.due {
            if !self.now.may_plan {
                return None;
            }
            let plan = known.plan_ask(due, self.now.n_flown, under_way(&self.task, &due.reason));
            (self.n_flown, self.asked_at_s) = (self.now.n_flown, known.now_s());
            self.course.found_since.clear();
            return self.worker.ask_for_plan(tick, plan);
        }
        if !self.now.is_running || self.stepped_at == Some(tick) {
            return None;
        }
        self.stepped_at = Some(tick);
        let step = known.step_ask(&self.task, self.course.follower.as_ref());
        self.worker.ask(tick, PendingKind::Step { usable: true }, What::Step(Box::new(step)))
    }

    /// Progress along its own plan, if that has a path.
    fn route(&self) -> Option<&PathFollower> {
        self.task.lanes().or(self.course.follower.as_ref())
    }

    /// Whether a place is at its plan; any is, if it has no path.
    fn is_near(&self, here: Point) -> bool {
        self.route().is_none_or(|route| route.cross_track_m(here) <= NEAR_PLAN_M)
    }
}
