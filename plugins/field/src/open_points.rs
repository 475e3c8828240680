//! What the texts of Wang et al. 2023 and Xu et al. 2022 leave open, as parameters; the defaults are our choices.
//!
//! Other choices come nearer to Wang's Table 1, and were selected on it: they show that the table is compatible with a
//! reading, not what the authors did.

use crate::{
    escape::{Escape, PushSide, PushStrength},
    law::Beside,
    laws::PushForm,
    settings::{FieldSettings, MoveLength, Targets},
    trap::Gate,
};
use planner_api::{Config, ParamSpec, choice};

const GROUP: &str = "Open points of the paper";

/// What counts as a trap.
pub const GATE: ParamSpec = choice("gate", "Gate", &["detected", "backward", "opposed"], 0)
    .help(
        "What counts as a trap. Detected: moves that lead hardly anywhere. By force, anew at every move: backward, the sum \
         of pull and push points away from the target; opposed, the push is more than 0.8 of the pull and opposed to it.",
    )
    .group(GROUP);
/// Which target comes next.
pub const TARGETS: ParamSpec = choice("targets", "Next target", &["lock-step", "ahead"], 0)
    .help(
        "Lock-step: the next preset point after every move. Ahead: the one behind the nearest ahead, if that is further on.",
    )
    .group(GROUP);
/// How long a move is.
pub const MOVE_LENGTH: ParamSpec = choice("move_length", "Length of a move", &["to-target", "by-force"], 0)
    .help("Up to the step: as far as the target, or as far as the force over the attraction gain.")
    .group(GROUP);
/// How the push falls with the distance.
pub const PUSH_FORM: ParamSpec = choice("push_form", "Form of the repulsion", &["khatib", "inverse"], 0)
    .help("Khatib: (1/rho - 1/rho0) / rho2. Inverse: 1/rho - 1/rho0.")
    .group(GROUP);
/// The same for planners to a goal.
pub const GOAL_PUSH_FORM: ParamSpec =
    choice("push_form", "Form of the repulsion", &["khatib", "hyperbola"], 0)
        .help("Khatib: (1/rho - 1/rho0) / rho2, the paper's eq. 2. Hyperbola: 1/rho up to rho0, its eq. 8 turned round.")
        .group(GROUP);
/// What pushes.
pub const PUSH_OF: ParamSpec = choice("push_of", "Repulsion of", &["all", "nearest"], 0)
    .help("All obstacles in range push, or the nearest alone.")
    .group(GROUP);
/// What acts beside the rotating force, or beside the push to the side.
pub const BESIDE: ParamSpec = choice("beside", "What acts beside it", &["all", "pull", "nothing"], 0)
    .help("Beside the rotating force, or the push to the side, while it acts: pull and push, the pull alone, or nothing.")
    .group(GROUP);
/// How strong the push to the side is.
pub const PUSH: ParamSpec = choice("push", "Push to the side", &["held", "half-pull", "pull", "unit-pull"], 0)
    .help(
        "Held: twice the pull, half of it ahead, for five moves. Half-pull and pull: so much of the pull across the way, for one move. \
         Unit-pull: the pull of a target one metre off across the way, for one move.",
    )
    .group(GROUP);
/// To which side it is pushed.
pub const PUSH_SIDE: ParamSpec =
    choice("push_side", "Side of the push", &["repulsion", "right", "random", "alternating"], 0)
        .help("To where obstacles push, to the right, at random (the same sequence in every plan), or from side to side.")
        .group(GROUP);

/// The settings with what every planner on a preset path reads: all but [`BESIDE`], [`PUSH`] and [`PUSH_SIDE`].
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

/// How the push of a planner to a goal falls with the distance.
pub fn goal_push_form(config: &Config<'_>) -> PushForm {
    if config.choice("push_form") == "hyperbola" { PushForm::Hyperbola } else { PushForm::Khatib }
}

/// What acts beside the rotating force, or beside the push to the side.
pub fn beside(config: &Config<'_>) -> Beside {
    match config.choice("beside") {
        "pull" => Beside::Pull,
        "nothing" => Beside::Nothing,
        _ => Beside::All,
    }
}

/// The push to the side.
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
