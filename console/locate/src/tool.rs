//! Determines when the tool was on, from a column of the readings or a file of its own.

use crate::{clock, rows::Rows};
use csv::StringRecord;
use std::path::Path;

/// Collects, from the moments of the readings, the stretches of time in which the tool was on.
#[derive(Debug, Default)]
pub(crate) struct Stretches {
    all: Vec<[f64; 2]>,
    is_on: bool,
    is_said: bool,
}

impl Stretches {
    /// Adds a moment at a time, in seconds, from which the tool is on or off; `None` leaves its state unchanged.
    pub(crate) fn take(&mut self, t_s: f64, tool_on: Option<bool>) {
        if let Some(last) = self.all.last_mut().filter(|_| self.is_on) {
            last[1] = t_s;
        }
        if tool_on == Some(true) && !self.is_on {
            self.all.push([t_s, t_s]);
        }
        self.is_on = tool_on.unwrap_or(self.is_on);
        self.is_said |= tool_on.is_some();
    }

    /// Returns the stretches in order; `None` if no moment states whether the tool is on.
    pub(crate) fn finish(self) -> Option<Vec<[f64; 2]>> {
        self.is_said.then_some(self.all)
    }
}

/// Reads a file of stretches: a table with the columns `from_s` and `to_s` (or `from` and `to`). Its times use the
/// clock of the readings, in any form that readings may use.
///
/// # Errors
/// The file cannot be read, or a stretch ends before it begins or overlaps the one before it. The message names the
/// line.
pub(crate) fn read(file: &Path) -> Result<Vec<[f64; 2]>, String> {
    let mut rows = Rows::open(file)?;
    let header = rows.header().clone();
    let column = |name: &str| {
        let is_it = |head: &str| {
            let head = head.to_lowercase();
            head == name || head.strip_suffix("_s") == Some(name)
        };
        let at = header.iter().position(is_it);
        at.ok_or_else(|| {
            format!("line 1: column {name}_s is missing; use from_s and to_s, by the clock of the readings")
        })
    };
    let columns = [("from_s", column("from")?), ("to_s", column("to")?)];
    let has_commas = rows.has_commas();
    let mut cells = StringRecord::new();
    let mut all: Vec<[f64; 2]> = Vec::new();
    while let Some(line) = rows.next(&mut cells).map_err(|problem| problem.to_string())? {
        let time = |(name, at): (&str, usize)| {
            let text = cells.get(at).unwrap_or_default();
            clock::time_s(text, has_commas).map_err(|what| format!("line {line}: {name}: {what}"))
        };
        let stretch = [time(columns[0])?, time(columns[1])?];
        if stretch[1] <= stretch[0] {
            return Err(format!("line {line}: to_s {} must be later than from_s {}", stretch[1], stretch[0]));
        }
        if let Some([_, before_s]) = all.last().filter(|before| stretch[0] < before[1]) {
            return Err(format!(
                "line {line}: from_s {} is before the end of the previous stretch, {before_s}",
                stretch[0]
            ));
        }
        all.push(stretch);
    }
    Ok(all)
}

/// Reports a stretch outside the span of the readings: the file uses a different clock.
pub(crate) fn outside(stretches: &[[f64; 2]], span: [f64; 2]) -> Option<String> {
    let [first_s, last_s] = span;
    let [from_s, to_s] = stretches.iter().find(|[from_s, to_s]| *to_s < first_s || *from_s > last_s)?;
    Some(format!(
        "the stretch from {from_s} to {to_s} s lies outside the readings, which run from {first_s} to {last_s} s; \
         use the same clock in both files"
    ))
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
        assert_eq!(stretches.finish(), Some(vec![[1.0, 4.0], [6.0, 6.0]]));
        assert_eq!(Stretches::default().finish(), None);
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
        // Times in all forms that readings may use.
        assert_eq!(of("from;to\n1,5;2,5\n").unwrap(), [[1.5, 2.5]]);
        assert_eq!(of("from,to\n07:40:00,07:40:01.5\n").unwrap(), [[27_600.0, 27_601.5]]);
        let dated = of("from_s,to_s\n1970-01-01T00:00:10Z,1970-01-01T00:00:12Z\n").unwrap();
        assert_eq!(dated, [[10.0, 12.0]]);
        assert!(of("from_s\n1\n").unwrap_err().starts_with("line 1: column to_s is missing"));
        assert_eq!(of("from_s,to_s\n1,2\n3,3\n").unwrap_err(), "line 3: to_s 3 must be later than from_s 3");
        assert!(
            of("from_s,to_s\n1,2\n1.5,3\n").unwrap_err().starts_with("line 3: from_s 1.5 is before the end")
        );
        assert_eq!(
            of("from_s,to_s\nsoon,2\n").unwrap_err(),
            "line 2: from_s: `soon` is not a time; write seconds, a time of day (07:40:12.250), or a date (2026-10-25T02:59:58.250Z)"
        );
    }

    #[test]
    fn stretches_by_another_clock_are_named() {
        assert_eq!(outside(&[[28_770.0, 28_780.0], [28_800.0, 28_900.0]], [28_770.0, 28_830.0]), None);
        let said = outside(&[[10.0, 20.0]], [28_770.0, 28_830.0]).unwrap();
        assert!(said.starts_with("the stretch from 10 to 20 s lies outside the readings"), "{said}");
    }
}
