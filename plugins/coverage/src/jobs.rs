//! Independent work on all cores, which the console can cancel. The results do not depend on the number of cores.

use crate::stages::Stage;
use planner_api::{Ctx, PlannerError, Result, on_own_thread};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, OnceLock};
use std::{collections::VecDeque, thread, time::Duration};

/// Interval at which the console is asked whether the work is cancelled.
const ASK: Duration = Duration::from_millis(2);

/// The work on one item: its progress and whether it is cancelled, for threads that cannot ask the console themselves.
#[derive(Default)]
pub(crate) struct Job {
    end: OnceLock<PlannerError>,
    /// Shares of the item, as bits: start and end of the current stage, and overall progress.
    from: AtomicU64,
    to: AtomicU64,
    at: AtomicU64,
}

impl Job {
    /// Returns an error once the console has cancelled the work. Call this in every loop.
    pub(crate) fn check(&self) -> Result<()> {
        self.end.get().map_or(Ok(()), |error| Err(error.clone()))
    }

    /// Ends the previous stage and starts the next, which ends at this share of the item.
    pub(crate) fn stage(&self, to: f64) {
        self.reached(1.0);
        self.from.store(self.to.load(Ordering::Relaxed), Ordering::Relaxed);
        self.to.store(to.to_bits(), Ordering::Relaxed);
    }

    /// Sets the progress within the current stage, 0 to 1. The item's progress never decreases.
    pub(crate) fn reached(&self, share: f64) {
        let [from, to, at] =
            [&self.from, &self.to, &self.at].map(|bits| f64::from_bits(bits.load(Ordering::Relaxed)));
        let now = at.max(from + (to - from) * share.clamp(0.0, 1.0));
        self.at.store(now.to_bits(), Ordering::Relaxed);
    }

    /// The progress of the item, 0 to 1.
    fn at(&self) -> f64 {
        f64::from_bits(self.at.load(Ordering::Relaxed))
    }
}

/// Works on all items, with one thread per core; the results are in the order of the items. Reports their progress as a
/// stage of the plan.
///
/// # Errors
/// The first error, in the order of the items.
pub(crate) fn run_all<T: Send, R: Send>(
    items: Vec<T>,
    stage: &Stage<'_>,
    work: impl Fn(T, &Job) -> Result<R> + Sync,
) -> Result<Vec<R>> {
    let n = items.len();
    let jobs: Vec<Job> = (0..n).map(|_| Job::default()).collect();
    let waiting: Mutex<VecDeque<(usize, T)>> = Mutex::new(items.into_iter().enumerate().collect());
    let next = || waiting.lock().ok()?.pop_front();
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let mut results: Vec<Option<Result<R>>> = (0..n).map(|_| None).collect();
    if n > 0 {
        report(stage, &jobs, &results);
    }
    thread::scope(|scope| {
        let (sender, receiver) = channel();
        for _ in 0..cores.min(n) {
            let (sender, jobs, work, next) = (sender.clone(), &jobs, &work, &next);
            let worker = move || {
                while let Some((place, item)) = next() {
                    if sender.send((place, on_own_thread(|| work(item, &jobs[place])))).is_err() {
                        break;
                    }
                }
            };
            // If a thread cannot be started, its work is done by the other threads or by the loop below.
            let _ = thread::Builder::new().spawn_scoped(scope, worker);
        }
        drop(sender);
        loop {
            match receiver.recv_timeout(ASK) {
                Ok((place, result)) => results[place] = Some(result),
                Err(RecvTimeoutError::Timeout) => pass_on_cancellation(&stage.ctx, &jobs),
                Err(RecvTimeoutError::Disconnected) => break,
            }
            report(stage, &jobs, &results);
        }
        while let Some((place, item)) = next() {
            results[place] = Some(stage.ctx.check().and_then(|()| work(item, &jobs[place])));
            report(stage, &jobs, &results);
        }
    });
    results.into_iter().flatten().collect()
}

fn pass_on_cancellation(ctx: &Ctx<'_>, jobs: &[Job]) {
    if let Err(error) = ctx.check() {
        for job in jobs {
            let _ = job.end.set(error.clone());
        }
    }
}

fn report<R>(stage: &Stage<'_>, jobs: &[Job], results: &[Option<R>]) {
    let shares = results.iter().zip(jobs).map(|(result, job)| if result.is_some() { 1.0 } else { job.at() });
    let n_done = results.iter().flatten().count();
    stage.report(shares.sum::<f64>() / jobs.len() as f64, n_done, jobs.len());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stages::Stages;
    use planner_api::Code;
    use planner_api::testing::Bench;

    fn stage(bench: &Bench) -> Stage<'_> {
        Stages::new(&bench.ctx()).next(0.5, "items")
    }

    #[test]
    fn the_reported_progress_rises_to_the_end_of_the_stage() {
        let bench = Bench::new();
        let work = |_: u64, job: &Job| {
            job.stage(0.5);
            for k in 0..10 {
                job.reached(f64::from(k) / 10.0);
                thread::sleep(Duration::from_millis(1));
            }
            job.stage(1.0);
            thread::sleep(Duration::from_millis(10));
            Ok(())
        };
        run_all(vec![0; 3], &stage(&bench), work).unwrap();
        let progress = bench.progress();
        assert_eq!(progress.first(), Some(&(0.0, "items: 0 of 3 worked out".to_owned())));
        assert!(
            progress.len() >= 4 && progress.windows(2).all(|pair| pair[0].0 <= pair[1].0),
            "{progress:?}"
        );
        assert_eq!(progress.last(), Some(&(0.5, "items: 3 of 3 worked out".to_owned())));
        assert!(progress.iter().any(|(share, _)| *share > 0.0 && *share < 0.5), "{progress:?}");
    }

    #[test]
    fn an_item_goes_through_its_stages_and_never_back() {
        let job = Job::default();
        let is_at = |share: f64| (job.at() - share).abs() < 1e-9;
        job.stage(0.4);
        assert!(is_at(0.0));
        job.reached(0.5);
        assert!(is_at(0.2));
        job.reached(0.1);
        assert!(is_at(0.2), "never back");
        job.stage(0.8);
        assert!(is_at(0.4), "the stage before is done");
        job.reached(7.0);
        assert!(is_at(0.8));
    }

    #[test]
    fn results_come_in_the_order_of_the_items() {
        let bench = Bench::new();
        let work = |k: u64, _: &Job| {
            thread::sleep(Duration::from_millis(20 - 2 * k));
            Ok(k * k)
        };
        let squares = run_all((0..10).collect(), &stage(&bench), work).unwrap();
        assert_eq!(squares, (0..10).map(|k| k * k).collect::<Vec<_>>());
    }

    #[test]
    fn a_panic_of_one_item_is_an_error_with_its_text() {
        let bench = Bench::new();
        let work = |k: i32, _: &Job| if k == 2 { panic!("item {k} is odd") } else { Ok(k) };
        let error = run_all((0..8).collect(), &stage(&bench), work).unwrap_err();
        assert!(error.code == Code::Panic && error.message.ends_with("item 2 is odd"), "{error}");
    }

    #[test]
    fn the_first_error_in_the_order_of_the_items_is_returned() {
        let bench = Bench::new();
        let work = |k: i32, _: &Job| {
            if k < 3 { Ok(k) } else { Err(PlannerError::new(Code::Invalid, format!("item {k}"))) }
        };
        let error = run_all((0..8).collect(), &stage(&bench), work).unwrap_err();
        assert_eq!(error.message, "item 3");
    }
}
