//! Joins ranges with the positions of their stations, and checks both once for all solvers.

use crate::{
    aggregate::{RANGE_LIMIT_M, is_usable},
    fix::{FixError, Ranging, share_sigma_m},
};
use nalgebra::Rotation2;
use std::f64::consts::TAU;
use world::{Point, Station, StationId, Vector};

/// Least distance to a station that is used in the computation, metres: closer to the station, the direction is
/// undefined.
const NEAREST_M: f64 = 1e-3;
/// Share of the longest range below which a range is short.
const SHORT_RANGE: f64 = 0.2;
/// The number of starts tried around a station that is close by.
const CIRCLE_STARTS: u32 = 36;

/// A range with the position of its station.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Anchor {
    pub station: StationId,
    pub at: Point,
    pub range_m: f64,
    pub sigma_m: f64,
    /// The part of `sigma_m` that is the same at every distance.
    pub timing_sigma_m: f64,
    /// The part of `sigma_m` that is a share of the distance, at `range_m`.
    share_sigma_m: f64,
}

/// A station as seen from a trial position.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View {
    /// Distance to the station, metres.
    pub distance_m: f64,
    /// Unit vector from the station.
    pub direction: Vector,
    /// Measured minus computed range, metres.
    pub residual_m: f64,
    /// Expected standard deviation of the residual, metres.
    pub sigma_m: f64,
    /// The increase in distance over which `sigma_m` would double at its present rate, metres.
    pub growth_m: f64,
}

impl View {
    /// Returns the residual in units of its sigma.
    pub(crate) fn sigmas(&self) -> f64 {
        self.residual_m / self.sigma_m
    }

    /// Returns the squared residual in units of its variance.
    pub(crate) fn squared_error(&self) -> f64 {
        (self.residual_m / self.sigma_m).powi(2)
    }
}

impl Anchor {
    pub(crate) fn new(
        station: StationId,
        at: Point,
        range_m: f64,
        sigma_m: f64,
        timing_sigma_m: f64,
    ) -> Self {
        let share_sigma_m = share_sigma_m(sigma_m, timing_sigma_m, 1.0);
        Self { station, at, range_m, sigma_m, timing_sigma_m, share_sigma_m }
    }

    /// Returns the station as seen from `position`.
    ///
    /// Except for timing errors, the scatter of a range is proportional to the true distance, so its sigma is scaled to
    /// the computed distance.
    pub(crate) fn view_from(&self, position: Point) -> View {
        let away = position - self.at;
        let distance_m = away.norm().max(NEAREST_M);
        let (sigma_m, growth_m) = if self.timing_sigma_m > 0.0 {
            let share_m = self.share_sigma_m * (distance_m / self.range_m);
            let variance = share_m * share_m + self.timing_sigma_m * self.timing_sigma_m;
            (variance.sqrt(), variance * distance_m / (share_m * share_m).max(1e-18))
        } else {
            (self.sigma_m * distance_m / self.range_m, distance_m)
        };
        let residual_m = self.range_m - distance_m;
        View { distance_m, direction: away / distance_m, residual_m, sigma_m, growth_m }
    }

    /// Returns the decrease of the residual, in units of its sigma, for each metre that the distance grows.
    pub(crate) fn steepness(&self, view: &View) -> f64 {
        if self.timing_sigma_m > 0.0 {
            1.0 / view.sigma_m + view.sigmas() / view.growth_m
        } else {
            // d/dl of (r - l) / (s l) is -r / (s l^2).
            self.range_m / (view.sigma_m * view.distance_m)
        }
    }

    /// Returns the range with the same error model at a different distance.
    pub(crate) fn at_range(&self, range_m: f64) -> Self {
        let sigma_m = if self.timing_sigma_m > 0.0 {
            (self.share_sigma_m * (range_m / self.range_m)).hypot(self.timing_sigma_m)
        } else {
            self.sigma_m / self.range_m * range_m
        };
        Self::new(self.station, self.at, range_m, sigma_m, self.timing_sigma_m)
    }
}

/// Joins the ranges with the positions of their stations, sorted by station.
pub(crate) fn anchored(ranges: &[Ranging], stations: &[Station]) -> Result<Vec<Anchor>, FixError> {
    let mut anchors = ranges.iter().map(|r| anchor(r, stations)).collect::<Result<Vec<_>, _>>()?;
    anchors.sort_by_key(|a| a.station);
    match anchors.windows(2).find(|pair| pair[0].station == pair[1].station) {
        Some(pair) => Err(FixError::DuplicateStation { station: pair[0].station }),
        None => Ok(anchors),
    }
}

fn anchor(ranging: &Ranging, stations: &[Station]) -> Result<Anchor, FixError> {
    let Ranging { station, range_m, sigma_m, timing_sigma_m, .. } = *ranging;
    if !is_usable(range_m) || !(1e-9..=RANGE_LIMIT_M).contains(&sigma_m) {
        return Err(FixError::BadRange { station });
    }
    let surveyed = stations.iter().find(|s| s.id == station && s.position.coords.amax() <= RANGE_LIMIT_M);
    let at = surveyed.ok_or(FixError::UnknownStation { station })?.position;
    // `amax` skips NaN.
    if at.coords.iter().any(|c| c.is_nan()) {
        return Err(FixError::UnknownStation { station });
    }
    Ok(Anchor::new(station, at, range_m, sigma_m, timing_sigma_m))
}

/// Returns places on the range circle of a station that is close by; none if there is no such station.
pub(crate) fn on_near_circle(anchors: &[Anchor]) -> impl Iterator<Item = Point> {
    let longest_m = anchors.iter().map(|a| a.range_m).fold(0.0, f64::max);
    let nearest = anchors.iter().min_by(|a, b| a.range_m.total_cmp(&b.range_m)).copied();
    nearest.filter(|n| n.range_m < SHORT_RANGE * longest_m).into_iter().flat_map(|nearest| {
        (0..CIRCLE_STARTS)
            .map(|k| Rotation2::new(TAU * f64::from(k) / f64::from(CIRCLE_STARTS)) * Vector::x())
            .map(move |direction| nearest.at + direction * nearest.range_m)
    })
}
