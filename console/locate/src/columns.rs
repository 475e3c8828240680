//! The columns of a file of readings, and how a row of cells is interpreted.

use crate::{
    clock::{self, Written},
    problem::Problem,
};
use csv::StringRecord;
use positioning::longest_pulse_m;
use report::document::csv::cell;
use std::collections::HashMap;
use world::{Odometry, Point, Pose, Station, StationId};

/// A quantity, with the suffixes for its units. Each suffix has its factor for conversion to seconds, metres or
/// radians.
type Column = (&'static str, &'static [(&'static str, f64)]);

const TIME: &[(&str, f64)] = &[("_s", 1.0), ("_ms", 1e-3), ("_us", 1e-6)];
const TIME_OR_DATE: &[(&str, f64)] = &[("_s", 1.0), ("_ms", 1e-3), ("_us", 1e-6), ("", DATED)];
/// The factor for a time of day or a date, which has no unit.
const DATED: f64 = 0.0;
const LENGTH: &[(&str, f64)] = &[("_m", 1.0), ("_mm", 1e-3)];
const ANGLE: &[(&str, f64)] = &[("_rad", 1.0), ("_deg", std::f64::consts::PI / 180.0)];
const NAME: &[(&str, f64)] = &[("", 1.0)];

const T: usize = 0;
const EMISSION: usize = 1;
const STATION: usize = 2;
const RANGE: usize = 3;
const ARRIVAL: usize = 4;
const EMITTED: usize = 5;
const DIFFERENCE: usize = 6;
const REPETITIONS: usize = 7;
const FORWARD: usize = 8;
const SIDEWAYS: usize = 9;
const TURN: usize = 10;
const TRUE_X: usize = 11;
const TRUE_Y: usize = 12;
const TRUE_HEADING: usize = 13;
const TOOL_ON: usize = 14;
const SENDER: usize = 15;

const COLUMNS: [Column; 16] = [
    ("t", TIME_OR_DATE),
    ("emission", NAME),
    ("station", NAME),
    ("range", LENGTH),
    ("arrival", TIME),
    ("emitted", TIME),
    ("tdoa", TIME),
    ("repetitions", NAME),
    ("forward", LENGTH),
    ("sideways", LENGTH),
    ("turn", ANGLE),
    ("true_x", LENGTH),
    ("true_y", LENGTH),
    ("true_heading", ANGLE),
    ("tool_on", NAME),
    ("sender", NAME),
];

/// The largest number of repetitions that one mean may stand for.
const REPETITIONS_MAX: u32 = 1000;

/// The kind of readings in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Distances, or times of flight.
    Ranges,
    /// Arrival times without the emission time, or differences between arrival times: only differences count.
    Differences,
}

/// The positions of the columns in a file.
#[derive(Debug, Clone)]
pub(crate) struct Columns {
    names: Vec<String>,
    /// The position of each of [`COLUMNS`], and its factor.
    at: [Option<(usize, f64)>; COLUMNS.len()],
    /// Speed of sound, metres per second; used for files that contain times instead of distances.
    sound_speed_m_s: f64,
    stations: HashMap<String, StationId>,
    station_names: String,
    /// The surveyed places of the stations, metres.
    places: Vec<(StationId, Point)>,
    /// Whether numbers have a decimal comma.
    pub has_commas: bool,
}

/// The contents of a row.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    pub line: u64,
    pub t_s: f64,
    /// The form in which the time was written.
    pub written: Written,
    /// The emission that the row belongs to.
    pub emission: Option<String>,
    pub range: Option<Heard>,
    /// The pulse of a station that another station heard.
    pub pulse: Option<Sent>,
    pub motion: Option<Odometry>,
    pub truth: Option<Pose>,
    /// Whether the tool is on from this row on; `None` if the row does not state it.
    pub tool_on: Option<bool>,
}

/// A reading of one station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Heard {
    pub station: StationId,
    /// The range, metres. If only differences count, the range is off by an unknown length that all readings share, and
    /// may be negative.
    pub range_m: f64,
    pub repetitions: u32,
}

/// A pulse of a station, as another station heard it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sent {
    pub sender: StationId,
    pub heard: Heard,
}

impl Columns {
    /// Finds the columns that the first line names.
    pub(crate) fn new(
        header: &StringRecord,
        stations: &[Station],
        sound_speed_m_s: Option<f64>,
    ) -> Result<Self, String> {
        let names: Vec<String> = header.iter().map(str::to_owned).collect();
        let mut at = [None; COLUMNS.len()];
        for (index, name) in names.iter().enumerate() {
            let Some((column, factor)) = known(name) else { continue };
            match at[column] {
                // A column with a unit takes precedence over a date column.
                Some((_, present)) if factor <= DATED && present > DATED => {}
                Some((_, present)) if present > DATED || factor <= DATED => {
                    return Err(format!(
                        "column {name}: there is already a column for {}",
                        COLUMNS[column].0
                    ));
                }
                _ => at[column] = Some((index, factor)),
            }
        }
        let is_there = |column: usize| at[column].is_some();
        let measured = [RANGE, ARRIVAL, DIFFERENCE].into_iter().filter(|column| is_there(*column)).count();
        let has_time = is_there(T) || (is_there(ARRIVAL) && is_there(EMISSION));
        let wrong = if !is_there(STATION) {
            Some("column `station` is missing")
        } else if measured == 0 {
            Some("no measurement column: add range_m, arrival_s or tdoa_s (also in mm, ms and us)")
        } else if measured > 1 {
            Some("more than one measurement column; keep only one of range, arrival and tdoa")
        } else if !has_time {
            Some(
                "no time column: add t_s, t_ms, t_us or `time` with dates, or both `arrival_s` and `emission`",
            )
        } else if !is_there(RANGE) && sound_speed_m_s.is_none() {
            Some("times need the speed of sound; add --sound-speed in metres per second")
        } else if is_there(TRUE_X) != is_there(TRUE_Y) {
            Some("true_x and true_y must be given together")
        } else {
            None
        };
        if let Some(wrong) = wrong {
            return Err(format!("{wrong}; columns found: {}", names.join(", ")));
        }
        let by_number = stations.iter().map(|station| (station.id.0.to_string(), station.id));
        let by_name = stations.iter().map(|station| (station.name.clone(), station.id));
        // The names as they are written in a table.
        let by_cell = stations.iter().map(|station| (cell(&station.name), station.id));
        Ok(Self {
            names,
            at,
            sound_speed_m_s: sound_speed_m_s.unwrap_or(1.0),
            stations: by_number.chain(by_cell).chain(by_name).collect(),
            station_names: stations.iter().map(|s| s.name.as_str()).collect::<Vec<_>>().join(", "),
            places: stations.iter().map(|station| (station.id, station.position)).collect(),
            has_commas: false,
        })
    }

    /// Returns the kind of the readings.
    pub(crate) fn kind(&self) -> Kind {
        let is_known = self.has(RANGE) || (self.has(ARRIVAL) && self.has(EMITTED));
        if is_known { Kind::Ranges } else { Kind::Differences }
    }

    /// Iterates over the columns that are not used.
    pub(crate) fn ignored(&self) -> impl Iterator<Item = &str> {
        let is_used = |index: usize| self.at.iter().flatten().any(|(used, _)| *used == index);
        self.names
            .iter()
            .enumerate()
            .filter(move |(index, _)| !is_used(*index))
            .map(|(_, name)| name.as_str())
    }

    /// Whether the motion between readings was measured.
    pub(crate) fn has_motion(&self) -> bool {
        self.has(FORWARD) || self.has(SIDEWAYS)
    }

    fn has(&self, column: usize) -> bool {
        self.at[column].is_some()
    }

    /// Reads a row of cells.
    pub(crate) fn row(&self, cells: &StringRecord, line: u64) -> Result<Row, Problem> {
        let number = |column| self.number(cells, line, column);
        let (arrival_s, emitted_s) = (number(ARRIVAL)?, number(EMITTED)?);
        let t_s = match (number(T)?, arrival_s) {
            (Some(t_s), _) => t_s,
            (None, Some(arrival_s)) if !self.has(T) => arrival_s,
            _ => return Err(self.problem(line, T, "empty; every row needs a time".into())),
        };
        let is_known = self.kind() == Kind::Ranges;
        let time_s = match (arrival_s, number(DIFFERENCE)?) {
            (Some(arrival_s), _) if is_known => emitted_s.map(|emitted_s| arrival_s - emitted_s),
            (arrival_s, difference_s) => arrival_s.or(difference_s),
        };
        let range_m = number(RANGE)?.or(time_s.map(|time_s| time_s * self.sound_speed_m_s));
        let (forward_m, sideways_m, turn_rad) = (number(FORWARD)?, number(SIDEWAYS)?, number(TURN)?);
        let is_moved = forward_m.or(sideways_m).or(turn_rad).is_some();
        let motion = is_moved.then(|| Odometry {
            forward_m: forward_m.unwrap_or_default(),
            sideways_m: sideways_m.unwrap_or_default(),
            turn_rad: turn_rad.unwrap_or_default(),
        });
        let truth = number(TRUE_X)?.zip(number(TRUE_Y)?);
        let heading_rad = number(TRUE_HEADING)?.unwrap_or_default();
        let heard = self.heard(cells, line, range_m)?;
        let pulse = self.sent(cells, line, heard)?;
        let time_cell = if self.has(T) { T } else { ARRIVAL };
        Ok(Row {
            line,
            t_s,
            written: Written::of(self.cell(cells, time_cell)),
            emission: Some(self.cell(cells, EMISSION)).filter(|text| !text.is_empty()).map(str::to_owned),
            range: heard.filter(|_| pulse.is_none()),
            pulse,
            motion,
            truth: truth.map(|(x, y)| Pose { position: Point::new(x, y), heading_rad }),
            tool_on: self.tool_on(cells, line)?,
        })
    }

    /// The pulse of a row that names a sender.
    fn sent(&self, cells: &StringRecord, line: u64, heard: Option<Heard>) -> Result<Option<Sent>, Problem> {
        let written = self.cell(cells, SENDER);
        if written.is_empty() {
            return Ok(None);
        }
        let wrong = |what: String| Err(self.problem(line, SENDER, what));
        let Some(sender) = self.stations.get(written).copied() else {
            return wrong(format!("the scenario has no station `{written}`, only {}", self.station_names));
        };
        match heard {
            _ if self.kind() == Kind::Differences => wrong(format!(
                "the pulse of station {written} needs its time of emission; add the column emitted_s, or range_m"
            )),
            None => wrong(format!(
                "station {written} sent a pulse, but the row has no reading; name the station that heard it"
            )),
            Some(heard) if heard.station == sender => wrong(format!(
                "station {written} hears its own pulse; name the station that heard it in `station`"
            )),
            Some(heard) => self.possible(cells, line, Sent { sender, heard }).map(Some),
        }
    }

    /// Refuses a pulse whose length is impossible between its stations.
    fn possible(&self, cells: &StringRecord, line: u64, sent: Sent) -> Result<Sent, Problem> {
        let at = |id| self.places.iter().find(|(own, _)| *own == id).map(|(_, place)| *place);
        let distance_m = at(sent.sender).zip(at(sent.heard.station)).map_or(0.0, |(a, b)| (a - b).norm());
        let most_m = longest_pulse_m(distance_m);
        // The comparisons also refuse NaN.
        if sent.heard.range_m > 0.0 && sent.heard.range_m <= most_m {
            return Ok(sent);
        }
        let column = if self.has(RANGE) { RANGE } else { ARRIVAL };
        let (written, from, to) =
            (self.cell(cells, column), self.cell(cells, SENDER), self.cell(cells, STATION));
        let what = format!(
            "`{written}` is impossible for a pulse from station {from} to {to}, which are {distance_m:.2} m apart: \
             the length must be above 0 and at most {most_m:.2} m"
        );
        Err(self.problem(line, column, what))
    }

    fn tool_on(&self, cells: &StringRecord, line: u64) -> Result<Option<bool>, Problem> {
        match self.cell(cells, TOOL_ON).to_lowercase().as_str() {
            "" => Ok(None),
            "1" | "true" | "on" | "yes" => Ok(Some(true)),
            "0" | "false" | "off" | "no" => Ok(Some(false)),
            other => {
                Err(self.problem(line, TOOL_ON, format!("`{other}` is neither on nor off; write 1 or 0")))
            }
        }
    }

    fn heard(&self, cells: &StringRecord, line: u64, range_m: Option<f64>) -> Result<Option<Heard>, Problem> {
        let written = self.cell(cells, STATION);
        let measured = [RANGE, ARRIVAL, DIFFERENCE].into_iter().find(|column| self.has(*column));
        let range_m = match (written.is_empty(), range_m) {
            (true, None) => return Ok(None),
            (true, Some(_)) => {
                return Err(self.problem(line, STATION, "empty, but the row has a reading".into()));
            }
            (false, None) => {
                let column = measured.filter(|column| self.cell(cells, *column).is_empty());
                return Err(self.problem(
                    line,
                    column.unwrap_or(EMITTED),
                    format!("empty, but the row names station {written}"),
                ));
            }
            (false, Some(range_m)) => range_m,
        };
        let station = *self.stations.get(written).ok_or_else(|| {
            let what = format!("the scenario has no station `{written}`, only {}", self.station_names);
            self.problem(line, STATION, what)
        })?;
        let repetitions = match self.cell(cells, REPETITIONS) {
            "" => 1,
            text => {
                let number = text.parse().ok().filter(|n| (1..=REPETITIONS_MAX).contains(n));
                number.ok_or_else(|| {
                    self.problem(
                        line,
                        REPETITIONS,
                        format!("`{text}` is not a whole number from 1 to {REPETITIONS_MAX}"),
                    )
                })?
            }
        };
        Ok(Some(Heard { station, range_m, repetitions }))
    }

    fn cell<'a>(&self, cells: &'a StringRecord, column: usize) -> &'a str {
        self.at[column].and_then(|(index, _)| cells.get(index)).unwrap_or_default()
    }

    fn number(&self, cells: &StringRecord, line: u64, column: usize) -> Result<Option<f64>, Problem> {
        let (text, Some((_, factor))) = (self.cell(cells, column), self.at[column]) else { return Ok(None) };
        if text.is_empty() {
            return Ok(None);
        }
        if [T, ARRIVAL, EMITTED].contains(&column) && clock::is_date(text) {
            return clock::seconds(text).map(Some).map_err(|what| self.problem(line, column, what));
        }
        if let Some(seconds) = clock::seconds_of_day(text).filter(|_| [T, ARRIVAL, EMITTED].contains(&column))
        {
            return Ok(Some(seconds));
        }
        let parsed = if self.has_commas { text.replace(',', ".").parse::<f64>() } else { text.parse() };
        // A word that an instrument writes for "no range" is treated as an impossible range, not as a bad row.
        let is_word = [RANGE, ARRIVAL, DIFFERENCE].contains(&column) && (column != ARRIVAL || self.has(T));
        let number = parsed.ok().filter(|number| number.is_finite() || is_word);
        let number = number.ok_or_else(|| self.problem(line, column, format!("`{text}` is not a number")))?;
        if factor <= DATED {
            let what = format!(
                "`{text}` has no unit; name the column t_s, t_ms or t_us, or write date, time and zone, such as {}",
                clock::EXAMPLE
            );
            return Err(self.problem(line, column, what));
        }
        Ok(Some(number * factor))
    }

    /// Returns a problem with the time in a row.
    pub(crate) fn wrong_time(&self, line: u64, what: String) -> Problem {
        self.problem(line, if self.has(T) { T } else { ARRIVAL }, what)
    }

    fn problem(&self, line: u64, column: usize, what: String) -> Problem {
        let name = self.at[column].map_or(COLUMNS[column].0, |(index, _)| self.names[index].as_str());
        Problem { line, column: Some(name.to_owned()), what, is_end: false }
    }
}

/// Finds the one of [`COLUMNS`] that a name such as `range_mm` or `Range [mm]` stands for, and its factor.
fn known(name: &str) -> Option<(usize, f64)> {
    let lower = name.to_lowercase().replace(['µ', 'μ'], "u");
    let words: Vec<&str> =
        lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let mut name = words.join("_");
    if let Some(unit) = name.strip_prefix("timestamp").or(name.strip_prefix("time")) {
        name = format!("t{unit}");
    }
    COLUMNS.iter().enumerate().find_map(|(index, (base, units))| {
        let suffix = name.strip_prefix(base)?;
        let (_, factor) = units.iter().find(|(unit, _)| *unit == suffix)?;
        Some((index, *factor))
    })
}
