//! Holds the robot when its cable has reached a limit, is caught, slack or torn.

use super::seen::{SAME_PLACE_M, Seen, Verdict};
use crate::{
    event::TetherAlarm,
    phase::{Hold, HoldReason, Outcome, Resumes},
};
use world::Point;

/// Maximum number of attempts to free the cable at one place without an operator, if little floor is scanned between the
/// attempts.
const MOST_TIMES_CAUGHT: usize = 2;
/// Share of the reachable floor that must be scanned between two holds to justify more attempts.
const WORTH_IT: f64 = 0.01;
/// In an unattended mission, how long to wait for a return path, seconds.
const WAIT_FOR_HOME_S: f64 = 30.0;

/// State of the tether rule.
#[derive(Clone, Debug, Default)]
pub(in crate::engine) struct TetherRule {
    /// The place where the cable last held the robot.
    caught: Option<Caught>,
    /// How long the robot has been held without a return path, seconds.
    waited_s: f64,
    /// Whether the robot has been stopped because its cable is torn.
    knows_torn: bool,
}

/// A place where the cable held the robot.
#[derive(Debug, Clone, Copy)]
struct Caught {
    at: Point,
    /// Share of the reachable floor that had been scanned at the first hold there.
    scanned: f64,
    times: usize,
}

impl TetherRule {
    /// The limit that the cable of a moving robot has reached. A torn cable counts once, even if the robot was held when it
    /// was found torn.
    pub(crate) fn reached<'a>(&mut self, seen: &Seen<'a>) -> Option<&'a TetherAlarm> {
        let alarm = seen.reached?;
        let is_old =
            matches!(alarm, TetherAlarm::Broken { .. }) && std::mem::replace(&mut self.knows_torn, true);
        (!is_old).then_some(alarm)
    }

    /// The hold of a robot that is held while its cable is found torn: it gets the reason that needs a remedy, so that an
    /// operator who resumes has seen it.
    pub(crate) fn found_torn(&mut self, seen: &Seen<'_>) -> Option<Hold> {
        let alarm = seen.reached.filter(|alarm| matches!(alarm, TetherAlarm::Broken { .. }))?;
        self.reached(seen).map(|_| held(alarm.to_string(), Resumes::Never))
    }

    /// The same for a robot that drives back. Slack that was known when the order was given does not count again, nor does a
    /// return path along a cable beside which the robot drives.
    pub(crate) fn reached_beside<'a>(&mut self, seen: &Seen<'a>) -> Option<&'a TetherAlarm> {
        let is_known = |alarm: &TetherAlarm| {
            matches!(alarm, TetherAlarm::Slack { .. } | TetherAlarm::Snag { .. } | TetherAlarm::NoReturnPath)
        };
        self.reached(seen).filter(|alarm| seen.beside.is_none() || !is_known(alarm))
    }

    /// Processes one tick of a running robot.
    pub(crate) fn update(&mut self, seen: &Seen<'_>) -> Option<Verdict> {
        let Some(alarm) = self.reached(seen) else { return before_own_cable(seen) };
        self.waited_s = 0.0;
        let message = alarm.to_string();
        Some(match alarm {
            TetherAlarm::Reel { .. } | TetherAlarm::Slack { .. } => {
                self.stop(seen, message, Outcome::Aborted)
            }
            TetherAlarm::Wrap { .. } | TetherAlarm::WrapTotal { .. } | TetherAlarm::Snag { .. } => {
                self.stop(seen, message, Outcome::Entangled)
            }
            TetherAlarm::Broken { .. } => stay(seen, message, Outcome::Aborted),
            // The obstacle that blocks the return path may move away.
            TetherAlarm::NoReturnPath | TetherAlarm::Strayed => {
                Verdict::Hold(held(message, Resumes::WhenCleared))
            }
        })
    }

    /// Holds a robot whose cable is at a limit, caught or slack, and requests a new plan that begins with a path that frees
    /// the cable or takes the slack in. An unattended mission tries this a few times at one place, and starts counting again whenever floor has
    /// been scanned in between; after that, it ends.
    fn stop(&mut self, seen: &Seen<'_>, message: String, outcome: Outcome) -> Verdict {
        let (at, scanned) = (seen.here, seen.scanned);
        let again = self
            .caught
            .filter(|last| (at - last.at).norm() < SAME_PLACE_M && scanned - last.scanned < WORTH_IT);
        let times = again.map_or(0, |last| last.times);
        self.caught = Some(Caught { times: times + 1, ..again.unwrap_or(Caught { at, scanned, times }) });
        if seen.can_replan && times < MOST_TIMES_CAUGHT {
            let resumes = if seen.config.attended { Resumes::Never } else { Resumes::WhenCleared };
            Verdict::HoldAndReplan(held(message, resumes))
        } else {
            stay(seen, message, outcome)
        }
    }

    /// Processes one tick of a robot that this rule holds until there is a return path. An unattended mission ends if it
    /// takes too long.
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

/// Holds a robot that would come near its own cable, which a stopped reel has left on the floor.
fn before_own_cable(seen: &Seen<'_>) -> Option<Verdict> {
    let left_m = seen.left_ahead_m?;
    let message = format!(
        "hull about to reach its own tether: the reel has stopped, and {left_m:.1} m of slack lie on the floor; ask for a way \
         back"
    );
    Some(stay(seen, message, Outcome::Aborted))
}

/// Holds a robot until an operator decides; without one, the mission ends.
fn stay(seen: &Seen<'_>, message: String, outcome: Outcome) -> Verdict {
    if seen.config.attended {
        Verdict::Hold(held(message, Resumes::Never))
    } else {
        Verdict::End(outcome, format!("unattended hold: {message}"))
    }
}

fn held(message: String, resumes: Resumes) -> Hold {
    Hold { by: HoldReason::Tether { message }, resumes }
}
