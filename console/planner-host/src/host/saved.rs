//! Private state of planners, kept for their successors.

use mission::{AskId, PlannerInfo};

/// The maximum number of states kept, each from a different worker.
const MOST: usize = 8;

/// The private state of a planner.
#[derive(Debug)]
pub(super) struct Saved {
    /// The ask for which it was saved.
    pub(super) ask: AskId,
    pub(super) planner: String,
    pub(super) sha256: String,
    pub(super) version: u32,
    pub(super) state: Vec<u8>,
}

/// The newest state of every worker, in the order in which the states were saved. States outlive their workers.
#[derive(Debug, Default)]
pub(super) struct SavedStates(Vec<Saved>);

impl SavedStates {
    /// Keeps a state, replacing an earlier one from the same worker.
    pub(super) fn keep(&mut self, saved: Saved) {
        self.0.retain(|earlier| earlier.ask.worker != saved.ask.worker);
        self.0.push(saved);
        let surplus = self.0.len().saturating_sub(MOST);
        self.0.drain(..surplus);
    }

    /// Returns the state that was saved for an ask, if the planner, the file and the version match.
    pub(super) fn fitting(&self, ask: AskId, info: &PlannerInfo, version: u32) -> Option<&[u8]> {
        let fits = |saved: &&Saved| {
            saved.ask == ask
                && saved.planner == info.id
                && saved.sha256 == info.sha256
                && saved.version == version
        };
        self.0.iter().find(fits).map(|saved| saved.state.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::info;
    use mission::WorkerId;

    fn ask(worker: u16, n: u32) -> AskId {
        AskId { worker: WorkerId(worker), n }
    }

    fn saved(ask: AskId) -> Saved {
        let state = vec![ask.n as u8];
        Saved { ask, planner: info().id, sha256: info().sha256, version: 7, state }
    }

    #[test]
    fn only_the_newest_of_a_worker_is_kept() {
        let mut states = SavedStates::default();
        for ask in [ask(1, 1), ask(2, 1), ask(1, 2)] {
            states.keep(saved(ask));
        }
        let fitting = |worker, n| states.fitting(ask(worker, n), &info(), 7);
        assert_eq!(fitting(1, 1), None);
        assert_eq!((fitting(1, 2), fitting(2, 1)), (Some(&[2][..]), Some(&[1][..])));
    }

    #[test]
    fn only_the_newest_workers_are_kept() {
        let mut states = SavedStates::default();
        (0..=MOST as u16).for_each(|worker| states.keep(saved(ask(worker, 1))));
        assert_eq!(states.fitting(ask(0, 1), &info(), 7), None);
        assert!(states.fitting(ask(1, 1), &info(), 7).is_some());
    }

    #[test]
    fn state_of_another_planner_file_or_version_does_not_fit() {
        let mut states = SavedStates::default();
        states.keep(saved(ask(1, 1)));
        let fits = |info: &PlannerInfo, version| states.fitting(ask(1, 1), info, version).is_some();
        assert!(fits(&info(), 7));
        assert!(!fits(&info(), 8));
        assert!(!fits(&PlannerInfo { id: "bvo".into(), ..info() }, 7));
        assert!(!fits(&PlannerInfo { sha256: "cd".into(), ..info() }, 7));
    }
}
