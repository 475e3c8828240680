//! Plugins that have failed too often.

use std::collections::{BTreeMap, BTreeSet};

/// Number of faults within [`WINDOW_S`] after which a plugin is not used again.
pub(in crate::engine) const MOST_FAULTS: usize = 3;
/// Mission time after which a fault no longer counts, seconds.
pub(in crate::engine) const WINDOW_S: f64 = 60.0;

/// Counts the faults of each plugin file, identified by its hash, over mission time.
#[derive(Clone, Debug, Default)]
pub(in crate::engine) struct Quarantine {
    faults_s: BTreeMap<String, Vec<f64>>,
    closed: BTreeSet<String>,
}

impl Quarantine {
    /// Records a fault of a plugin at this mission time.
    pub(crate) fn note(&mut self, sha256: &str, t_s: f64) {
        let recent = self.faults_s.entry(sha256.to_owned()).or_default();
        recent.push(t_s);
        recent.retain(|earlier| t_s - earlier < WINDOW_S);
        if recent.len() >= MOST_FAULTS {
            self.closed.insert(sha256.to_owned());
        }
    }

    /// Whether a plugin is excluded from being used again.
    pub(crate) fn holds(&self, sha256: &str) -> bool {
        self.closed.contains(sha256)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_faults_within_a_minute_are_too_many() {
        let mut quarantine = Quarantine::default();
        quarantine.note("a", 0.0);
        quarantine.note("b", 1.0);
        quarantine.note("a", 30.0);
        assert!(!quarantine.holds("a"));
        quarantine.note("a", 59.0);
        assert!(quarantine.holds("a") && !quarantine.holds("b"));
    }

    #[test]
    fn faults_that_lie_far_apart_are_forgiven() {
        let mut quarantine = Quarantine::default();
        for t_s in [0.0, 31.0, 61.0, 92.0] {
            quarantine.note("a", t_s);
        }
        assert!(!quarantine.holds("a"));
        quarantine.note("a", 93.0);
        assert!(quarantine.holds("a"), "the plugin stays excluded");
        quarantine.note("a", 1000.0);
        assert!(quarantine.holds("a"));
    }
}
