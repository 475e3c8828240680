//! Mission time in a human-readable format.

/// Formats a time span as hours, minutes and whole seconds; fractions of a second are cut off.
///
/// ```
/// assert_eq!(mission::clock(2480.9), "00:41:20");
/// ```
pub fn clock(seconds: f64) -> String {
    let whole = if seconds.is_finite() { seconds.max(0.0) as u64 } else { 0 };
    format!("{:02}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
}
