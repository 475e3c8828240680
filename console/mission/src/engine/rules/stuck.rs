//! A robot that makes no progress gets a new plan while it follows lanes, once at each place; after that, an operator
//! must help.

use super::seen::{SAME_PLACE_M, Seen, Verdict};
use crate::{
    phase::{Hold, HoldReason, Outcome, Resumes},
    task::{StuckWatch, Task},
};
use planner_api::Reason;
use world::{Point, coverage::percent_text};

/// What stops a survey that cannot choose a way, and the remedy.
const SHUT_IN: &str = "; the scans show no free floor with room for the hull around the robot: check range and mounting of \
                       the scanner, or start where there is more room";

/// Watches the progress of the task.
#[derive(Clone)]
pub(in crate::engine) struct StuckRule {
    watch: StuckWatch,
    /// The place where the robot last got a new plan because it was stuck.
    replanned_at: Option<Point>,
}

impl StuckRule {
    /// Creates the rule; `patience_s` is the time without progress after which the robot may count as stuck, seconds.
    pub(crate) fn new(patience_s: f64) -> Self {
        Self { watch: StuckWatch::new(patience_s), replanned_at: None }
    }

    /// Forgets the progress so far, because a new plan takes a different path.
    pub(crate) fn restart(&mut self) {
        self.watch.reset();
    }

    /// Processes one tick in which the robot was free to move.
    pub(crate) fn update(&mut self, seen: &Seen<'_>) -> Option<Verdict> {
        if !self.watch.update(seen.task, seen.plan_left_m, seen.here, seen.config.tick_s) {
            return None;
        }
        let tried = self.replanned_at.is_some_and(|at| (seen.here - at).norm() < SAME_PLACE_M);
        if tried || !matches!(seen.task, Task::Cover(_) | Task::Survey(_)) {
            return Some(give_up(seen));
        }
        self.replanned_at = Some(seen.here);
        self.watch.reset();
        Some(Verdict::Replan(Reason::Blocked))
    }

    /// Processes one tick in which the robot was free to drive back.
    pub(crate) fn update_return(&mut self, seen: &Seen<'_>) -> Option<Verdict> {
        let is_stuck = self.watch.update(seen.task, seen.plan_left_m, seen.here, seen.config.tick_s);
        let (x, y) = (seen.here.x, seen.here.y);
        let message = || format!("no progress at {x:.2}, {y:.2} m on the way back");
        is_stuck.then(|| {
            Verdict::Hold(Hold { by: HoldReason::Stuck { message: message() }, resumes: Resumes::Never })
        })
    }
}

/// An operator may find a way out; in an unattended mission, the mission ends.
fn give_up(seen: &Seen<'_>) -> Verdict {
    let (here, done) = (seen.here, percent_text(seen.task.done(), 0));
    let mut message = format!("no progress at {:.2}, {:.2} m, {done} % done", here.x, here.y);
    if matches!(seen.task, Task::Survey(survey) if survey.is_shut_in) {
        message += SHUT_IN;
    }
    if seen.config.attended {
        Verdict::Hold(Hold { by: HoldReason::Stuck { message }, resumes: Resumes::Never })
    } else {
        Verdict::End(Outcome::Stuck, message)
    }
}
