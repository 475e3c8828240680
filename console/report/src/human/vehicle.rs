//! The lines of the summary about a real vehicle.

use super::text::counted;
use account::VehicleRecord;

/// The vehicle, its link and its stops, as labelled lines.
pub(super) fn lines(vehicle: &VehicleRecord) -> Vec<(&'static str, String)> {
    let VehicleRecord { name, at, heard, missed, faulty, age_p99_s, lost, .. } = vehicle;
    let sent = heard + missed;
    let loss = if sent == 0 { 0.0 } else { 100.0 * *missed as f64 / sent as f64 };
    let age = age_p99_s.map(|s| format!(", age on arrival p99 {:.0} ms", 1e3 * s)).unwrap_or_default();
    let unmeasured = match vehicle.unmeasured_s {
        s if s > 0.0 => format!(", motion unknown for {s:.2} s"),
        _ => String::new(),
    };
    let mut lines = vec![
        ("vehicle", format!("{name} at {at}; a live run has no figures that need the true position")),
        (
            "link",
            format!(
                "{} readings, {missed} missing ({loss:.1} %){age}, {}, lost {}{unmeasured}",
                heard,
                counted(*faulty, "faulty message"),
                counted(*lost, "time"),
            ),
        ),
    ];
    let most = vehicle.stop_max_s.map(|s| format!(" within {s:.2} s")).unwrap_or_default();
    let not = match vehicle.stops_not_confirmed {
        0 => String::new(),
        n => format!("; STOP NOT CONFIRMED {}", counted(n, "time")),
    };
    let stops = counted(vehicle.stops, "stop");
    lines.push(("stops", format!("{stops} confirmed by odometry{most}{not}")));
    lines.extend(vehicle.stands.map(|stands| {
        let at_end = if stands {
            "the vehicle stands still, confirmed by odometry"
        } else {
            "STOP NOT CONFIRMED: go to the vehicle and make sure that it stands still"
        };
        ("at the end", at_end.to_owned())
    }));
    lines
}
