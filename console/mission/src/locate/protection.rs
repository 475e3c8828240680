//! The protection of the pose, and when it was lost.

use crate::event::EventKind;
use positioning::{Guard, Positioner, PositionerConfig, Risk};

/// The guard of a pose, with its last finding.
#[derive(Clone)]
pub(super) struct Protection {
    /// Takes the same readings as the positioner.
    pub guard: Guard,
    is_lost: bool,
}

impl Protection {
    /// Creates the protection for the positioner with this configuration.
    pub(super) fn new(config: &PositionerConfig, risk: Risk) -> Self {
        Self { guard: Guard::new(config, risk), is_lost: false }
    }

    /// Returns the events about the protection of the estimate that follows.
    pub(super) fn events(&mut self, positioner: &Positioner) -> Vec<EventKind> {
        let level = self.guard.level_m(positioner);
        let was_lost = std::mem::replace(&mut self.is_lost, level.is_err());
        let news = match level {
            Err(why) if !was_lost => Some(EventKind::ProtectionLost { why }),
            Ok(level_m) if was_lost => Some(EventKind::ProtectionRegained { level_m }),
            _ => None,
        };
        [EventKind::Protected { level_m: level.ok() }].into_iter().chain(news).collect()
    }
}
