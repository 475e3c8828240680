//! A cable that has reached a limit, or has caught on something, holds the robot.

use super::seen::{SAME_PLACE_M, Seen, Verdict};
use crate::{
    event::TetherAlarm,
    phase::{Hold, HoldReason, Outcome, Resumes},
};
use world::Point;

/// So often a cable that holds the robot in one place is freed without an operator while little is scanned.
const MOST_TIMES_CAUGHT: usize = 2;
/// Share of the reachable floor that is worth another try.
const WORTH_IT: f64 = 0.01;
/// A robot without a return path that nobody attends waits this long for one, seconds.
const WAIT_FOR_HOME_S: f64 = 30.0;

/// What the cable has done to the robot.
#[derive(Clone, Debug, Default)]
pub(in crate::engine) struct TetherRule {
    /// Where the cable held the robot last.
    caught: Option<Caught>,
    /// For how long the robot has been held without a return path, seconds.
    waited_s: f64,
}

/// The cable held the robot.
#[derive(Debug, Clone, Copy)]
struct Caught {
    at: Point,
    /// Share of the reachable floor scanned when it first did so there.
    scanned: f64,
    times: usize,
}

impl TetherRule {
    /// One tick of a running robot in which the cable reached a limit.
    pub(crate) fn update(&mut self, seen: &Seen<'_>, alarm: &TetherAlarm) -> Verdict {
        self.waited_s = 0.0;
        let message = alarm.to_string();
        match alarm {
            TetherAlarm::Reel { .. } => self.stop(seen, message, Outcome::Aborted),
            TetherAlarm::Wrap { .. } | TetherAlarm::WrapTotal { .. } | TetherAlarm::Snag { .. } => {
                self.stop(seen, message, Outcome::Entangled)
            }
            // What closed the way may move on.
            TetherAlarm::NoReturnPath | TetherAlarm::Strayed => {
                Verdict::Hold(held(message, Resumes::WhenCleared))
            }
        }
    }

    /// A cable at its limits, or caught, holds the robot. Lanes are planned again from there, after a way that eases the
    /// cable; with nobody there this is tried a few times in one place, and more often while floor is scanned in between;
    /// else the mission ends.
    fn stop(&mut self, seen: &Seen<'_>, message: String, outcome: Outcome) -> Verdict {
        let (at, scanned) = (seen.here, seen.scanned);
        let again = self
            .caught
            .filter(|last| (at - last.at).norm() < SAME_PLACE_M && scanned - last.scanned < WORTH_IT);
        let times = again.map_or(0, |last| last.times);
        self.caught = Some(Caught { times: times + 1, ..again.unwrap_or(Caught { at, scanned, times }) });
        let attended = seen.config.attended;
        let resumes = if attended { Resumes::Never } else { Resumes::WhenCleared };
        if seen.can_replan && times < MOST_TIMES_CAUGHT {
            Verdict::HoldAndReplan(held(message, resumes))
        } else if attended {
            Verdict::Hold(held(message, resumes))
        } else {
            Verdict::End(outcome, format!("unattended hold: {message}"))
        }
    }

    /// One tick of a robot that this rule holds until it has a return path; with nobody there to help the mission ends after
    /// a while.
    pub(crate) fn update_held(&mut self, seen: &Seen<'_>) -> Option<Verdict> {
        if seen.can_go_home {
            return Some(Verdict::Resume);
        }
        if !seen.config.attended && self.waited_s >= WAIT_FOR_HOME_S {
            let message = TetherAlarm::NoReturnPath.to_string();
            return Some(Verdict::End(Outcome::Entangled, format!("unattended hold: {message}")));
        }
        self.waited_s += seen.config.tick_s;
        None
    }
}

fn held(message: String, resumes: Resumes) -> Hold {
    Hold { by: HoldReason::Tether { message }, resumes }
}
