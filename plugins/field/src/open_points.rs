//! Parameters for points that the texts of Wang et al. 2023 and Xu et al. 2022 leave open. The defaults are our
//! choices.
//!
//! Other choices come closer to Wang's Table 1, but they were selected to match it. They show that the table is
//! compatible with an interpretation, not what the authors did.

use crate::{
    escape::{Escape, PushSide, PushStrength},
    law::Beside,
    laws::PushForm,
    settings::{FieldSettings, MoveLength, Targets},
    trap::Gate,
};
use planner_api::{Config, ParamSpec, choice};

const GROUP: &str = "Left open by the paper";

/// When the robot is considered trapped.
pub const GATE: ParamSpec = choice("gate", "Gate", &["detected", "backward", "opposed"], 0)
    .help(
        "When the robot is considered trapped. Detected: recent moves make almost no headway. The other \
         two are checked at every move. Backward: the sum of pull and push points away from the target. \
         Opposed: the push exceeds 0.8 of the pull and opposes it.",
    )
    .group(GROUP);
/// The next target.
pub const TARGETS: ParamSpec = choice("targets", "Next target", &["lock-step", "ahead"], 0)
    .help(
        "Lock-step: the next preset point after every move. Ahead: the point after the nearest one ahead, \
         but at least the next in the list.",
    )
    .group(GROUP);
/// The length of a move.
pub const MOVE_LENGTH: ParamSpec = choice("move_length", "Move length", &["to-target", "by-force"], 0)
    .help(
        "To-target: as far as the target. By-force: the force divided by the attraction gain. Neither \
         exceeds the step.",
    )
    .group(GROUP);
/// How the push decreases with distance.
pub const PUSH_FORM: ParamSpec = choice("push_form", "Repulsion form", &["khatib", "inverse"], 0)
    .help("Khatib: (1/rho - 1/rho0) / rho2. Inverse: 1/rho - 1/rho0.")
    .group(GROUP);
/// How the push decreases with distance, for goal planners.
pub const GOAL_PUSH_FORM: ParamSpec = choice("push_form", "Repulsion form", &["khatib", "hyperbola"], 0)
    .help(
        "Khatib: (1/rho - 1/rho0) / rho2, eq. 2 of the paper. Hyperbola: 1/rho up to rho0, eq. 8 of \
               the paper with its direction reversed.",
    )
    .group(GROUP);
/// The obstacles that push.
pub const PUSH_OF: ParamSpec = choice("push_of", "Repulsion from", &["all", "nearest"], 0)
    .help("All obstacles in range push, or only the nearest.")
    .group(GROUP);
/// The forces that act together with the rotating force or the sideways push.
pub const BESIDE: ParamSpec = choice("beside", "Companion force", &["all", "pull", "nothing"], 0)
    .help(
        "What acts together with the rotating force or the sideways push: pull and push, the pull alone, \
           or nothing.",
    )
    .group(GROUP);
/// Strength of the sideways push.
pub const PUSH: ParamSpec = choice("push", "Sideways push", &["held", "half-pull", "pull", "unit-pull"], 0)
    .help(
        "Held: twice the pull across the path and half as much ahead, for five moves. Half-pull and pull: \
         half or all of the pull, across the path, for one move. Unit-pull: the pull of a target 1 m away, \
         across the path, for one move.",
    )
    .group(GROUP);
/// Side of the sideways push.
pub const PUSH_SIDE: ParamSpec =
    choice("push_side", "Side of the push", &["repulsion", "right", "random", "alternating"], 0)
        .help(
            "Repulsion: the side to which obstacles push. Right: always the right. Random: a random side, \
             in the same sequence in every plan. Alternating: each side in turn.",
        )
        .group(GROUP);

/// Adds the settings that every planner on a preset path reads: all but [`BESIDE`], [`PUSH`] and [`PUSH_SIDE`].
pub fn read(settings: FieldSettings, config: &Config<'_>) -> FieldSettings {
    let mut read = settings;
    read.gate = match config.choice("gate") {
        "backward" => Gate::Backward,
        "opposed" => Gate::Opposed,
        _ => Gate::Detected,
    };
    let is = |key: &str, word: &str| config.choice(key) == word;
    read.walking.targets = if is("targets", "ahead") { Targets::Ahead } else { Targets::LockStep };
    read.walking.length =
        if is("move_length", "by-force") { MoveLength::ByForce } else { MoveLength::ToTarget };
    read.law.form = if is("push_form", "inverse") { PushForm::Inverse } else { PushForm::Khatib };
    read.law.nearest_only = is("push_of", "nearest");
    read
}

/// Reads how the push of a goal planner decreases with distance.
pub fn goal_push_form(config: &Config<'_>) -> PushForm {
    if config.choice("push_form") == "hyperbola" { PushForm::Hyperbola } else { PushForm::Khatib }
}

/// Reads the forces that act together with the rotating force or the sideways push.
pub fn beside(config: &Config<'_>) -> Beside {
    match config.choice("beside") {
        "pull" => Beside::Pull,
        "nothing" => Beside::Nothing,
        _ => Beside::All,
    }
}

/// Reads the sideways push.
pub fn push(config: &Config<'_>) -> Escape {
    let strength = match config.choice("push") {
        "half-pull" => PushStrength::HalfPull,
        "pull" => PushStrength::Pull,
        "unit-pull" => PushStrength::UnitPull,
        _ => PushStrength::Held,
    };
    let side = match config.choice("push_side") {
        "right" => PushSide::Right,
        "random" => PushSide::Random,
        "alternating" => PushSide::Alternating,
        _ => PushSide::Repulsion,
    };
    Escape::Push { strength, side }
}
