//! Independent work on all cores that the console can end. What comes out does not depend on the number of cores.

use planner_api::{Ctx, PlannerError, Result, on_own_thread};
use std::{
    collections::VecDeque,
    sync::{
        Mutex, OnceLock,
        mpsc::{RecvTimeoutError, channel},
    },
    thread,
    time::Duration,
};

/// How often the console is asked whether it wants an end.
const ASK: Duration = Duration::from_millis(2);

/// Whether the console wants an end, for threads that cannot ask it themselves.
#[derive(Debug, Default)]
pub struct Stop(OnceLock<PlannerError>);

impl Stop {
    /// Call it in every loop.
    ///
    /// # Errors
    /// When the console wants an end.
    pub fn check(&self) -> Result<()> {
        self.0.get().map_or(Ok(()), |error| Err(error.clone()))
    }
}

/// Works on all items, as many at a time as there are cores; the results are in the order of the items.
///
/// # Errors
/// The first error of any item, in their order.
pub fn side_by_side<T: Send, R: Send>(
    items: Vec<T>,
    ctx: &Ctx<'_>,
    work: impl Fn(T, &Stop) -> Result<R> + Sync,
) -> Result<Vec<R>> {
    let n = items.len();
    let stop = Stop::default();
    let waiting: Mutex<VecDeque<(usize, T)>> = Mutex::new(items.into_iter().enumerate().collect());
    let next = || waiting.lock().ok()?.pop_front();
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let mut results: Vec<Option<Result<R>>> = (0..n).map(|_| None).collect();
    thread::scope(|scope| {
        let (sender, receiver) = channel();
        for _ in 0..cores.min(n) {
            let (sender, stop, work, next) = (sender.clone(), &stop, &work, &next);
            let toil = move || {
                while let Some((place, item)) = next() {
                    if sender.send((place, on_own_thread(|| work(item, stop)))).is_err() {
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
                        let _ = stop.0.set(error);
                    }
                }
                Err(RecvTimeoutError::Disconnected) => break,
            }
        }
        while let Some((place, item)) = next() {
            results[place] = Some(ctx.check().and_then(|()| work(item, &stop)));
        }
    });
    results.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_api::{Code, testing::Bench};

    #[test]
    fn results_come_in_the_order_of_the_items() {
        let bench = Bench::new();
        let work = |k: u64, _: &Stop| {
            thread::sleep(Duration::from_millis(20 - 2 * k));
            Ok(k * k)
        };
        let squares = side_by_side((0..10).collect(), &bench.ctx(), work).unwrap();
        assert_eq!(squares, (0..10).map(|k| k * k).collect::<Vec<_>>());
    }

    #[test]
    fn a_panic_of_one_item_is_an_error_with_its_text() {
        let bench = Bench::new();
        let work = |k: i32, _: &Stop| if k == 2 { panic!("item {k} is odd") } else { Ok(k) };
        let error = side_by_side((0..8).collect(), &bench.ctx(), work).unwrap_err();
        assert!(error.code == Code::Panic && error.message.ends_with("item 2 is odd"), "{error}");
    }

    #[test]
    fn the_first_error_in_the_order_of_the_items_is_told() {
        let bench = Bench::new();
        let work = |k: i32, _: &Stop| {
            if k < 3 { Ok(k) } else { Err(PlannerError::new(Code::Invalid, format!("item {k}"))) }
        };
        let error = side_by_side((0..8).collect(), &bench.ctx(), work).unwrap_err();
        assert_eq!(error.message, "item 3");
    }
}
