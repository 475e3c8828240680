//! A robot with an unreliable position is held until the position is reliable again.

use super::seen::{Seen, Verdict};
use crate::{
    phase::{Hold, HoldReason, Resumes},
    standing::PositionTrust,
};

/// How long the position has been unreliable, seconds.
#[derive(Clone, Debug, Default)]
pub(in crate::engine) struct LostPositionRule {
    position_lost_s: f64,
}

impl LostPositionRule {
    /// Processes one tick of a running robot: holds the robot if the position has been unreliable for too long.
    pub(crate) fn update(&mut self, seen: &Seen<'_>) -> Option<Verdict> {
        self.position_lost_s =
            if seen.is_position_good() { 0.0 } else { self.position_lost_s + seen.config.tick_s };
        let by = match seen.position {
            PositionTrust::Good => return None,
            PositionTrust::Lost { .. } => HoldReason::PositionLost,
            PositionTrust::Alarmed => HoldReason::RangesInconsistent,
        };
        (self.position_lost_s >= seen.config.position_lost_hold_s)
            .then_some(Verdict::Hold(Hold { by, resumes: Resumes::WhenCleared }))
    }

    /// Processes one tick of a robot that is held by this rule.
    pub(crate) fn update_held(seen: &Seen<'_>) -> Option<Verdict> {
        seen.is_position_good().then_some(Verdict::Resume)
    }
}
