//! The operator's orders; they enter at the top of the next tick.

use crate::planner::{ParamValue, PlannerChoice};
use serde::{Deserialize, Serialize};

/// One order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// Begin the mission.
    Start,
    /// Stand still.
    Hold,
    /// Go on.
    Resume,
    /// While held: move for one tick.
    Step,
    /// While held for a plan that was refused because of the tether: fly it, and later plans until one fails.
    FlyUncertified,
    /// End the mission here.
    Abort,
    /// While held or waiting: another planner takes over.
    ChoosePlanner(PlannerChoice),
    /// Change one parameter of the planner; while the mission runs only live ones.
    SetParameter {
        /// Which parameter.
        key: String,
        /// Its new value.
        value: ParamValue,
    },
}
