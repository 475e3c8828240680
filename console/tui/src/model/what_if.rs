//! How a held mission would go on with one planner or another.

use mission::{Outlook, PlannerChoice};
use serde::{Deserialize, Serialize};
use world::Point;

/// Most planners that are compared.
pub const MOST: usize = 4;

/// How a held mission would go on with one planner or another. The first candidate goes on as it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WhatIf {
    /// Mission time from which they go on, seconds.
    pub t_s: f64,
    /// The candidates.
    pub candidates: Vec<Candidate>,
    /// The one that is looked at.
    pub selected: usize,
    /// A planner whose parameters are being changed for a further forecast.
    #[serde(default)]
    pub draft: Option<PlannerChoice>,
}

/// A planner that could go on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// The planner, with its parameters.
    pub choice: PlannerChoice,
    /// Share of the task done in the forecast so far, 0 to 1; `None` before it begins.
    pub at: Option<f64>,
    /// The forecast, or why there is none, as a sentence; `None` while it is being made.
    pub made: Option<Result<Forecast, String>>,
}

/// How a mission would go on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Forecast {
    /// Its figures.
    pub outlook: Outlook,
    /// The way driven.
    pub path: Vec<Point>,
}

impl WhatIf {
    /// The candidate that is looked at.
    pub fn candidate(&self) -> Option<&Candidate> {
        self.candidates.get(self.selected)
    }

    /// The figures that are there.
    pub fn outlooks(&self) -> Vec<Outlook> {
        let made = self.candidates.iter().filter_map(|candidate| candidate.made.as_ref()?.as_ref().ok());
        made.map(|forecast| forecast.outlook.clone()).collect()
    }

    /// How many forecasts are done.
    pub fn n_done(&self) -> usize {
        self.candidates.iter().filter(|candidate| candidate.made.is_some()).count()
    }
}
