//! One decision of the inspector, and the gate items that need decisions.

/// The gate item about the tank.
pub(super) const TANK: usize = 1;
/// The gate item about the scope.
pub(super) const SCOPE: usize = 2;
/// The gate item about missed areas.
pub(super) const MISSED: usize = 6;
/// The gate item about indications.
pub(super) const INDICATIONS: usize = 9;

/// A decision that the inspector must make.
pub(super) struct Decision {
    /// The question, for the reader.
    pub(super) what: String,
    /// The section with the facts.
    pub(super) section: usize,
    /// Key of the decision under `[inspection]`.
    pub(super) key: &'static str,
    /// The gate item that stays open without the decision.
    pub(super) item: usize,
    /// The reason that the inspector gave.
    pub(super) answer: Option<String>,
}
