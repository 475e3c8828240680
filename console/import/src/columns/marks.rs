//! Determines whether the numbers of a list use a decimal point or a decimal comma, and whether this mark might instead
//! separate thousands.

/// One millimetre in metres. Columns are not measured to the micrometre, so three digits after a mark in millimetres
/// may be a group of thousands.
const MILLIMETRE_M: f64 = 1e-3;

/// A number with a mark, and its position.
#[derive(Debug, Clone)]
struct Seen {
    line: u64,
    field: String,
    written: String,
}

/// The marks seen so far in the numbers of a list.
#[derive(Debug, Default)]
pub(super) struct Marks {
    /// The current line.
    pub line: u64,
    point: Option<Seen>,
    comma: Option<Seen>,
    /// The first number in millimetres whose mark may be a thousands separator.
    grouped: Option<Seen>,
    /// Whether another number shows that the mark is a decimal mark.
    has_decimals: bool,
}

impl Marks {
    /// Inspects a number as written.
    pub(super) fn see(&mut self, written: &str, field: &str, unit_m: f64) {
        let is_number =
            !written.is_empty() && written.chars().all(|c| c.is_ascii_digit() || "+-.,".contains(c));
        let Some(at) = written.find(['.', ',']).filter(|_| is_number) else { return };
        let seen = || Seen { line: self.line, field: field.to_owned(), written: written.to_owned() };
        let mark = if written[at..].starts_with('.') { &mut self.point } else { &mut self.comma };
        mark.get_or_insert_with(seen);
        let before = written[..at].trim_start_matches(['+', '-']);
        let is_grouped =
            written.len() - at == 4 && (1..=3).contains(&before.len()) && !before.starts_with('0');
        if (unit_m - MILLIMETRE_M).abs() < 1e-9 && is_grouped {
            self.grouped.get_or_insert_with(seen);
        } else {
            self.has_decimals = true;
        }
    }

    /// The line, field and reason if the meaning of the numbers is ambiguous.
    pub(super) fn doubt(self) -> Option<(u64, String, String)> {
        if let (Some(point), Some(comma)) = (&self.point, &self.comma) {
            let [first, second] = if (point.line, &point.field) <= (comma.line, &comma.field) {
                [point, comma]
            } else {
                [comma, point]
            };
            let what = format!(
                "`{}`, and `{}` in line {}: two decimal marks in one list; use only one, and no thousands \
                 separators",
                second.written, first.written, first.line
            );
            return Some((second.line, second.field.clone(), what));
        }
        let Seen { line, field, written } = self.grouped.filter(|_| !self.has_decimals)?;
        let [short, long] = [
            written.split(['.', ',']).next().unwrap_or_default().to_owned(),
            written.replace(['.', ','], ""),
        ];
        let what =
            format!("`{written}` could be {short} mm or {long} mm; write it without thousands separators");
        Some((line, field, what))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn doubt(numbers: &[&str], unit_m: f64) -> Option<String> {
        let mut marks = Marks::default();
        for (index, number) in numbers.iter().enumerate() {
            marks.line = index as u64 + 2;
            marks.see(number, "x", unit_m);
        }
        marks.doubt().map(|(line, _, what)| format!("{line}: {what}"))
    }

    #[test]
    fn two_marks_are_named_with_both_lines() {
        let what = doubt(&["4000", "4.000", "12", "250,5"], 1e-3).unwrap();
        assert!(what.starts_with("5: `250,5`, and `4.000` in line 3: two decimal marks"), "{what}");
        assert!(doubt(&["250,5", "1.25"], 1.0).unwrap().starts_with("3: `1.25`, and `250,5` in line 2"));
        assert_eq!(doubt(&["250,5", "1,25", "7"], 1.0), None);
    }

    #[test]
    fn thousands_are_suspected_where_all_numbers_in_millimetres_look_like_it() {
        assert!(doubt(&["500", "4.000", "-12.500"], 1e-3).unwrap().contains("could be 4 mm or 4000 mm"));
        assert!(doubt(&["4,000"], 1e-3).unwrap().contains("could be 4 mm or 4000 mm"));
        for clear in [["4.000", "1.5"], ["4.000", "0.250"], ["4.000", "2500.125"]] {
            assert_eq!(doubt(&clear, 1e-3), None, "{clear:?}");
        }
        assert_eq!(doubt(&["4.000", "1.250"], 1.0), None);
    }
}
