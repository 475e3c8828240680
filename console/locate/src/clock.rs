//! Times with a date, as instruments write them (RFC 3339).

use jiff::{
    Timestamp,
    civil::{DateTime, Time},
};

/// A time as it is to be written.
pub(crate) const EXAMPLE: &str = "2026-10-25T02:59:58.250Z";

/// Whether a cell begins with a date.
pub(crate) fn is_date(cell: &str) -> bool {
    let bytes = cell.as_bytes();
    bytes.len() >= 8 && bytes[..4].iter().all(u8::is_ascii_digit) && bytes[4] == b'-'
}

/// Seconds since midnight of a time of day, as `07:40:12.250` or `07:40:12,250`; `None` if it is not one.
pub(crate) fn seconds_of_day(cell: &str) -> Option<f64> {
    let time: Time = cell.replace(',', ".").parse().ok().filter(|_| cell.matches(':').count() == 2)?;
    let whole = f64::from(time.hour()) * 3600.0 + f64::from(time.minute()) * 60.0 + f64::from(time.second());
    Some(whole + f64::from(time.subsec_nanosecond()) * 1e-9)
}

/// Seconds since 1970 of a time with date and zone.
pub(crate) fn seconds(cell: &str) -> Result<f64, String> {
    match cell.parse::<Timestamp>() {
        Ok(time) => Ok(time.as_second() as f64 + f64::from(time.subsec_nanosecond()) * 1e-9),
        Err(_) if cell.parse::<DateTime>().is_ok() => Err(format!(
            "`{cell}` states no zone; append Z if it is UTC, or the difference from it, as +01:00"
        )),
        Err(_) => Err(format!("`{cell}` is not a time; write date, time and zone, as {EXAMPLE}")),
    }
}

/// Seconds since 1970 as a time of UTC.
pub(crate) fn written(seconds: f64) -> String {
    let time = Timestamp::from_millisecond((seconds * 1e3).round() as i64);
    time.map_or_else(|_| format!("{seconds} s"), |time| time.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_every_zone_are_one_time() {
        for text in [
            "2026-10-25T02:59:58.250Z",
            "2026-10-25T03:59:58.250+01:00",
            "2026-10-25 02:59:58.250Z",
            "2026-10-24T21:29:58,25-05:30",
        ] {
            assert!(is_date(text));
            assert_eq!(seconds(text), Ok(1_792_897_198.25), "{text}");
        }
        assert_eq!(written(1_792_897_198.25), "2026-10-25T02:59:58.25Z");
    }

    #[test]
    fn times_of_day_are_seconds_since_midnight() {
        assert_eq!(seconds_of_day("07:40:12,250"), Some(27_612.25));
        assert_eq!(seconds_of_day("00:00:00"), Some(0.0));
        for text in ["7.5", "07:40", "25:00:00", "2026-10-25T02:59:58Z", ""] {
            assert_eq!(seconds_of_day(text), None, "{text}");
        }
    }

    #[test]
    fn a_time_without_a_zone_is_refused_with_what_to_add() {
        assert!(seconds("2026-10-25T02:59:58").unwrap_err().contains("append Z"));
        assert!(seconds("2026-13-25T02:59:58Z").unwrap_err().contains("is not a time"));
        assert!(!is_date("12.5") && !is_date("-3") && !is_date("2026.5"));
    }
}
