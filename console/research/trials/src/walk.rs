//! Our criterion for a successful walk along the spiral; the paper uses the word "success" without defining it.

use crate::score::ARRIVED_M;
use serde::{Deserialize, Serialize};
use world::Point;

/// Number of moves in a row over which a walk is tested for being trapped.
const TRAP_MOVES: usize = 25;
/// Distance gained in these moves, metres, below which a walk may be trapped.
const TRAP_GAIN_M: f64 = 0.2;
/// Distance to the preset point, metres, that a trapped walk exceeds throughout these moves; at their end, it exceeds
/// twice this distance.
const TRAP_LAG_M: f64 = 0.2;
/// Maximum lag of a walk, metres: one coil of the paper's spiral. A walk that falls further behind skips floor.
const COIL_M: f64 = 0.4 * std::f64::consts::PI;

/// The result of a walk.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WalkOutcome {
    /// Whether the walk ends within 0.4 m of the last preset point.
    pub arrives: bool,
    /// Whether the walk stood still for 25 moves while its preset point moved on.
    pub is_trapped: bool,
    /// Largest distance of a planned point from its preset point, metres.
    pub lag_m: f64,
}

impl WalkOutcome {
    /// The outcome of a walk whose k-th point belongs to the k-th of `targets`, which are preset points.
    pub fn of(path: &[Point], targets: &[Point], preset: &[Point]) -> Self {
        let lags: Vec<f64> = path.iter().zip(targets).map(|(p, q)| (p - q).norm()).collect();
        let stands = |k: usize| {
            (path[k + TRAP_MOVES] - path[k]).norm() < TRAP_GAIN_M
                && lags[k..=k + TRAP_MOVES].iter().all(|lag| *lag > TRAP_LAG_M)
                && lags[k + TRAP_MOVES] > 2.0 * TRAP_LAG_M
        };
        Self {
            arrives: path.last().zip(preset.last()).is_some_and(|(p, q)| (p - q).norm() <= ARRIVED_M),
            is_trapped: (0..lags.len().saturating_sub(TRAP_MOVES)).any(stands),
            lag_m: lags.iter().copied().fold(0.0, f64::max),
        }
    }

    /// Whether the walk arrives, is never trapped and never lags by more than a coil.
    pub fn is_ok(&self) -> bool {
        self.arrives && !self.is_trapped && self.lag_m <= COIL_M
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::spiral::Spiral;

    #[test]
    fn the_preset_path_itself_is_ok() {
        let preset = Spiral::WANG_2023.points();
        let outcome = WalkOutcome::of(&preset, &preset, &preset);
        assert!(outcome.is_ok() && outcome.lag_m == 0.0);
    }

    #[test]
    fn a_walk_that_stays_where_it_is_is_trapped() {
        let preset = Spiral::WANG_2023.points();
        let path: Vec<Point> = preset.iter().enumerate().map(|(k, p)| preset[k.min(300)] + (p - p)).collect();
        let outcome = WalkOutcome::of(&path, &preset, &preset);
        assert!(outcome.is_trapped && !outcome.arrives && !outcome.is_ok());
    }
}
