//! The protection level of the estimated position, from tick to tick.

use crate::{accuracy::nearest_rank, summary};

/// The protection levels of a run.
#[derive(Debug, Default)]
pub(crate) struct Protection {
    before: Option<f64>,
    now: Option<f64>,
    levels_m: Vec<f32>,
    ticks: usize,
}

impl Protection {
    /// Adds the level of a tick, metres; `None` if the position is not protected.
    pub(crate) fn take(&mut self, level_m: Option<f64>) {
        self.before = std::mem::replace(&mut self.now, level_m);
        self.levels_m.extend(level_m.map(|level_m| level_m as f32));
        self.ticks += 1;
    }

    /// Returns the larger level at the two ends of the last movement, metres; infinity if an end is not protected.
    ///
    /// A fix makes the level smaller, but says nothing about the way to the place of the fix.
    pub(crate) fn level_m(&self) -> f64 {
        let of = |level: Option<f64>| level.unwrap_or(f64::INFINITY);
        of(self.before).max(of(self.now))
    }
}

impl Protection {
    /// The figures of the run; `None` if the mission computes no levels. `guarantees` states whether the level decides
    /// which floor is guaranteed.
    pub(crate) fn statement(&self, guarantees: bool) -> Option<summary::Protection> {
        let mut sorted = self.levels_m.clone();
        sorted.sort_by(f32::total_cmp);
        let metres = |level: Option<f32>| level.map(f64::from);
        (self.ticks > 0).then(|| summary::Protection {
            p50_m: metres(nearest_rank(&sorted, 0.5)),
            p95_m: metres(nearest_rank(&sorted, 0.95)),
            max_m: metres(sorted.last().copied()),
            unprotected: (self.ticks - sorted.len()) as f64 / self.ticks as f64,
            guarantees,
            risk: None,
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn the_larger_level_of_both_ends_counts_and_a_missing_one_protects_nothing() {
        let mut protection = Protection::default();
        let mut after = |level| {
            protection.take(level);
            protection.level_m()
        };
        let levels = [Some(0.2), Some(0.3), Some(0.1), None, Some(0.1), Some(0.1)].map(&mut after);
        let is_same = |a: f64, b: f64| a.total_cmp(&b).is_eq();
        let expected = [f64::INFINITY, 0.3, 0.3, f64::INFINITY, f64::INFINITY, 0.1];
        assert!(levels.iter().zip(expected).all(|(level, other)| is_same(*level, other)), "{levels:?}");
        let statement = protection.statement(true).unwrap();
        assert!(
            is_same(statement.unprotected, 1.0 / 6.0)
                && is_same(statement.p95_m.unwrap(), f64::from(0.3_f32))
        );
    }
}
