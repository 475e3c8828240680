//! How often planners were called, and how much wall-clock time their calls took.

use std::time::Duration;

/// Calls of one kind.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct CallStats {
    /// The number of calls.
    pub calls: u64,
    /// Median duration, microseconds; absent without calls.
    pub p50_us: Option<f64>,
    /// 99th percentile of the duration, microseconds; absent without calls.
    pub p99_us: Option<f64>,
}

/// The cost of planners so far. Wall times differ from run to run, so they may be written to reports but never to the
/// journal.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct HostStats {
    /// Requests for plans.
    pub plan: CallStats,
    /// Requests for commands.
    pub step: CallStats,
    /// Faults of all kinds, including refusals to plan.
    pub faults: u64,
}

/// Resident memory of a worker, including its libraries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Memory {
    /// Current memory, bytes.
    pub now_bytes: u64,
    /// Peak memory so far, bytes.
    pub most_bytes: u64,
    /// The current number of threads, including the worker's own two.
    pub threads: u32,
}

/// Wall times of calls of one kind, microseconds. A million of them take up four megabytes, each accurate to one part
/// in ten million.
#[derive(Debug, Default)]
pub(crate) struct Durations(Vec<f32>);

impl Durations {
    pub(crate) fn note(&mut self, took: Duration) {
        self.0.push((took.as_secs_f64() * 1e6) as f32);
    }

    pub(crate) fn stats(&self) -> CallStats {
        let mut sorted = self.0.clone();
        sorted.sort_unstable_by(f32::total_cmp);
        let quantile = |share: f64| {
            let rank = (share * sorted.len() as f64).ceil() as usize;
            sorted.get(rank.saturating_sub(1)).copied().map(f64::from)
        };
        CallStats { calls: sorted.len() as u64, p50_us: quantile(0.5), p99_us: quantile(0.99) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_values_that_occurred() {
        let mut durations = Durations::default();
        assert_eq!(durations.stats(), CallStats::default());
        (1..=100).rev().for_each(|n| durations.note(Duration::from_micros(n)));
        let stats = durations.stats();
        assert_eq!((stats.calls, stats.p50_us, stats.p99_us), (100, Some(50.0), Some(99.0)));
    }
}
