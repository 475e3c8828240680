//! An action: one row of the action table.

use super::ActionId;
use super::argument::Arg;
use super::context::Context;
use crate::keys::Key;
use crate::model::Model;
use crate::update::Effect;

/// What an action can do to the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Risk {
    /// Cannot make the robot move and loses nothing.
    Safe,
    /// Changes how the robot will move, but does not make it move; asks for confirmation first.
    Changes,
    /// Can make the robot move; asks for confirmation first.
    Moves,
    /// Ends the mission; asks for confirmation first.
    Destroys,
}

impl Risk {
    /// The word that marks the risk in lists.
    pub fn word(self) -> &'static str {
        match self {
            Self::Safe => "safe",
            Self::Changes => "ASKS",
            Self::Moves => "MOVES",
            Self::Destroys => "ENDS",
        }
    }
}

/// The topic under which the help lists an action, in the order of the help.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Topic {
    /// The mission and its planner.
    Mission,
    /// Alarms, events, zones and stations.
    Alarms,
    /// Scenarios and runs.
    Runs,
    /// The map.
    Map,
    /// The console.
    Console,
    /// The screens.
    Screens,
}

impl Topic {
    /// The heading in the help.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mission => "Mission and planner",
            Self::Alarms => "Alarms, events, zones, stations",
            Self::Runs => "Scenarios and runs",
            Self::Map => "Map",
            Self::Console => "Console",
            Self::Screens => "Screens",
        }
    }
}

/// What an action affects beyond the screen; this determines which consoles offer the action.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Reach {
    /// Only this screen: every console offers the action.
    Screen,
    /// Another run or its folder: not offered on a view-only console.
    Runs,
    /// Time: whether it passes and how fast, in a mission or a replay. Not offered on a view-only console.
    Pace,
    /// The mission: offered only on the console that runs it.
    Mission,
}

/// The effect of an action. Actions whose ids carry a value have the same effect for every value.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Deed {
    /// Opens the command line to ask for the action's value.
    Begin,
    /// Changes only what the operator sees.
    Look(fn(&mut Model)),
    /// Changes the model and may return effects for the caller to carry out.
    Act(fn(&mut Model) -> Vec<Effect>),
}

/// An action of the operator.
#[derive(Debug, Clone, Copy)]
pub struct Action {
    /// The action's id.
    pub id: ActionId,
    /// The action's name in the command list: lower case, words joined by hyphens.
    pub name: &'static str,
    /// The description in the help.
    pub about: &'static str,
    /// The word next to the key in the footer; empty if the footer omits the action.
    pub label: &'static str,
    /// The action's keys; the first one is shown.
    pub keys: &'static [Key],
    /// What the action can do to the robot.
    pub risk: Risk,
    /// The contexts in which the keys work.
    pub contexts: &'static [Context],
    /// Whether the action repeats while its key is held down.
    pub repeats: bool,
    /// Other names for the action.
    pub synonyms: &'static [&'static str],
    /// The arguments of the command.
    pub args: &'static [Arg],
    /// The topic under which the help lists the action.
    pub topic: Topic,
    /// What the action affects beyond the screen.
    pub(crate) reach: Reach,
    /// Checks whether the action is possible now; the error is the reason why it is not, with keys written as
    /// `<end>`.
    pub(crate) can: fn(&Model) -> Result<(), String>,
    /// The effect of the action.
    pub(crate) deed: Deed,
}

impl PartialEq for Action {
    /// Compares rows, not actions: an action has one row for each set of keys.
    fn eq(&self, other: &Self) -> bool {
        (self.id, self.name, self.contexts) == (other.id, other.name, other.contexts)
    }
}

impl Eq for Action {}

/// Creates a row of the table. By default the action is safe, affects only the screen, is always possible, and opens
/// the command line to ask for its value.
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
        topic: Topic::Console,
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

    /// Whether the action's keys work in any of the given contexts.
    pub fn works_in(&self, contexts: &[Context]) -> bool {
        self.contexts.iter().any(|context| contexts.contains(context))
    }

    /// Whether the action can be run by name.
    pub fn is_command(&self) -> bool {
        self.contexts.iter().any(|context| context.has_commands())
    }

    /// Whether the command can be run without a value.
    pub fn runs_alone(&self) -> bool {
        self.args.iter().all(|arg| !arg.is_required)
    }

    /// The usage of the command, such as `open SCENARIO [PLANNER]`.
    pub fn usage(&self) -> String {
        let args = self.args.iter().map(|arg| format!(" {}", arg.usage()));
        std::iter::once(self.name.to_owned()).chain(args).collect()
    }
}
