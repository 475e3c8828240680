//! Records the last requests to a worker, so that they can be replayed to its plugin.

use crate::wire::kind;
use std::collections::VecDeque;

/// The maximum number of requests kept, counted from the last plan request.
const MOST: usize = 200;
/// The maximum number of configuration requests kept: loading, parameters, state.
const MOST_LASTING: usize = 64;

/// Frames as they were sent to the worker.
#[derive(Debug, Default)]
pub(super) struct Tape {
    lasting: Vec<Vec<u8>>,
    /// The last plan request, and the newest steps after it.
    recent: VecDeque<Vec<u8>>,
}

impl Tape {
    /// Records a request.
    pub(super) fn note(&mut self, kind: u8, frame: &[u8]) {
        match kind {
            kind::LOAD | kind::CONFIGURE | kind::RECONFIGURE | kind::RESTORE
                if self.lasting.len() < MOST_LASTING =>
            {
                self.lasting.push(frame.to_vec());
            }
            kind::PLAN => self.recent = VecDeque::from([frame.to_vec()]),
            kind::STEP => {
                // The plan request at the front stays.
                let full = self.recent.len() == MOST;
                let mut room = full.then(|| self.recent.remove(1)).flatten().unwrap_or_default();
                room.clear();
                room.extend_from_slice(frame);
                self.recent.push_back(room);
            }
            _ => {}
        }
    }

    /// Returns all recorded requests, in order.
    pub(super) fn bytes(&self) -> Vec<u8> {
        self.lasting.iter().chain(&self.recent).flatten().copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_made_the_planner_the_plan_and_the_newest_steps_are_kept() {
        let mut tape = Tape::default();
        for (kind, frame) in [(kind::LOAD, 1), (kind::PLAN, 2), (kind::STEP, 3), (kind::PLAN, 4)] {
            tape.note(kind, &[frame]);
        }
        tape.note(kind::SNAPSHOT, &[9]);
        for step in 0..MOST + 5 {
            tape.note(kind::STEP, &[(step % 100) as u8]);
        }
        tape.note(kind::RECONFIGURE, &[7]);
        let bytes = tape.bytes();
        assert_eq!(bytes[..4], [1, 7, 4, 6]);
        assert_eq!((bytes.len(), bytes[bytes.len() - 1]), (2 + MOST, 4));
    }
}
