//! Runs cases on all cores.

use crate::{coverage::Picture, planners::Planners, study::Problem};
use planner_host::PluginDirs;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// More threads than this help nobody, and each starts planners of its own.
const MOST_THREADS: usize = 256;

/// Who runs the cases of a study.
pub struct Bench<'a> {
    planners: Planners,
    threads: rayon::ThreadPool,
    progress: &'a (dyn Fn(usize, usize) + Sync),
    gallery: Option<&'a (dyn Fn(&Picture<'_>) + Sync)>,
}

impl<'a> Bench<'a> {
    /// A bench with planners from these folders on so many threads (0: one for each core), which reports to
    /// `progress` how many cases of how many are done.
    ///
    /// # Errors
    /// So many threads are of no use, or cannot be started.
    pub fn new(
        dirs: &PluginDirs,
        n_threads: usize,
        progress: &'a (dyn Fn(usize, usize) + Sync),
    ) -> Result<Self, Problem> {
        if n_threads > MOST_THREADS {
            return Err(Problem::Nothing(format!(
                "--threads {n_threads}: at most {MOST_THREADS}; 0 is one for each core"
            )));
        }
        let threads = rayon::ThreadPoolBuilder::new()
            .num_threads(n_threads)
            .build()
            .map_err(|error| Problem::Nothing(format!("the threads cannot be started: {error}")))?;
        Ok(Self { planners: Planners::new(dirs), threads, progress, gallery: None })
    }

    /// The same, showing every plan to whoever draws; only some studies have plans to show.
    #[must_use]
    pub fn with_gallery(self, show: &'a (dyn Fn(&Picture<'_>) + Sync)) -> Self {
        Self { gallery: Some(show), ..self }
    }

    /// Who draws.
    pub(crate) fn gallery(&self) -> Option<&'a (dyn Fn(&Picture<'_>) + Sync)> {
        self.gallery
    }

    /// Computes every case; the answers keep the order of the cases, whoever computed them.
    ///
    /// # Errors
    /// The first problem in the order of the cases.
    pub fn map<C: Sync, T: Send>(
        &self,
        cases: &[C],
        compute: impl Fn(&Planners, &C) -> Result<T, Problem> + Sync,
    ) -> Result<Vec<T>, Problem> {
        let done = AtomicUsize::new(0);
        (self.progress)(0, cases.len());
        let one = |case: &C| {
            let answer = compute(&self.planners, case);
            (self.progress)(done.fetch_add(1, Ordering::Relaxed) + 1, cases.len());
            answer
        };
        self.threads.install(|| {
            let answers: Vec<Result<T, Problem>> = cases.par_iter().map(one).collect();
            answers.into_iter().collect()
        })
    }
}
