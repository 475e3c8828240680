//! The state of the rule that limits commands.

use crate::{config::MissionConfig, governor::Momentum};
use world::{Medium, Mode, SensedMedium, Zone};

/// A limit is reported again only after nothing was limited for this long, seconds.
const NAMED_AGAIN_S: f64 = 10.0;
/// State of the rule that limits commands.
#[derive(Debug, Clone)]
pub(in crate::engine) struct Governor {
    pub(in crate::engine) momentum: Momentum,
    /// Whether an amphibious robot walks or swims.
    pub(in crate::engine) mode: Mode,
    /// The medium according to the pressure sensor, for a robot that has one.
    pub(in crate::engine) sensed: SensedMedium,
    pub(in crate::engine) has_said_that_it_waits: bool,
    pub(in crate::engine) limited: Limited,
}

/// How long commands have been limited, or how long they have not been.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::engine) struct Limited {
    for_s: f64,
    free_s: f64,
    is_named: bool,
}

impl Limited {
    /// Records one more command; returns whether to report now that commands are limited, which is after
    /// `named_after_s` seconds.
    pub(in crate::engine) fn update(&mut self, is_limited: bool, tick_s: f64, named_after_s: f64) -> bool {
        if !is_limited {
            self.for_s = 0.0;
            self.free_s += tick_s;
            self.is_named &= self.free_s < NAMED_AGAIN_S;
            return false;
        }
        self.free_s = 0.0;
        self.for_s += tick_s;
        self.for_s >= named_after_s && !std::mem::replace(&mut self.is_named, true)
    }
}

impl Governor {
    /// The state for a robot at rest at its start.
    pub(in crate::engine) fn new(config: &MissionConfig, zones: &[Zone]) -> Self {
        let mode = Mode::of(Medium::at(zones, config.start.position));
        Self {
            momentum: Momentum::NONE,
            mode,
            sensed: SensedMedium::default(),
            has_said_that_it_waits: false,
            limited: Limited::default(),
        }
    }

    /// Records that the robot has stopped.
    pub(in crate::engine) fn stand(&mut self) {
        self.momentum = Momentum::NONE;
    }
}
