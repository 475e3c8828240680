//! Section numbers and numbers as text.

/// The sections of a report on a task other than scanning, given by the numbers that they have in a scan report.
const WITHOUT_SCAN: [usize; 9] = [1, 2, 5, 7, 8, 9, 10, 11, 12];

/// Converts the number of a section in a scan report to its number in this report.
pub(super) fn number_of(is_to_scan: bool, section: usize) -> usize {
    let place = WITHOUT_SCAN.iter().position(|known| *known == section).map_or(section, |index| index + 1);
    if is_to_scan { section } else { place }
}

/// Formats a number with a sign and a fixed number of decimals; zero has no sign.
pub(super) fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let is_zero = text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.');
    if is_zero { text.trim_start_matches('-').to_owned() } else { text.replace('-', "\u{2212}") }
}

/// Converts metres to centimetres.
pub(super) fn cm(value_m: f64) -> String {
    number(100.0 * value_m, 1)
}

/// Formats a whole number with its digits in groups of three.
pub(super) fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let groups = digits.as_bytes().rchunks(3).rev().map(String::from_utf8_lossy);
    groups.collect::<Vec<_>>().join("\u{202f}")
}
