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

/// Faults that are listed; of more the number is said.
const LISTED: usize = 20;
/// Rounding of what a file says in whole millimetres, metres.
const ROUNDING_M: f64 = 1e-3;

/// An indication with its place.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Indication {
    /// Its number, from 1.
    pub number: usize,
    /// Name of the run in which it was found; absent if its file says only where, and there are several runs.
    pub run: Option<String>,
    /// Mission time, seconds; absent if its file says only where.
    pub t_s: Option<f64>,
    /// Where it lies, metres.
    pub at: Point,
    /// 95 % error of the place, metres; absent if its file says where it lies.
    pub error_m: Option<f64>,
    /// The plate on which it lies; absent if the layout of the plates is not known.
    pub plate: Option<String>,
    /// What kind, as the instrument says.
    pub kind: String,
    /// Size, millimetres.
    pub size_mm: Option<f64>,
    /// Depth, millimetres.
    pub depth_mm: Option<f64>,
    /// Anything else.
    pub note: String,
}

/// A run on whose track indications can be placed.
pub(super) struct Flown<'a> {
    /// Name of its folder.
    pub(super) name: &'a str,
    pub(super) record: &'a Record,
    /// When its mission time was 0, to the second; absent if the name of its folder does not say.
    pub(super) began: Option<Timestamp>,
    /// Half the width that its tool scans, metres.
    pub(super) reach_m: f64,
}

/// What an indication can lie on.
pub(super) struct Ground<'a> {
    /// Thickness of the plates, if it is known, millimetres.
    pub(super) thickness_mm: Option<f64>,
    /// The nearest solid thing and the distance from it, metres; negative within it, or outside the tank.
    pub(super) nearest_solid: &'a dyn Fn(Point) -> (String, f64),
    /// The plate of a place.
    pub(super) plate_at: &'a dyn Fn(Point) -> Option<String>,
}

/// Reads indications from text with a line of names first; the columns are those of [`row::COLUMNS`]. Each is placed where the
/// robot believed its tool to be at its time, or where its coordinates say. `run` is needed with several runs.
///
/// # Errors
/// Everything that is wrong in the file, a line each: file, line, column, and what would be right.
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
            "with several runs, add a column `run` that names the run of each indication: {}",
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
        lines.push(format!("{file}: {more} more like these"));
    }
    Err(lines.join("\n"))
}

fn names(runs: &[Flown<'_>]) -> String {
    runs.iter().map(|run| run.name).collect::<Vec<_>>().join(", ")
}

impl Row<'_> {
    /// The indication of this row at its place.
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
                format!("{place} lies {:.3} m outside the tank", -off_m)
            } else {
                format!("{place} lies {:.3} m within {name}", -off_m)
            };
            return Err(self.fault(column, format!("{what}: not floor that could have been scanned")));
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

    /// Where the tool was at the time of this row.
    fn on_track<'r>(&self, runs: &'r [Flown<'r>]) -> Result<Placed<'r>, Fault> {
        let run =
            self.run_of(runs)?.ok_or_else(|| self.fault("run", format!("must be one of {}", names(runs))))?;
        let (column, t_s) = self.mission_time(run)?;
        let end_s = run.record.track.last().map_or(0.0, |point| f64::from(point.t_s));
        let point = run.record.at(t_s).filter(|_| (0.0..=end_s + 0.5).contains(&t_s)).ok_or_else(|| {
            let clock = if column == "time" {
                format!(" is {t_s:.1} s after its beginning, and")
            } else {
                String::new()
            };
            self.fault(
                column,
                format!("{}{clock}: the run lasts from 0 to {end_s:.1} s", self.text_of(column)),
            )
        })?;
        for (name, offset_m) in [("left_m", self.left_m), ("ahead_m", self.ahead_m)] {
            if offset_m.abs() > run.reach_m + ROUNDING_M {
                let what = format!(
                    "{offset_m} lies beyond the tool: at most {} m from its centre, half of the swath",
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

    /// The run that this row names, or the only one; none if it names none of several.
    fn run_of<'r>(&self, runs: &'r [Flown<'r>]) -> Result<Option<&'r Flown<'r>>, Fault> {
        let Some(name) = &self.run else { return Ok(runs.first().filter(|_| runs.len() == 1)) };
        let found = runs.iter().find(|run| run.name == name);
        found.map(Some).ok_or_else(|| self.fault("run", format!("{name}: must be one of {}", names(runs))))
    }
}

/// The run, the mission time, the place, and its 95 % error.
type Placed<'a> = (Option<&'a Flown<'a>>, Option<f64>, Point, Option<f64>);
