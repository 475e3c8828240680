//! What can be reproduced.

use crate::{bench::Bench, coverage, fields, positioning, row::Row, spiral, traps};
use mission::Fault;

/// What a study is asked for.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Options {
    /// Number of layouts or draws; the study's own if none.
    pub layouts: Option<usize>,
    /// Seed of the first layout; the others follow.
    pub first_seed: u64,
    /// Cases whose ids begin with one of these; all if empty.
    pub cases: Vec<String>,
    /// Methods whose ids begin with one of these; all if empty.
    pub methods: Vec<String>,
}

impl Options {
    /// Whether a case is asked for.
    pub fn has_case(&self, id: &str) -> bool {
        is_asked(&self.cases, id)
    }

    /// Whether a method is asked for.
    pub fn has_method(&self, id: &str) -> bool {
        is_asked(&self.methods, id)
    }

    /// The seeds of the layouts, `default` of them if no number was given.
    pub fn seeds(&self, default: usize) -> impl Iterator<Item = u64> + Clone + use<> {
        let first = self.first_seed;
        (0..self.layouts.unwrap_or(default) as u64).map(move |k| first.wrapping_add(k))
    }

    /// Why a study has nothing to do: no case or no method begins as asked.
    pub fn nothing_left(&self, study: &Study, cases: &[&str], methods: &[&str]) -> Problem {
        let unknown = |option: &str, asked: &[String], known: &[&str]| {
            let is_left = known.iter().any(|id| is_asked(asked, id));
            let asked = asked.join(", ");
            let plural = option.trim_start_matches('-');
            (!is_left)
                .then(|| format!("no {plural} begins with {option} {asked}; known are {}", known.join(", ")))
        };
        let reasons = [unknown("--case", &self.cases, cases), unknown("--method", &self.methods, methods)];
        let reasons: Vec<String> = reasons.into_iter().flatten().collect();
        Problem::Nothing(format!("{}: {}", study.name, reasons.join("; ")))
    }
}

fn is_asked(asked: &[String], id: &str) -> bool {
    asked.is_empty() || asked.iter().any(|prefix| id.starts_with(prefix.as_str()))
}

/// Why a study has no rows.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Problem {
    /// A planner is missing, refuses its parameters or broke down; with the case it was asked for.
    #[error("{case}: {fault}")]
    Planner {
        /// Layout and method.
        case: String,
        /// What happened.
        fault: Box<Fault>,
    },
    /// Nothing is left to measure.
    #[error("{0}")]
    Nothing(String),
}

/// A table or figure.
#[derive(Debug, Clone, Copy)]
pub struct Study {
    /// Name on the command line.
    pub name: &'static str,
    /// One sentence: what it is, and of which paper.
    pub about: &'static str,
    /// What its layouts are when no number is given.
    pub layouts: usize,
    /// Makes its rows.
    pub run: fn(&Study, &Bench<'_>, &Options) -> Result<Vec<Row>, Problem>,
}

impl Study {
    /// Whether its plans can be drawn.
    pub fn has_pictures(&self) -> bool {
        coverage::STUDIES.iter().any(|study| study.name == self.name)
    }
}

/// Every study.
pub const STUDIES: &[&[Study]] =
    &[spiral::STUDIES, traps::STUDIES, fields::STUDIES, positioning::STUDIES, coverage::STUDIES];

/// The study of this name.
pub fn study(name: &str) -> Option<&'static Study> {
    STUDIES.iter().flat_map(|studies| studies.iter()).find(|study| study.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_study_has_a_name_of_its_own() {
        let names: Vec<&str> = STUDIES.iter().flat_map(|s| s.iter()).map(|study| study.name).collect();
        assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len());
        assert!(names.iter().all(|name| study(name).is_some()));
    }

    #[test]
    fn a_prefix_that_fits_nothing_is_answered_with_what_there_is() {
        let study = study("pan-maps").unwrap();
        let options = Options { cases: vec!["nope".into()], ..Options::default() };
        let message = options.nothing_left(study, &["E1", "E2"], &["a", "b"]).to_string();
        assert_eq!(message, "pan-maps: no case begins with --case nope; known are E1, E2");
        let options = Options { methods: vec!["c".into(), "d".into()], ..Options::default() };
        let message = options.nothing_left(study, &["E1", "E2"], &["a", "b"]).to_string();
        assert_eq!(message, "pan-maps: no method begins with --method c, d; known are a, b");
    }

    #[test]
    fn prefixes_choose_cases() {
        let options = Options { cases: vec!["d1/".into(), "d2/disk".into()], ..Options::default() };
        assert!(
            options.has_case("d1/square") && options.has_case("d2/disk") && !options.has_case("d2/square")
        );
        assert!(options.has_method("rpf"));
    }
}
