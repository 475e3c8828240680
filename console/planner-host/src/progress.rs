//! Progress of a plan while it is being computed. It depends on wall-clock time, so it is displayed, but kept out of
//! both the journal and the recording.

use crate::checks::limits;
use mission::AskId;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Progress of a plan that is being computed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    /// Share done, 0 to 1, as reported by the planner.
    #[serde(deserialize_with = "limits::share")]
    pub share: f64,
    /// The current activity, in a few words.
    #[serde(deserialize_with = "limits::doing")]
    pub what: String,
}

/// Callback for the progress of the plan that an ask requested. It is called on the thread that waits for the plan and
/// must not block that thread.
pub type OnProgress = Arc<dyn Fn(AskId, &Progress) + Send + Sync>;

impl Progress {
    /// Maximum number of characters of [`Self::what`].
    pub(crate) const LONGEST: usize = 80;
}
