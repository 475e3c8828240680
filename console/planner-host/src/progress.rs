//! How far a plan is while it is being made. It is shown and then forgotten: it depends on the clock on the wall, so it
//! enters neither journal nor recording.

use mission::AskId;
use std::sync::Arc;

/// How far a plan is.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// Share done, 0 to 1, as the planner tells it.
    pub share: f64,
    /// What is being done, a few words.
    pub what: String,
}

/// Who is told how far the plan of an ask is. It is called on the thread that waits for the plan and must not keep it
/// waiting.
pub type OnProgress = Arc<dyn Fn(AskId, &Progress) + Send + Sync>;

impl Progress {
    /// Most characters of the words.
    pub(crate) const LONGEST: usize = 80;
}
