//! The account of the floor as tables in the document beside the map.

use super::figures::missed;
use account::{Account, Shares};
use std::fmt::Write;

/// Maximum number of missed areas listed; the report has all of them.
const MOST_AREAS: usize = 60;

/// The tables of a floor: all of it, plate by plate, and the missed areas.
pub(crate) fn floor(account: &Account, is_over: bool) -> String {
    // Writing to a String cannot fail.
    let mut text = String::from("\n## Floor\n\n");
    let has_untestable = account.whole.untestable > 0.0;
    let (head, rule) = if has_untestable { (" not testable % |", "---|") } else { ("", "") };
    let _ = writeln!(
        text,
        "| part | area m² | scanned % | guaranteed % | missed % | unreachable % | margin % | 95 % error m |{head}"
    );
    let _ = writeln!(text, "|---|---|---|---|---|---|---|---|{rule}");
    let mut add = |name: &str, shares: &Shares, error_m: Option<f64>| {
        row(&mut text, name, shares, error_m);
        if has_untestable {
            let _ = write!(text, " {:.1} |", shares.percent.untestable);
        }
        text.push('\n');
    };
    add("whole floor", &account.whole, None);
    add("reachable floor", &account.reachable, None);
    for plate in &account.plates {
        add(&plate.name, &plate.shares, plate.error_p95_m);
    }
    let areas = missed(&account.missed, is_over);
    if areas.is_empty() {
        return text;
    }
    text.push_str("\n## Missed areas\n\n| no. | area m² | at, m | plate | why |\n|---|---|---|---|---|\n");
    for (area, number) in areas.iter().take(MOST_AREAS).zip(1..) {
        let (at, plate) = (area.at, area.plate.as_deref().unwrap_or("–"));
        let (area_m2, why) = (area.area_m2, area.why());
        let _ = writeln!(text, "| {number} | {area_m2:.2} | {:.1}, {:.1} | {plate} | {why} |", at.x, at.y);
    }
    if let Some(more) = areas.len().checked_sub(MOST_AREAS).filter(|more| *more > 0) {
        let _ = writeln!(text, "\n{more} more are in the report.");
    }
    text
}

fn row(text: &mut String, name: &str, shares: &Shares, error_m: Option<f64>) {
    let percent = shares.percent;
    let optional = |number: Option<f64>, decimals: usize| {
        number.map_or_else(|| "–".to_owned(), |number| format!("{number:.decimals$}"))
    };
    let _ = write!(
        text,
        "| {name} | {:.1} | {:.1} | {} | {:.1} | {:.1} | {:.1} | {} |",
        shares.area_m2,
        percent.scanned,
        optional(percent.guaranteed, 1),
        percent.missed,
        percent.unreachable,
        percent.margin,
        optional(error_m, 3)
    );
}
