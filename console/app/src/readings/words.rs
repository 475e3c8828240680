//! The results of an import as text.

use ::locate::thickness::{Gap, Placed};
use account::clock;
use world::coverage::percent_text;

/// Maximum number of gaps that are listed.
const MOST_GAPS: usize = 12;

/// Why a file is refused: every kind of fault with its number, and the first faults.
pub(super) fn refused(file: &str, placed: &Placed) -> String {
    let faults = &placed.faults;
    let mut lines = vec![format!("{file}: refused: {}", kinds(placed))];
    lines.extend(faults.listed.iter().map(|fault| format!("{file}: {fault}")));
    if faults.unlisted() > 0 {
        lines.push(format!("{file}: faults not listed: {}", faults.unlisted()));
    }
    lines.push(
        "correct the file, or add --skip-bad-rows: it places all other readings and keeps the faulty rows in \
         readings-refused.csv"
            .to_owned(),
    );
    lines.join("\n")
}

/// The kinds of faults, each with its number and its lines.
fn kinds(placed: &Placed) -> String {
    let kind = |(kind, fault): (&&str, &::locate::thickness::Fault)| {
        let lines = if fault.first_line == fault.last_line {
            format!("line {}", fault.first_line)
        } else {
            format!("lines {} to {}", fault.first_line, fault.last_line)
        };
        format!("{kind}: {} ({lines})", fault.count)
    };
    placed.faults.kinds.iter().map(kind).collect::<Vec<_>>().join("; ")
}

/// What was found in a file, as sentences for the report.
pub(super) fn notes(placed: &Placed) -> Vec<String> {
    let mut notes = Vec::new();
    notes.push(match placed.clock_sigma_s {
        0.0 => format!("clock offset {:+.3} s", placed.clock_offset_s),
        sigma_s => format!("clock offset {:+.3} s, standard deviation {sigma_s:.3} s", placed.clock_offset_s),
    });
    let drift = placed.clock_drift_s_per_h;
    if drift.abs() > 0.005 {
        let way = if drift > 0.0 { "loses" } else { "gains" };
        notes.push(format!("the clock of the instrument {way} {:.2} s an hour; corrected", drift.abs()));
    }
    if placed.faults.count() > 0 {
        notes.push(format!("left out: {}", kinds(placed)));
    }
    if let Some(line) = placed.first_out_of_order {
        notes.push(format!("out of order: {} readings, the first in line {line}", placed.out_of_order));
    }
    if placed.uncounted > 0 {
        notes.push(format!(
            "{} readings where floor does not count as scanned are not judged",
            placed.uncounted
        ));
    }
    if placed.lost > 0 {
        let share = placed.lost as f64 / (placed.lost + placed.readings.count) as f64;
        let percent = percent_text(share, 1);
        notes.push(format!("lost on the scanned way: {} readings ({percent} %)", placed.lost));
    }
    notes.extend(placed.gaps.iter().take(MOST_GAPS).map(gap));
    if placed.gaps.len() > MOST_GAPS {
        notes.push(format!("gaps not listed: {}", placed.gaps.len() - MOST_GAPS));
    }
    notes
}

fn gap(gap: &Gap) -> String {
    format!(
        "{}: no readings from {} to {} ({:.1} s, {:.1} m of the scanned way); the floor under {} was not tested",
        channels(&gap.channels),
        clock(gap.from_s),
        clock(gap.to_s),
        gap.to_s - gap.from_s,
        gap.way_m,
        if gap.channels.len() == 1 { "it" } else { "them" }
    )
}

/// Numbers of channels, with runs of numbers as a range.
fn channels(numbers: &[u16]) -> String {
    let mut ranges: Vec<[u16; 2]> = Vec::new();
    for number in numbers {
        match ranges.last_mut() {
            Some([_, to]) if *to + 1 == *number => *to = *number,
            _ => ranges.push([*number, *number]),
        }
    }
    let range = |[from, to]: &[u16; 2]| if from == to { from.to_string() } else { format!("{from} to {to}") };
    let text = ranges.iter().map(range).collect::<Vec<_>>().join(", ");
    format!("channel{} {text}", if numbers.len() == 1 { "" } else { "s" })
}

/// A number with its noun.
fn counted(count: u64, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// The results for people.
pub(super) fn human(placed: &Placed) -> String {
    let readings = &placed.readings;
    let mut lines = vec![format!(
        "placed         {} of {}, {} of them not judged; {}",
        counted(readings.count, "reading"),
        counted(placed.rows, "row"),
        readings.untestable,
        counted(readings.indications, "indication")
    )];
    if let Some(deepest) = &readings.deepest {
        lines.push(format!(
            "deepest        {:.1} ± {:.1} mm at {:.2}, {:.2} m",
            deepest.depth_mm, deepest.depth_error_mm, deepest.at.x, deepest.at.y
        ));
    }
    lines.extend(notes(placed).into_iter().map(|note| format!("note           {note}")));
    if !placed.ignored_columns.is_empty() {
        lines.push(format!("ignored        columns {}", placed.ignored_columns.join(", ")));
    }
    lines.extend(placed.faults.listed.iter().map(|fault| format!("left out       {fault}")));
    lines.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_in_a_row_are_a_range() {
        assert_eq!(channels(&[3]), "channel 3");
        assert_eq!(channels(&[0, 1, 2, 5, 7, 8]), "channels 0 to 2, 5, 7 to 8");
    }
}
