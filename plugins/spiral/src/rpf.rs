//! The rotating potential field.

use crate::potential::{Kind, Potential};
use field::{FieldSettings, open_points as o, params as p};
use planner_api::{Config, ParamSpec};

/// The rotating potential field of Wang et al. 2023, in both interpretations.
///
/// For a point robot, planning applies the force law step by step, as in the paper. For a robot with a hull, this
/// nearly always fails, so planning simulates a mission over the known map instead. During the mission, the rotating
/// force acts around whatever is in the way, on the side of the smaller detour, unless configured differently; as
/// printed in the paper, the method gets stuck.
pub type Rpf = Potential<Rotating>;

/// Selects the force law of [`Rpf`].
pub enum Rotating {}

impl Kind for Rotating {
    const ID: &'static str = "rpf";
    const NAME: &'static str = "Rotating potential field";
    const ABOUT: &'static str = "Potential field with a rotating force around obstacles, along a preset \
                                 spiral, after Wang et al. 2023. Evades moving obstacles unless steered as \
                                 in the paper.";
    const PARAMS: &'static [ParamSpec] = &[
        p::READING,
        p::SENSE,
        p::ROTATION,
        p::K_ATT,
        p::K_REP,
        p::K_ROT,
        p::RHO_0,
        p::REPULSION_IMPROVED,
        p::EXPONENT,
        o::GATE,
        o::BESIDE,
        o::PUSH_FORM,
        o::PUSH_OF,
        o::TARGETS,
        o::MOVE_LENGTH,
        p::WALL_GAIN,
        p::PLANNING,
        p::STEP,
        p::GOTO_STEP,
        p::FLEXIBLE,
        p::TURN_LIMIT,
        p::MAX_LAG,
        p::STEERING,
        p::GUARD,
        p::GUARD_SIGMAS,
        p::SLOW,
        p::MIN_SHARE,
        p::STUCK,
        p::EVADE,
    ];

    fn settings(config: &Config<'_>) -> FieldSettings {
        let mut settings = o::read(p::rotating_settings(config), config);
        settings.law.beside = o::beside(config);
        settings
    }
}

#[cfg(test)]
mod tests;
