//! One row of an indications file.

use super::{
    Flown,
    moment::Clock,
    table::{Cells, Fault, NUMBERS, Table},
};
use foreign::unplain;
use world::Point;

/// Largest number that can be a position or a size.
const MOST: f64 = 1e9;

/// A row whose cells were read and are within their limits.
pub(super) struct Row<'a> {
    table: &'a Table,
    cells: &'a Cells,
    pub(super) run: Option<String>,
    t_s: Option<f64>,
    clock: Option<Clock>,
    pub(super) left_m: f64,
    pub(super) ahead_m: f64,
    /// Position of the indication, if the row has coordinates.
    pub(super) at: Option<Point>,
    pub(super) kind: String,
    pub(super) size_mm: Option<f64>,
    pub(super) depth_mm: Option<f64>,
    pub(super) note: String,
}

impl<'a> Row<'a> {
    /// Reads a row.
    ///
    /// # Errors
    /// All faults in the cells of the row.
    pub(super) fn of(
        table: &'a Table,
        cells: &'a Cells,
        thickness_mm: Option<f64>,
    ) -> Result<Self, Vec<Fault>> {
        let mut faults = Vec::new();
        let [t_s, left_m, ahead_m, x_m, y_m, size_mm, depth_mm] = NUMBERS.map(|name| {
            number(table.cell(cells, name)).unwrap_or_else(|what| {
                faults.push(fault(cells, name, what));
                None
            })
        });
        let clock = Some(table.cell(cells, "time")).filter(|text| !text.is_empty()).and_then(|text| {
            let read = Clock::read(text);
            if read.is_none() {
                let right = "write 2026-11-24T07:40:12Z, or 07:40:12 (UTC)";
                faults.push(fault(cells, "time", format!("`{text}` is not a time; {right}")));
            }
            read
        });
        for name in ["kind", "note"] {
            if let Some(odd) = unplain(table.cell(cells, name)) {
                faults.push(fault(cells, name, format!("must be plain text, without {odd}")));
            }
        }
        for (name, mm) in [("size_mm", size_mm), ("depth_mm", depth_mm)] {
            if let Some(mm) = mm.filter(|mm| *mm <= 0.0) {
                faults.push(fault(cells, name, format!("{mm}: must be above 0")));
            }
        }
        if let Some((mm, most_mm)) = depth_mm.zip(thickness_mm).filter(|(mm, most_mm)| mm > most_mm) {
            let what = format!(
                "{mm}: must be at most {most_mm}, the plate thickness (inspection.nominal_thickness_mm)"
            );
            faults.push(fault(cells, "depth_mm", what));
        }
        let is_bad = |name: &str| faults.iter().any(|fault| fault.column.as_deref() == Some(name));
        let place_fault = match (x_m, y_m, t_s.is_some() || clock.is_some()) {
            (Some(_), Some(_), _) if left_m.or(ahead_m).is_some() => {
                Some(("left_m", "x_m and y_m already give the position: leave left_m and ahead_m empty"))
            }
            (Some(_), Some(_), true) => {
                Some(("x_m", "the row gives both a time and a position: leave one of the two empty"))
            }
            (Some(_), None, _) if !is_bad("y_m") => {
                Some(("y_m", "missing; x_m and y_m must be given together"))
            }
            (None, Some(_), _) if !is_bad("x_m") => {
                Some(("x_m", "missing; x_m and y_m must be given together"))
            }
            (None, None, false) if !["t_s", "time", "x_m", "y_m"].into_iter().any(is_bad) => {
                Some(("t_s", "missing; give the time, or the position in x_m and y_m"))
            }
            _ => None,
        };
        faults.extend(place_fault.map(|(name, what)| fault(cells, name, what.to_owned())));
        if !faults.is_empty() {
            return Err(faults);
        }
        let text = |name| table.cell(cells, name).to_owned();
        Ok(Self {
            table,
            cells,
            run: Some(text("run")).filter(|name| !name.is_empty()),
            t_s,
            clock,
            left_m: left_m.unwrap_or(0.0),
            ahead_m: ahead_m.unwrap_or(0.0),
            at: x_m.zip(y_m).map(|(x, y)| Point::new(x, y)),
            kind: text("kind"),
            size_mm,
            depth_mm,
            note: text("note"),
        })
    }

    /// A fault in one of the row's cells.
    pub(super) fn fault(&self, column: &str, what: String) -> Fault {
        fault(self.cells, column, what)
    }

    /// The row's text in a column.
    pub(super) fn text_of(&self, column: &str) -> &str {
        self.table.cell(self.cells, column)
    }

    /// The mission time of the indication, seconds, and the column that gives it.
    pub(super) fn mission_time(&self, run: &Flown<'_>) -> Result<(&'static str, f64), Fault> {
        match (&self.clock, run.began) {
            (None, _) => Ok(("t_s", self.t_s.unwrap_or(0.0))),
            (Some(clock), Some(began)) => Ok(("time", clock.after_s(began))),
            (Some(_), None) => {
                let what = format!(
                    "the folder name of run {} does not contain its start time; give t_s, the mission time",
                    run.name
                );
                Err(self.fault("time", what))
            }
        }
    }
}

fn fault(cells: &Cells, column: &str, what: String) -> Fault {
    Fault { line: cells.line, column: Some(column.to_owned()), what }
}

/// A number with a decimal point or a decimal comma; `None` for an empty cell.
fn number(text: &str) -> Result<Option<f64>, String> {
    if text.is_empty() {
        return Ok(None);
    }
    let marks = text.chars().filter(|mark| matches!(mark, ',' | '.')).count();
    let read = if marks > 1 { None } else { text.replace(',', ".").parse::<f64>().ok() };
    match read {
        Some(value) if value.is_finite() && value.abs() <= MOST => Ok(Some(value)),
        Some(_) => Err(format!("`{text}`: must be a finite number")),
        None => Err(format!(
            "`{text}` is not a number; write 12.5 or 12,5, without thousands separators or units"
        )),
    }
}
