//! What lies over a screen and receives the keys: questions, lists and input lines.

use crate::model::{Cause, LineEdit, Palette, ZoneDraft, step::Step};
use mission::{Order, ParamValue, PlanId, PlannerChoice};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use world::Point;

/// The overlay on top of the screen; it receives the keys.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum Overlay {
    /// No overlay.
    #[default]
    None,
    /// The question before the robot moves or before the mission ends.
    Confirm(Ask),
    /// The line for single steps.
    Stepping,
    /// The question before the console quits.
    Quit,
    /// The command line with its list.
    Commands(Palette),
    /// The list of planners.
    Planners {
        /// The purpose for which the planner is chosen.
        purpose: Purpose,
        /// The index of the selected line.
        selected: usize,
        /// Whether the planners that cannot run the mission are listed one by one.
        #[serde(default)]
        is_unfolded: bool,
    },
    /// The parameters of the active planner.
    Parameters {
        /// The index of the selected line.
        selected: usize,
        /// The value being typed.
        edit: Option<Edit>,
    },
    /// The changes that a preset would make.
    Preset {
        /// The name of the preset.
        name: String,
        /// The planner with its parameters.
        choice: PlannerChoice,
        /// The index of the selected line.
        selected: usize,
        /// The parameters whose values are not to be taken.
        #[serde(default)]
        left: BTreeSet<String>,
    },
    /// The layers of the map.
    Layers {
        /// The index of the selected line.
        selected: usize,
    },
    /// Forecasts of how the mission would continue with different planners.
    WhatIf,
    /// The ways to end the mission: end here, or drive back.
    Finish {
        /// The index of the selected line.
        selected: usize,
    },
    /// A no-go zone being drawn on the map.
    ZoneDraft(ZoneDraft),
    /// The history of messages, newest first.
    Messages {
        /// The index of the selected line.
        selected: usize,
    },
    /// The pre-flight check.
    Preflight {
        /// The index of the selected line.
        selected: usize,
    },
    /// The filter of a list, being typed.
    Filter(LineEdit),
    /// The action list of an alarm.
    Remedies {
        /// The cause of the alarm.
        cause: Cause,
        /// The actions at the time when the list was opened, in the order of their numbers.
        #[serde(skip)]
        steps: Vec<Step>,
        /// The index of the selected line.
        selected: usize,
    },
    /// The input line for shelving an alarm: how long and why.
    Shelve(Shelving),
    /// The input line for the text of a bookmark at the replay cursor.
    Bookmark(LineEdit),
}

impl Overlay {
    /// Whether the overlay asks something that only its own keys on the keyboard may answer.
    pub fn is_question(&self) -> bool {
        matches!(self, Self::Confirm(_) | Self::Quit | Self::Stepping | Self::Finish { .. })
    }
}

/// The input for shelving an alarm: how long and why.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shelving {
    /// The cause of the alarm.
    pub cause: Cause,
    /// The typed line: minutes, then a reason.
    pub line: LineEdit,
    /// Why the input was refused.
    pub refusal: Option<String>,
}

/// The purpose of choosing a planner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Purpose {
    /// The planner will drive.
    Drive,
    /// The planner will make a plan for comparison.
    Compare,
    /// The planner will forecast how the mission would continue.
    WhatIf,
    /// The planner will run in shadow.
    Shadow,
}

/// The question in the confirmation line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Ask {
    /// Start the mission with the plan shown; `None` if the start does not name a plan.
    Start(Option<PlanId>),
    /// Resume the mission.
    Resume,
    /// Run a plan that was refused because of the tether.
    FlyUncertified,
    /// Change the active planner.
    Swap(PlannerChoice),
    /// Promote the planner in shadow.
    Promote,
    /// Take the better plan.
    TakePlan,
    /// Drive back to the anchor or the start.
    DriveBack,
    /// Close the floor within an outline: its corners, metres, tank frame.
    DrawZone(Vec<Point>),
    /// Change a parameter of the active planner.
    Set {
        /// The parameter.
        key: String,
        /// Its new value.
        value: ParamValue,
        /// The line in the list of parameters from which the change was made; `None` if it was made by a command.
        #[serde(default)]
        list: Option<usize>,
    },
}

impl Ask {
    /// The order to send when the operator agrees.
    pub fn order(&self) -> Order {
        match self {
            Self::Start(plan) => plan.map_or(Order::Start, Order::StartPlan),
            Self::Resume => Order::Resume,
            Self::FlyUncertified => Order::FlyUncertified,
            Self::Swap(choice) => Order::ChoosePlanner(choice.clone()),
            Self::Promote => Order::Promote,
            Self::TakePlan => Order::TakePlan,
            Self::DriveBack => Order::DriveBack,
            Self::DrawZone(corners) => Order::DrawZone(corners.clone()),
            Self::Set { key, value, .. } => Order::SetParameter { key: key.clone(), value: value.clone() },
        }
    }
}

/// A parameter value being typed.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Edit {
    /// The typed line.
    pub line: LineEdit,
    /// Why the value was refused.
    pub refusal: Option<String>,
}
