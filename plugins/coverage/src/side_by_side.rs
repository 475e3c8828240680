//! Independent work on all cores that the console can end. What comes out does not depend on the number of cores.

use crate::stages::Part;
use planner_api::{PlannerError, Result, on_own_thread};
use std::{
    collections::VecDeque,
    sync::{
        Mutex, OnceLock,
        atomic::{AtomicU64, Ordering},
        mpsc::{RecvTimeoutError, channel},
    },
    thread,
    time::Duration,
};

/// How often the console is asked whether it wants an end.
const ASK: Duration = Duration::from_millis(2);

/// One item's line to the console, for threads that have none themselves: whether it wants an end, and how far the item is.
#[derive(Debug, Default)]
pub struct Stop {
    end: OnceLock<PlannerError>,
    /// Shares of the item, as bits: where the stage at hand begins, where it ends, and how far all is.
    from: AtomicU64,
    to: AtomicU64,
    at: AtomicU64,
}

impl Stop {
    /// Call it in every loop.
    ///
    /// # Errors
    /// When the console wants an end.
    pub fn check(&self) -> Result<()> {
        self.end.get().map_or(Ok(()), |error| Err(error.clone()))
    }

    /// The stage before is done, and what follows leads up to this share of the item.
    pub fn stage(&self, to: f64) {
        self.reached(1.0);
        self.from.store(self.to.load(Ordering::Relaxed), Ordering::Relaxed);
        self.to.store(to.to_bits(), Ordering::Relaxed);
    }

    /// So much of the stage at hand is done, 0 to 1. The item never goes back.
    pub fn reached(&self, share: f64) {
        let [from, to, at] =
            [&self.from, &self.to, &self.at].map(|bits| f64::from_bits(bits.load(Ordering::Relaxed)));
        let now = at.max(from + (to - from) * share.clamp(0.0, 1.0));
        self.at.store(now.to_bits(), Ordering::Relaxed);
    }

    /// How far the item is, 0 to 1.
    fn at(&self) -> f64 {
        f64::from_bits(self.at.load(Ordering::Relaxed))
    }
}

/// Works on all items, as many at a time as there are cores; the results are in the order of the items. Meanwhile
/// reports their progress as a part of the plan.
///
/// # Errors
/// The first error of any item, in their order.
pub fn side_by_side<T: Send, R: Send>(
    items: Vec<T>,
    part: &Part<'_>,
    work: impl Fn(T, &Stop) -> Result<R> + Sync,
) -> Result<Vec<R>> {
    let (n, ctx) = (items.len(), &part.ctx);
    let stops: Vec<Stop> = (0..n).map(|_| Stop::default()).collect();
    let waiting: Mutex<VecDeque<(usize, T)>> = Mutex::new(items.into_iter().enumerate().collect());
    let next = || waiting.lock().ok()?.pop_front();
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let mut results: Vec<Option<Result<R>>> = (0..n).map(|_| None).collect();
    let report = |results: &[Option<Result<R>>]| {
        let shares =
            results.iter().zip(&stops).map(|(result, stop)| if result.is_some() { 1.0 } else { stop.at() });
        let n_done = results.iter().flatten().count();
        part.report(shares.sum::<f64>() / n as f64, n_done, n);
    };
    thread::scope(|scope| {
        let (sender, receiver) = channel();
        for _ in 0..cores.min(n) {
            let (sender, stops, work, next) = (sender.clone(), &stops, &work, &next);
            let toil = move || {
                while let Some((place, item)) = next() {
                    if sender.send((place, on_own_thread(|| work(item, &stops[place])))).is_err() {
                        break;
                    }
                }
            };
            // Where threads are not to be had the others do the work, or this one below.
            let _ = thread::Builder::new().spawn_scoped(scope, toil);
        }
        drop(sender);
        loop {
            match receiver.recv_timeout(ASK) {
                Ok((place, result)) => results[place] = Some(result),
                Err(RecvTimeoutError::Timeout) => {
                    if let Err(error) = ctx.check() {
                        for stop in &stops {
                            let _ = stop.end.set(error.clone());
                        }
                    }
                }
                Err(RecvTimeoutError::Disconnected) => break,
            }
            report(&results);
        }
        while let Some((place, item)) = next() {
            results[place] = Some(ctx.check().and_then(|()| work(item, &stops[place])));
            report(&results);
        }
    });
    results.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stages::Stages;
    use planner_api::{Code, testing::Bench};

    fn part(bench: &Bench) -> Part<'_> {
        Stages::new(&bench.ctx()).next(0.5, "items")
    }

    #[test]
    fn the_reported_progress_rises_to_the_end_of_the_part() {
        let bench = Bench::new();
        let work = |_: u64, stop: &Stop| {
            stop.stage(0.5);
            for k in 0..10 {
                stop.reached(f64::from(k) / 10.0);
                thread::sleep(Duration::from_millis(1));
            }
            stop.stage(1.0);
            thread::sleep(Duration::from_millis(10));
            Ok(())
        };
        side_by_side(vec![0; 3], &part(&bench), work).unwrap();
        let progress = bench.progress();
        assert!(
            progress.len() >= 3 && progress.windows(2).all(|pair| pair[0].0 <= pair[1].0),
            "{progress:?}"
        );
        assert_eq!(progress.last(), Some(&(0.5, "items, 3 of 3 done".to_owned())));
        assert!(progress.iter().any(|(share, _)| *share > 0.0 && *share < 0.5), "{progress:?}");
    }

    #[test]
    fn an_item_goes_through_its_stages_and_never_back() {
        let stop = Stop::default();
        let is_at = |share: f64| (stop.at() - share).abs() < 1e-9;
        stop.stage(0.4);
        assert!(is_at(0.0));
        stop.reached(0.5);
        assert!(is_at(0.2));
        stop.reached(0.1);
        assert!(is_at(0.2), "never back");
        stop.stage(0.8);
        assert!(is_at(0.4), "the stage before is done");
        stop.reached(7.0);
        assert!(is_at(0.8));
    }

    #[test]
    fn results_come_in_the_order_of_the_items() {
        let bench = Bench::new();
        let work = |k: u64, _: &Stop| {
            thread::sleep(Duration::from_millis(20 - 2 * k));
            Ok(k * k)
        };
        let squares = side_by_side((0..10).collect(), &part(&bench), work).unwrap();
        assert_eq!(squares, (0..10).map(|k| k * k).collect::<Vec<_>>());
    }

    #[test]
    fn a_panic_of_one_item_is_an_error_with_its_text() {
        let bench = Bench::new();
        let work = |k: i32, _: &Stop| if k == 2 { panic!("item {k} is odd") } else { Ok(k) };
        let error = side_by_side((0..8).collect(), &part(&bench), work).unwrap_err();
        assert!(error.code == Code::Panic && error.message.ends_with("item 2 is odd"), "{error}");
    }

    #[test]
    fn the_first_error_in_the_order_of_the_items_is_returned() {
        let bench = Bench::new();
        let work = |k: i32, _: &Stop| {
            if k < 3 { Ok(k) } else { Err(PlannerError::new(Code::Invalid, format!("item {k}"))) }
        };
        let error = side_by_side((0..8).collect(), &part(&bench), work).unwrap_err();
        assert_eq!(error.message, "item 3");
    }
}
