//! Forecasts how well the stations check each other: protection level, least detectable error, and whether a wrong
//! station can be told from a wrong speed of sound.
//!
//! Method: reliability theory (Baarda 1968). The position of every fix is free; what is left of a pattern of range
//! errors after the best position is fitted to it decides whether the pattern shows.

use super::{Forecast, Grid, NEAREST_M, adviser::along_wall, is_in_sight, needed};
use crate::{
    anchor::Anchor,
    protection::{Layout, Risk, other_side_m},
    quality::{LEAST_SPARED, alarm_limit, inverse_of, largest_sigma_m},
};
use nalgebra::{Matrix2, Vector2};
use serde::{Deserialize, Serialize};
use world::{ObstacleMap, Point, Station, StationId, World};

/// Standard normal quantile of the share of the cases in which the least detectable error is noticed: 80 %.
const POWER_Z: f64 = 0.841_621_234;
/// Number of standard deviations of the least error for which the calibration of a session names the station in 80 % of the
/// cases: the bias must exceed five of them, and must fit better by far than that of any other station. Measured with
/// `tankops-research reproduce detectable`.
pub(crate) const SESSION_SIGMAS: f64 = 6.3;
/// Upper bound of a least detectable error, in standard deviations, and the number of halvings of the interval below it.
const MOST_SIGMAS: f64 = 100.0;
const HALVINGS: u32 = 30;
/// Correlation above which two errors cannot be told apart.
pub const NOT_SEPARABLE: f64 = 0.95;
/// The number of fixes of the forecast session.
pub const SESSION_FIXES: usize = 60;
/// The number of cells along the longer side of the floor on which one more station is judged.
const COARSE_CELLS: f64 = 16.0;

/// How well the stations check each other at a place, with a single fix.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Checks {
    /// Usual protection level, metres; absent where a fix is not protected.
    pub level_m: Option<f64>,
    /// Least error of the worst station for which a single fix, with a known speed of sound, raises an alarm or leaves the
    /// station out in 80 % of the cases, metres; absent where an error never shows.
    pub detectable_m: Option<f64>,
    /// Largest correlation of an error of one station with an error of the speed of sound, 0 to 1.
    pub correlation: f64,
}

impl Checks {
    /// Whether a single fix can tell a wrong station from a wrong speed of sound.
    pub fn is_separable(&self) -> bool {
        self.correlation <= NOT_SEPARABLE
    }
}

/// How well the stations check each other over a session in which every error stays the same.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SessionChecks {
    /// The number of fixes.
    pub fixes: usize,
    /// The station whose error shows least; absent if that of one never shows.
    pub worst: Option<StationId>,
    /// Least error of the worst station for which the calibration names it within the session in 80 % of the cases, although
    /// the speed of sound is unknown, metres; absent if an error never shows.
    pub detectable_m: Option<f64>,
    /// Largest correlation of an error of one station with an error of the speed of sound, 0 to 1.
    pub correlation: f64,
    /// Whether the session can tell a wrong station from a wrong speed of sound.
    pub is_separable: bool,
}

/// The effect of one more station at its best place on the wall.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct OneMore {
    /// Place on the wall, metres.
    pub at: Point,
    /// Protection level that 95 % of the floor does not exceed, metres; absent if more than 5 % is not protected.
    pub p95_level_m: Option<f64>,
    /// Share of the floor where a single fix cannot tell a wrong station from a wrong speed of sound.
    pub not_separable_share: f64,
}

/// The ranges expected at a place.
struct Heard {
    place: Point,
    rows: Vec<Row>,
    /// The ranges without errors, in the order of the rows.
    anchors: Vec<Anchor>,
    covariance: Matrix2<f64>,
    /// Variance of the length that all ranges share, at the best position: 0 if the time of emission is known, square
    /// metres.
    shared: f64,
    /// The least number of stations for a protection level.
    protected_from: usize,
}

/// A range. If the time of emission is unknown, direction and distance are relative to their weighted means, because only
/// differences show.
struct Row {
    station: StationId,
    direction: Vector2<f64>,
    distance_m: f64,
    weight: f64,
}

impl Heard {
    /// `None` where the ranges give no unambiguous fix.
    fn at(forecast: &Forecast, place: Point, stations: &[Station], map: &ObstacleMap) -> Option<Self> {
        let heard =
            stations.iter().filter(|s| !forecast.needs_line_of_sight || is_in_sight(map, place, s.position));
        let mut rows: Vec<Row> = heard
            .map(|station| {
                let away = place - station.position;
                let distance_m = away.norm().max(NEAREST_M);
                let weight = forecast.sigma_m(distance_m).powi(-2);
                Row { station: station.id, direction: away / distance_m, distance_m, weight }
            })
            .collect();
        let anchor = |row: &Row| {
            let (at, sigma_m) = (place - row.direction * row.distance_m, row.weight.sqrt().recip());
            Anchor::new(row.station, at, row.distance_m, sigma_m, sigma_m)
        };
        let anchors = rows.iter().map(anchor).collect();
        let shared = if forecast.is_emission_unknown { centred(&mut rows) } else { 0.0 };
        let information: Matrix2<f64> =
            rows.iter().map(|row| row.direction * row.direction.transpose() * row.weight).sum();
        let needed = needed(forecast.is_emission_unknown);
        let covariance = inverse_of(&information).filter(|_| rows.len() >= needed)?;
        Some(Self { place, rows, anchors, covariance, shared, protected_from: needed + 1 })
    }

    /// Number of standard deviations of the least error that raises the alarm of a fix in 80 % of the cases: the
    /// non-centrality of its chi-squared test (Baarda 1968), by the cube formula of Abdel-Aty 1954.
    fn detected_sigmas(&self) -> f64 {
        let unknowns = 2 + usize::from(self.shared > 0.0);
        let k = u32::try_from(self.rows.len().saturating_sub(unknowns)).unwrap_or(u32::MAX).max(1);
        let (limit, k) = (alarm_limit(k), f64::from(k));
        let is_noticed = |sigmas: f64| {
            let mean = k + sigmas * sigmas;
            let spread = 2.0 * (mean + sigmas * sigmas) / (9.0 * mean * mean);
            (limit / mean).cbrt() - (1.0 - spread) <= -POWER_Z * spread.sqrt()
        };
        let (mut low, mut high) = (0.0, MOST_SIGMAS);
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(low, high);
            (low, high) = if is_noticed(middle) { (low, middle) } else { (middle, high) };
        }
        high
    }

    /// Information about the size of a wrong station's error, about the scale of all ranges, and about both together.
    fn patterns(&self) -> Patterns {
        let pull: Vector2<f64> = self.rows.iter().map(|r| r.direction * (r.weight * r.distance_m)).sum();
        let whole: f64 = self.rows.iter().map(|r| r.weight * r.distance_m * r.distance_m).sum();
        let of = |row: &Row| {
            let own = row.direction * row.weight;
            let alone = row.weight - own.dot(&(self.covariance * own)) - row.weight.powi(2) * self.shared;
            let both = row.weight * row.distance_m - own.dot(&(self.covariance * pull));
            let alone = if alone > LEAST_SPARED * row.weight { alone } else { 0.0 };
            (row.station, Pattern { alone, both })
        };
        Patterns {
            scale: (whole - pull.dot(&(self.covariance * pull))).max(0.0),
            stations: self.rows.iter().map(of).collect(),
        }
    }

    /// The usual protection level of a fix, metres: with the deviation of one standard deviation between the fix and the
    /// position without a station.
    fn level_m(&self, risk: &Risk) -> Option<f64> {
        let multipliers =
            risk.multipliers(self.rows.len(), false).filter(|_| self.rows.len() >= self.protected_from)?;
        let mut level_m = multipliers.fault_free * largest_sigma_m(&self.covariance);
        let layout =
            Layout::of(self.anchors.iter().zip(&self.rows).map(|(anchor, row)| (anchor.at, row.weight)));
        if layout.is_flat(None) {
            level_m += self.other_side_m(None, multipliers.fault_free)?;
        }
        for (index, row) in self.rows.iter().enumerate() {
            let pull = self.covariance * row.direction;
            let spared = 1.0 / row.weight - row.direction.dot(&pull) - self.shared;
            if spared <= LEAST_SPARED / row.weight {
                return None;
            }
            let without = self.covariance + pull * pull.transpose() / spared;
            let other_side_m = if layout.is_flat(Some((self.anchors[index].at, row.weight))) {
                self.other_side_m(Some(index), multipliers.one_fault)?
            } else {
                0.0
            };
            let apart_m = (pull.norm() / spared.sqrt()).max(other_side_m);
            level_m = level_m.max(apart_m + multipliers.one_fault * largest_sigma_m(&without));
        }
        Some(level_m).filter(|level_m| level_m.is_finite())
    }

    /// Returns the distance to the mirror image that the ranges allow, without one station if one is given, metres; 0 if they
    /// exclude it.
    fn other_side_m(&self, left_out: Option<usize>, sigmas: f64) -> Option<f64> {
        let others = self.anchors.iter().enumerate().filter(|(index, _)| Some(*index) != left_out);
        let others: Vec<Anchor> = others.map(|(_, anchor)| *anchor).collect();
        other_side_m(&others, self.place, self.shared > 0.0, sigmas * sigmas)
    }
}

/// Makes directions and distances relative to their weighted means; returns the variance of the length that all ranges
/// share, square metres.
fn centred(rows: &mut [Row]) -> f64 {
    let weight: f64 = rows.iter().map(|row| row.weight).sum();
    let direction = rows.iter().map(|row| row.direction * row.weight).sum::<Vector2<f64>>() / weight;
    let distance_m = rows.iter().map(|row| row.distance_m * row.weight).sum::<f64>() / weight;
    for row in rows {
        row.direction -= direction;
        row.distance_m -= distance_m;
    }
    1.0 / weight
}

/// The information that fixes contain about patterns of range errors.
struct Patterns {
    /// About the scale of all ranges.
    scale: f64,
    stations: Vec<(StationId, Pattern)>,
}

#[derive(Clone, Copy)]
struct Pattern {
    /// About the length by which the ranges of the station are too long.
    alone: f64,
    /// Its product with the scale.
    both: f64,
}

impl Patterns {
    /// The largest correlation of a station's error with the scale.
    fn correlation(&self) -> f64 {
        let of = |pattern: &Pattern| {
            let both = (pattern.alone * self.scale).sqrt();
            // Without any information about one of the two, they cannot be told apart.
            if both > 0.0 { (pattern.both.abs() / both).min(1.0) } else { 1.0 }
        };
        self.stations.iter().map(|(_, pattern)| of(pattern)).fold(0.0, f64::max)
    }

    /// The error of the worst station that is this number of standard deviations, metres; `None` if it never shows.
    fn detectable_m(&self, sigmas: f64) -> Option<f64> {
        self.worst(false).map(|(_, sigma_m)| sigmas * sigma_m)
    }

    /// The station whose error shows least, and the standard deviation with which this error is known, metres; `None` if it
    /// never shows.
    fn worst(&self, is_scale_free: bool) -> Option<(StationId, f64)> {
        let information = |pattern: &Pattern| {
            let shared =
                if is_scale_free && self.scale > 0.0 { pattern.both.powi(2) / self.scale } else { 0.0 };
            pattern.alone - shared
        };
        let of = |(station, pattern): &(StationId, Pattern)| (*station, information(pattern));
        let (station, least) = self.stations.iter().map(of).min_by(|a, b| a.1.total_cmp(&b.1))?;
        (least > 0.0 && least.is_finite()).then(|| (station, 1.0 / least.sqrt()))
    }

    fn add(&mut self, other: &Self) {
        self.scale += other.scale;
        for (station, pattern) in &other.stations {
            match self.stations.iter_mut().find(|(own, _)| own == station) {
                Some((_, own)) => {
                    (own.alone, own.both) = (own.alone + pattern.alone, own.both + pattern.both);
                }
                None => self.stations.push((*station, *pattern)),
            }
        }
    }
}

impl Forecast {
    /// Forecasts how well the stations check each other at a place; `None` where the ranges alone give no fix.
    ///
    /// ```
    /// use positioning::{Forecast, RangeNoise, Risk, Timing};
    /// use world::{Boundary, ObstacleMap, Point, Station, StationId};
    /// let map = ObstacleMap::new(&Boundary::Circle { radius_m: 10.0 }, &[]);
    /// let forecast = Forecast {
    ///     noise: RangeNoise::Gaussian { sigma_ratio: 0.01 },
    ///     timing: Timing::default(),
    ///     repetitions: 1,
    ///     needs_line_of_sight: false,
    ///     is_emission_unknown: false,
    ///     cell_m: 0.5,
    /// };
    /// let ring = |n: u32| -> Vec<Station> {
    ///     let angle = |k: u32| f64::from(k) * std::f64::consts::TAU / f64::from(n);
    ///     let at = |k: u32| Point::new(10.0 * angle(k).cos(), 10.0 * angle(k).sin());
    ///     (0..n).map(|k| Station { id: StationId(k), name: String::new(), position: at(k) }).collect()
    /// };
    /// let at = |n| forecast.checks_at(Point::new(3.0, 1.0), &ring(n), &map, &Risk::default()).unwrap();
    /// // More stations: a lower level.
    /// assert!(at(8).level_m < at(5).level_m && at(8).detectable_m.is_some());
    /// // Three stations have one redundant range, which cannot tell a wrong station from a wrong speed of sound.
    /// assert!(at(3).level_m.is_none() && !at(3).is_separable());
    /// ```
    pub fn checks_at(
        &self,
        place: Point,
        stations: &[Station],
        map: &ObstacleMap,
        risk: &Risk,
    ) -> Option<Checks> {
        let heard = Heard::at(self, place, stations, map)?;
        let patterns = heard.patterns();
        Some(Checks {
            level_m: heard.level_m(risk),
            detectable_m: patterns.detectable_m(heard.detected_sigmas()),
            correlation: patterns.correlation(),
        })
    }

    /// Forecasts how well the stations check each other over a session: fixes evenly chosen from `places`. `None` if no
    /// place gives a fix.
    pub fn session_checks(
        &self,
        places: &[Point],
        stations: &[Station],
        map: &ObstacleMap,
    ) -> Option<SessionChecks> {
        let n = SESSION_FIXES.min(places.len());
        let chosen = (0..n).map(|k| places[k * places.len() / n]);
        let mut all = Patterns { scale: 0.0, stations: Vec::new() };
        let mut fixes = 0;
        for heard in chosen.filter_map(|place| Heard::at(self, place, stations, map)) {
            all.add(&heard.patterns());
            fixes += 1;
        }
        let correlation = all.correlation();
        let worst = all.worst(true);
        (fixes > 0).then(|| SessionChecks {
            fixes,
            worst: worst.map(|(station, _)| station),
            detectable_m: worst.map(|(_, sigma_m)| SESSION_SIGMAS * sigma_m),
            correlation,
            is_separable: correlation <= NOT_SEPARABLE,
        })
    }

    /// Finds the best place on the wall for one more station: the one with the lowest protection level over the floor.
    /// `None` if no place protects any floor.
    pub fn one_more(&self, drawing: &World, risk: &Risk) -> Option<OneMore> {
        let (low, high) = drawing.boundary.bounds();
        let grid = Grid::of(drawing, (high - low).amax() / COARSE_CELLS);
        let map = ObstacleMap::new(&drawing.boundary, &drawing.obstacles);
        let places: Vec<Point> = (0..grid.width * grid.height)
            .map(|index| grid.center(index))
            .filter(|at| map.clearance_m(*at) >= 0.0)
            .collect();
        let id = StationId(drawing.stations.iter().map(|s| s.id.0).max().unwrap_or(0).saturating_add(1));
        let with = |at: Point| {
            let new = Station { id, name: String::new(), position: at };
            let stations: Vec<Station> = drawing.stations.iter().cloned().chain([new]).collect();
            let checks: Vec<Checks> =
                places.iter().filter_map(|place| self.checks_at(*place, &stations, &map, risk)).collect();
            Floor::new(&checks, places.len())
        };
        let found = along_wall(&drawing.boundary).into_iter().map(|at| (at, with(at)));
        let (at, floor) = found.min_by(|a, b| a.1.cost().total_cmp(&b.1.cost()))?;
        floor.cost().is_finite().then_some(OneMore {
            at,
            p95_level_m: floor.p95_level_m(),
            not_separable_share: floor.not_separable_share,
        })
    }
}

/// The checks over a floor.
pub struct Floor {
    /// The levels of the protected places, metres, in order.
    levels_m: Vec<f64>,
    n_places: usize,
    /// Share of the floor where a single fix cannot tell a wrong station from a wrong speed of sound.
    pub not_separable_share: f64,
}

impl Floor {
    /// Collects the checks of a number of places; places without a fix have none.
    pub fn new(checks: &[Checks], n_places: usize) -> Self {
        let mut levels_m: Vec<f64> = checks.iter().filter_map(|checks| checks.level_m).collect();
        levels_m.sort_by(f64::total_cmp);
        let separable = checks.iter().filter(|checks| checks.is_separable()).count();
        let not_separable_share = 1.0 - separable as f64 / n_places.max(1) as f64;
        Self { levels_m, n_places, not_separable_share }
    }

    /// Share of the floor where a fix is not protected.
    pub fn unprotected_share(&self) -> f64 {
        1.0 - self.levels_m.len() as f64 / self.n_places.max(1) as f64
    }

    /// Protection level in the middle of all places, metres; `None` if half of the floor is not protected.
    pub fn median_level_m(&self) -> Option<f64> {
        self.levels_m.get(self.n_places / 2).copied()
    }

    /// Protection level that 95 % of the floor does not exceed, metres; `None` if more than 5 % is not protected.
    pub fn p95_level_m(&self) -> Option<f64> {
        self.levels_m.get(self.n_places * 95 / 100).copied()
    }

    /// The mean level, where an unprotected place counts as twice the largest level; infinity if no place is protected.
    fn cost(&self) -> f64 {
        let Some(largest_m) = self.levels_m.last() else { return f64::INFINITY };
        let blind = (self.n_places - self.levels_m.len()) as f64;
        (self.levels_m.iter().sum::<f64>() + blind * 2.0 * largest_m) / self.n_places as f64
    }
}

#[cfg(test)]
mod tests;
