//! When the tool was on: a column of the readings, or a file of its own.

use csv::{ReaderBuilder, StringRecord, Trim};
use foreign::read_regular;
use std::path::Path;

/// Stretches of time in which the tool was on, put together out of moments.
#[derive(Debug, Default)]
pub(crate) struct Stretches {
    all: Vec<[f64; 2]>,
    is_on: bool,
}

impl Stretches {
    /// A moment at a time, seconds, from which on the tool is on or off; a moment that does not say it leaves it as it was.
    pub(crate) fn take(&mut self, t_s: f64, tool_on: Option<bool>) {
        if let Some(last) = self.all.last_mut().filter(|_| self.is_on) {
            last[1] = t_s;
        }
        if tool_on == Some(true) && !self.is_on {
            self.all.push([t_s, t_s]);
        }
        self.is_on = tool_on.unwrap_or(self.is_on);
    }

    /// The stretches, in order.
    pub(crate) fn finish(self) -> Vec<[f64; 2]> {
        self.all
    }
}

/// Reads a file of stretches: CSV with the columns `from_s` and `to_s`, by the clock of the readings.
///
/// # Errors
/// It cannot be read; a stretch that ends before it begins, or that begins before the one before it ends: with the line.
pub(crate) fn read(file: &Path) -> Result<Vec<[f64; 2]>, String> {
    let text = read_regular(file).map_err(|error| error.to_string())?;
    let mut reader = ReaderBuilder::new().trim(Trim::All).comment(Some(b'#')).from_reader(text.as_bytes());
    let header = reader.headers().map_err(|error| error.to_string())?.clone();
    let column = |name: &str| {
        let at = header.iter().position(|head| head.to_lowercase() == name);
        at.ok_or_else(|| format!("line 1: no column {name}; the columns are from_s and to_s, seconds by the clock of the readings"))
    };
    let columns = [("from_s", column("from_s")?), ("to_s", column("to_s")?)];
    let mut all: Vec<[f64; 2]> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| error.to_string())?;
        let line = record.position().map_or(0, csv::Position::line);
        let [from_s, to_s] = columns.map(|(name, at)| number(&record, line, name, at));
        let stretch = [from_s?, to_s?];
        if stretch[1] <= stretch[0] {
            return Err(format!("line {line}: to_s {} must be later than from_s {}", stretch[1], stretch[0]));
        }
        if let Some([_, before_s]) = all.last().filter(|before| stretch[0] < before[1]) {
            return Err(format!(
                "line {line}: from_s {} is before the end of the line above, {before_s}",
                stretch[0]
            ));
        }
        all.push(stretch);
    }
    Ok(all)
}

fn number(record: &StringRecord, line: u64, name: &str, at: usize) -> Result<f64, String> {
    let text = record.get(at).unwrap_or_default();
    let number = text.parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| format!("line {line}: {name}: `{text}` is not a number of seconds"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    #[test]
    fn moments_make_stretches_that_last_until_something_else_is_said() {
        let said = [None, Some(true), None, Some(true), Some(false), None, Some(true)];
        let mut stretches = Stretches::default();
        for (t_s, said) in (0_u8..).zip(said) {
            stretches.take(f64::from(t_s), said);
        }
        assert_eq!(stretches.finish(), [[1.0, 4.0], [6.0, 6.0]]);
    }

    #[test]
    fn a_file_of_stretches_is_read_or_refused_with_its_line() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("on.csv");
        let of = |text: &str| {
            std::fs::write(&file, text).unwrap();
            read(&file)
        };
        assert_eq!(of("# tool\nfrom_s, to_s\n1, 2.5\n2.5, 4\n").unwrap(), [[1.0, 2.5], [2.5, 4.0]]);
        assert_eq!(of("to_s,from_s\n").unwrap(), Vec::<[f64; 2]>::new());
        assert!(of("from_s\n1\n").unwrap_err().starts_with("line 1: no column to_s"));
        assert_eq!(of("from_s,to_s\n1,2\n3,3\n").unwrap_err(), "line 3: to_s 3 must be later than from_s 3");
        assert!(
            of("from_s,to_s\n1,2\n1.5,3\n").unwrap_err().starts_with("line 3: from_s 1.5 is before the end")
        );
        assert_eq!(
            of("from_s,to_s\nsoon,2\n").unwrap_err(),
            "line 2: from_s: `soon` is not a number of seconds"
        );
    }
}
