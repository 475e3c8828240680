//! Formats rows as human-readable text and for spreadsheets.

use crate::study::{Row, without_seed, wrong_signs};
use std::fmt::Write;

/// Maximum number of blocks without a seed that are named; the others are only counted.
const MOST_NAMED: usize = 12;
/// The size below which a number is printed as 0.
const ZERO: f64 = 1e-15;

/// Formats the rows as human-readable text: a block for each case and method, with its notes below it; then the claims
/// that are not reproduced, and the rows that do not depend on a seed.
pub fn table(rows: &[Row]) -> String {
    let mut text = String::new();
    for block in rows.chunk_by(|a, b| (&a.case, &a.method) == (&b.case, &b.method)) {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}  {}", block[0].case, block[0].method);
        let _ = writeln!(
            text,
            "  {:<32} {:>12} {:>12}  {:<8} {:>6} {:>12}  95 % interval",
            "", "paper", "ours", "", "n", "difference"
        );
        for row in block {
            let line = line(row);
            let _ = writeln!(text, "{}", line.trim_end());
        }
        for note in notes(block) {
            let _ = writeln!(text, "  {note}");
        }
        text.push('\n');
    }
    text + &account(rows)
}

fn line(row: &Row) -> String {
    let (paper, ours, difference) = (number(row.paper), number(row.ours), number(row.difference));
    let interval = interval(row.interval_95);
    let verdict = row.verdict.map(|verdict| match &*row.why {
        "" => verdict.words().to_owned(),
        why => format!("{}: {why}", verdict.words()),
    });
    let seed = if row.seeded || row.paper.is_none() { "" } else { " (no seed)" };
    format!(
        "  {:<32} {paper:>12} {ours:>12}  {:<8} {:>6} {difference:>12}  {interval:<25} {}{seed}",
        row.metric,
        row.unit,
        row.n,
        verdict.unwrap_or_default()
    )
}

/// The summary of all rows: the number of each verdict, claims with a different sign, rows without a seed.
fn account(rows: &[Row]) -> String {
    let mut text = String::new();
    let printed: Vec<&Row> = rows.iter().filter(|row| row.verdict.is_some()).collect();
    let count =
        |words: &str| printed.iter().filter(|row| row.verdict.is_some_and(|v| v.words() == words)).count();
    if !printed.is_empty() {
        let fitted = match count("fitted") {
            0 => String::new(),
            n => format!(", {n} equally close, but with a number or a layout fitted to the printed values"),
        };
        let _ = writeln!(
            text,
            "rows with a printed value: {}; {} reproduced (within 5 %, or in the interval of one draw where \
             one is printed), {} better, {} not reproduced{fitted}",
            printed.len(),
            count("reproduced"),
            count("better"),
            count("not reproduced")
        );
    }
    for sentence in wrong_signs(rows) {
        let _ = writeln!(text, "the sign of a claim of the paper is not reproduced: {sentence}");
    }
    let blocks = without_seed(rows);
    if !blocks.is_empty() {
        let n: usize = blocks.iter().map(|(_, n)| n).sum();
        let rows = if n == 1 { "row" } else { "rows" };
        let named: Vec<&str> = blocks.iter().take(MOST_NAMED).map(|(name, _)| name.as_str()).collect();
        let more = match blocks.len().saturating_sub(MOST_NAMED) {
            0 => String::new(),
            more => format!("; blocks not named here: {more}"),
        };
        let _ = writeln!(
            text,
            "--first-seed has no effect on {n} {rows}, because no random draws are involved: {}{more}",
            named.join("; ")
        );
    }
    text
}

/// Formats the rows for spreadsheets: a header, then a line for each row.
pub fn csv(rows: &[Row]) -> String {
    let mut text = String::from(
        "table,case,method,metric,paper,ours,unit,n,difference,interval_95_low,interval_95_high,interval_of_one_draw,verdict,\
         why,seeded,claim,note\n",
    );
    for row in rows {
        let [low, high] = row.interval_95.map_or([None; 2], |ends| ends.map(Some));
        let plain = |value: Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
        let fields = [
            row.table.clone(),
            row.case.clone(),
            row.method.clone(),
            row.metric.clone(),
            plain(row.paper),
            plain(row.ours),
            row.unit.clone(),
            row.n.to_string(),
            plain(row.difference),
            plain(low),
            plain(high),
            row.is_of_one_draw.to_string(),
            row.verdict.map(|verdict| verdict.words().to_owned()).unwrap_or_default(),
            row.why.clone(),
            row.seeded.to_string(),
            row.is_claim.to_string(),
            row.note.clone(),
        ];
        text += &fields.map(|field| quoted(&field)).join(",");
        text.push('\n');
    }
    text
}

/// Formats a CSV field.
fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.into()
    }
}

/// Lists every note of a block once, with its metric if the note does not apply to all.
fn notes(block: &[Row]) -> Vec<String> {
    let is_new = |(index, row): &(usize, &Row)| {
        !row.note.is_empty() && block[..*index].iter().all(|other| other.note != row.note)
    };
    let is_of_all = block.iter().all(|row| row.note == block[0].note);
    let new = block.iter().enumerate().filter(is_new);
    new.map(|(_, row)| if is_of_all { row.note.clone() } else { format!("{}: {}", row.metric, row.note) })
        .collect()
}

fn interval(ends: Option<[f64; 2]>) -> String {
    ends.map(|[low, high]| format!("{} to {}", number(Some(low)), number(Some(high)))).unwrap_or_default()
}

fn number(value: Option<f64>) -> String {
    match value {
        None => "-".into(),
        // Rounding errors of a bound that is zero.
        Some(value) if value.abs() < ZERO => "0".into(),
        Some(value) if value.abs() < 1e-3 => format!("{value:.2e}"),
        Some(value) => format!("{value:.4}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::{Block, judged};

    fn rows() -> Vec<Row> {
        let block = Block { table: "t", case: "d1/disk", method: "rpf", note: "" };
        let claim = Block { case: "mean/disk", method: "rpf against iapf", ..block };
        let rows = [
            block.row("rmse", 0.25, "m", 3).printed(0.266).note("gated").within(Some([0.2, 0.3])),
            block.row("rmse_median", None, "m", 3).note("gated"),
            block.row("collisions", 0.0, "m", 3).note("at 0.3 m"),
            claim.row("rmse_reduction", -0.3, "", 3).printed(0.0949).claimed(Some([-0.4, -0.2])),
        ];
        let stop = Block { table: "u", ..block }.row("stop_x", 40.0, "m", 1).printed(44.3).note("a, \"b\"");
        rows.into_iter().map(|row| judged(row, true)).chain([judged(stop, false)]).collect()
    }

    #[test]
    fn rows_are_printed_in_blocks_with_their_notes_once() {
        insta::assert_snapshot!(table(&rows()));
    }

    #[test]
    fn a_rounding_error_is_printed_as_zero_and_a_small_number_is_not() {
        let block = Block { table: "t", case: "all", method: "ranges", note: "" };
        let printed = |low| table(&[block.row("beyond_rate", 0.001, "", 1000).within(Some([low, 0.0013]))]);
        assert!(printed(1.08e-19).contains(" 0 to 0.0013"), "{}", printed(1.08e-19));
        assert!(printed(1.08e-9).contains(" 1.08e-9 to 0.0013"), "{}", printed(1.08e-9));
    }

    #[test]
    fn a_row_is_a_line_for_spreadsheets() {
        let text = csv(&rows());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 6);
        assert_eq!(
            lines[1],
            "t,d1/disk,rpf,rmse,0.266,0.25,m,3,-0.016000000000000014,0.2,0.3,false,not reproduced,\"ours is \
             6.0 % below the printed value, but the interval contains the printed value: use more layouts to \
             decide\",true,false,gated"
        );
        assert!(lines[5].ends_with(",false,false,\"a, \"\"b\"\"\""), "{}", lines[5]);
        assert!(
            lines[4].contains(",not reproduced,\"the sign of the claim is not reproduced: printed +9.5 %"),
            "{}",
            lines[4]
        );
    }
}
