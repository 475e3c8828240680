//! Rows as people read them.

use crate::study::Row;
use std::fmt::Write;

/// The rows for people: a block for each case and method, its notes below.
pub fn table(rows: &[Row]) -> String {
    let mut text = String::new();
    for block in rows.chunk_by(|a, b| (&a.case, &a.method) == (&b.case, &b.method)) {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}  {}", block[0].case, block[0].method);
        let _ = writeln!(text, "  {:<32} {:>12} {:>12}  {:<8} {:>6}", "", "paper", "ours", "", "n");
        for row in block {
            let (paper, ours) = (number(row.paper), number(row.ours));
            let _ =
                writeln!(text, "  {:<32} {paper:>12} {ours:>12}  {:<8} {:>6}", row.metric, row.unit, row.n);
        }
        for note in notes(block) {
            let _ = writeln!(text, "  {note}");
        }
        text.push('\n');
    }
    text
}

/// Every note of a block once, with the metric it belongs to if it is not of all.
fn notes(block: &[Row]) -> Vec<String> {
    let is_new = |(index, row): &(usize, &Row)| {
        !row.note.is_empty() && block[..*index].iter().all(|other| other.note != row.note)
    };
    let is_of_all = block.iter().all(|row| row.note == block[0].note);
    let new = block.iter().enumerate().filter(is_new);
    new.map(|(_, row)| if is_of_all { row.note.clone() } else { format!("{}: {}", row.metric, row.note) })
        .collect()
}

fn number(value: Option<f64>) -> String {
    match value {
        None => "-".into(),
        Some(0.0) => "0".into(),
        Some(value) if value.abs() < 1e-3 => format!("{value:.2e}"),
        Some(value) => format!("{value:.4}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Block;

    #[test]
    fn rows_are_printed_in_blocks_with_their_notes_once() {
        let block = Block { table: "t", case: "d1/disk", method: "rpf", note: "" };
        let rows = [
            block.row("rmse", 0.25, "m", 3).printed(0.266).note("gated"),
            block.row("rmse_median", None, "m", 3).note("gated"),
            block.row("collisions", 0.0, "m", 3).note("at 0.3 m"),
        ];
        insta::assert_snapshot!(table(&rows));
    }
}
