//! Lists of columns as CSV.

mod fields;

use crate::{
    error::{ImportError, read_file},
    plan::{FloorPlan, Named},
    text::decoded,
};
use fields::{Fields, Quantity};
use std::{collections::HashSet, path::Path};
use world::{Boundary, Point, Shape};

/// Reads a list of round columns in a round tank of a radius, metres.
///
/// The first line names the fields: x, y, radius or diameter, each with its unit, as `x_m` or `X [mm]`, and perhaps `name`,
/// in any order, separated by commas, semicolons or tabs; but for commas, numbers may have a decimal comma. The origin is the
/// tank's centre. Lines that begin with `#` are skipped, and fields of other names listed.
///
/// # Errors
/// File, line and field of what is wrong.
pub fn read(file: &Path, tank_radius_m: f64) -> Result<FloorPlan, ImportError> {
    // Lines are counted by their line feeds.
    let text = decoded(&read_file(file)?, None).replace("\r\n", "\n").replace('\r', "\n") + "\n";
    let wrong = |line: u64, key: &str, what: String| ImportError {
        file: file.display().to_string(),
        line: Some(line as usize),
        key: Some(key.to_owned()).filter(|key| !key.is_empty()),
        what,
    };
    if let Some(at) = text.find('\0') {
        let line = text[..at].lines().count().max(1) as u64;
        return Err(wrong(line, "", "no text: a byte 0; save the list as CSV".into()));
    }
    let delimiter = delimiter(&text);
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let bad = |error: &csv::Error, line: u64| {
        let what = match error.kind() {
            csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                format!("{len} cells, and the first line names {expected_len}")
            }
            _ => format!("not a CSV file: {error}"),
        };
        wrong(line, "", what)
    };
    let header = match reader.headers() {
        Ok(header) => header.clone(),
        Err(error) => return Err(bad(&error, line_of(&reader))),
    };
    let first_line = line_of(&reader);
    let fields = Fields::new(&header).map_err(|(field, what)| wrong(first_line, &field, what))?;
    let (mut names, mut obstacles) = (HashSet::new(), Vec::new());
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record).map_err(|error| bad(&error, line_of(&reader)))? {
        let line = line_of(&reader);
        // Spreadsheets leave lines of empty cells behind a list.
        if record.iter().all(str::is_empty) {
            continue;
        }
        let metres = |quantity: Quantity| {
            let has_commas = delimiter != b',';
            fields.metres(&record, quantity, has_commas).map_err(|(field, what)| wrong(line, field, what))
        };
        let (center, radius_m) =
            (Point::new(metres(Quantity::X)?, metres(Quantity::Y)?), metres(Quantity::Radius)?);
        if radius_m <= 0.0 {
            let what = format!("{radius_m} m for the radius; it must be greater than 0");
            return Err(wrong(line, fields.name_of(Quantity::Radius), what));
        }
        if center.coords.norm() - radius_m >= tank_radius_m {
            let what = format!(
                "({}, {}) lies outside the tank of {tank_radius_m} m; x and y count from its centre",
                center.x, center.y
            );
            return Err(wrong(line, fields.name_of(Quantity::X), what));
        }
        let given = fields.name(&record).filter(|name| !name.is_empty());
        let name = given.map_or_else(|| format!("column {}", obstacles.len() + 1), str::to_owned);
        if !names.insert(name.clone()) {
            return Err(wrong(line, "name", format!("`{name}` is there twice")));
        }
        obstacles.push(Named { name, shape: Shape::Disc { center, radius_m } });
    }
    if obstacles.is_empty() {
        return Err(ImportError::of_file(file, "no columns: below the first line there are no rows"));
    }
    let boundary = Boundary::Circle { radius_m: tank_radius_m };
    let notes = fields.unused.iter().map(|field| format!("not used: field {field}")).collect();
    Ok(FloorPlan { boundary, obstacles, no_go: Vec::new(), notes })
}

/// The line that a reader has come to: where a record begins is not kept behind comments and empty lines.
fn line_of(reader: &csv::Reader<&[u8]>) -> u64 {
    reader.position().line().saturating_sub(1).max(1)
}

/// What separates the cells of the line that names them.
fn delimiter(text: &str) -> u8 {
    let names = text.lines().find(|line| !line.starts_with('#')).unwrap_or_default();
    [b';', b'\t'].into_iter().find(|delimiter| names.contains(char::from(*delimiter))).unwrap_or(b',')
}

#[cfg(test)]
mod tests;
