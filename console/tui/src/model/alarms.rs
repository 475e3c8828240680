//! What is wrong, and whether the operator has seen it.

use mission::Severity;
use serde::{Deserialize, Serialize};

/// Most alarms kept; there are fewer causes than that.
const MAX_ALARMS: usize = 64;

/// What an alarm is about; each cause has one alarm at most.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Cause {
    /// The position error is beyond the limit.
    PositionLost,
    /// The ranges contradict each other.
    Contradiction,
    /// The ranges give no position.
    NoFix,
    /// A station is left out.
    Station(world::StationId),
    /// An obstacle was found that is not on the drawing.
    Map,
    /// The cable comes near a limit or has reached it: which one.
    Tether(String),
    /// The last plan could not be certified for the tether.
    Certificate,
    /// The planner failed.
    Planner,
    /// The robot gets nowhere.
    Stuck,
    /// The run ended otherwise than complete.
    Ended,
    /// The run is not being written down.
    Recording,
    /// A part of the console failed.
    Console,
}

/// One alarm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Alarm {
    /// What it is about.
    pub cause: Cause,
    /// How much it asks of the operator.
    pub severity: Severity,
    /// What is wrong, as a sentence.
    pub text: String,
    /// Mission time since when, seconds.
    pub since_s: f64,
    /// Whether the cause persists.
    pub active: bool,
    /// Whether the operator has seen it.
    pub acknowledged: bool,
    /// The lower severity to which it has fallen since, with its words; shown once the operator has seen the worse.
    #[serde(default)]
    pub fallen: Option<(Severity, String)>,
}

impl Alarm {
    fn new(cause: Cause, severity: Severity, text: String, since_s: f64) -> Self {
        Self { cause, severity, text, since_s, active: true, acknowledged: false, fallen: None }
    }

    /// Takes what its cause says now. What the operator has not seen is never replaced by something less severe.
    fn take(&mut self, severity: Severity, text: String, t_s: f64) {
        let was_active = std::mem::replace(&mut self.active, true);
        if !self.acknowledged && severity < self.severity {
            self.fallen = Some((severity, text));
            return;
        }
        if !was_active || severity > self.severity {
            (self.acknowledged, self.since_s) = (false, t_s);
        }
        (self.severity, self.text, self.fallen) = (severity, text, None);
    }

    /// Notes that the operator has seen it, and gives the words that were seen. Those of the lower severity were not, and
    /// may be about something else of the same cause: they are to be acknowledged next.
    fn acknowledge(&mut self) -> String {
        let Some((severity, text)) = self.fallen.take() else {
            self.acknowledged = true;
            return self.text.clone();
        };
        self.severity = severity;
        std::mem::replace(&mut self.text, text)
    }
}

/// What is wrong, in the order in which it came.
///
/// An alarm stays until its cause has cleared and, from WARN on, the operator has acknowledged it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Alarms {
    list: Vec<Alarm>,
}

impl Alarms {
    /// Raises an alarm. One that is active already takes the new words; it needs another acknowledgement only if it became
    /// more severe.
    pub fn raise(&mut self, cause: Cause, severity: Severity, text: String, t_s: f64) {
        if let Some(alarm) = self.list.iter_mut().find(|alarm| alarm.cause == cause) {
            alarm.take(severity, text, t_s);
        } else if self.list.len() < MAX_ALARMS {
            self.list.push(Alarm::new(cause, severity, text, t_s));
        }
    }

    /// Notes that a cause has cleared.
    pub fn clear(&mut self, cause: &Cause) {
        for alarm in self.list.iter_mut().filter(|alarm| alarm.cause == *cause) {
            alarm.active = false;
        }
        self.drop_settled();
    }

    /// Acknowledges the worst alarm that the operator has not acknowledged, the oldest of them; returns its words.
    pub fn acknowledge(&mut self) -> Option<String> {
        let worst = self.list.iter().filter(|alarm| !alarm.acknowledged).map(|alarm| alarm.severity).max()?;
        let alarm = self.list.iter_mut().find(|alarm| !alarm.acknowledged && alarm.severity == worst)?;
        let text = alarm.acknowledge();
        self.drop_settled();
        Some(text)
    }

    /// Every alarm, in the order in which it came.
    pub fn list(&self) -> &[Alarm] {
        &self.list
    }

    /// The alarm to show where there is room for one: unacknowledged before acknowledged, then the worst.
    pub fn worst(&self) -> Option<&Alarm> {
        self.list.iter().rev().max_by_key(|alarm| (!alarm.acknowledged, alarm.severity))
    }

    /// How many there are of a severity.
    pub fn count(&self, severity: Severity) -> usize {
        self.list.iter().filter(|alarm| alarm.severity == severity).count()
    }

    /// How many of a severity the operator has not acknowledged.
    pub fn unacknowledged(&self, severity: Severity) -> usize {
        self.list.iter().filter(|alarm| alarm.severity == severity && !alarm.acknowledged).count()
    }

    fn drop_settled(&mut self) {
        self.list.retain(|alarm| alarm.active || (!alarm.acknowledged && alarm.severity >= Severity::Warn));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn raised(severity: Severity) -> Alarms {
        let mut alarms = Alarms::default();
        alarms.raise(Cause::PositionLost, severity, "position lost".into(), 1.0);
        alarms
    }

    #[test]
    fn a_critical_alarm_stays_until_it_is_acknowledged() {
        let mut alarms = raised(Severity::Crit);
        alarms.clear(&Cause::PositionLost);
        assert_eq!(alarms.count(Severity::Crit), 1);
        assert_eq!(alarms.acknowledge().as_deref(), Some("position lost"));
        assert!(alarms.list().is_empty());
    }

    #[test]
    fn an_acknowledged_alarm_stays_until_its_cause_is_gone_and_wakes_when_it_comes_back() {
        let mut alarms = raised(Severity::Crit);
        alarms.acknowledge();
        assert_eq!((alarms.count(Severity::Crit), alarms.unacknowledged(Severity::Crit)), (1, 0));
        alarms.clear(&Cause::PositionLost);
        alarms.raise(Cause::PositionLost, Severity::Crit, "again".into(), 2.0);
        assert_eq!(alarms.unacknowledged(Severity::Crit), 1);
    }

    #[test]
    fn something_to_watch_goes_with_its_cause() {
        let mut alarms = raised(Severity::Watch);
        alarms.clear(&Cause::PositionLost);
        assert!(alarms.list().is_empty());
    }

    #[test]
    fn the_worst_alarm_is_acknowledged_first() {
        let mut alarms = raised(Severity::Watch);
        alarms.raise(Cause::Planner, Severity::Crit, "planner failed".into(), 2.0);
        assert_eq!(alarms.worst().map(|a| a.text.as_str()), Some("planner failed"));
        assert_eq!(alarms.acknowledge().as_deref(), Some("planner failed"));
        assert_eq!(alarms.acknowledge().as_deref(), Some("position lost"));
        assert_eq!(alarms.acknowledge(), None);
    }

    /// The only alarm: severity and words, whether it is active and whether it was acknowledged.
    fn only(alarms: &Alarms) -> Option<(Severity, &str, bool, bool)> {
        let alarm = alarms.list().first()?;
        Some((alarm.severity, &alarm.text, alarm.active, alarm.acknowledged))
    }

    #[test]
    fn an_alarm_that_was_not_acknowledged_is_never_lowered() {
        for clears in [false, true] {
            let mut alarms = raised(Severity::Crit);
            if clears {
                alarms.clear(&Cause::PositionLost);
            }
            alarms.raise(Cause::PositionLost, Severity::Warn, "position poor".into(), 2.0);
            assert_eq!(only(&alarms), Some((Severity::Crit, "position lost", true, false)));
            assert_eq!(alarms.acknowledge().as_deref(), Some("position lost"));
            assert_eq!(only(&alarms), Some((Severity::Warn, "position poor", true, false)), "not seen yet");
            assert_eq!(alarms.acknowledge().as_deref(), Some("position poor"));
            alarms.raise(Cause::PositionLost, Severity::Watch, "position fair".into(), 3.0);
            assert_eq!(only(&alarms), Some((Severity::Watch, "position fair", true, true)));
        }
    }

    #[test]
    fn an_alarm_that_gets_worse_again_forgets_what_it_had_fallen_to() {
        let mut alarms = raised(Severity::Crit);
        alarms.raise(Cause::PositionLost, Severity::Warn, "position poor".into(), 2.0);
        alarms.raise(Cause::PositionLost, Severity::Crit, "lost again".into(), 3.0);
        alarms.acknowledge();
        assert_eq!(only(&alarms), Some((Severity::Crit, "lost again", true, true)));
    }
}
