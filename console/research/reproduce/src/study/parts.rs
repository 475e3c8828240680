//! Results that are stored between processes, so that a study can be resumed and shared by several machines.

use super::error::{Result, StudyError};
use rayon::prelude::*;
use serde::{Serialize, de::DeserializeOwned};
use std::time::Duration;

/// Interval between checks for a part that another process has claimed.
const POLL: Duration = Duration::from_millis(200);

/// The store of the parts: a folder in which several processes may work at the same time.
pub trait Parts: Sync {
    /// The path of a part, for messages.
    fn place(&self, name: &str) -> String;
    /// Reads a part, if it exists.
    ///
    /// # Errors
    /// The part cannot be read.
    fn read(&self, name: &str) -> Result<Option<Vec<u8>>, String>;
    /// Claims a part for this process; false if another process has it.
    fn claim(&self, name: &str) -> bool;
    /// Called while this process waits for a part that another process has claimed.
    fn wait_for(&self, name: &str);
    /// Refreshes a claim, to show that its holder is alive.
    fn keep_claim(&self, name: &str);
    /// Releases the claim to a part.
    fn release(&self, name: &str);
    /// Stores a part completely or not at all.
    ///
    /// # Errors
    /// The part cannot be written.
    fn publish(&self, name: &str, bytes: &[u8]) -> Result<(), String>;
}

/// Parts of one list of cases.
pub(super) struct Kept<'a> {
    pub parts: &'a dyn Parts,
    /// The index of the list in the study.
    pub list: usize,
    /// The maximum number of parts of a list.
    pub most: usize,
}

impl Kept<'_> {
    /// Returns the results of all cases, in order: read from existing parts, or computed. `is_done` is called with
    /// the number of cases of each part that did not have to be computed.
    ///
    /// # Errors
    /// The first error in the order of the cases, or an error of the folder.
    pub(super) fn map<C: Sync, T: Send + Serialize + DeserializeOwned>(
        &self,
        cases: &[C],
        compute: impl Fn(&C) -> Result<T> + Sync,
        is_done: impl Fn(usize) + Sync,
    ) -> Result<Vec<T>> {
        let size = cases.len().div_ceil(self.most).max(1);
        let parts: Vec<(usize, &[C])> = cases.chunks(size).enumerate().collect();
        let take = |(n, cases): &(usize, &[C])| self.take(*n, cases, &compute, &is_done);
        let taken: Vec<Option<Result<Vec<T>>>> =
            parts.par_iter().map(|part| take(part).transpose()).collect();
        let wait = |part: &(usize, &[C])| loop {
            if let Some(answers) = take(part)? {
                return Ok(answers);
            }
            self.parts.wait_for(&self.name(part.0));
            std::thread::sleep(POLL);
        };
        let answers = taken.into_iter().zip(&parts).map(|(taken, part)| taken.unwrap_or_else(|| wait(part)));
        answers.collect::<Result<Vec<Vec<T>>>>().map(|parts| parts.into_iter().flatten().collect())
    }

    fn name(&self, n: usize) -> String {
        format!("part-{:05}-{n:05}.cbor", self.list)
    }

    /// The results of a part; `None` if another process is computing them.
    fn take<C, T: Serialize + DeserializeOwned>(
        &self,
        n: usize,
        cases: &[C],
        compute: impl Fn(&C) -> Result<T>,
        is_done: impl Fn(usize),
    ) -> Result<Option<Vec<T>>> {
        let name = self.name(n);
        let refused = |why: String| StudyError::Refused(format!("{}: {why}", self.parts.place(&name)));
        let there = || -> Result<Option<Vec<T>>> {
            let Some(bytes) = self.parts.read(&name).map_err(refused)? else { return Ok(None) };
            let answers = read(&bytes).filter(|answers: &Vec<T>| answers.len() == cases.len());
            let remedy = || refused("damaged; delete it, then run the same command again".into());
            let answers = answers.ok_or_else(remedy)?;
            is_done(cases.len());
            Ok(Some(answers))
        };
        if let Some(answers) = there()? {
            return Ok(Some(answers));
        }
        if !self.parts.claim(&name) {
            return Ok(None);
        }
        let one = |case: &C| {
            let answer = compute(case);
            self.parts.keep_claim(&name);
            answer
        };
        let compute_all = || {
            let answers = cases.iter().map(one).collect::<Result<Vec<T>>>()?;
            let mut bytes = Vec::new();
            ciborium::into_writer(&answers, &mut bytes).map_err(|error| refused(error.to_string()))?;
            self.parts.publish(&name, &bytes).map_err(refused)?;
            Ok(answers)
        };
        // The previous holder may have stored the part before it released the claim.
        let answers = there().and_then(|there| there.map_or_else(compute_all, Ok));
        self.parts.release(&name);
        answers.map(Some)
    }
}

fn read<T: DeserializeOwned>(bytes: &[u8]) -> Option<T> {
    let mut rest = bytes;
    let read = ciborium::from_reader(&mut rest).ok()?;
    rest.is_empty().then_some(read)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{
        collections::{BTreeMap, BTreeSet},
        sync::{
            Mutex,
            atomic::{AtomicUsize, Ordering},
        },
    };

    #[derive(Default)]
    struct Memory {
        parts: Mutex<BTreeMap<String, Vec<u8>>>,
        claims: Mutex<BTreeSet<String>>,
    }

    impl Parts for Memory {
        fn place(&self, name: &str) -> String {
            format!("memory/{name}")
        }
        fn read(&self, name: &str) -> Result<Option<Vec<u8>>, String> {
            Ok(self.parts.lock().unwrap().get(name).cloned())
        }
        fn claim(&self, name: &str) -> bool {
            self.claims.lock().unwrap().insert(name.to_owned())
        }
        fn wait_for(&self, name: &str) {
            assert!(name.starts_with("part-00000-"));
        }
        fn keep_claim(&self, name: &str) {
            assert!(self.claims.lock().unwrap().contains(name));
        }
        fn release(&self, name: &str) {
            self.claims.lock().unwrap().remove(name);
        }
        fn publish(&self, name: &str, bytes: &[u8]) -> Result<(), String> {
            self.parts.lock().unwrap().insert(name.to_owned(), bytes.to_owned());
            Ok(())
        }
    }

    /// Squares of numbers, and how many of them were computed.
    fn squares(memory: &Memory, fails_at: Option<u64>) -> (Result<Vec<f64>>, usize) {
        let computed = AtomicUsize::new(0);
        let cases: Vec<u64> = (0..23).collect();
        let compute = |case: &u64| {
            if fails_at == Some(*case) {
                return Err(StudyError::Refused("ended".into()));
            }
            computed.fetch_add(1, Ordering::Relaxed);
            Ok(if *case == 3 { f64::INFINITY } else { (case * case) as f64 })
        };
        let kept = Kept { parts: memory, list: 0, most: 6 };
        (kept.map(&cases, compute, |_| ()), computed.into_inner())
    }

    #[test]
    fn a_study_that_was_ended_goes_on_where_it_was() {
        let memory = Memory::default();
        assert!(squares(&memory, Some(9)).0.is_err());
        assert_eq!(memory.parts.lock().unwrap().len(), 5, "all parts but the one that failed");
        assert!(memory.claims.lock().unwrap().is_empty());
        let (answers, computed) = squares(&memory, None);
        assert_eq!(computed, 4);
        let answers = answers.unwrap();
        assert_eq!((answers.len(), answers[3], answers[22]), (23, f64::INFINITY, 484.0));
        assert_eq!(squares(&memory, None).1, 0);
    }

    #[test]
    fn several_processes_share_the_parts() {
        let memory = Memory::default();
        let counts = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..3).map(|_| scope.spawn(|| squares(&memory, None))).collect();
            workers.into_iter().map(|worker| worker.join().unwrap()).collect::<Vec<_>>()
        });
        assert!(counts.iter().all(|(answers, _)| answers.as_ref().unwrap().len() == 23));
        assert_eq!(counts.iter().map(|(_, computed)| computed).sum::<usize>(), 23);
    }

    #[test]
    fn a_damaged_part_is_named() {
        let memory = Memory::default();
        squares(&memory, None).0.unwrap();
        memory.parts.lock().unwrap().get_mut("part-00000-00002.cbor").unwrap().truncate(5);
        let why = squares(&memory, None).0.unwrap_err().to_string();
        assert!(why.starts_with("memory/part-00000-00002.cbor: damaged; delete it"), "{why}");
    }
}
