//! Forecasts of how a held mission would continue with different planners.

use mission::{Outlook, PlannerChoice};
use serde::{Deserialize, Serialize};
use world::Point;

/// The maximum number of planners compared.
pub const MOST: usize = 4;

/// Forecasts of how a held mission would continue with different planners. The first candidate is the active planner,
/// unchanged.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WhatIf {
    /// Mission time at which the forecasts begin, seconds.
    pub t_s: f64,
    /// The candidates.
    pub candidates: Vec<Candidate>,
    /// The index of the selected candidate.
    pub selected: usize,
    /// A planner whose parameters are being changed for another forecast.
    #[serde(default)]
    pub draft: Option<PlannerChoice>,
    /// The candidate that was added to estimate the effect of a change while the operator is asked about it.
    #[serde(default)]
    pub estimated: Option<PlannerChoice>,
}

/// A planner with its forecast.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// The planner, with its parameters.
    pub choice: PlannerChoice,
    /// Share of the task done in the forecast so far, 0 to 1; `None` before it begins.
    pub at: Option<f64>,
    /// The forecast, or the reason why there is none, as a sentence; `None` while the forecast is being computed.
    pub made: Option<Result<Forecast, String>>,
}

/// A forecast of how the mission would continue.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Forecast {
    /// The figures of the forecast.
    pub outlook: Outlook,
    /// The path driven.
    pub path: Vec<Point>,
    /// Whether every plan of the forecast is certified for the tether; `None` if none was checked.
    #[serde(default)]
    pub certified: Option<bool>,
}

impl WhatIf {
    /// The selected candidate.
    pub fn candidate(&self) -> Option<&Candidate> {
        self.candidates.get(self.selected)
    }

    /// The index of the candidate with this planner and these parameters.
    pub fn position(&self, choice: &PlannerChoice) -> Option<usize> {
        self.candidates.iter().position(|candidate| candidate.choice == *choice)
    }

    /// The candidates whose forecasts are not finished.
    pub fn open(&self) -> impl Iterator<Item = &PlannerChoice> {
        self.candidates.iter().filter(|candidate| candidate.made.is_none()).map(|candidate| &candidate.choice)
    }

    /// The figures of the finished forecasts.
    pub fn outlooks(&self) -> Vec<Outlook> {
        let made = self.candidates.iter().filter_map(|candidate| candidate.made.as_ref()?.as_ref().ok());
        made.map(|forecast| forecast.outlook.clone()).collect()
    }

    /// The number of finished forecasts.
    pub fn n_done(&self) -> usize {
        self.candidates.iter().filter(|candidate| candidate.made.is_some()).count()
    }
}
