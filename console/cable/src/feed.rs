//! What the reel does in a step.

use crate::solve::spring;

/// A reel that takes cable up at one pull and pays it out at another, not smaller one, within bounds. At a bound, it
/// holds the cable.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Feed {
    /// Pull while the reel takes cable up, newtons.
    pub in_n: f64,
    /// Pull while the reel pays cable out, newtons.
    pub out_n: f64,
    /// Most cable that the reel takes up, metres.
    pub in_m: f64,
    /// Most cable that the reel pays out, metres.
    pub out_m: f64,
}

impl Feed {
    /// Pull, growth of the pull per metre, and energy of the reel's link, for its drawn length beyond its length at rest.
    /// As the link is drawn longer, the pull rises from nothing, stays while the reel takes less and less up, rises,
    /// stays while the reel pays out more and more, and rises.
    pub(crate) fn strain(&self, stiffness: f64, longer_m: f64) -> [f64; 3] {
        let (mut from_m, mut from_n, mut energy) = (-self.in_m, 0.0, 0.0);
        for (pull_n, feeds_m) in [(self.in_n, self.in_m), (self.out_n, self.out_m)] {
            let rises_m = (pull_n - from_n) / stiffness;
            if longer_m <= from_m + rises_m {
                break;
            }
            energy += 0.5 * (from_n + pull_n) * rises_m;
            (from_m, from_n) = (from_m + rises_m, pull_n);
            if longer_m <= from_m + feeds_m {
                return [pull_n, 0.0, energy + pull_n * (longer_m - from_m)];
            }
            energy += pull_n * feeds_m;
            from_m += feeds_m;
        }
        if longer_m <= from_m {
            return [0.0; 3];
        }
        let [more_n, growth, more] = spring(stiffness, longer_m - from_m);
        [from_n + more_n, growth, energy + from_n * (longer_m - from_m) + more]
    }

    /// The feed at a drawn length beyond the length at rest, metres; negative if cable is taken up.
    pub(crate) fn at(&self, stiffness: f64, longer_m: f64) -> f64 {
        let taken_m = (longer_m - self.in_n / stiffness).clamp(-self.in_m, 0.0);
        taken_m + (longer_m - self.out_n / stiffness).clamp(0.0, self.out_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pull_is_the_growth_of_the_energy_and_stays_while_the_reel_feeds() {
        let feed = Feed { in_n: 2.0, out_n: 3.0, in_m: 0.05, out_m: 0.1 };
        for k in -100..300 {
            let longer_m = 1e-3 * f64::from(k) + 3e-4;
            let [low, high] = [-1e-7, 1e-7].map(|by_m| feed.strain(1000.0, longer_m + by_m));
            let [pull_n, growth, _] = feed.strain(1000.0, longer_m);
            assert!(((high[2] - low[2]) / 2e-7 - pull_n).abs() < 1e-4, "{longer_m}");
            assert!(((high[0] - low[0]) / 2e-7 - growth).abs() < 1e-3, "{longer_m}");
            let left_m = longer_m - feed.at(1000.0, longer_m);
            assert!(
                (left_m.max(0.0) * 1000.0 - pull_n).abs() < 1e-9,
                "{longer_m}: the link bears what is left"
            );
        }
    }
}
