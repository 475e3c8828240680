//! Locates planners' objections in the text of a scenario.

use super::{Complaint, Problem, Scenario, ScenarioErrors};
use std::ops::Range;
use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

impl Scenario {
    /// Converts planners' objections to problems in this scenario. An objection consists of the path of a key
    /// (`planner.parameters.k_rep`) and the problem.
    pub fn refused(&self, objections: Vec<(String, String)>) -> ScenarioErrors {
        let table = DeTable::parse(&self.text).ok();
        let problem = |(key, message): (String, String)| {
            let at = table.as_ref().and_then(|table| place(table.get_ref(), &key));
            let written = at.clone().and_then(|at| self.text.get(at)).and_then(|text| text.lines().next());
            Problem { value: written.map(str::to_owned), key, at, what: Complaint::Planner(message) }
        };
        ScenarioErrors {
            shown_name: self.shown_name.clone(),
            text: self.text.clone(),
            problems: objections.into_iter().map(problem).collect(),
        }
    }
}

/// The bytes of a key's value, or of the nearest enclosing table.
fn place(table: &DeTable<'_>, key: &str) -> Option<Range<usize>> {
    let mut parts = key.split('.');
    let first: &Spanned<DeValue<'_>> = table.get(parts.next()?)?;
    let mut at = first;
    for part in parts {
        let DeValue::Table(inner) = at.get_ref() else { break };
        let Some(next) = inner.get(part) else { break };
        at = next;
    }
    Some(at.span())
}
