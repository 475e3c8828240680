//! Planners as the mission knows them: who they are, what parameters they take, how they fail.

mod sandbox;

pub use sandbox::Sandbox;

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// The value of a parameter as scenarios, the command line and the screen have it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum ParamValue {
    /// On or off.
    Flag(bool),
    /// A whole number.
    Int(i64),
    /// A real number.
    Float(f64),
    /// One of the words of a choice.
    Word(String),
}

impl fmt::Display for ParamValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flag(on) => write!(f, "{on}"),
            Self::Int(number) => write!(f, "{number}"),
            Self::Float(number) => write!(f, "{number}"),
            Self::Word(word) => f.write_str(word),
        }
    }
}

/// Parameter values by key, in a fixed order.
pub type Parameters = BTreeMap<String, ParamValue>;

/// Which planner drives, with the parameters that differ from their defaults.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PlannerChoice {
    /// The planner's id.
    pub id: String,
    /// Values set by hand; the others take their defaults.
    #[serde(default)]
    pub parameters: Parameters,
}

/// What values a parameter takes; the owned form of [`planner_api::Kind`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum ParamKind {
    /// A real number.
    Float {
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
        /// Value when nothing is set.
        default: f64,
    },
    /// A whole number.
    Int {
        /// Smallest value.
        min: i64,
        /// Largest value.
        max: i64,
        /// Value when nothing is set.
        default: i64,
    },
    /// On or off.
    Flag {
        /// Value when nothing is set.
        default: bool,
    },
    /// One of some words.
    Choice {
        /// The words.
        options: Vec<String>,
        /// The word when nothing is set.
        default: String,
    },
}

/// One parameter; the owned form of [`planner_api::ParamSpec`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ParamInfo {
    /// Name in scenarios and on the command line.
    pub key: String,
    /// Name on screen.
    pub label: String,
    /// Unit; empty for a pure number.
    pub unit: String,
    /// What it does.
    pub help: String,
    /// Heading under which the screen lists it.
    pub group: String,
    /// What values it takes.
    #[serde(flatten)]
    pub kind: ParamKind,
    /// Whether it may change while the mission runs.
    pub live: bool,
}

/// A planner that was found, or that drives.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlannerInfo {
    /// Its id.
    pub id: String,
    /// Name on screen.
    pub name: String,
    /// Version of its plugin.
    pub version: String,
    /// One sentence about it.
    pub about: String,
    /// File name of its plugin, without the folder.
    pub plugin: String,
    /// SHA-256 of the plugin file, hexadecimal.
    pub sha256: String,
    /// Planner ABI it was built for, as `major.minor`.
    pub abi: String,
    /// Whether it covers floor.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub covers: bool,
    /// Whether it can save its private state and go on from it in a new process.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub snapshots: bool,
    /// How far its process is closed off, on the machine where it was found or drives; absent in older journals.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sandbox: Option<Sandbox>,
    /// Its parameters.
    pub parameters: Vec<ParamInfo>,
}

/// A plugin that was found and not accepted.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RefusedPlugin {
    /// File name of the plugin, without the folder.
    pub plugin: String,
    /// Why, as a sentence.
    pub reason: String,
}

impl RefusedPlugin {
    /// Whether its file is called as one that holds the planner of this id usually is.
    pub fn is_named_after(&self, id: &str) -> bool {
        let stem = self.plugin.split_once('.').map_or(&*self.plugin, |(stem, _)| stem);
        stem.split_once("planner_").is_some_and(|(_, name)| name.replace('_', "-") == id.replace('_', "-"))
    }
}

impl PlannerInfo {
    /// Why it cannot fly a mission over a whole floor, if it cannot; the sentence reads on after the planner's name.
    pub fn why_no_coverage(&self) -> Option<&'static str> {
        (!self.covers).then_some("does not support coverage missions")
    }

    /// Whether it has this parameter and lets it change while the robot moves.
    pub fn has_live(&self, key: &str) -> bool {
        self.parameters.iter().any(|param| param.key == key && param.live)
    }
}

/// During which call a planner failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum During {
    /// Finding and loading the plugin.
    Load,
    /// Making the planner.
    Configure,
    /// Planning.
    Plan,
    /// Deciding a step.
    Step,
}

impl fmt::Display for During {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Load => "load",
            Self::Configure => "configure",
            Self::Plan => "plan",
            Self::Step => "step",
        })
    }
}

/// What kind of fault it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// The planner itself said no, with this code; its process is well.
    Planner(planner_api::Code),
    /// It panicked.
    Panic,
    /// Its process ended: a signal, an abort, an exit.
    Died,
    /// It did not answer although it had the processor to itself for the whole time allowed, or it was stopped; its
    /// process was killed.
    Hung,
    /// It answered only after it was asked to stop: too slow.
    Late,
    /// It hardly got the processor, for very long; its process was killed.
    Starved,
    /// It answered with numbers that are not finite or beyond the robot's limits.
    BadOutput,
    /// It tried to do something outside its process that no planner may do; its process was killed.
    Forbidden,
    /// It sent something that is not a valid answer.
    Protocol,
    /// The host refused to load or configure it.
    Refused,
    /// It failed too often and may not drive again in this mission.
    Quarantined,
}

impl Cause {
    /// Whether the process failed from outside the planner's own logic, by the clock, by what the machine enforces, or by
    /// something that reached the console unasked, as from a thread that outlived its call: computing the run again need not
    /// show it again, or not in the same tick. After such a fault the process is gone.
    pub fn is_external(self) -> bool {
        matches!(
            self,
            Self::Died | Self::Hung | Self::Late | Self::Starved | Self::Forbidden | Self::Protocol
        )
    }
}

/// A planner's failure, worded so that an operator knows what happened.
///
/// `message` names planner, cause and step, and carries no figure that differs between two equal runs (no
/// milliseconds, no process ids): it goes into the journal, which must repeat byte for byte.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, thiserror::Error)]
#[error("{message}")]
pub struct Fault {
    /// Id of the planner.
    pub planner: String,
    /// During which call.
    pub during: During,
    /// What kind.
    pub cause: Cause,
    /// One sentence.
    pub message: String,
    /// For a plan that got only part of the way: that part.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub partial: Vec<world::Point>,
    /// SHA-256 of the plugin's file, hexadecimal, as far as it is known by then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plugin_sha256: Option<String>,
}

impl Fault {
    /// Whether it is the planner's answer that no way leads from the start to the goal, and so no failure of the planner.
    pub fn is_no_way(&self) -> bool {
        use planner_api::Code::{GoalOccupied, GoalOutside, NoPath, StartOccupied, StartOutside};
        let says = |code| matches!(code, NoPath | GoalOccupied | GoalOutside | StartOccupied | StartOutside);
        matches!(self.cause, Cause::Planner(code) if says(code))
    }
}
