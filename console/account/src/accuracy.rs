//! Accuracy of the estimated position: according to its own covariance and, where the true position is known,
//! compared with the truth.

use crate::summary::{Accuracy as Statement, Positioning};
use nalgebra::Matrix2;
use positioning::fix::ELLIPSE_95;
use world::Point;

/// Accumulates the 95 % error according to the covariance, tick by tick.
#[derive(Debug, Default)]
pub(crate) struct Claimed {
    errors_m: Vec<f32>,
    way_m: f64,
    way_over_m: f64,
    last: Option<Point>,
    /// Largest error since the last ranging cycle, and during the cycle before that. The error grows between two
    /// fixes and drops at each fix, and only its peaks matter.
    tips_m: [f64; 2],
    fixes: u64,
    stations: u64,
    stations_min: Option<u64>,
}

impl Claimed {
    /// Adds the estimate of a tick and its 95 % error, metres.
    pub(crate) fn estimate(&mut self, position: Point, error_m: f64, limit_m: f64) {
        self.errors_m.push(error_m as f32);
        self.tips_m[0] = self.tips_m[0].max(error_m);
        let step_m = self.last.map_or(0.0, |last| (position - last).norm());
        self.last = Some(position);
        self.way_m += step_m;
        self.way_over_m += if error_m > limit_m { step_m } else { 0.0 };
    }

    /// Marks the end of a ranging cycle.
    pub(crate) fn end_cycle(&mut self) {
        self.tips_m = [0.0, self.tips_m[0]];
    }

    /// Adds a position computed from the ranges of this many stations.
    pub(crate) fn fix(&mut self, stations: usize) {
        let stations = stations as u64;
        self.fixes += 1;
        self.stations += stations;
        self.stations_min = Some(self.stations_min.map_or(stations, |least| least.min(stations)));
    }

    /// Largest 95 % error in this ranging cycle and the previous one, metres.
    pub(crate) fn tip_m(&self) -> f64 {
        self.tips_m[0].max(self.tips_m[1])
    }

    /// The figures; `None` without an estimate.
    pub(crate) fn statement(&self, limit_m: f64) -> Option<Statement> {
        let mut sorted = self.errors_m.clone();
        sorted.sort_by(f32::total_cmp);
        Some(Statement {
            mean_m: sorted.iter().map(|m| f64::from(*m)).sum::<f64>() / sorted.len() as f64,
            p95_m: f64::from(nearest_rank(&sorted, 0.95)?),
            max_m: f64::from(*sorted.last()?),
            limit_m,
            over_limit: if self.way_m > 0.0 { self.way_over_m / self.way_m } else { 0.0 },
            fixes: self.fixes,
            stations_mean: (self.fixes > 0).then(|| self.stations as f64 / self.fixes as f64),
            stations_min: self.stations_min,
            protection: None,
        })
    }
}

/// Returns the value that the given share of the sorted values does not exceed.
pub(crate) fn nearest_rank<T: Copy>(sorted: &[T], share: f64) -> Option<T> {
    sorted.get(((share * sorted.len() as f64).ceil() as usize).max(1) - 1).copied()
}

/// Accumulates position errors; pairs the true and the estimated position of a tick, whichever comes first.
#[derive(Debug, Default)]
pub(crate) struct Accuracy {
    truth: Option<(u64, Point)>,
    estimate: Option<(u64, Point, Matrix2<f64>)>,
    errors_m: Vec<f64>,
    in_ellipse: usize,
    lost_since_s: Option<f64>,
    position_lost_s: f64,
}

impl Accuracy {
    /// Adds the true position of a tick; returns the error, metres, if the estimate is known.
    pub(crate) fn truth(&mut self, tick: u64, position: Point) -> Option<f64> {
        self.truth = Some((tick, position));
        self.pair()
    }

    /// Adds the estimated position of a tick with its covariance, square metres; returns the error, metres, if the true
    /// position is known.
    pub(crate) fn estimate(&mut self, tick: u64, position: Point, covariance: Matrix2<f64>) -> Option<f64> {
        self.estimate = Some((tick, position, covariance));
        self.pair()
    }

    /// Marks the position as lost from now on.
    pub(crate) fn lost(&mut self, t_s: f64) {
        self.lost_since_s.get_or_insert(t_s);
    }

    /// Marks the position as recovered.
    pub(crate) fn regained(&mut self, t_s: f64) {
        self.position_lost_s += self.lost_since_s.take().map_or(0.0, |since_s| t_s - since_s);
    }

    fn pair(&mut self) -> Option<f64> {
        let ((tick, truth), (estimate_tick, position, covariance)) = (self.truth?, self.estimate?);
        if tick != estimate_tick {
            return None;
        }
        self.estimate = None;
        let error = truth - position;
        self.errors_m.push(error.norm());
        let (a, b, c) = (covariance[(0, 0)], covariance[(0, 1)], covariance[(1, 1)]);
        let determinant = a * c - b * b;
        // Squared Mahalanobis distance, multiplied by the determinant to avoid a division by zero.
        let scaled = c * error.x * error.x - 2.0 * b * error.x * error.y + a * error.y * error.y;
        self.in_ellipse += usize::from(scaled <= ELLIPSE_95 * determinant);
        Some(error.norm())
    }

    /// The figures of a run up to `now_s`; `None` if no tick had both truth and estimate.
    pub(crate) fn positioning(&self, now_s: f64) -> Option<Positioning> {
        let mut sorted = self.errors_m.clone();
        sorted.sort_by(f64::total_cmp);
        let n = sorted.len();
        let rank = |share: f64| nearest_rank(&sorted, share);
        Some(Positioning {
            mean_error_m: sorted.iter().sum::<f64>() / n as f64,
            p50_m: rank(0.5)?,
            p95_m: rank(0.95)?,
            max_m: *sorted.last()?,
            in_95_ellipse: self.in_ellipse as f64 / n as f64,
            position_lost_s: self.position_lost_s + self.lost_since_s.map_or(0.0, |since_s| now_s - since_s),
        })
    }
}
