//! Reads lists of columns from CSV files.

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

/// The largest number of overlaps that are listed individually in the notes.
const MOST_NOTES: usize = 20;

/// Reads a list of round columns in a round tank of the given radius, in metres.
///
/// The first line names the fields: x, y, and radius or diameter, each with its unit, as in `x_m` or `X [mm]`, and
/// optionally `name`. Fields can be in any order, separated by commas, semicolons or tabs. Unless commas separate the
/// fields, numbers may have a decimal comma. The origin is the tank's centre. Lines that begin with `#` are skipped.
/// The notes list unknown fields, and pairs of columns in which one covers the centre of the other.
///
/// # Errors
/// Every problem, with its line and field.
pub fn read(input: &Input, tank_radius_m: f64) -> Result<FloorPlan, Vec<ImportError>> {
    // Convert all line ends to line feeds, by which lines are counted.
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
        return Err(vec![ImportError::of_input(
            input,
            "no columns: the list has no rows below the first line",
        )]);
    }
    let boundary = Boundary::Circle { radius_m: tank_radius_m };
    Ok(FloorPlan { boundary, obstacles, no_go: Vec::new(), plates: Vec::new(), notes })
}

/// A problem in a line, optionally in one of the line's fields.
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

/// A column with its line number.
type Row = (u64, Named);

/// Parses a list; returns its columns and the names of unused fields.
fn list(text: &str, tank_radius_m: f64) -> Result<(Vec<Row>, Vec<String>), Vec<Wrong>> {
    if let Some(at) = text.find('\0') {
        let line = text[..at].lines().count().max(1) as u64;
        return Err(vec![Wrong::new(
            line,
            "",
            "not a text file: contains a zero byte; save the list as CSV",
        )]);
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
            // Spreadsheets write lines of empty cells after a list.
            Ok(true) if record.iter().all(str::is_empty) => continue,
            Ok(true) => {}
        }
        marks.line = line;
        let disc = disc(&fields, &record, delimiter != b',', &mut marks, tank_radius_m);
        let shape = disc.map_err(|(field, what)| problems.push(Wrong::new(line, field, what))).ok();
        let given = fields.name(&record).filter(|name| !name.is_empty());
        let name = given.map_or_else(|| format!("column {}", columns.len() + 1), foreign::seen);
        if !names.insert(name.clone()) {
            problems.push(Wrong::new(line, "name", format!("the name `{name}` is used twice")));
        }
        columns.extend(shape.map(|shape| (line, Named { name, shape })));
    }
    if let Some((line, field, what)) = marks.doubt() {
        // Report ambiguous numbers before any problem with their values.
        problems.insert(0, Wrong::new(line, field, what));
    }
    if problems.is_empty() { Ok((columns, fields.unused)) } else { Err(problems) }
}

/// The shape of the column in a row. An error states the field and its problem.
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
        let what = format!("the radius is {radius_m} m; it must be greater than 0");
        return Err((fields.name_of(Quantity::Radius).to_owned(), what));
    }
    if center.coords.norm() - radius_m >= tank_radius_m {
        let what = format!(
            "({}, {}) is outside the tank of radius {tank_radius_m} m; x and y are measured from its centre",
            center.x, center.y
        );
        return Err((fields.name_of(Quantity::X).to_owned(), what));
    }
    Ok(Shape::Disc { center, radius_m })
}

/// Notes each pair of columns in which one contains the centre of the other; real columns cannot overlap like this.
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
                "`{}` (line {}) overlaps `{}` (line {}): their centres are {:.0} mm apart",
                second.1,
                second.0,
                first.1,
                first.0,
                apart_m * 1000.0
            ));
        }
    }
}

/// The problem in a line that is not a valid row.
fn no_row(error: &csv::Error, line: u64) -> Wrong {
    let what = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("{len} cell{}, but the first line has {expected_len}", if *len == 1 { "" } else { "s" })
        }
        _ => format!("not a CSV file: {error}"),
    };
    Wrong::new(line, "", what)
}

/// The line that the reader has reached. The position of its current record is wrong after comments and empty lines.
fn line_of(reader: &csv::Reader<&[u8]>) -> u64 {
    reader.position().line().saturating_sub(1).max(1)
}

/// The separator of the cells in the first line.
fn delimiter(text: &str) -> u8 {
    let names = text.lines().find(|line| !line.starts_with('#')).unwrap_or_default();
    [b';', b'\t'].into_iter().find(|delimiter| names.contains(char::from(*delimiter))).unwrap_or(b',')
}

#[cfg(test)]
mod tests;
