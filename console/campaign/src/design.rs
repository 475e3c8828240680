//! The values that vary between the missions of a campaign, and the metrics. A plan and the campaign frozen from it
//! share this type.

use crate::{until::Until, value::Value};
use serde::{Deserialize, Serialize};

/// Consecutive seeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Seeds {
    /// The first seed.
    pub first: u64,
    /// Number of seeds.
    pub count: u64,
}

/// The values that vary between missions besides the scenario, and the metrics.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Design {
    /// Name of the campaign.
    pub name: String,
    /// Ids of the planners; empty to use those named by the scenarios.
    pub planners: Vec<String>,
    /// Keys of scenarios and parameters of planners that change between missions.
    pub keys: Vec<String>,
    /// Values of these keys at each point of the grid; there is at least one point.
    pub points: Vec<Vec<Value>>,
    /// Bounds that every run must meet in addition to the bounds of its scenario: key of `[expect]` and value.
    pub expect: Vec<(String, Value)>,
    /// The seeds.
    pub seeds: Seeds,
    /// Columns of the table that the summary covers.
    pub metrics: Vec<String>,
    /// The condition under which the campaign may end early.
    pub until: Option<Until>,
}
