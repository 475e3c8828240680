//! What varies from mission to mission of a campaign, and what is measured: the same in a plan and in the campaign frozen from it.

use crate::{until::Until, value::Value};
use serde::{Deserialize, Serialize};

/// Consecutive seeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Seeds {
    /// The first.
    pub first: u64,
    /// How many.
    pub count: u64,
}

/// What varies from mission to mission besides the scenario, and what is measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Design {
    /// Name of the campaign.
    pub name: String,
    /// Ids of planners; empty for those of the scenarios.
    pub planners: Vec<String>,
    /// Keys of scenarios and parameters of planners that change from mission to mission.
    pub keys: Vec<String>,
    /// Values of these keys; at least one point.
    pub points: Vec<Vec<Value>>,
    /// Bounds that every run is held to, beside those of its scenario: key of `[expect]` and value.
    pub expect: Vec<(String, Value)>,
    /// Seeds.
    pub seeds: Seeds,
    /// Columns of the table that the summary is about.
    pub metrics: Vec<String>,
    /// When the campaign may end early.
    pub until: Option<Until>,
}
