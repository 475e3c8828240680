//! The paper's figures of a planned path.

use world::{Point, polyline};

/// How well a planned path follows its preset points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Score {
    /// Share of planned points within 0.2 m of the preset point of the same index.
    pub precision: f64,
    /// Root of the mean squared distance to the preset point of the same index, metres.
    pub rmse_m: f64,
    /// Furthest distance to the preset point of the same index, metres.
    pub worst_m: f64,
    /// Share of preset points within 0.2 m of the path.
    pub covered: f64,
}

/// The figures of a path whose k-th point belongs to the k-th preset point.
pub fn score(path: &[Point], preset: &[Point]) -> Score {
    let lags: Vec<f64> = path.iter().zip(preset).skip(1).map(|(p, q)| (p - q).norm()).collect();
    let n_points = lags.len().max(1) as f64;
    let n_covered = preset.iter().filter(|q| polyline::distance_m(path, **q) <= 0.2).count();
    Score {
        precision: lags.iter().filter(|lag| **lag <= 0.2).count() as f64 / n_points,
        rmse_m: (lags.iter().map(|lag| lag * lag).sum::<f64>() / n_points).sqrt(),
        worst_m: lags.iter().copied().fold(0.0, f64::max),
        covered: n_covered as f64 / preset.len().max(1) as f64,
    }
}
