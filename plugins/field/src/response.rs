//! The responses to traps during a walk or a flight: the rotating force, and the escape.

use crate::{
    escape::{Escaping, Situation},
    settings::FieldSettings,
    trap::{Gate, TrapDetector},
    turning::Turning,
};
use geometry::Vector;
use steering::Source;

/// Detects traps and responds as configured.
#[derive(Debug, Clone)]
pub struct TrapResponse {
    gate: Gate,
    detector: TrapDetector,
    escaping: Escaping,
    /// When the rotating force acts, and its direction.
    pub turning: Turning,
    /// The force of the escape in progress; zero if there is none.
    pub escape: Vector,
}

impl TrapResponse {
    /// Creates the state of a robot that has not moved yet.
    pub fn new(settings: &FieldSettings) -> Self {
        Self {
            gate: settings.gate,
            detector: TrapDetector::default(),
            escaping: Escaping::new(settings.escape),
            turning: Turning::new(settings.reading, settings.rule, settings.gate),
            escape: Vector::zeros(),
        }
    }

    /// Processes the situation before a move; `expected_m` is the distance that an unobstructed move would cover.
    pub fn update(&mut self, now: &Situation<'_>, expected_m: f64) {
        let to_goal = now.goal - now.at;
        self.detector.record(now.at);
        let obstacle_acts = now.contacts.iter().any(|c| c.source != Source::Wall);
        let is_trapped = match self.gate {
            Gate::Detected => self.detector.is_trapped(expected_m, now.step_m, to_goal.norm(), obstacle_acts),
            by_force => obstacle_acts && by_force.is_open(&now.without_rotation()),
        };
        self.turning.update(is_trapped, now.contacts, to_goal);
        self.escape = self.escaping.update(now, is_trapped);
    }
}
