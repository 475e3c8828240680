//! Indications of the scanning instrument, placed on the track by time, or by coordinates.

mod moment;
mod row;
mod table;
#[cfg(test)]
mod tests;

pub(super) use moment::began;

use crate::record::Record;
use jiff::Timestamp;
use row::Row;
use serde::Serialize;
use table::{Fault, Table};
use world::{Point, geometry::unit_vector};

/// Maximum number of faults listed; any others are only counted.
const LISTED: usize = 20;
/// Rounding error of a value given in whole millimetres; metres.
const ROUNDING_M: f64 = 1e-3;

/// An indication with its position.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Indication {
    /// Number of the indication, from 1.
    pub number: usize,
    /// Name of the run in which the indication was found; absent if the file gives only coordinates and there are
    /// several runs.
    pub run: Option<String>,
    /// Mission time, seconds; absent if the file gives only coordinates.
    pub t_s: Option<f64>,
    /// Position of the indication, tank frame, metres.
    pub at: Point,
    /// 95 % error of the position, metres; absent if the file gives coordinates.
    pub error_m: Option<f64>,
    /// The plate at this position; absent if the plate layout is not known.
    pub plate: Option<String>,
    /// Kind of the indication, as given by the instrument.
    pub kind: String,
    /// Size, millimetres.
    pub size_mm: Option<f64>,
    /// Depth, millimetres.
    pub depth_mm: Option<f64>,
    /// Remarks.
    pub note: String,
}

/// A run on whose track indications can be placed.
pub(super) struct Flown<'a> {
    /// Name of the run's folder.
    pub(super) name: &'a str,
    pub(super) record: &'a Record,
    /// The date and time at which mission time was 0, to the second; absent if the folder name does not contain it.
    pub(super) began: Option<Timestamp>,
    /// Half the swath, metres.
    pub(super) reach_m: f64,
}

/// The floor on which indications are placed.
pub(super) struct Ground<'a> {
    /// Thickness of the plates, millimetres, if known.
    pub(super) thickness_mm: Option<f64>,
    /// The nearest solid object and the distance to it, metres; negative inside it or outside the tank.
    pub(super) nearest_solid: &'a dyn Fn(Point) -> (String, f64),
    /// The plate at a position.
    pub(super) plate_at: &'a dyn Fn(Point) -> Option<String>,
}

/// Reads indications from text whose first line names the columns; these are [`row::COLUMNS`]. An indication is
/// placed at its coordinates or, if it has none, where the tool was at that time according to the estimated position.
/// With several runs, the column `run` is required.
///
/// # Errors
/// All faults in the file, one line each: file, line, column, and how to correct it.
pub(super) fn indications(
    (file, text): (&str, &str),
    runs: &[Flown<'_>],
    ground: &Ground<'_>,
) -> Result<Vec<Indication>, String> {
    let table = Table::read(text).map_err(|fault| format!("{file}: {fault}"))?;
    let mut faults: Vec<Fault> = table.broken.clone();
    faults.extend(table.mixed_marks());
    if runs.len() > 1 && table.has("t_s").or(table.has("time")).is_some() && table.has("run").is_none() {
        let what = format!(
            "there are several runs: add a column `run` with the run of each indication, one of {}",
            names(runs)
        );
        return Err(format!("{file}: line 1: {what}"));
    }
    let mut placed = Vec::new();
    for (number, cells) in (1..).zip(&table.rows) {
        let found = Row::of(&table, cells, ground.thickness_mm)
            .and_then(|row| row.placed(number, runs, ground).map_err(|fault| vec![fault]));
        match found {
            Ok(indication) => placed.push(indication),
            Err(found) => faults.extend(found),
        }
    }
    if faults.is_empty() {
        return Ok(placed);
    }
    faults.sort_by_key(|fault| fault.line);
    let more = faults.len().saturating_sub(LISTED);
    let mut lines: Vec<String> = faults.iter().take(LISTED).map(|fault| format!("{file}: {fault}")).collect();
    if more > 0 {
        lines.push(format!("{file}: faults not listed: {more}"));
    }
    Err(lines.join("\n"))
}

fn names(runs: &[Flown<'_>]) -> String {
    runs.iter().map(|run| run.name).collect::<Vec<_>>().join(", ")
}

impl Row<'_> {
    /// Places the indication of a row.
    fn placed(self, number: usize, runs: &[Flown<'_>], ground: &Ground<'_>) -> Result<Indication, Fault> {
        let (run, t_s, at, error_m) = match self.at {
            Some(at) => (self.run_of(runs)?, None, at, None),
            None => self.on_track(runs)?,
        };
        let column = if self.at.is_some() { "x_m" } else { "t_s" };
        let (name, off_m) = (ground.nearest_solid)(at);
        if off_m < -error_m.unwrap_or(0.0) - ROUNDING_M {
            let place = format!("{:.3}, {:.3} m", at.x, at.y);
            let what = if name == "the shell" {
                format!("{place} is {:.3} m outside the tank", -off_m)
            } else {
                format!("{place} is {:.3} m inside {name}", -off_m)
            };
            return Err(self.fault(column, format!("{what}, where no floor can be scanned")));
        }
        Ok(Indication {
            number,
            run: run.map(|run| run.name.to_owned()),
            t_s,
            at,
            error_m,
            plate: (ground.plate_at)(at),
            kind: self.kind,
            size_mm: self.size_mm,
            depth_mm: self.depth_mm,
            note: self.note,
        })
    }

    /// The position of the tool at the time given in a row.
    fn on_track<'r>(&self, runs: &'r [Flown<'r>]) -> Result<Placed<'r>, Fault> {
        let run =
            self.run_of(runs)?.ok_or_else(|| self.fault("run", format!("must be one of {}", names(runs))))?;
        let (column, t_s) = self.mission_time(run)?;
        let end_s = run.record.track.last().map_or(0.0, |point| f64::from(point.t_s));
        let point = run.record.at(t_s).filter(|_| (0.0..=end_s + 0.5).contains(&t_s)).ok_or_else(|| {
            let clock = if column == "time" {
                format!(" ({t_s:.1} s after the start of the run)")
            } else {
                String::new()
            };
            self.fault(column, format!("{}{clock}: the run covers 0 to {end_s:.1} s", self.text_of(column)))
        })?;
        for (name, offset_m) in [("left_m", self.left_m), ("ahead_m", self.ahead_m)] {
            if offset_m.abs() > run.reach_m + ROUNDING_M {
                let what = format!(
                    "{offset_m} is beyond the tool, which extends {} m (half the swath) from its centre",
                    run.reach_m
                );
                return Err(self.fault(name, what));
            }
        }
        let heading = f64::from(point.heading_rad);
        let left = unit_vector(heading + std::f64::consts::FRAC_PI_2);
        let at = point.position() + left * self.left_m + unit_vector(heading) * self.ahead_m;
        Ok((Some(run), Some(t_s), at, Some(f64::from(point.error_m))))
    }

    /// The run that a row names, or the only run; `None` if there are several and the row names none.
    fn run_of<'r>(&self, runs: &'r [Flown<'r>]) -> Result<Option<&'r Flown<'r>>, Fault> {
        let Some(name) = &self.run else { return Ok(runs.first().filter(|_| runs.len() == 1)) };
        let found = runs.iter().find(|run| run.name == name);
        found.map(Some).ok_or_else(|| self.fault("run", format!("{name}: must be one of {}", names(runs))))
    }
}

/// The run, the mission time, the position, and the 95 % error of the position.
type Placed<'a> = (Option<&'a Flown<'a>>, Option<f64>, Point, Option<f64>);
