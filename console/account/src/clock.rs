//! Mission time as people read it.

/// A span of time as hours, minutes and whole seconds; what is left of a second is cut off.
///
/// ```
/// assert_eq!(account::clock(2480.9), "00:41:20");
/// ```
pub fn clock(seconds: f64) -> String {
    let whole = if seconds.is_finite() { seconds.max(0.0) as u64 } else { 0 };
    format!("{:02}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
}
