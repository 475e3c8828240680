//! Lists of columns as CSV.

mod fields;
mod marks;

use crate::{
    error::ImportError,
    input::Input,
    plan::{FloorPlan, Named},
    text::decoded,
};
use fields::{Fields, Quantity};
use marks::Marks;
use std::collections::HashSet;
use world::{Boundary, Point, Shape};

/// Notes after which columns that stand in each other are no longer named one by one.
const MOST_NOTES: usize = 20;

/// Reads a list of round columns in a round tank of a radius, metres.
///
/// The first line names the fields: x, y, radius or diameter, each with its unit, as `x_m` or `X [mm]`, and perhaps `name`,
/// in any order, separated by commas, semicolons or tabs; but for commas, numbers may have a decimal comma. The origin is the
/// tank's centre. Lines that begin with `#` are skipped, and fields of other names listed. Columns that stand in each other are
/// named in the notes.
///
/// # Errors
/// Line and field of everything that is wrong.
pub fn read(input: &Input, tank_radius_m: f64) -> Result<FloorPlan, Vec<ImportError>> {
    // Lines are counted by their line feeds.
    let text = decoded(&input.bytes, None).replace("\r\n", "\n").replace('\r', "\n") + "\n";
    let wrong = |Wrong { line, field, what }: Wrong| ImportError {
        file: input.name.clone(),
        line: Some(line as usize),
        key: Some(field).filter(|field| !field.is_empty()),
        what,
    };
    let (rows, unused) = list(&text, tank_radius_m)
        .map_err(|problems| problems.into_iter().map(wrong).collect::<Vec<ImportError>>())?;
    let mut notes: Vec<String> = unused.iter().map(|field| format!("not used: field {field}")).collect();
    note_coincident(&rows, &mut notes);
    let obstacles: Vec<Named> = rows.into_iter().map(|(_, named)| named).collect();
    if obstacles.is_empty() {
        return Err(vec![ImportError::of_input(input, "no columns: below the first line there are no rows")]);
    }
    let boundary = Boundary::Circle { radius_m: tank_radius_m };
    Ok(FloorPlan { boundary, obstacles, no_go: Vec::new(), plates: Vec::new(), notes })
}

/// What is wrong in a line, perhaps in one of its fields.
struct Wrong {
    line: u64,
    field: String,
    what: String,
}

impl Wrong {
    fn new(line: u64, field: impl Into<String>, what: impl Into<String>) -> Self {
        Self { line, field: field.into(), what: what.into() }
    }
}

/// A column with its line.
type Row = (u64, Named);

/// The columns of a list, and the names of fields that are not used.
fn list(text: &str, tank_radius_m: f64) -> Result<(Vec<Row>, Vec<String>), Vec<Wrong>> {
    if let Some(at) = text.find('\0') {
        let line = text[..at].lines().count().max(1) as u64;
        return Err(vec![Wrong::new(line, "", "not a text: it holds a byte 0; save the list as CSV")]);
    }
    let delimiter = delimiter(text);
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let header = match reader.headers() {
        Ok(header) => header.clone(),
        Err(error) => return Err(vec![no_row(&error, line_of(&reader))]),
    };
    let first_line = line_of(&reader);
    let fields = Fields::new(&header).map_err(|(field, what)| vec![Wrong::new(first_line, field, what)])?;
    let (mut names, mut columns, mut problems) = (HashSet::new(), Vec::new(), Vec::new());
    let (mut record, mut marks) = (csv::StringRecord::new(), Marks::default());
    loop {
        let read = reader.read_record(&mut record);
        let line = line_of(&reader);
        match read {
            Ok(false) => break,
            Err(error) => {
                problems.push(no_row(&error, line));
                continue;
            }
            // Spreadsheets leave lines of empty cells behind a list.
            Ok(true) if record.iter().all(str::is_empty) => continue,
            Ok(true) => {}
        }
        marks.line = line;
        let disc = disc(&fields, &record, delimiter != b',', &mut marks, tank_radius_m);
        let shape = disc.map_err(|(field, what)| problems.push(Wrong::new(line, field, what))).ok();
        let given = fields.name(&record).filter(|name| !name.is_empty());
        let name = given.map_or_else(|| format!("column {}", columns.len() + 1), foreign::seen);
        if !names.insert(name.clone()) {
            problems.push(Wrong::new(line, "name", format!("`{name}` occurs twice")));
        }
        columns.extend(shape.map(|shape| (line, Named { name, shape })));
    }
    if let Some((line, field, what)) = marks.doubt() {
        // What the numbers mean comes before what they say.
        problems.insert(0, Wrong::new(line, field, what));
    }
    if problems.is_empty() { Ok((columns, fields.unused)) } else { Err(problems) }
}

/// The column of a row; otherwise the field that is wrong, and what is wrong with it.
fn disc(
    fields: &Fields,
    record: &csv::StringRecord,
    has_commas: bool,
    marks: &mut Marks,
    tank_radius_m: f64,
) -> Result<Shape, (String, String)> {
    let mut metres = |quantity| {
        fields.metres(record, quantity, has_commas, marks).map_err(|(field, what)| (field.to_owned(), what))
    };
    let (center, radius_m) =
        (Point::new(metres(Quantity::X)?, metres(Quantity::Y)?), metres(Quantity::Radius)?);
    if radius_m <= 0.0 {
        let what = format!("{radius_m} m for the radius; it must be greater than 0");
        return Err((fields.name_of(Quantity::Radius).to_owned(), what));
    }
    if center.coords.norm() - radius_m >= tank_radius_m {
        let what = format!(
            "({}, {}) lies outside the tank of {tank_radius_m} m; x and y count from its centre",
            center.x, center.y
        );
        return Err((fields.name_of(Quantity::X).to_owned(), what));
    }
    Ok(Shape::Disc { center, radius_m })
}

/// Names columns of which one stands on the centre of another: no two do.
fn note_coincident(rows: &[Row], notes: &mut Vec<String>) {
    let mut discs: Vec<(f64, Point, &Row)> = rows
        .iter()
        .filter_map(|row| match &row.1.shape {
            Shape::Disc { center, radius_m } => Some((*radius_m, *center, row)),
            _ => None,
        })
        .collect();
    discs.sort_by(|(_, a, _), (_, b, _)| a.x.total_cmp(&b.x));
    let widest_m = discs.iter().map(|(radius_m, ..)| *radius_m).fold(0.0, f64::max);
    for (index, (radius_m, at, (line, named))) in discs.iter().enumerate() {
        let near = discs[index + 1..].iter().take_while(|(_, other, _)| other.x - at.x < widest_m);
        for (other_m, other, (other_line, other_named)) in near {
            let apart_m = (other - at).norm();
            if apart_m >= radius_m.max(*other_m) {
                continue;
            }
            if notes.len() > MOST_NOTES {
                return notes.push("more columns overlap".into());
            }
            let (mut first, mut second) = ((line, &named.name), (other_line, &other_named.name));
            if first.0 > second.0 {
                std::mem::swap(&mut first, &mut second);
            }
            notes.push(format!(
                "`{}` (line {}) stands in `{}` (line {}): their centres are {:.0} mm apart",
                second.1,
                second.0,
                first.1,
                first.0,
                apart_m * 1000.0
            ));
        }
    }
}

/// Why a line is not a row.
fn no_row(error: &csv::Error, line: u64) -> Wrong {
    let what = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("{len} cells, but the first line names {expected_len}")
        }
        _ => format!("not a CSV file: {error}"),
    };
    Wrong::new(line, "", what)
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
