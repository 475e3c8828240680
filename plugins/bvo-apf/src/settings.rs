//! What the planner can be set to.

use field::{GoalLaw, Pull};

/// How a trap is gone round.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// Round one circle about the whole trap, always on the left, after walking in: the paper, where it can be read.
    Literal,
    /// Along the hull of the trap instead of the circle, always on the left.
    Hull,
    /// Along the hull, on the side whose detour is shorter when walked in thought.
    Rollout,
    /// Rolled out, pulled taut and begun before the trap is entered; where that finds no way, by the others.
    Pre,
}

impl Mode {
    /// All modes, as they are ordered where one is chosen.
    pub const ALL: [Self; 4] = [Self::Literal, Self::Hull, Self::Rollout, Self::Pre];

    /// Its name where one is chosen.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Literal => "literal",
            Self::Hull => "hull",
            Self::Rollout => "rollout",
            Self::Pre => "pre",
        }
    }
}

/// Everything that a machine needs besides the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachineSettings {
    /// How a trap is gone round.
    pub mode: Mode,
    /// The field.
    pub law: GoalLaw,
    /// Length of a step, metres.
    pub step_m: f64,
    /// Distance kept from what is gone round, metres. Gaps that leave less than this on both sides count as closed.
    pub margin_m: f64,
    /// Distance between the hull and what a path is pulled taut around, metres.
    pub taut_margin_m: f64,
    /// Distance that no step goes below, metres.
    pub keep_m: f64,
    /// Way over which an oscillation is looked for, metres.
    pub window_m: f64,
    /// Escapes after which the planner gives up.
    pub escapes_max: u32,
}

impl MachineSettings {
    /// The same for a trip of some length from start to goal, metres: the base of the logarithm depends on it.
    #[must_use]
    pub fn for_trip(&self, length_m: f64) -> Self {
        let mut pull = self.law.pull;
        if let Pull::Logarithm { trip_m, .. } = &mut pull {
            *trip_m = length_m;
        }
        Self { law: GoalLaw { pull, ..self.law }, ..*self }
    }
}
