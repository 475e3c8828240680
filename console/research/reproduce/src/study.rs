//! The parts of every study: its cases and methods, the runner, and the resulting rows.

mod error;
mod gallery;
mod method;
mod parts;
mod planners;
mod row;
mod runner;
mod sample;
mod verdict;

pub use error::{Result, StudyError};
pub use gallery::Gallery;
pub(crate) use method::Method;
pub use parts::Parts;
pub(crate) use planners::{Planned, Planners};
pub(crate) use row::Block;
pub use row::Row;
pub use runner::Runner;
pub(crate) use sample::{Sample, jackknife_95};
pub use verdict::Verdict;
pub(crate) use verdict::{judged, without_seed, wrong_signs};

use std::sync::atomic::{AtomicBool, Ordering};

/// Maximum number of cases or methods that an error names.
const KNOWN_SHOWN: usize = 20;

/// A table or figure.
#[derive(Debug, Clone, Copy)]
pub struct Study {
    /// Name on the command line.
    pub name: &'static str,
    /// A one-sentence description with the paper.
    pub about: &'static str,
    /// Default number of layouts or draws.
    pub layouts: usize,
    pub(crate) run: fn(&Job<'_>) -> Result<Vec<Row>>,
}

/// A request to a study.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Options {
    /// Number of layouts or draws; `None` for the study's default.
    pub layouts: Option<usize>,
    /// Seed of the first layout; later layouts use the following seeds.
    pub first_seed: u64,
    /// Cases whose ids begin with one of these; all if empty.
    pub cases: Vec<String>,
    /// Methods whose ids begin with one of these; all if empty.
    pub methods: Vec<String>,
}

impl Study {
    /// Computes the requested rows.
    ///
    /// # Errors
    /// A planner is missing or failed, or nothing is left to measure.
    pub fn rows(&self, runner: &Runner<'_>, options: &Options) -> Result<Vec<Row>> {
        if options.layouts == Some(0) {
            return Err(StudyError::Refused("--layouts 0 measures nothing; give at least 1".into()));
        }
        let job = Job { study: self, runner, options, has_drawn: AtomicBool::new(false) };
        let rows = (self.run)(&job).map_err(|error| match error {
            StudyError::Planner { case, fault } => {
                StudyError::Planner { case: format!("{}: {case}", self.name), fault }
            }
            refused @ StudyError::Refused(_) => refused,
        })?;
        if rows.is_empty() {
            return Err(StudyError::Refused(format!(
                "{}: no row matches both --case and --method",
                self.name
            )));
        }
        let has_drawn = job.has_drawn.load(Ordering::Relaxed);
        Ok(rows.into_iter().map(|row| judged(row, has_drawn)).collect())
    }
}

/// A study in progress.
pub(crate) struct Job<'a> {
    pub runner: &'a Runner<'a>,
    study: &'a Study,
    options: &'a Options,
    /// Whether the study has asked for seeds. If it has not, nothing in it is drawn at random.
    has_drawn: AtomicBool,
}

impl Job<'_> {
    /// Whether a case is requested.
    pub(crate) fn has_case(&self, id: &str) -> bool {
        is_asked(&self.options.cases, id)
    }

    /// Whether a method is requested.
    pub(crate) fn has_method(&self, id: &str) -> bool {
        is_asked(&self.options.methods, id)
    }

    /// The requested cases; an error if there are none.
    pub(crate) fn cases<C>(
        &self,
        all: impl IntoIterator<Item = C>,
        id: impl Fn(&C) -> String,
    ) -> Result<Vec<C>> {
        self.asked("case", &self.options.cases, all, id)
    }

    /// The requested methods; an error if there are none.
    pub(crate) fn methods<M>(
        &self,
        all: impl IntoIterator<Item = M>,
        id: impl Fn(&M) -> String,
    ) -> Result<Vec<M>> {
        self.asked("method", &self.options.methods, all, id)
    }

    fn asked<T>(
        &self,
        what: &str,
        prefixes: &[String],
        all: impl IntoIterator<Item = T>,
        id: impl Fn(&T) -> String,
    ) -> Result<Vec<T>> {
        let (asked, others): (Vec<T>, Vec<T>) = all.into_iter().partition(|one| is_asked(prefixes, &id(one)));
        if !asked.is_empty() {
            return Ok(asked);
        }
        let known: Vec<String> = others.iter().map(id).take(KNOWN_SHOWN).collect();
        let more = if others.len() > KNOWN_SHOWN { ", ..." } else { "" };
        let (name, prefixes, known) = (self.study.name, prefixes.join(", "), known.join(", "));
        let why = format!("{name}: no {what} id begins with {prefixes} (--{what}); known: {known}{more}");
        Err(StudyError::Refused(why))
    }

    /// The seeds of the layouts.
    pub(crate) fn seeds(&self) -> Vec<u64> {
        self.has_drawn.store(true, Ordering::Relaxed);
        let n = self.options.layouts.unwrap_or(self.study.layouts) as u64;
        (0..n).map(|k| self.options.first_seed.wrapping_add(k)).collect()
    }

    /// The rows of a method in a case, all with this note.
    pub(crate) fn block<'b>(&self, case: &'b str, method: &'b str, note: &'b str) -> Block<'b> {
        Block { table: self.study.name, case, method, note }
    }
}

fn is_asked(prefixes: &[String], id: &str) -> bool {
    prefixes.is_empty() || prefixes.iter().any(|prefix| id.starts_with(prefix.as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_host::PluginDirs;

    const STUDY: Study = Study { name: "pan-maps", about: "", layouts: 1, run: |_| Ok(Vec::new()) };

    fn chosen(options: &Options, ids: [&'static str; 3]) -> [Result<Vec<&'static str>>; 2] {
        let runner = Runner::new(&PluginDirs::of(Vec::new()), 1, &|_, _| ()).unwrap();
        let job = Job { study: &STUDY, runner: &runner, options, has_drawn: AtomicBool::new(false) };
        let id = |id: &&str| (*id).to_owned();
        [job.cases(ids, id), job.methods(ids, id)]
    }

    #[test]
    fn a_prefix_that_fits_nothing_is_answered_with_what_there_is() {
        let unknown = vec!["nope".into(), "c".into()];
        let options = Options { cases: unknown.clone(), methods: unknown, ..Options::default() };
        let [cases, methods] =
            chosen(&options, ["E1", "E2", "E3"]).map(|chosen| chosen.unwrap_err().to_string());
        assert_eq!(cases, "pan-maps: no case id begins with nope, c (--case); known: E1, E2, E3");
        assert_eq!(methods, "pan-maps: no method id begins with nope, c (--method); known: E1, E2, E3");
    }

    #[test]
    fn prefixes_choose_cases() {
        let options = Options { cases: vec!["d1/".into(), "d2/disk".into()], ..Options::default() };
        let [cases, methods] = chosen(&options, ["d1/square", "d2/disk", "d2/square"]);
        assert_eq!(cases.unwrap(), ["d1/square", "d2/disk"]);
        assert_eq!(methods.unwrap().len(), 3);
    }
}
