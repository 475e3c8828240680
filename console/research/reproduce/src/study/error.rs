//! Why a study has no rows.

use mission::Fault;

/// The result of a study, or the error.
pub type Result<T, E = StudyError> = std::result::Result<T, E>;

/// Why a study has no rows.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StudyError {
    /// In the case that is named, a planner is missing, refuses its parameters or failed.
    #[error("{case}: {fault}")]
    Planner {
        /// Layout and method.
        case: String,
        /// The fault of the planner.
        fault: Box<Fault>,
    },
    /// The study cannot be carried out as requested. Contains the reason.
    #[error("{0}")]
    Refused(String),
}

impl From<StudyError> for String {
    fn from(error: StudyError) -> Self {
        error.to_string()
    }
}

impl StudyError {
    /// A fault of a planner in a case.
    pub(crate) fn planner(case: impl Into<String>, fault: Fault) -> Self {
        Self::Planner { case: case.into(), fault: Box::new(fault) }
    }

    /// Returns the same error, with this case if it is a fault of a planner.
    pub(crate) fn in_case(self, case: String) -> Self {
        match self {
            Self::Planner { fault, .. } => Self::Planner { case, fault },
            refused @ Self::Refused(_) => refused,
        }
    }
}
