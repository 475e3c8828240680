//! Planners as the mission sees them: their identity, their parameters and their faults.

mod sandbox;

pub use sandbox::Sandbox;

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// The value of a parameter in scenarios, on the command line and on the screen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum ParamValue {
    /// On or off.
    Flag(bool),
    /// A whole number.
    Int(i64),
    /// A real number.
    Float(f64),
    /// One of a fixed set of words.
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

/// A planner, with the parameters that differ from their defaults.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PlannerChoice {
    /// Id of the planner.
    pub id: String,
    /// Values set by hand; all other parameters have their defaults.
    #[serde(default)]
    pub parameters: Parameters,
}

/// The values that a parameter accepts; the owned form of [`planner_api::Kind`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum ParamKind {
    /// A real number.
    Float {
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
        /// Default value.
        default: f64,
    },
    /// A whole number.
    Int {
        /// Smallest value.
        min: i64,
        /// Largest value.
        max: i64,
        /// Default value.
        default: i64,
    },
    /// On or off.
    Flag {
        /// Default value.
        default: bool,
    },
    /// One of a fixed set of words.
    Choice {
        /// The words.
        options: Vec<String>,
        /// The default word.
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
    /// Description.
    pub help: String,
    /// Heading under which the screen lists the parameter.
    pub group: String,
    /// The values that the parameter accepts.
    #[serde(flatten)]
    pub kind: ParamKind,
    /// Whether the parameter can be changed while the mission runs.
    pub live: bool,
}

/// Description of a planner that is installed or active.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlannerInfo {
    /// Id of the planner.
    pub id: String,
    /// Name on screen.
    pub name: String,
    /// Version of the planner's plugin.
    pub version: String,
    /// Description of the planner, one sentence.
    pub about: String,
    /// File name of the planner's plugin, without the folder.
    pub plugin: String,
    /// SHA-256 of the plugin file, hexadecimal.
    pub sha256: String,
    /// Planner ABI for which the plugin was built, as `major.minor`.
    pub abi: String,
    /// Whether the planner can cover floor.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub covers: bool,
    /// Whether the planner can save its private state and continue from that state in a new process.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub snapshots: bool,
    /// Sandbox of the planner's process on the machine where the planner was found or is active; absent in older
    /// journals.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sandbox: Option<Sandbox>,
    /// Parameters of the planner.
    pub parameters: Vec<ParamInfo>,
}

/// A plugin file that was refused.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RefusedPlugin {
    /// File name of the plugin, without the folder.
    pub plugin: String,
    /// The reason, as a sentence.
    pub reason: String,
}

impl RefusedPlugin {
    /// Whether the file name is the usual one for a plugin that contains the planner with this id.
    pub fn is_named_after(&self, id: &str) -> bool {
        let stem = self.plugin.split_once('.').map_or(&*self.plugin, |(stem, _)| stem);
        stem.split_once("planner_").is_some_and(|(_, name)| name.replace('_', "-") == id.replace('_', "-"))
    }
}

impl PlannerInfo {
    /// Why the planner cannot run a mission over a whole floor; `None` if it can. The text continues a sentence that
    /// begins with the planner's name.
    pub fn why_no_coverage(&self) -> Option<&'static str> {
        (!self.covers).then_some("does not support coverage missions")
    }

    /// Whether the planner has this parameter and allows changes to it while the robot moves.
    pub fn has_live(&self, key: &str) -> bool {
        self.parameters.iter().any(|param| param.key == key && param.live)
    }
}

/// The call during which a planner failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum During {
    /// Finding and loading the plugin.
    Load,
    /// Creating the planner.
    Configure,
    /// Changing live parameters while the planner is in use.
    Reconfigure,
    /// Planning.
    Plan,
    /// Computing a step.
    Step,
}

impl fmt::Display for During {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Load => "load",
            Self::Configure => "configure",
            Self::Reconfigure => "change of parameters",
            Self::Plan => "plan",
            Self::Step => "step",
        })
    }
}

/// The kind of fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(strum::EnumCount))]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// The planner itself returned this error code; its process is still running.
    Planner(planner_api::Code),
    /// The planner panicked.
    Panic,
    /// The process ended: through a signal, an abort or an exit.
    Died,
    /// The planner did not answer although it had the processor to itself for the whole time allowed, or its process was
    /// stopped. The process was killed.
    Hung,
    /// The planner answered only after it had been asked to stop, so it is too slow.
    Late,
    /// The planner was starved of CPU time for too long; its process was killed.
    Starved,
    /// The planner answered with numbers that are not finite or that exceed the robot's limits.
    BadOutput,
    /// The planner attempted a forbidden system call; its process was killed.
    Forbidden,
    /// The planner sent something that is not a valid answer.
    Protocol,
    /// The host refused to load or configure the planner.
    Refused,
    /// The planner failed too often and cannot be used again in this mission.
    Quarantined,
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Planner(code) => return write!(f, "the planner reports: {code}"),
            Self::Panic => "panic",
            Self::Died => "process died",
            Self::Hung => "no answer",
            Self::Late => "answer too late",
            Self::Starved => "starved of CPU time",
            Self::BadOutput => "invalid numbers",
            Self::Forbidden => "forbidden system call",
            Self::Protocol => "invalid reply",
            Self::Refused => "refused by the host",
            Self::Quarantined => "quarantined",
        })
    }
}

impl Cause {
    /// Whether the failure came from outside the planner's own logic: from the clock, from limits enforced by the
    /// machine, or from an unrequested message to the console, for example from a thread that outlived its call. When the
    /// run is recomputed, the same failure may not occur, or may occur in another tick. After such a failure, the process
    /// is gone.
    pub fn is_external(self) -> bool {
        matches!(
            self,
            Self::Died | Self::Hung | Self::Late | Self::Starved | Self::Forbidden | Self::Protocol
        )
    }
}

/// A planner's failure, in words that tell an operator what happened.
///
/// `message` names the planner, the cause and the step. It contains no figures that differ between two equal runs (no
/// milliseconds, no process ids), because it is written to the journal, which must repeat byte for byte.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, thiserror::Error)]
#[error("{message}")]
pub struct Fault {
    /// Id of the planner.
    pub planner: String,
    /// The call during which it failed.
    pub during: During,
    /// The kind of fault.
    pub cause: Cause,
    /// The message, one sentence.
    pub message: String,
    /// The first part of the path, if the plan got only part of the way.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub partial: Vec<world::Point>,
    /// SHA-256 of the plugin file, hexadecimal, if it was known at the time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plugin_sha256: Option<String>,
}

impl Fault {
    /// Whether the planner answered that there is no path from the start to the goal, which is not a failure of the
    /// planner.
    pub fn is_no_way(&self) -> bool {
        use planner_api::Code::{GoalOccupied, GoalOutside, NoPath, StartOccupied, StartOutside};
        let says = |code| matches!(code, NoPath | GoalOccupied | GoalOutside | StartOccupied | StartOutside);
        matches!(self.cause, Cause::Planner(code) if says(code))
    }

    /// Whether new values of live parameters were refused, by the planner or by the host. The planner continues with its
    /// old values.
    pub fn refuses_change(&self) -> bool {
        self.during == During::Reconfigure && matches!(self.cause, Cause::Planner(_) | Cause::Refused)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use strum::EnumCount;

    #[test]
    fn every_cause_has_a_word_of_its_own() {
        let all: [Cause; Cause::COUNT] = [
            Cause::Planner(planner_api::Code::NoPath),
            Cause::Panic,
            Cause::Died,
            Cause::Hung,
            Cause::Late,
            Cause::Starved,
            Cause::BadOutput,
            Cause::Forbidden,
            Cause::Protocol,
            Cause::Refused,
            Cause::Quarantined,
        ];
        let words: BTreeSet<String> = all.iter().map(ToString::to_string).collect();
        assert_eq!(words.len(), all.len(), "{words:?}");
        assert!(words.iter().all(|word| !word.is_empty() && !word.contains('_')), "{words:?}");
    }
}
