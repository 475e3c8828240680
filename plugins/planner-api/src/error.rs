//! The reasons why a planner cannot do what the console asked.

use std::fmt;

/// A closed list of reasons, so that the console can react to each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(test, derive(strum::EnumCount))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[repr(i32)]
pub enum Code {
    /// The request makes no sense.
    Invalid = 1,
    /// The parameters contradict each other or do not fit the site.
    Config = 2,
    /// The start is inside an obstacle.
    StartOccupied = 3,
    /// The start is outside the floor.
    StartOutside = 4,
    /// The goal is inside an obstacle.
    GoalOccupied = 5,
    /// The goal is outside the floor.
    GoalOutside = 6,
    /// No path exists, or none was found.
    NoPath = 7,
    /// The deadline has passed.
    Timeout = 8,
    /// The console asked to stop.
    Cancelled = 9,
    /// The planner is caught in a local minimum.
    Stuck = 10,
    /// A function was called in the wrong order, or the state passed to `restore` does not fit.
    State = 11,
    /// The planner does not offer this function or task.
    Unsupported = 12,
    /// An internal error of the planner.
    Internal = 13,
    /// Reserved for the glue: the planner panicked.
    Panic = 14,
    /// Reserved for the glue: the planner panicked earlier and cannot be called again.
    Poisoned = 15,
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Invalid => "invalid request",
            Self::Config => "unsuitable parameters",
            Self::StartOccupied => "start in an obstacle",
            Self::StartOutside => "start outside the floor",
            Self::GoalOccupied => "goal in an obstacle",
            Self::GoalOutside => "goal outside the floor",
            Self::NoPath => "no path found",
            Self::Timeout => "deadline missed",
            Self::Cancelled => "cancelled",
            Self::Stuck => "stuck in a local minimum",
            Self::State => "called in the wrong state",
            Self::Unsupported => "not supported",
            Self::Internal => "internal fault",
            Self::Panic => "panic",
            Self::Poisoned => "unusable after a panic",
        })
    }
}

impl Code {
    const ALL: [Self; 15] = [
        Self::Invalid,
        Self::Config,
        Self::StartOccupied,
        Self::StartOutside,
        Self::GoalOccupied,
        Self::GoalOutside,
        Self::NoPath,
        Self::Timeout,
        Self::Cancelled,
        Self::Stuck,
        Self::State,
        Self::Unsupported,
        Self::Internal,
        Self::Panic,
        Self::Poisoned,
    ];

    /// Converts a number that was passed across the boundary; `None` if it is not a code.
    ///
    /// ```
    /// use planner_api::Code;
    ///
    /// assert_eq!(Code::from_number(7), Some(Code::NoPath));
    /// assert_eq!(Code::from_number(0), None, "0 is success");
    /// ```
    pub fn from_number(number: i32) -> Option<Self> {
        Self::ALL.into_iter().find(|code| *code as i32 == number)
    }
}

/// A planner's refusal: a code for the console and a sentence for the operator.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannerError {
    /// The kind of refusal.
    pub code: Code,
    /// What is wrong and what to do about it, as a sentence without a full stop.
    pub message: String,
    /// With `NoPath`: the part of the path that was found.
    pub partial: Vec<nalgebra::Point2<f64>>,
}

impl PlannerError {
    /// Creates a refusal from a code and a sentence.
    ///
    /// ```
    /// use planner_api::{Code, PlannerError};
    ///
    /// let refusal = PlannerError::new(Code::GoalOccupied, "the goal lies in column N");
    /// assert_eq!(refusal.to_string(), "the goal lies in column N");
    /// ```
    pub fn new(code: Code, message: impl Into<String>) -> Self {
        Self { code, message: message.into(), partial: Vec::new() }
    }

    /// Creates the refusal for a function that this planner does not offer.
    ///
    /// ```
    /// use planner_api::{Code, PlannerError};
    ///
    /// assert_eq!(PlannerError::unsupported().code, Code::Unsupported);
    /// ```
    pub fn unsupported() -> Self {
        Self::new(Code::Unsupported, "not offered by this planner")
    }

    /// Creates a refusal for a goal that cannot be reached; `partial` is the part of the path that was found.
    ///
    /// ```
    /// use planner_api::{Code, Point2, PlannerError};
    ///
    /// let as_far_as = vec![Point2::new(0.0, 0.0), Point2::new(2.5, 0.0)];
    /// let refusal = PlannerError::no_path_but("walled in at x = 2.5 m", as_far_as);
    /// assert_eq!((refusal.code, refusal.partial.len()), (Code::NoPath, 2));
    /// ```
    pub fn no_path_but(message: impl Into<String>, partial: Vec<nalgebra::Point2<f64>>) -> Self {
        Self { code: Code::NoPath, message: message.into(), partial }
    }
}

impl fmt::Display for PlannerError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for PlannerError {}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use strum::EnumCount;

    #[test]
    fn every_code_has_a_word_of_its_own() {
        let all: [Code; Code::COUNT] = Code::ALL;
        let words: BTreeSet<String> = all.iter().map(ToString::to_string).collect();
        assert_eq!(words.len(), all.len(), "{words:?}");
        assert!(words.iter().all(|word| !word.is_empty() && !word.contains('_')), "{words:?}");
    }
}
