//! The rules that hold the robot, let it move again, request a plan, or end the mission.
//!
//! Each rule is a type with its own state and an `update` method, which processes one tick and may return a verdict. The
//! state of a rule is changed by that rule alone.

mod blocked;
mod cuts;
mod fallback;
mod late_planner;
mod lost_position;
mod seen;
mod stuck;
mod tether;
mod time_limit;
mod zone;

pub(super) use blocked::BlockedRule;
pub(super) use cuts::{CutsRule, HOME_M, Solids};
use fallback::FallbackRule;
pub(super) use late_planner::LatePlannerRule;
use lost_position::LostPositionRule;
pub(super) use seen::{PlannerSeen, Seen, Verdict};
use stuck::StuckRule;
use tether::TetherRule;
use time_limit::TimeLimitRule;
use zone::ZoneRule;

use crate::{
    config::MissionConfig,
    event::TetherAlarm,
    phase::{Gait, Hold, HoldReason, Outcome, Phase, Resumes},
};

/// The rules that do not depend on which planner is active.
#[derive(Clone)]
pub(super) struct Rules {
    pub time_limit: TimeLimitRule,
    pub lost_position: LostPositionRule,
    pub stuck: StuckRule,
    pub tether: TetherRule,
    pub fallback: FallbackRule,
}

impl Rules {
    /// The rules at the start of a mission.
    pub(super) fn new(config: &MissionConfig) -> Self {
        Self {
            time_limit: TimeLimitRule::default(),
            lost_position: LostPositionRule::default(),
            stuck: StuckRule::new(config.stuck_s),
            tether: TetherRule::default(),
            fallback: FallbackRule::default(),
        }
    }

    /// Updates the rules for one tick of a mission in progress; the first rule that returns a verdict decides.
    pub(super) fn update(&mut self, seen: &Seen<'_>, phase: &Phase) -> Option<Verdict> {
        let time_is_up = self.time_limit.update(seen, phase);
        if seen.touched {
            return Some(Verdict::End(Outcome::Collision, "bumper contact".into()));
        }
        match phase {
            _ if time_is_up.is_some() && !seen.is_finishing => time_is_up,
            Phase::Running(Gait::Back) => self.update_return(seen),
            Phase::Running(_) => self.update_running(seen),
            Phase::Held(hold) => self.update_held(seen, hold),
            Phase::Waiting | Phase::Ended(_) => None,
        }
    }

    fn update_running(&mut self, seen: &Seen<'_>) -> Option<Verdict> {
        let Self { lost_position, tether, stuck, .. } = self;
        lost_position
            .update(seen)
            .or_else(|| ZoneRule::update(seen))
            .or_else(|| (seen.is_finishing || seen.task.is_done(seen.here)).then_some(Verdict::Done))
            .or_else(|| tether.update(seen))
            .or_else(|| LatePlannerRule::update(&seen.planner))
            .or_else(|| ZoneRule::update_planner(seen))
            .or_else(|| if seen.planner.is_waited_for { None } else { stuck.update(seen) })
    }

    /// The rules for a robot that drives back: they may hold it, but they neither ask planners nor end the mission
    /// unfinished.
    fn update_return(&mut self, seen: &Seen<'_>) -> Option<Verdict> {
        let Self { lost_position, tether, stuck, .. } = self;
        let hold = |by| Verdict::Hold(Hold { by, resumes: Resumes::Never });
        let by_tether = |alarm: &TetherAlarm| hold(HoldReason::Tether { message: alarm.to_string() });
        lost_position
            .update(seen)
            .or_else(|| ZoneRule::update(seen))
            .or_else(|| (seen.is_finishing || seen.is_back).then_some(Verdict::Back))
            .or_else(|| tether.reached_beside(seen).map(by_tether))
            .or_else(|| Some(hold(HoldReason::Tether { message: seen.beside?.trouble()? })))
            .or_else(|| stuck.update_return(seen))
    }

    /// The rules that let the robot resume from holds that last until a condition has cleared.
    fn update_held(&mut self, seen: &Seen<'_>, hold: &Hold) -> Option<Verdict> {
        // A hold by the operator gets the reason that needs a remedy.
        let yields =
            !hold.resumes.is_never() || matches!(hold.by, HoldReason::Operator | HoldReason::Stepped);
        if yields {
            let torn = || Some(Verdict::Hold(self.tether.found_torn(seen)?));
            if let Some(reason) = ZoneRule::update(seen).or_else(torn) {
                return Some(reason);
            }
        }
        if hold.resumes != Resumes::WhenCleared {
            return None;
        }
        match hold.by {
            HoldReason::PositionLost | HoldReason::RangesInconsistent => LostPositionRule::update_held(seen),
            HoldReason::Tether { .. } => self.tether.update_held(seen),
            HoldReason::PlannerSilent { .. } => (!seen.planner.owes).then_some(Verdict::Resume),
            _ => None,
        }
    }

    /// Resets the rules when the robot moves again, because their earlier counts are out of date.
    pub(super) fn restart(&mut self) {
        self.lost_position = LostPositionRule::default();
        self.stuck.restart();
    }
}
