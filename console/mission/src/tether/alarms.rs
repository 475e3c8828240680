//! Which alarms have been raised, and how far each has gone.

use crate::event::{EventKind, TetherAlarm};
use std::collections::BTreeMap;

/// Share of a limit from which the operator is warned.
const NEAR: f64 = 0.8;
/// Share of a limit below which an alarm is over.
const EASED: f64 = 0.75;

/// How far an alarm has gone.
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
    /// What is newly wrong or right again, at this share of the limit.
    pub(super) fn check(&mut self, alarm: TetherAlarm, share: f64) -> Option<EventKind> {
        let level = self.levels.entry(alarm.word()).or_default();
        let now = match share {
            share if share > 1.0 => Level::Reached,
            share if share > NEAR => Level::Near,
            _ => Level::Calm,
        };
        if now > *level {
            *level = now;
            return Some(EventKind::TetherAlarmRaised { alarm, reached: now == Level::Reached });
        }
        if *level == Level::Reached && share <= 1.0 && share > EASED {
            // Raised again if the limit is passed again.
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
