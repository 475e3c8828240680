//! A planner that answers late: the robot stands still meanwhile, and is held if the answer takes too long.

use super::seen::{PlannerSeen, Verdict};
use crate::phase::{Hold, HoldReason, Resumes};

/// Age, seconds, above which a command is not sent. A command that is at most one tick old is always sent.
const STALE_S: f64 = 0.2;
/// Time without an answer from the planner, seconds, after which the robot is held until the planner answers.
const SILENT_S: f64 = 2.0;

/// Whether the planner's last command came late.
#[derive(Clone, Debug, Default)]
pub(in crate::engine) struct LatePlannerRule {
    was_late: bool,
}

impl LatePlannerRule {
    /// Records a command that arrived some ticks after it was requested; returns whether it is the first in a row of late
    /// commands.
    pub(crate) fn arrived(&mut self, ticks: u64) -> bool {
        let begins = ticks > 0 && !self.was_late;
        self.was_late = ticks > 0;
        begins
    }

    /// Whether a command may still be sent that arrived `ticks` ticks, of `tick_s` seconds each, after it was
    /// requested. If ticks are long, the planner has until the next tick.
    pub(crate) fn is_fresh(ticks: u64, tick_s: f64) -> bool {
        // Ages are multiples of the tick and contain floating-point errors.
        ticks <= 1 || ticks as f64 * tick_s <= STALE_S + 1e-9
    }

    /// Processes one tick of a running robot: holds the robot if its planner has owed an answer for too long.
    pub(crate) fn update(planner: &PlannerSeen<'_>) -> Option<Verdict> {
        let is_silent = planner.owed_s.is_some_and(|owed_s| owed_s >= SILENT_S - 1e-9);
        is_silent.then(|| {
            let message = format!("planner {} has not answered for {SILENT_S} s", planner.id);
            Verdict::Hold(Hold { by: HoldReason::PlannerSilent { message }, resumes: Resumes::WhenCleared })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_first_late_command_of_a_row_is_reported() {
        let mut rule = LatePlannerRule::default();
        let begins: Vec<bool> = [0, 1, 1, 0, 2].map(|ticks| rule.arrived(ticks)).to_vec();
        assert_eq!(begins, [false, true, false, false, true]);
    }

    #[test]
    fn a_command_two_ticks_old_may_be_sent_and_a_silent_planner_holds_after_twenty() {
        assert!(LatePlannerRule::is_fresh(2, 0.1) && !LatePlannerRule::is_fresh(3, 0.1));
        assert!(LatePlannerRule::is_fresh(1, 0.5) && !LatePlannerRule::is_fresh(2, 0.5));
        let silent = |owed_s| {
            let owed_s = Some(owed_s);
            let seen = PlannerSeen { id: "apf", is_waited_for: false, owes: true, owed_s, is_shut_in: false };
            LatePlannerRule::update(&seen).is_some()
        };
        assert!(!silent(19.0 * 0.1) && silent(20.0 * 0.1));
    }
}
