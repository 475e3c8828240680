//! What an event means for the screen beyond the run that it belongs to.

use mission::{Order, Severity};

/// Which questions an event withdraws: those that were asked under circumstances that no longer hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Withdrawn {
    /// None.
    #[default]
    Nothing,
    /// Whether to resume.
    Resume,
    /// Every question.
    All,
}

/// What an event means for the screen beyond the run that it belongs to. A replay has no use for it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Change {
    /// Which questions it withdraws.
    pub withdrawn: Withdrawn,
    /// The notice for the operator.
    pub notice: Option<(Severity, String)>,
    /// The order that it answers.
    pub answered: Option<Order>,
}

impl Change {
    pub(super) fn withdraw(&mut self, withdrawn: Withdrawn) {
        self.withdrawn = self.withdrawn.max(withdrawn);
    }

    pub(super) fn say(&mut self, severity: Severity, text: impl Into<String>) {
        self.notice = Some((severity, text.into()));
    }
}
