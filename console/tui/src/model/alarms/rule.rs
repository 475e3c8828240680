//! When a cause is an alarm, and how severe the alarm is, by what the mission does (ISA-18.2: delays, and limits by
//! phase).
//!
//! An alarm is critical only if the robot moves or is held for its cause. A cause that disappears within its delay has
//! no effect on the robot: it is an event, but not an alarm.

use super::Cause;
use mission::{Gait, Phase, Severity, event::TetherAlarm};

/// What the mission does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Context {
    /// The mission waits for its start; plans are being made.
    Planning,
    /// The robot drives, or stands still while its planner replans.
    Driving,
    /// The robot drives back by order.
    DrivingBack,
    /// The robot is held.
    Held,
    /// The mission has ended.
    Ended,
}

impl Context {
    /// The context of a phase.
    pub fn of(phase: &Phase) -> Self {
        match phase {
            Phase::Waiting => Self::Planning,
            Phase::Running(Gait::Back) => Self::DrivingBack,
            Phase::Running(_) => Self::Driving,
            Phase::Held(_) => Self::Held,
            Phase::Ended(_) => Self::Ended,
        }
    }

    /// Whether the robot may move.
    pub fn moves(self) -> bool {
        matches!(self, Self::Driving | Self::DrivingBack)
    }

    /// Every context, for tests.
    #[doc(hidden)]
    pub const EVERY: [Self; 5] = [Self::Planning, Self::Driving, Self::DrivingBack, Self::Held, Self::Ended];
}

/// The conditions for the alarm of a cause in a context.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule {
    /// The severity of the alarm.
    pub severity: Severity,
    /// How long the cause must persist before the alarm is raised, seconds of mission time.
    pub on_delay_s: f64,
    /// How long the cause must be gone before the alarm clears, seconds of mission time.
    pub off_delay_s: f64,
}

/// A wrong cycle of ranges is normally followed by a good one within this time, seconds. It is shorter than the time
/// after which the mission holds the robot by default.
const CYCLE_S: f64 = 1.0;
/// A tether at the edge of a limit crosses it in both directions while the robot turns, seconds.
const TURN_S: f64 = 5.0;

/// The rule for a cause whose event has the given severity. If the table has no row for a cause, its alarm is raised at
/// once with the severity of the event, in every context.
pub fn rule(cause: &Cause, severity: Severity, context: Context) -> Rule {
    let rule = |most: Severity, on_delay_s, off_delay_s| Rule {
        severity: severity.min(most),
        on_delay_s,
        off_delay_s,
    };
    let at_once = |most| rule(most, 0.0, 0.0);
    match (cause, context) {
        // While the robot stands still, a bad position only delays the start or the resumption.
        (Cause::PositionLost | Cause::Contradiction, Context::Planning | Context::Held) => {
            rule(Severity::Warn, CYCLE_S, 0.0)
        }
        (Cause::PositionLost | Cause::Contradiction, _) => rule(Severity::Crit, CYCLE_S, 0.0),
        (Cause::NotProtected, _) => rule(Severity::Warn, CYCLE_S, 0.0),
        (Cause::NoFix | Cause::Station(_), _) => rule(Severity::Watch, CYCLE_S, 0.0),
        // A refused plan is never run. While the robot is under way, the mission has a second one made; only if that is
        // refused, too, the robot is held for it.
        (Cause::Certificate, Context::Driving | Context::DrivingBack) if severity == Severity::Crit => {
            at_once(Severity::Watch)
        }
        // Without a planner, a stationary robot only stays where it is.
        (
            Cause::Certificate | Cause::Bias(_) | Cause::NotSeparable | Cause::Pulses | Cause::DeadChannel,
            _,
        )
        | (Cause::Planner, Context::Planning | Context::Held) => at_once(Severity::Warn),
        // A tether that is only near a limit needs no action at once; one that is at its limit holds the robot.
        (Cause::Tether(word), _) if has_own_limit(word) && severity < Severity::Crit => {
            rule(Severity::Warn, CYCLE_S, TURN_S)
        }
        _ => at_once(Severity::Crit),
    }
}

/// Whether a tether alarm is about a figure that can go to and fro at its limit: a length, a wrap or a pull.
fn has_own_limit(word: &str) -> bool {
    matches!(word, "reel" | "wrap" | "total wrap" | "reel pull" | "robot pull")
}

/// What sag, stretch and position errors may add to the tether that a plan promises: metres, and a share of its length.
const REEL_MARGIN: (f64, f64) = (0.5, 0.02);

/// The length of tether out at which its reel counts as nearly out, metres. A certified plan that promises a length,
/// metres, may use it: the alarm is raised only beyond that promise.
pub fn reel_limit_m(reel_length_m: f64, promised_m: Option<f64>) -> f64 {
    let (margin_m, share) = REEL_MARGIN;
    let promised_m = promised_m.map_or(0.0, |promised_m| promised_m * (1.0 + share) + margin_m);
    promised_m.max(TetherAlarm::NEAR * reel_length_m).min(reel_length_m)
}

/// The severity of the alarm of a cause for which the robot is held.
pub fn held_for(cause: &Cause) -> Option<Severity> {
    match cause {
        Cause::PositionLost | Cause::Contradiction | Cause::Certificate => Some(Severity::Crit),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_alarm_is_more_severe_than_its_event() {
        for cause in Cause::every() {
            for context in Context::EVERY {
                for severity in [Severity::Watch, Severity::Warn, Severity::Crit] {
                    let rule = rule(&cause, severity, context);
                    assert!(rule.severity <= severity, "{cause:?} {context:?}");
                    // A critical cause at which the robot is held at once must not wait.
                    let waits = matches!(cause, Cause::PositionLost | Cause::Contradiction);
                    assert!(rule.severity < Severity::Crit || rule.on_delay_s == 0.0 || waits, "{cause:?}");
                }
            }
        }
    }

    #[test]
    fn a_certified_plan_may_use_the_tether_that_it_promises() {
        let limits_m = [None, Some(50.0), Some(90.0), Some(99.0)].map(|m| reel_limit_m(100.0, m));
        // A short plan leaves the limit where it is; no limit is beyond the reel.
        for (limit_m, expected_m) in limits_m.into_iter().zip([80.0, 80.0, 92.3, 100.0]) {
            assert!((limit_m - expected_m).abs() < 1e-9, "{limits_m:?}");
        }
    }

    #[test]
    fn a_refused_plan_is_critical_only_where_the_robot_is_held_for_it() {
        let severity = |context| rule(&Cause::Certificate, Severity::Crit, context).severity;
        assert_eq!(Context::EVERY.map(severity), {
            use Severity::{Warn, Watch};
            [Warn, Watch, Watch, Warn, Warn]
        });
        assert_eq!(held_for(&Cause::Certificate), Some(Severity::Crit));
    }
}
