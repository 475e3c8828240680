//! What an action is: a row of the table.

use super::ActionId;
use super::argument::Arg;
use super::context::Context;
use crate::keys::Key;
use crate::model::Model;
use crate::update::Effect;

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

/// What an action reaches beyond the screen, and so which consoles have it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Reach {
    /// Nothing but this screen: every console has it.
    Screen,
    /// Another run, or the folder of one: not a console that looks on.
    Runs,
    /// How fast time goes and whether it does, in a mission or a replay: not a console that looks on.
    Pace,
    /// The mission: only the console that runs it.
    Mission,
}

/// What an action does; one whose id carries a value does the same with each.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Deed {
    /// It opens the command line for its value.
    Begin,
    /// It changes what the operator looks at, and nothing else.
    Look(fn(&mut Model)),
    /// It changes the model, and there may be something to do outside.
    Act(fn(&mut Model) -> Vec<Effect>),
}

/// One thing the operator can do.
#[derive(Debug, Clone, Copy)]
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
    /// What it reaches.
    pub(crate) reach: Reach,
    /// Whether it can be done now, and why not otherwise; keys are named as `<end>`.
    pub(crate) can: fn(&Model) -> Result<(), String>,
    /// What it does.
    pub(crate) deed: Deed,
}

impl PartialEq for Action {
    /// Whether it is the same row: an action has one for each set of keys.
    fn eq(&self, other: &Self) -> bool {
        (self.id, self.name, self.contexts) == (other.id, other.name, other.contexts)
    }
}

impl Eq for Action {}

/// A row of the table. Unless it says otherwise, its action is safe, reaches nothing, can be done at any time, and opens the command
/// line for its value.
pub(crate) const fn action(
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
        reach: Reach::Screen,
        can: |_| Ok(()),
        deed: Deed::Begin,
    }
}

impl Action {
    pub(super) const fn label(self, label: &'static str) -> Self {
        Self { label, ..self }
    }

    pub(super) const fn risk(self, risk: Risk) -> Self {
        Self { risk, reach: Reach::Mission, ..self }
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

    pub(super) const fn reaches(self, reach: Reach) -> Self {
        Self { reach, ..self }
    }

    pub(crate) const fn when(self, can: fn(&Model) -> Result<(), String>) -> Self {
        Self { can, ..self }
    }

    pub(crate) const fn does(self, act: fn(&mut Model) -> Vec<Effect>) -> Self {
        Self { deed: Deed::Act(act), ..self }
    }

    pub(super) const fn looks(self, look: fn(&mut Model)) -> Self {
        Self { deed: Deed::Look(look), ..self }
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
