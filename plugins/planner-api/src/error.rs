//! Why a planner could not do what it was asked.

use std::fmt;

/// A closed list of reasons, so that the console can act on them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[repr(i32)]
pub enum Code {
    /// The request makes no sense.
    Invalid = 1,
    /// The parameters do not fit together or do not fit the site.
    Config = 2,
    /// The start lies in an obstacle.
    StartOccupied = 3,
    /// The start lies outside the floor.
    StartOutside = 4,
    /// The goal lies in an obstacle.
    GoalOccupied = 5,
    /// The goal lies outside the floor.
    GoalOutside = 6,
    /// There is no way, or none was found.
    NoPath = 7,
    /// The deadline passed.
    Timeout = 8,
    /// The console asked to stop.
    Cancelled = 9,
    /// In a local minimum.
    Stuck = 10,
    /// Called in the wrong order, or the state given to `restore` does not fit.
    State = 11,
    /// The planner does not offer this.
    Unsupported = 12,
    /// A fault of the planner itself.
    Internal = 13,
    /// Reserved for the glue: the planner panicked.
    Panic = 14,
    /// Reserved for the glue: the planner panicked before and may not be called again.
    Poisoned = 15,
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

    /// The code of a number that came over the boundary, if it is one.
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

/// A planner's refusal: a code for the console, a sentence for the operator.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannerError {
    /// What kind of refusal.
    pub code: Code,
    /// What was wrong and what would be right, as a sentence without a full stop.
    pub message: String,
    /// For `NoPath`: how far it got.
    pub partial: Vec<nalgebra::Point2<f64>>,
}

impl PlannerError {
    /// A refusal with a code and a sentence.
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

    /// This planner does not offer what was asked.
    ///
    /// ```
    /// use planner_api::{Code, PlannerError};
    ///
    /// assert_eq!(PlannerError::unsupported().code, Code::Unsupported);
    /// ```
    pub fn unsupported() -> Self {
        Self::new(Code::Unsupported, "not offered by this planner")
    }

    /// No way through, but this far one gets.
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
