//! Runs cases on all cores.

use super::{
    error::{Result, StudyError},
    gallery::Gallery,
    parts::{Kept, Parts},
    planners::Planners,
};
use planner_host::PluginDirs;
use rayon::prelude::*;
use serde::{Serialize, de::DeserializeOwned};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Maximum number of threads; more do not help, and each starts planners of its own.
const THREADS_MAX: usize = 256;

/// Runs the cases of a study.
pub struct Runner<'a> {
    planners: Planners,
    threads: rayon::ThreadPool,
    progress: &'a (dyn Fn(usize, usize) + Sync),
    gallery: Option<&'a Gallery>,
    /// The store of results, and the maximum number of parts of a list of cases.
    parts: Option<(&'a dyn Parts, usize)>,
    /// Number of lists of cases so far; a study has the same lists in every process.
    lists: AtomicUsize,
}

impl<'a> Runner<'a> {
    /// Creates a runner with planners from these folders on this number of threads (0: one for each core). It calls
    /// `progress` with the number of finished cases and of all cases.
    ///
    /// # Errors
    /// The number of threads is too large, or they cannot be started.
    pub fn new(
        dirs: &PluginDirs,
        n_threads: usize,
        progress: &'a (dyn Fn(usize, usize) + Sync),
    ) -> Result<Self> {
        if n_threads > THREADS_MAX {
            return Err(StudyError::Refused(format!(
                "--threads {n_threads}: at most {THREADS_MAX}; 0 means one for each core"
            )));
        }
        let threads = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build();
        let threads = threads
            .map_err(|error| StudyError::Refused(format!("the threads cannot be started: {error}")))?;
        Ok(Self {
            planners: Planners::new(dirs),
            threads,
            progress,
            gallery: None,
            parts: None,
            lists: AtomicUsize::new(0),
        })
    }

    /// Returns this runner, drawing every plan into a gallery; only some studies have plans to draw.
    #[must_use]
    pub fn with_gallery(self, gallery: Option<&'a Gallery>) -> Self {
        Self { gallery, ..self }
    }

    /// Returns this runner, storing the results of each list of cases in at most this number of parts, and reading
    /// existing parts.
    #[must_use]
    pub fn with_parts(self, parts: Option<&'a dyn Parts>, most: usize) -> Self {
        Self { parts: parts.map(|parts| (parts, most)), ..self }
    }

    /// The gallery for plans, if drawings are requested.
    pub(crate) fn gallery(&self) -> Option<&Gallery> {
        self.gallery
    }

    /// Computes every case, or reads its result; the results keep the order of the cases, whichever thread computed
    /// them.
    ///
    /// # Errors
    /// The first error in the order of the cases.
    pub(crate) fn map<C: Sync, T: Send + Serialize + DeserializeOwned>(
        &self,
        cases: &[C],
        compute: impl Fn(&Planners, &C) -> Result<T> + Sync,
    ) -> Result<Vec<T>> {
        let list = self.lists.fetch_add(1, Ordering::Relaxed);
        let done = AtomicUsize::new(0);
        (self.progress)(0, cases.len());
        let is_done = |n: usize| (self.progress)(done.fetch_add(n, Ordering::Relaxed) + n, cases.len());
        let one = |case: &C| {
            let answer = compute(&self.planners, case);
            is_done(1);
            answer
        };
        self.threads.install(|| {
            if let Some((parts, most)) = self.parts {
                return Kept { parts, list, most }.map(cases, one, is_done);
            }
            let answers: Vec<Result<T, StudyError>> = cases.par_iter().map(one).collect();
            answers.into_iter().collect()
        })
    }

    /// Computes every case for every draw; one list for each case, in the order of the draws.
    ///
    /// It finishes all cases of one draw before it begins the next draw, so that the progress shown is that of the
    /// whole study.
    ///
    /// # Errors
    /// The first error in the order of the draws.
    pub(crate) fn grid<C: Sync, D: Sync, T: Send + Serialize + DeserializeOwned>(
        &self,
        cases: &[C],
        draws: &[D],
        compute: impl Fn(&Planners, &C, &D) -> Result<T> + Sync,
    ) -> Result<Vec<Vec<T>>> {
        let pairs: Vec<(&D, &C)> =
            draws.iter().flat_map(|draw| cases.iter().map(move |case| (draw, case))).collect();
        let mut answers =
            self.map(&pairs, |planners, (draw, case)| compute(planners, case, draw))?.into_iter();
        let mut lists: Vec<Vec<T>> = cases.iter().map(|_| Vec::with_capacity(draws.len())).collect();
        for _ in draws {
            lists.iter_mut().zip(&mut answers).for_each(|(list, answer)| list.push(answer));
        }
        Ok(lists)
    }
}
