//! Carries out the verdicts of the rules: holds the robot, lets it resume, or ends the mission.

use super::{
    Mission,
    driving::{Driving, Prepare},
    rules::Verdict,
    surveying::Surveying,
};
use crate::{
    event::EventKind,
    phase::{Gait, Hold, HoldReason, Outcome, Phase, Resumes},
};
use planner_api::{Drive, Reason};

impl Mission {
    pub(super) fn carry_out(&mut self, verdict: Verdict) {
        match verdict {
            Verdict::Hold(hold) => {
                if self.known.phase.is_return() && matches!(hold.by, HoldReason::Stuck { .. }) {
                    self.known.close_dead_end();
                }
                self.hold(hold);
                self.announce_wait();
            }
            Verdict::HoldAndReplan(hold) => {
                self.driving.course.want_plan(Reason::Blocked);
                self.hold(hold);
            }
            Verdict::Resume => self.go_on(Gait::Steady),
            Verdict::Replan(_) if self.known.survey.is_some() => {
                self.known.survey.iter_mut().for_each(Surveying::give_up);
            }
            Verdict::Replan(reason) => self.driving.course.want_plan(reason),
            Verdict::Done | Verdict::Back if self.waits_for_pulses() => {}
            Verdict::Done => self.end_done(),
            Verdict::Back => self.end_back(),
            Verdict::End(outcome, reason) => self.end(outcome, reason),
        }
    }

    /// If the vehicle cannot be driven, holds the robot unless it is already held; only an order ends that hold.
    /// Returns whether the vehicle cannot be driven. In that case, no rule ends the mission, because nothing is known
    /// about the robot.
    pub(super) fn hold_in_trouble(&mut self) -> bool {
        let Some(why) = self.known.trouble.clone() else { return false };
        if self.known.phase.may_move() {
            self.hold(Hold { by: HoldReason::Vehicle { message: why }, resumes: Resumes::Never });
        }
        self.go_on_or_help();
        true
    }

    /// After a fault, or if the planner finds no path, the fallback planner takes over if there is one. If there is none
    /// and the mission is unattended, the mission ends.
    pub(super) fn replace_failed_planner(&mut self) {
        let Phase::Held(Hold { by, resumes }) = &self.known.phase else { return };
        if *resumes == Resumes::ByFallback {
            let from = self.driving.id().to_owned();
            if let Some(choice) = self.rules.fallback.update(&self.known.config, &from) {
                let worker = self.driving.worker.successor(choice);
                self.reject_preparing(&format!("the fallback planner {} takes over", worker.id()));
                self.replace_driving(Driving::new(worker, Reason::Swap { from }, Prepare::Plan));
            }
        } else if resumes.is_never() && !self.known.config.attended && self.driving.prepare == Prepare::No {
            let (outcome, message) = match by {
                // A planner that reports that no path exists has not failed.
                HoldReason::Stuck { message } | HoldReason::Guard { message } => (Outcome::Stuck, message),
                HoldReason::PlannerFault { message }
                | HoldReason::PlanRefused { message }
                | HoldReason::PlannerSilent { message }
                | HoldReason::Vehicle { message } => (Outcome::Aborted, message),
                _ => return,
            };
            let reason = format!("unattended hold: {message}");
            self.end(outcome, reason);
        }
    }

    /// Holds the robot. If the robot is already under a hold that ends only by order, or is only being stepped, the new
    /// hold ends only by order, too: the operator's HOLD stays, whatever happens to planners in the meantime.
    pub(super) fn hold(&mut self, Hold { by, resumes }: Hold) {
        let only_by_order = match &self.known.phase {
            Phase::Held(before) => before.resumes.is_never(),
            Phase::Running(gait) => *gait != Gait::Steady,
            Phase::Waiting | Phase::Ended(_) => false,
        };
        let resumes = if only_by_order { Resumes::Never } else { resumes };
        self.happened.push(EventKind::Held { by: by.clone(), resumes });
        self.known.phase = Phase::Held(Hold { by, resumes });
        self.known.hold_finish();
        self.rules.time_limit.hold(self.known.now_s());
        self.driving.outdate_step();
        self.driving.drop_command(&mut self.happened);
    }

    /// Reports the wait for a reliable position in an unattended run of a real vehicle, which may last until the time
    /// limit.
    fn announce_wait(&mut self) {
        let config = &self.known.config;
        let Phase::Held(Hold { by: HoldReason::PositionLost | HoldReason::RangesInconsistent, resumes }) =
            &self.known.phase
        else {
            return;
        };
        if config.live && !config.attended && *resumes == Resumes::WhenCleared {
            let ends_t_s = self.rules.time_limit.ends_s(config);
            self.happened.push(EventKind::PositionAwaited { limit_m: config.position_limit_m, ends_t_s });
        }
    }

    /// Lets the robot move again, with the given gait.
    pub(super) fn resume(&mut self, gait: Gait) {
        if gait != Gait::Back {
            self.leave_way_back();
        }
        if gait == Gait::Back || !self.known.task.is_done(self.known.position()) {
            self.known.leave_finish();
        }
        self.driving.prepare = Prepare::No;
        self.known.survey.iter_mut().for_each(Surveying::leave_way);
        self.go_on(gait);
    }

    pub(super) fn go_on(&mut self, gait: Gait) {
        self.rules.restart();
        self.happened.push(EventKind::Resumed);
        self.known.phase = Phase::Running(gait);
    }

    /// Sends the command for this tick to the robot; without a command, the robot stands still.
    pub(super) fn drive(&mut self) -> Drive {
        let Phase::Running(gait) = self.known.phase else { return Drive::STILL };
        if self.known.finishing.is_some() {
            return Drive::STILL;
        }
        if gait == Gait::Back {
            return self.drive_along_way_back();
        }
        let drive = if self.known.survey.is_some() {
            self.drive_survey()
        } else {
            let Some(drive) = self.driving.send(&mut self.known, &mut self.happened) else {
                return Drive::STILL;
            };
            drive
        };
        if gait == Gait::OneTick {
            self.hold(Hold { by: HoldReason::Stepped, resumes: Resumes::Never });
        }
        drive
    }

    pub(super) fn end(&mut self, outcome: Outcome, reason: String) {
        self.report_map();
        self.report_missing_pulses();
        self.happened.ending = Some(EventKind::Ended { outcome, reason });
        self.known.phase = Phase::Ended(outcome);
        self.drop_preparing();
        self.drop_shadow();
        self.driving.close(&mut self.workers, &mut self.happened);
    }
}
