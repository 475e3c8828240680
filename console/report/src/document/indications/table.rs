//! Rows of cells under a header line.

use std::fmt;

/// The known columns.
const COLUMNS: [&str; 13] = [
    "run", "t_s", "time", "left_m", "ahead_m", "x_m", "y_m", "x", "y", "kind", "size_mm", "depth_mm", "note",
];
/// The columns that contain numbers.
pub(super) const NUMBERS: [&str; 7] = ["t_s", "left_m", "ahead_m", "x_m", "y_m", "size_mm", "depth_mm"];

/// A fault in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Fault {
    /// The line, from 1.
    pub(super) line: u64,
    /// Name of the column, if the fault is in a single cell.
    pub(super) column: Option<String>,
    /// What is wrong, and how to correct it.
    pub(super) what: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let column = self.column.as_ref().map(|name| format!(", {name}")).unwrap_or_default();
        write!(f, "line {}{column}: {}", self.line, self.what)
    }
}

/// The cells of a row, with its line number.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cells {
    pub(super) line: u64,
    cells: csv::StringRecord,
}

/// A table that was read.
#[derive(Debug)]
pub(super) struct Table {
    names: Vec<String>,
    pub(super) rows: Vec<Cells>,
    /// Faults of rows that could not be read at all.
    pub(super) broken: Vec<Fault>,
}

impl Table {
    /// Reads text whose cells are separated by commas, semicolons or tabs; the first line determines which.
    pub(super) fn read(text: &str) -> Result<Self, Fault> {
        // The reader increments the line count at the end of a line.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text).trim_end().to_owned() + "\n";
        let first =
            text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or_default();
        let delimiter =
            [b';', b'\t'].into_iter().find(|mark| first.as_bytes().contains(mark)).unwrap_or(b',');
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(delimiter)
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let at_line = |line: u64, what: String| Fault { line, column: None, what };
        let header = reader.headers().map_err(|error| at_line(1, error.to_string()))?;
        let names: Vec<String> = header.iter().map(str::to_lowercase).collect();
        for (index, name) in names.iter().enumerate() {
            if !COLUMNS.contains(&name.as_str()) {
                let known = COLUMNS.join(", ");
                return Err(at_line(1, format!("unknown column `{name}`; known columns: {known}")));
            }
            if names[..index].contains(name) {
                return Err(at_line(1, format!("column `{name}` occurs twice")));
            }
        }
        let (mut rows, mut broken) = (Vec::new(), Vec::new());
        loop {
            let mut cells = csv::StringRecord::new();
            let read = reader.read_record(&mut cells);
            // The CSV reader does not record where a row begins after comments and empty lines.
            let within = cells.as_slice().bytes().filter(|byte| *byte == b'\n').count() as u64;
            let line = reader.position().line().saturating_sub(1 + within);
            match read {
                Ok(true) => rows.push(Cells { line, cells }),
                Ok(false) => break,
                Err(error) => broken.push(unequal(line, &error)),
            }
        }
        let table = Self { names, rows, broken };
        match (table.has("t_s").or(table.has("time")), table.has("x_m").zip(table.has("y_m"))) {
            (None, None) => {
                Err(at_line(1, "no column gives the position: add t_s or time, or x_m and y_m".into()))
            }
            _ if table.has("x_m").is_some() != table.has("y_m").is_some() => {
                Err(at_line(1, "x_m and y_m must be given together".into()))
            }
            _ if table.has("t_s").is_some() && table.has("time").is_some() => {
                Err(at_line(1, "t_s and time both give the time: keep one".into()))
            }
            _ => Ok(table),
        }
    }

    /// The index of a column, if the table has it.
    pub(super) fn has(&self, name: &str) -> Option<usize> {
        let alias = match name {
            "x_m" => "x",
            "y_m" => "y",
            other => other,
        };
        self.names.iter().position(|known| known == name || known == alias)
    }

    /// The text of a row in a column; empty if there is no such column.
    pub(super) fn cell<'a>(&self, cells: &'a Cells, name: &str) -> &'a str {
        self.has(name).and_then(|index| cells.cells.get(index)).unwrap_or_default()
    }

    /// The fault of mixing decimal commas and decimal points in one file, which makes its numbers ambiguous.
    pub(super) fn mixed_marks(&self) -> Option<Fault> {
        let marked = |mark: char| {
            let has = |cells: &&Cells| NUMBERS.iter().any(|name| self.cell(cells, name).contains(mark));
            self.rows.iter().find(has).map(|cells| cells.line)
        };
        let (comma, point) = (marked(',')?, marked('.')?);
        let what = format!(
            "numbers with a decimal comma (line {comma}) and with a decimal point (line {point}); use the \
             same mark throughout"
        );
        Some(Fault { line: comma.min(point), column: None, what })
    }
}

fn unequal(line: u64, error: &csv::Error) -> Fault {
    let what = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => format!(
            "{len} cells, but the first line has {expected_len}; numbers with a decimal comma need \
             semicolons or tabs between cells"
        ),
        _ => error.to_string(),
    };
    Fault { line, column: None, what }
}
