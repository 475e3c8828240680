//! A planner set up for a study.

use mission::{ParamValue, Parameters};

/// A planner set up for a study.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Method {
    /// Id in rows: the planner, its mode after a slash.
    pub id: String,
    /// Id of the planner.
    pub planner: String,
    /// Values that differ from its defaults.
    pub parameters: Parameters,
    /// A note for the reader; empty if there is none.
    pub note: &'static str,
}

impl Method {
    /// A planner with its defaults.
    pub(crate) fn new(id: impl Into<String>, planner: impl Into<String>, note: &'static str) -> Self {
        Self { id: id.into(), planner: planner.into(), parameters: Parameters::new(), note }
    }

    /// Sets a parameter to a real number.
    pub(crate) fn number(self, key: &str, value: f64) -> Self {
        self.with(key, ParamValue::Float(value))
    }

    /// Sets a parameter that is a choice to one of its words.
    pub(crate) fn word(self, key: &str, value: &str) -> Self {
        self.with(key, ParamValue::Word(value.to_owned()))
    }

    /// Sets a parameter to a whole number.
    pub(crate) fn int(self, key: &str, value: i64) -> Self {
        self.with(key, ParamValue::Int(value))
    }

    /// Sets a switch.
    pub(crate) fn flag(self, key: &str, value: bool) -> Self {
        self.with(key, ParamValue::Flag(value))
    }

    fn with(mut self, key: &str, value: ParamValue) -> Self {
        self.parameters.insert(key.to_owned(), value);
        self
    }
}
