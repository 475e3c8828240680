//! Forecasts how well a layout of stations will locate a robot, place by place, before the mission starts.

pub mod adviser;
pub mod checks;

use crate::{
    fix::{Ranging, ellipse_95},
    noise::{RangeNoise, Timing},
    protection::Risk,
    quality::{NO_GEOMETRY, inverse_of},
    sides::mirrored,
};
use checks::Checks;
use nalgebra::{Matrix2, Vector2};
use serde::{Deserialize, Serialize};
use world::{ObstacleMap, Point, Station, World};

/// Least distance to a station that is used in the computation, metres: closer to the station, the direction is
/// undefined.
const NEAREST_M: f64 = 0.05;
/// The largest number of cells along the longer side of a map.
const MOST_CELLS: usize = 400;
/// Distance, metres, within which a ray counts as having reached a station: a station may be mounted on a column.
const REACHED_M: f64 = 1e-3;

/// The inputs of a forecast.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Forecast {
    /// The scatter of single ranges.
    pub noise: RangeNoise,
    /// The timing errors of ranges.
    #[serde(default)]
    pub timing: Timing,
    /// The number of ranges per station and cycle.
    pub repetitions: u32,
    /// Whether a station is unusable wherever an obstacle hides it from the robot.
    pub needs_line_of_sight: bool,
    /// Whether the time of emission is unknown, so that only the differences of ranges count.
    #[serde(default)]
    pub is_emission_unknown: bool,
    /// Edge length of a cell, metres.
    pub cell_m: f64,
}

/// The forecast for one place.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Accuracy {
    /// Longer semi-axis of the 95 % ellipse of a single fix, metres; `None` where the ranges alone give no fix.
    pub error_95_m: Option<f64>,
    /// Geometric dilution of precision; `None` where the ranges alone give no fix.
    pub gdop: Option<f64>,
    /// The number of stations heard.
    pub heard: u32,
    /// If the stations are nearly on a line: the mirror image of the place, metres, which has practically the same
    /// ranges.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mirror: Option<Point>,
    /// How well the stations check each other; absent without a fix, and in maps that do not contain it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub checks: Option<Checks>,
}

/// The forecast for every cell of the floor, row by row from the south-west corner.
///
/// The forecast is the Cramér-Rao bound for a single cycle with normal noise. Least squares reach this bound; filters
/// do better during a mission.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AccuracyMap {
    /// South-west corner of cell 0, metres.
    pub origin: Point,
    /// Edge length of a cell, metres.
    pub cell_m: f64,
    /// The number of cells from west to east.
    pub width: usize,
    /// The number of cells from south to north.
    pub height: usize,
    /// The forecast for each cell; `None` where there is no floor.
    pub cells: Vec<Option<Accuracy>>,
}

impl AccuracyMap {
    /// Computes the forecast for a tank as drawn. Casts one ray for each pair of cell and station.
    pub fn new(drawing: &World, forecast: &Forecast) -> Self {
        let grid = Grid::of(drawing, forecast.cell_m);
        let map = ObstacleMap::new(&drawing.boundary, &drawing.obstacles);
        let cells = (0..grid.width * grid.height)
            .map(|index| grid.center(index))
            .map(|at| (map.clearance_m(at) >= 0.0).then(|| forecast.at(at, &drawing.stations, &map)))
            .collect();
        Self { origin: grid.origin, cell_m: grid.cell_m, width: grid.width, height: grid.height, cells }
    }

    /// Adds to each cell how well the stations check each other there; see [`Forecast::checks_at`].
    #[must_use]
    pub fn with_checks(mut self, drawing: &World, forecast: &Forecast, risk: &Risk) -> Self {
        let map = ObstacleMap::new(&drawing.boundary, &drawing.obstacles);
        for index in 0..self.cells.len() {
            let at = self.center(index);
            if let Some(cell) = &mut self.cells[index] {
                cell.checks = forecast.checks_at(at, &drawing.stations, &map, risk);
            }
        }
        self
    }

    /// Returns the centre of a cell, metres.
    pub fn center(&self, index: usize) -> Point {
        let Self { origin, cell_m, width, height, .. } = *self;
        Grid { origin, cell_m, width, height }.center(index)
    }

    /// Returns the forecast for a place; `None` where there is no floor.
    pub fn at(&self, place: Point) -> Option<Accuracy> {
        let offset = (place - self.origin) / self.cell_m;
        let is_inside = offset.x >= 0.0 && offset.y >= 0.0 && offset.x < self.width as f64;
        let index = offset.y as usize * self.width + offset.x as usize;
        self.cells.get(index).copied().flatten().filter(|_| is_inside)
    }

    /// Iterates over the centres of the floor cells, with their forecasts.
    pub fn floor(&self) -> impl Iterator<Item = (Point, Accuracy)> + '_ {
        self.cells.iter().enumerate().filter_map(|(index, cell)| Some((self.center(index), (*cell)?)))
    }

    /// Returns the places where the error exceeds a limit or there is no fix, worst first.
    pub fn beyond(&self, limit_m: f64) -> Vec<(Point, Accuracy)> {
        let error_m = |cell: &Accuracy| cell.error_95_m.unwrap_or(f64::INFINITY);
        let mut places: Vec<_> = self.floor().filter(|(_, cell)| error_m(cell) > limit_m).collect();
        places.sort_by(|a, b| error_m(&b.1).total_cmp(&error_m(&a.1)));
        places
    }
}

impl Forecast {
    /// Computes the forecast for one place.
    pub fn at(&self, place: Point, stations: &[Station], map: &ObstacleMap) -> Accuracy {
        let heard =
            || stations.iter().filter(|s| !self.needs_line_of_sight || is_in_sight(map, place, s.position));
        let mut sum = Seen { is_emission_unknown: self.is_emission_unknown, ..Seen::default() };
        heard().for_each(|station| sum.add(&self.seen(place, station.position)));
        let covariance = sum.covariance();
        Accuracy {
            error_95_m: covariance.map(|covariance| ellipse_95(&covariance).0),
            gdop: covariance.and_then(|_| sum.gdop()),
            heard: sum.heard,
            mirror: covariance.and_then(|_| self.mirror(place, heard(), stations)),
            checks: None,
        }
    }

    fn mirror<'a>(
        &self,
        place: Point,
        heard: impl Iterator<Item = &'a Station>,
        stations: &[Station],
    ) -> Option<Point> {
        let expected = |station: &Station| {
            let range_m = (place - station.position).norm().max(NEAREST_M);
            Ranging::single(station.id, range_m, self.sigma_m(range_m))
        };
        mirrored(&heard.map(expected).collect::<Vec<_>>(), stations, place)
    }

    /// Returns the standard deviation of the aggregated range of one station in a cycle, metres.
    fn sigma_m(&self, distance_m: f64) -> f64 {
        let repetitions = f64::from(self.repetitions.max(1));
        let single_m = self.noise.sigma_ratio() * distance_m;
        let share_m = (single_m / repetitions.sqrt()).max(crate::aggregate::SIGMA_FLOOR_M);
        if self.timing.is_none() {
            return share_m;
        }
        share_m.hypot(self.timing.mean_sigma_m(single_m, repetitions))
    }

    /// Returns the information that one station provides at a place.
    fn seen(&self, place: Point, station: Point) -> Seen {
        let away = place - station;
        let distance_m = away.norm().max(NEAREST_M);
        let direction = away / distance_m;
        let square = direction * direction.transpose();
        let sigma_m = self.sigma_m(distance_m);
        Seen {
            heard: 1,
            geometry: square,
            information: square / sigma_m.powi(2),
            directions: direction,
            pull: direction / sigma_m.powi(2),
            weight: sigma_m.powi(-2),
            ..Seen::default()
        }
    }
}

/// The combined information that several stations provide at a place.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    heard: u32,
    /// Whether all ranges are too long by one unknown length.
    is_emission_unknown: bool,
    geometry: Matrix2<f64>,
    information: Matrix2<f64>,
    /// Sum of the directions, without and with their weights.
    directions: Vector2<f64>,
    pull: Vector2<f64>,
    weight: f64,
}

/// The least number of stations for an unambiguous fix.
fn needed(is_emission_unknown: bool) -> usize {
    3 + usize::from(is_emission_unknown)
}

impl Seen {
    fn add(&mut self, other: &Self) {
        self.heard += other.heard;
        self.geometry += other.geometry;
        self.information += other.information;
        self.directions += other.directions;
        self.pull += other.pull;
        self.weight += other.weight;
    }

    /// Returns the covariance of a fix; `None` for too few stations, which leave a mirror image.
    fn covariance(&self) -> Option<Matrix2<f64>> {
        let information = self.for_position(&self.information, &self.pull, self.weight);
        let needed = needed(self.is_emission_unknown);
        inverse_of(&information)
            .filter(|covariance| self.heard as usize >= needed && covariance.trace().is_finite())
    }

    /// Returns the information about the position alone: what is left after the unknown length that all ranges share is
    /// fitted, too (Schur complement).
    fn for_position(&self, all: &Matrix2<f64>, pull: &Vector2<f64>, weight: f64) -> Matrix2<f64> {
        if self.is_emission_unknown { all - pull * pull.transpose() / weight } else { *all }
    }

    fn gdop(&self) -> Option<f64> {
        let geometry = self.for_position(&self.geometry, &self.directions, f64::from(self.heard));
        Some(inverse_of(&geometry)?.trace().max(0.0).sqrt()).filter(|gdop| *gdop < NO_GEOMETRY)
    }
}

fn is_in_sight(map: &ObstacleMap, from: Point, to: Point) -> bool {
    let way = to - from;
    let distance_m = way.norm();
    distance_m <= REACHED_M
        || map.ray_m(from, way / distance_m, distance_m).is_none_or(|hit_m| hit_m >= distance_m - REACHED_M)
}

/// Square cells that cover the bounding box of a tank.
struct Grid {
    origin: Point,
    cell_m: f64,
    width: usize,
    height: usize,
}

impl Grid {
    /// Creates cells with this edge length, or a longer one if there would otherwise be too many cells.
    fn of(world: &World, cell_m: f64) -> Self {
        let (low, high) = world.boundary.bounds();
        let span = high - low;
        let least_m = span.amax() / MOST_CELLS as f64;
        // `max` also replaces NaN with the minimum.
        let cell_m = cell_m.max(least_m).max(1e-6);
        let count = |span_m: f64| ((span_m / cell_m).ceil().max(1.0) as usize).min(MOST_CELLS + 1);
        Self { origin: low, cell_m, width: count(span.x), height: count(span.y) }
    }

    fn center(&self, index: usize) -> Point {
        let (row, column) = (index / self.width, index % self.width);
        let middle = |k: usize| (k as f64 + 0.5) * self.cell_m;
        self.origin + world::Vector::new(middle(column), middle(row))
    }
}

#[cfg(test)]
mod tests;
