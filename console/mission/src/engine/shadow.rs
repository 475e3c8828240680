//! A planner in shadow has its own worker, its own plan, and its own progress along that plan. It computes commands in
//! parallel with the active planner, but its commands are not sent to the robot. If it fails, only the shadow ends.

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
    standing::InShadow,
    task::Task,
};
use geometry::PathFollower;
use planner_api::{Plan, Reason};
use promotion::Promotion;
use world::{Point, Shape};

/// Distance from the shadow's plan, metres, above which the robot counts as having left the plan.
const NEAR_PLAN_M: f64 = 0.5;
/// Minimum time between two plans for a robot that has left the shadow's plan, seconds.
const PLAN_AGAIN_S: f64 = 10.0;

/// A planner in shadow.
#[derive(Clone)]
pub(super) struct Shadow {
    pub worker: Worker,
    pub course: Course,
    /// The last tick for which a command was requested.
    stepped_at: Option<u64>,
    /// The planner's record in shadow.
    pub tally: ShadowTally,
    /// The progress of the task along the planner's own plan.
    pub task: Task,
    plan: Plan,
    /// Whether the planner has made a plan.
    has_planned: bool,
    /// Whether the plan begins at the anchor because the plan from the robot's position was refused for the tether.
    from_anchor: bool,
    /// Number of points in the path driven when the planner's plan was requested.
    n_flown: usize,
    /// Mission time of that request, seconds.
    asked_at_s: f64,
    /// The requests that the planner can get in this tick; they depend on the sensor readings alone, not on another
    /// planner's answers.
    now: Now,
    /// Whether the planner has been ordered to take over.
    promotion: Promotion,
    /// Whether the planner is to be asked for its state, because its process may have ended.
    check_due: bool,
}

/// The requests that a planner in shadow can get in a tick, fixed at the start of the tick.
#[derive(Debug, Clone, Copy, Default)]
struct Now {
    /// Whether the robot is running.
    is_running: bool,
    /// Whether the planner may be asked for a plan; in coverage missions, only once the active planner has a plan.
    may_plan: bool,
    /// Number of points in the path driven.
    n_flown: usize,
}

impl Mission {
    /// Starts a planner in shadow; it replaces the planner that is in shadow now.
    pub(super) fn begin_shadow(&mut self, choice: PlannerChoice) {
        self.drop_shadow();
        let reason = Reason::Swap { from: self.driving.id().to_owned() };
        self.shadow = Some(Shadow::new(self.driving.worker.successor(choice), reason, &self.known));
    }

    /// Closes the planner in shadow without an event.
    pub(super) fn drop_shadow(&mut self) {
        if let Some(mut shadow) = self.shadow.take() {
            self.workers.close(shadow.worker.leave());
        }
    }

    /// Ends the shadow by order.
    pub(super) fn end_shadow(&mut self) {
        if let Some(shadow) = &self.shadow {
            let (planner, why) = (shadow.worker.id().to_owned(), "ended by operator".into());
            self.happened.push(EventKind::ShadowEnded { planner, why });
        }
        self.drop_shadow();
    }

    /// Ends the shadow after a failure.
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
            has_planned: false,
            from_anchor: false,
            n_flown: known.trail.len(),
            asked_at_s: known.now_s(),
            now: Now::default(),
            promotion: Promotion::No,
            check_due: false,
        }
    }

    /// Asks the planner for its state if it is open; the answer shows whether its process still runs.
    pub(super) fn check(&mut self) {
        self.check_due = self.worker.is_ready();
    }

    /// Advances along the shadow's own plan to the robot's position; `driving` is the id of the active planner.
    pub(super) fn lead(&mut self, known: &Known, driving: &str) {
        let here = known.position();
        self.advance(here, known);
        self.now = Now {
            is_running: known.follows_planner(),
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

    /// What decides whether the planner can take over.
    pub(super) fn standing(&self) -> InShadow {
        InShadow { tally: self.tally, has_planned: self.has_planned }
    }

    fn advance(&mut self, here: Point, known: &Known) {
        let (chart, room_m) = (&known.chart, known.config.room_m());
        self.task.advance(here, chart.map(), |at| chart.has_room(at, room_m));
        self.course.advance(here, chart.map());
    }

    /// Handles a change to the map: obstacles that were found, and whether they block the shadow's plan.
    pub(super) fn map_changed(&mut self, found: &[Shape], is_in_the_way: bool) {
        self.course.found_since.extend_from_slice(found);
        if is_in_the_way {
            self.course.want_plan(Reason::MapChanged);
        }
    }

    /// The next ask to the planner in shadow.
    pub(super) fn next_ask(&mut self, known: &Known, workers: &mut Workers) -> Option<Ask> {
        if self.worker.pending.is_some() {
            return None;
        }
        if !self.worker.is_ready() {
            return Some(self.worker.open(known, workers));
        }
        let tick = known.tick;
        if std::mem::take(&mut self.check_due) {
            return self.worker.ask(tick, PendingKind::Snapshot, What::Snapshot);
        }
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

    /// Progress along the shadow's own plan, if the plan has a path.
    fn route(&self) -> Option<&PathFollower> {
        self.task.lanes().or(self.course.follower.as_ref())
    }

    /// Whether a place is close to the shadow's plan; always true if the plan has no path.
    fn is_near(&self, here: Point) -> bool {
        self.route().is_none_or(|route| route.cross_track_m(here) <= NEAR_PLAN_M)
    }
}
