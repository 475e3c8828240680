//! Rows of one time or emission put together.

use crate::{
    columns::{Columns, Heard, Kind, Row},
    problem::Problem,
    rows::Rows,
};
use csv::StringRecord;
use world::{Odometry, Pose, RangeSet};

/// Differences of arrival times become ranges by adding this to the time since the first arrival, metres: a range is positive.
const BASE_M: f64 = 100.0;

/// What was measured at one time.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Moment {
    /// Time as in the file, seconds.
    pub t_s: f64,
    /// One set per station heard.
    pub ranges: Vec<RangeSet>,
    /// Motion since the moment before.
    pub odometry: Odometry,
    /// Where the robot truly was, if somebody knows.
    pub truth: Option<Pose>,
}

/// The moments of a file, and between them what is wrong with rows.
pub(crate) struct Moments {
    rows: Rows,
    columns: Columns,
    cells: StringRecord,
    /// The row that begins the next moment.
    next: Option<Row>,
    /// A problem found while a moment was put together.
    found: Option<Problem>,
    last_s: f64,
    /// Rows read.
    pub count: u64,
}

impl Moments {
    pub(crate) fn new(rows: Rows, columns: Columns) -> Self {
        Self {
            rows,
            columns,
            cells: StringRecord::new(),
            next: None,
            found: None,
            last_s: f64::NEG_INFINITY,
            count: 0,
        }
    }

    /// The next row that can be used; a problem is kept for the caller.
    fn row(&mut self) -> Option<Row> {
        let read = self.rows.next(&mut self.cells);
        let line = match read {
            Ok(line) => line?,
            Err(problem) => {
                self.count += 1;
                self.found = Some(problem);
                return None;
            }
        };
        self.count += 1;
        self.columns.row(&self.cells, line).map_err(|problem| self.found = Some(problem)).ok()
    }

    fn moment(&mut self, first: &Row) -> Moment {
        let mut moment =
            Moment { t_s: first.t_s, ranges: Vec::new(), odometry: Odometry::default(), truth: None };
        let mut row = first.clone();
        loop {
            moment.add(&row);
            match self.row() {
                Some(next) if belongs(&next, first) => row = next,
                other => {
                    self.next = other;
                    break;
                }
            }
        }
        if self.columns.kind() == Kind::Differences {
            moment.count_from_first();
        }
        moment
    }
}

impl Iterator for Moments {
    type Item = Result<Moment, Problem>;

    fn next(&mut self) -> Option<Self::Item> {
        if let Some(problem) = self.found.take() {
            return Some(Err(problem));
        }
        let Some(first) = self.next.take().or_else(|| self.row()) else {
            return self.found.take().map(Err);
        };
        if first.t_s < self.last_s {
            let what = format!("{} s is earlier than the row before ({} s)", first.t_s, self.last_s);
            return Some(Err(self.columns.wrong_time(first.line, what)));
        }
        self.last_s = first.t_s;
        Some(Ok(self.moment(&first)))
    }
}

/// Whether a row is of the moment that another began.
fn belongs(row: &Row, first: &Row) -> bool {
    match (&row.emission, &first.emission) {
        (Some(one), Some(other)) => one == other,
        _ => row.t_s.total_cmp(&first.t_s).is_eq(),
    }
}

impl Moment {
    fn add(&mut self, row: &Row) {
        if let Some(Heard { station, range_m, repetitions }) = row.range {
            let index = self.ranges.iter().position(|set| set.station == station);
            let index = index.unwrap_or_else(|| {
                self.ranges.push(RangeSet { station, ranges_m: Vec::new() });
                self.ranges.len() - 1
            });
            // A mean of so many counts as so many that are equal.
            self.ranges[index].ranges_m.extend((0..repetitions).map(|_| range_m));
        }
        if let Some(Odometry { forward_m, sideways_m, turn_rad }) = row.motion {
            self.odometry.forward_m += forward_m;
            self.odometry.sideways_m += sideways_m;
            self.odometry.turn_rad += turn_rad;
        }
        self.truth = row.truth.or(self.truth);
    }

    /// Counts ranges of which only the differences matter from the first arrival.
    fn count_from_first(&mut self) {
        let least_m = self.ranges.iter().flat_map(|set| &set.ranges_m).copied().fold(f64::INFINITY, f64::min);
        for range_m in self.ranges.iter_mut().flat_map(|set| &mut set.ranges_m) {
            *range_m += BASE_M - least_m;
        }
    }
}
