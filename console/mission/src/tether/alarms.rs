//! The alarms that have been raised, and their levels.

use crate::event::{EventKind, TetherAlarm};
use std::collections::BTreeMap;

/// Share of a limit below which an alarm is cleared.
const EASED: f64 = 0.75;

/// The level of an alarm.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
enum Level {
    #[default]
    Calm,
    Near,
    Reached,
}

/// The level of each alarm, by its kind.
#[derive(Clone, Default)]
pub(super) struct Alarms {
    levels: BTreeMap<&'static str, Level>,
}

impl Alarms {
    /// Updates the level of an alarm from its current value, given as a share of its limit; returns an event if the level
    /// changed.
    pub(super) fn check(&mut self, alarm: TetherAlarm, share: f64) -> Option<EventKind> {
        let level = self.levels.entry(alarm.word()).or_default();
        let now = match share {
            share if share > 1.0 => Level::Reached,
            share if share > TetherAlarm::NEAR => Level::Near,
            _ => Level::Calm,
        };
        if now > *level {
            *level = now;
            return Some(EventKind::TetherAlarmRaised { alarm, reached: now == Level::Reached });
        }
        if *level == Level::Reached && share <= 1.0 && share > EASED {
            // If the limit is exceeded once more, the alarm is raised again.
            *level = Level::Near;
            return Some(EventKind::TetherAlarmRaised { alarm, reached: false });
        }
        let eased = *level > Level::Calm && share <= EASED;
        eased.then(|| {
            *level = Level::Calm;
            EventKind::TetherAlarmCleared { alarm }
        })
    }
}
