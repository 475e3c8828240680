//! The effect of an event on the screen, beyond the run that the event belongs to.

use mission::{Order, Severity};

/// The open questions that an event withdraws because the conditions have changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Withdrawn {
    /// No question.
    #[default]
    Nothing,
    /// The question whether to resume.
    Resume,
    /// Every question.
    All,
}

/// The effect of an event on the screen, beyond the run that the event belongs to. A replay ignores it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Change {
    /// The questions to withdraw.
    pub withdrawn: Withdrawn,
    /// The notice for the operator.
    pub notice: Option<(Severity, String)>,
    /// The order that the event answers.
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
