//! What an action is: a row of the table.

use super::ActionId;
use super::argument::Arg;
use super::context::Context;
use crate::keys::Key;

/// What an action can do to the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Risk {
    /// It cannot make the robot move and loses nothing.
    Safe,
    /// It can make the robot move: it asks first.
    Moves,
    /// It ends the mission: it asks first.
    Destroys,
}

impl Risk {
    /// How lists show it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Safe => "safe",
            Self::Moves => "MOVES",
            Self::Destroys => "ENDS",
        }
    }
}

/// One thing the operator can do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Action {
    /// Its id.
    pub id: ActionId,
    /// Its name in the command list, lower case, words joined by hyphens.
    pub name: &'static str,
    /// What it does.
    pub about: &'static str,
    /// The word beside its key in the footer; empty for what the footer leaves out.
    pub label: &'static str,
    /// Its keys, the one to show first.
    pub keys: &'static [Key],
    /// What it can do to the robot.
    pub risk: Risk,
    /// Where its keys work.
    pub contexts: &'static [Context],
    /// Whether it follows a key that repeats.
    pub repeats: bool,
    /// Other words for its name.
    pub synonyms: &'static [&'static str],
    /// What its command takes.
    pub args: &'static [Arg],
}

pub(super) const fn action(
    id: ActionId,
    name: &'static str,
    about: &'static str,
    keys: &'static [Key],
    contexts: &'static [Context],
) -> Action {
    Action {
        id,
        name,
        about,
        label: "",
        keys,
        risk: Risk::Safe,
        contexts,
        repeats: false,
        synonyms: &[],
        args: &[],
    }
}

impl Action {
    pub(super) const fn label(self, label: &'static str) -> Self {
        Self { label, ..self }
    }

    pub(super) const fn risk(self, risk: Risk) -> Self {
        Self { risk, ..self }
    }

    pub(super) const fn repeats(self) -> Self {
        Self { repeats: true, ..self }
    }

    pub(super) const fn also(self, synonyms: &'static [&'static str]) -> Self {
        Self { synonyms, ..self }
    }

    pub(super) const fn args(self, args: &'static [Arg]) -> Self {
        Self { args, ..self }
    }

    /// Whether its keys work in one of some contexts.
    pub fn works_in(&self, contexts: &[Context]) -> bool {
        self.contexts.iter().any(|context| contexts.contains(context))
    }

    /// Whether it can be run by its name.
    pub fn is_command(&self) -> bool {
        self.contexts.iter().any(|context| context.has_commands())
    }

    /// Whether its command can be run without a value.
    pub fn runs_alone(&self) -> bool {
        self.args.iter().all(|arg| !arg.is_required)
    }

    /// How its command is written, such as `open SCENARIO [PLANNER]`.
    pub fn usage(&self) -> String {
        let args = self.args.iter().map(|arg| format!(" {}", arg.usage()));
        std::iter::once(self.name.to_owned()).chain(args).collect()
    }
}
