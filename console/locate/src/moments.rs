//! Groups rows by time or emission.

use crate::{
    clock::{self, Written},
    columns::{Columns, Heard, Kind, Row, Sent},
    problem::Problem,
    rows::Rows,
};
use csv::StringRecord;
use positioning::{Impossible, Possible};
use world::{Odometry, Pose, RangeSet};

/// The length added to each arrival difference to make it a range, metres: ranges must be positive.
const BASE_M: f64 = 100.0;

/// The longest time that a file may cover, seconds: a year.
const LONGEST_S: f64 = 366.0 * 86_400.0;
/// The latest time of a file, and the earliest one below zero, seconds.
const LATEST_S: f64 = 1e11;

/// Time, seconds: if the time of day goes back by more than this, midnight has passed.
const HALF_A_DAY_S: f64 = 43_200.0;

/// All measurements of one time or emission.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Moment {
    /// Time as in the file, seconds.
    pub t_s: f64,
    /// One set for each station heard.
    pub ranges: Vec<RangeSet>,
    /// The possible readings behind `ranges`, row by row.
    pub heard: Vec<Heard>,
    /// The pulses of stations.
    pub pulses: Vec<Sent>,
    /// Motion since the previous moment, if measured.
    pub odometry: Option<Odometry>,
    /// The true pose of the robot, if known.
    pub truth: Option<Pose>,
    /// Whether the tool is on from this moment on; `None` if no row states it. If rows contradict each other, the tool
    /// counts as off.
    pub tool_on: Option<bool>,
    /// The form in which the time is written.
    pub written: Written,
}

/// Iterates over the moments of a file, and over the problems with rows between them.
pub(crate) struct Moments {
    rows: Rows,
    columns: Columns,
    cells: StringRecord,
    /// The moment being collected, and its first row.
    open: Option<(Row, Moment)>,
    /// The bounds of possible arrival differences in the tank.
    possible: Possible,
    first: Option<Place>,
    last: Option<Place>,
    back: Option<Back>,
    /// A row that is held back until the out-of-order rows before it have been reported.
    waiting: Option<Row>,
    /// The number of out-of-order rows, not counting the first of each stretch.
    pub left_behind: u64,
    /// The number of rows read.
    pub count: u64,
}

/// A time and its line.
#[derive(Debug, Clone, Copy)]
struct Place {
    line: u64,
    t_s: f64,
}

/// A stretch of rows with times earlier than that of the row before the stretch.
#[derive(Debug, Clone, Copy)]
struct Back {
    first: Place,
    before: Place,
    last_line: u64,
    rows: u64,
}

impl Moments {
    pub(crate) fn new(rows: Rows, columns: Columns, possible: Possible) -> Self {
        let cells = StringRecord::new();
        Self {
            rows,
            columns,
            cells,
            open: None,
            possible,
            first: None,
            last: None,
            back: None,
            waiting: None,
            left_behind: 0,
            count: 0,
        }
    }

    /// Returns the next row, or the problem with it.
    fn row(&mut self) -> Option<Result<Row, Problem>> {
        if let Some(row) = self.waiting.take() {
            return Some(Ok(row));
        }
        let read = self.rows.next(&mut self.cells).transpose()?;
        self.count += 1;
        Some(read.and_then(|line| self.columns.row(&self.cells, line)).and_then(|row| self.timely(row)))
    }

    /// Returns a row whose time is possible: an absurd one would make the recording endless.
    fn timely(&mut self, row: Row) -> Result<Row, Problem> {
        let first = *self.first.get_or_insert(Place { line: row.line, t_s: row.t_s });
        if row.t_s.abs() > LATEST_S {
            self.first = self.first.filter(|first| first.line != row.line);
            let what = format!("{:e} s is not a possible time; check its unit", row.t_s);
            return Err(self.columns.wrong_time(row.line, what));
        }
        if row.t_s - first.t_s > LONGEST_S {
            let what = format!(
                "{} is {:.0} days after the first time, {} in line {}, but a file covers at most 366 days; check the \
                 unit of the times, or divide the file",
                row.written.shown(row.t_s),
                (row.t_s - first.t_s) / 86_400.0,
                row.written.shown(first.t_s),
                first.line
            );
            return Err(self.columns.wrong_time(row.line, what));
        }
        Ok(row)
    }

    /// Adds a row. Returns the previous moment if the row begins a new one.
    fn take(&mut self, row: Row) -> Result<Option<Moment>, Problem> {
        let place = Place { line: row.line, t_s: row.t_s };
        match &mut self.open {
            Some((first, moment)) if belongs(&row, first) && self.back.is_none() => {
                moment.add(&row);
                self.last = Some(place);
                return Ok(None);
            }
            Some((first, _)) if row.t_s < first.t_s => {
                self.went_back(place);
                return Ok(None);
            }
            _ => {}
        }
        if let Some(back) = self.back.take() {
            self.waiting = Some(row);
            return Err(self.told(&back));
        }
        self.last = Some(place);
        let moment = Moment::of(&row);
        Ok(self.open.replace((row, moment)).map(|(_, moment)| self.whole(moment)))
    }

    /// Counts an out-of-order row; only the first row of a stretch is reported.
    fn went_back(&mut self, place: Place) {
        if let Some(back) = &mut self.back {
            (back.last_line, back.rows) = (place.line, back.rows + 1);
        } else {
            let before = self.last.unwrap_or(place);
            self.back = Some(Back { first: place, before, last_line: place.line, rows: 1 });
        }
    }

    fn told(&mut self, back: &Back) -> Problem {
        let Back { first, before, last_line, rows } = *back;
        self.left_behind += rows - 1;
        let written = self.open.as_ref().map_or(Written::Number, |(row, _)| row.written);
        let (earlier, later) = (written.shown(first.t_s), written.shown(before.t_s));
        if written == Written::OfDay && before.t_s - first.t_s > HALF_A_DAY_S {
            let what = format!(
                "{earlier} comes after {later} in line {}: the time of day passes midnight here; \
                 write times with their dates, such as {}",
                before.line,
                clock::EXAMPLE
            );
            return self.columns.wrong_time(first.line, what);
        }
        let until = match rows {
            1 => String::new(),
            _ => format!("; all {rows} rows up to line {last_line} are too early"),
        };
        let what = format!(
            "time goes backwards: {earlier} follows {later} in line {}{until}; sort the rows by time",
            before.line
        );
        self.columns.wrong_time(first.line, what)
    }

    /// Finishes a moment after its last row.
    fn whole(&self, mut moment: Moment) -> Moment {
        let (_, impossible) = match self.columns.kind() {
            Kind::Ranges => self.possible.ranges(&moment.ranges),
            Kind::Differences => self.possible.differences(&moment.ranges, &[]),
        };
        moment.heard.retain(|heard| {
            let is_it = |one: &Impossible| {
                one.station == heard.station && one.range_m.total_cmp(&heard.range_m).is_eq()
            };
            !impossible.iter().any(is_it)
        });
        if self.columns.kind() == Kind::Differences {
            moment.count_from_first();
        }
        moment
    }
}

/// A bad row within a moment is returned before that moment and does not split it.
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
        if let Some(back) = self.back.take() {
            return Some(Err(self.told(&back)));
        }
        self.open.take().map(|(_, moment)| Ok(self.whole(moment)))
    }
}

/// Whether a row belongs to the moment that `first` began.
fn belongs(row: &Row, first: &Row) -> bool {
    match (&row.emission, &first.emission) {
        (Some(one), Some(other)) => one == other,
        _ => row.t_s.total_cmp(&first.t_s).is_eq(),
    }
}

impl Moment {
    /// Whether the moment only tests the stations, and says nothing about the robot.
    pub(crate) fn is_test(&self) -> bool {
        !self.pulses.is_empty()
            && self.ranges.is_empty()
            && self.odometry.is_none()
            && self.truth.is_none()
            && self.tool_on.is_none()
    }

    fn of(first: &Row) -> Self {
        let mut moment = Self {
            t_s: first.t_s,
            ranges: Vec::new(),
            heard: Vec::new(),
            pulses: Vec::new(),
            odometry: None,
            truth: None,
            written: first.written,
            tool_on: None,
        };
        moment.add(first);
        moment
    }

    fn add(&mut self, row: &Row) {
        self.heard.extend(row.range);
        self.pulses.extend(row.pulse);
        if let Some(Heard { station, range_m, repetitions }) = row.range {
            let index = self.ranges.iter().position(|set| set.station == station);
            let index = index.unwrap_or_else(|| {
                self.ranges.push(RangeSet { station, ranges_m: Vec::new() });
                self.ranges.len() - 1
            });
            // A mean of N repetitions counts as N equal readings.
            self.ranges[index].ranges_m.extend((0..repetitions).map(|_| range_m));
        }
        if let Some(Odometry { forward_m, sideways_m, turn_rad }) = row.motion {
            let sum = self.odometry.get_or_insert_default();
            sum.forward_m += forward_m;
            sum.sideways_m += sideways_m;
            sum.turn_rad += turn_rad;
        }
        self.truth = row.truth.or(self.truth);
        self.tool_on = match (self.tool_on, row.tool_on) {
            (Some(before), Some(now)) => Some(before && now),
            (before, now) => before.or(now),
        };
    }

    /// Makes ranges relative to the first possible arrival; only their differences matter.
    fn count_from_first(&mut self) {
        let least_m = self.heard.iter().map(|heard| heard.range_m).fold(f64::INFINITY, f64::min);
        let heard = self.heard.iter_mut().map(|heard| &mut heard.range_m);
        for range_m in self.ranges.iter_mut().flat_map(|set| &mut set.ranges_m).chain(heard) {
            *range_m += BASE_M - least_m;
        }
    }
}
