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
    /// Whether the tool is on from here on; none if no row says it. Rows that contradict each other: it is off.
    pub tool_on: Option<bool>,
}

/// The moments of a file, and between them what is wrong with rows.
pub(crate) struct Moments {
    rows: Rows,
    columns: Columns,
    cells: StringRecord,
    /// The moment that is being put together, and the row that began it.
    open: Option<(Row, Moment)>,
    /// Rows read.
    pub count: u64,
}

impl Moments {
    pub(crate) fn new(rows: Rows, columns: Columns) -> Self {
        Self { rows, columns, cells: StringRecord::new(), open: None, count: 0 }
    }

    /// The next row, or what is wrong with it.
    fn row(&mut self) -> Option<Result<Row, Problem>> {
        let read = self.rows.next(&mut self.cells).transpose()?;
        self.count += 1;
        Some(read.and_then(|line| self.columns.row(&self.cells, line)))
    }

    /// Takes in a row; gives the moment that it ends, if it begins another.
    fn take(&mut self, row: Row) -> Result<Option<Moment>, Problem> {
        match &mut self.open {
            Some((first, moment)) if belongs(&row, first) => {
                moment.add(&row);
                return Ok(None);
            }
            Some((first, _)) if row.t_s < first.t_s => {
                let what = format!("{} s is earlier than the row before ({} s)", row.t_s, first.t_s);
                return Err(self.columns.wrong_time(row.line, what));
            }
            _ => {}
        }
        let moment = Moment::of(&row);
        Ok(self.open.replace((row, moment)).map(|(_, moment)| self.whole(moment)))
    }

    /// A moment of which nothing more comes.
    fn whole(&self, mut moment: Moment) -> Moment {
        if self.columns.kind() == Kind::Differences {
            moment.count_from_first();
        }
        moment
    }
}

/// A bad row in the middle of a moment comes before it and does not divide it.
impl Iterator for Moments {
    type Item = Result<Moment, Problem>;

    fn next(&mut self) -> Option<Self::Item> {
        while let Some(row) = self.row() {
            match row.and_then(|row| self.take(row)) {
                Ok(None) => {}
                Ok(Some(moment)) => return Some(Ok(moment)),
                Err(problem) => return Some(Err(problem)),
            }
        }
        self.open.take().map(|(_, moment)| Ok(self.whole(moment)))
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
    fn of(first: &Row) -> Self {
        let mut moment = Self {
            t_s: first.t_s,
            ranges: Vec::new(),
            odometry: Odometry::default(),
            truth: None,
            tool_on: None,
        };
        moment.add(first);
        moment
    }

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
        self.tool_on = match (self.tool_on, row.tool_on) {
            (Some(before), Some(now)) => Some(before && now),
            (before, now) => before.or(now),
        };
    }

    /// Counts ranges of which only the differences matter from the first arrival.
    fn count_from_first(&mut self) {
        let least_m = self.ranges.iter().flat_map(|set| &set.ranges_m).copied().fold(f64::INFINITY, f64::min);
        for range_m in self.ranges.iter_mut().flat_map(|set| &mut set.ranges_m) {
            *range_m += BASE_M - least_m;
        }
    }
}
