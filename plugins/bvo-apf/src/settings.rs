//! The settings of the planner.

use field::{GoalLaw, Pull};

/// How the robot goes around a trap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// Around one circle that encloses the whole trap, always on the left, after walking in: as in the paper, as far as
    /// the paper is clear.
    Literal,
    /// Along the hull of the trap instead of the circle, always on the left.
    Hull,
    /// Along the hull, on the side with the shorter simulated detour.
    Rollout,
    /// Like a rollout, but pulled taut, and begun before the robot enters the trap. If that finds no path, the other
    /// modes are tried.
    Pre,
}

impl Mode {
    /// All modes, in the order of the options of the parameter.
    pub const ALL: [Self; 4] = [Self::Literal, Self::Hull, Self::Rollout, Self::Pre];

    /// The name of the mode as an option of the parameter.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Literal => "literal",
            Self::Hull => "hull",
            Self::Rollout => "rollout",
            Self::Pre => "pre",
        }
    }
}

/// All settings of a machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachineSettings {
    /// How the robot goes around a trap.
    pub mode: Mode,
    /// The field.
    pub law: GoalLaw,
    /// Length of a step, metres.
    pub step_m: f64,
    /// Distance kept from the solids that the robot goes around, metres. Gaps that leave less than this on both sides
    /// are treated as closed.
    pub margin_m: f64,
    /// Distance between the hull and the solids around which a path is pulled taut, metres.
    pub taut_margin_m: f64,
    /// Minimum distance that every step keeps, metres.
    pub keep_m: f64,
    /// Distance over which an oscillation is detected, metres.
    pub window_m: f64,
    /// Number of escapes after which the planner gives up.
    pub escapes_max: u32,
}

impl MachineSettings {
    /// Adapts the settings to a trip of some length from start to goal, metres: the base of the logarithm depends on
    /// it.
    #[must_use]
    pub fn for_trip(&self, length_m: f64) -> Self {
        let mut pull = self.law.pull;
        if let Pull::Logarithm { trip_m, .. } = &mut pull {
            *trip_m = length_m;
        }
        Self { law: GoalLaw { pull, ..self.law }, ..*self }
    }
}
