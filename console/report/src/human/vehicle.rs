//! What a report says about a real vehicle: in the summary and on the first page of a document.

use super::text::counted;
use account::VehicleRecord;

/// The vehicle, its link and its stops, as labelled lines.
pub(super) fn lines(vehicle: &VehicleRecord) -> Vec<(&'static str, String)> {
    let VehicleRecord { name, at, .. } = vehicle;
    let mut lines = vec![
        ("vehicle", format!("{name} at {at}; a live run has no figures that need the true position")),
        ("link", link(vehicle)),
        ("stops", stops(vehicle)),
    ];
    lines.extend(at_end(vehicle).map(|at_end| ("at the end", at_end.to_owned())));
    lines
}

/// The vehicle, its link and its stops, as sentences.
pub(crate) fn sentences(vehicle: &VehicleRecord) -> String {
    let VehicleRecord { name, at, .. } = vehicle;
    let at_end = at_end(vehicle).map(|at_end| format!(" At the end: {at_end}.")).unwrap_or_default();
    format!(
        "Vehicle {name} at {at}. Link: {}. Stops: {}.{at_end} No figure in this report was compared with a true \
         position.",
        link(vehicle),
        stops(vehicle),
    )
}

fn link(vehicle: &VehicleRecord) -> String {
    let VehicleRecord { heard, missed, faulty, age_p99_s, lost, .. } = vehicle;
    let sent = heard + missed;
    let (least, loss) = match (vehicle.at_least, sent) {
        (true, _) => ("at least ", String::new()),
        (false, 0) => ("", " (0.0 %)".to_owned()),
        (false, _) => ("", format!(" ({:.1} %)", 100.0 * *missed as f64 / sent as f64)),
    };
    let age = age_p99_s.map(|s| format!(", age on arrival p99 {:.0} ms", 1e3 * s)).unwrap_or_default();
    let unmeasured = match vehicle.unmeasured_s {
        s if s > 0.0 => format!(", motion unknown for {least}{s:.2} s"),
        _ => String::new(),
    };
    format!(
        "{least}{heard} readings, {least}{missed} missing{loss}{age}, {least}{}, lost {}{unmeasured}",
        counted(*faulty, "faulty message"),
        counted(*lost, "time"),
    )
}

fn stops(vehicle: &VehicleRecord) -> String {
    let most = vehicle.stop_max_s.map(|s| format!(" within {s:.2} s")).unwrap_or_default();
    let not = match vehicle.stops_not_confirmed {
        0 => String::new(),
        n => format!("; STOP NOT CONFIRMED {}", counted(n, "time")),
    };
    format!("{} confirmed by odometry{most}{not}", counted(vehicle.stops, "stop"))
}

fn at_end(vehicle: &VehicleRecord) -> Option<&'static str> {
    Some(if vehicle.stands? {
        "the vehicle stands still, confirmed by odometry"
    } else {
        "STOP NOT CONFIRMED: go to the vehicle and make sure that it stands still"
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_says_all_that_the_summary_says() {
        let mut vehicle = VehicleRecord::default();
        (vehicle.heard, vehicle.at_least, vehicle.unmeasured_s) = (66, true, 1.5);
        (vehicle.stops_not_confirmed, vehicle.stands) = (1, Some(false));
        let page = sentences(&vehicle);
        for (label, says) in lines(&vehicle).into_iter().skip(1) {
            assert!(page.contains(&says), "{label}: {says}: {page}");
        }
        for says in ["at least 66 readings", "motion unknown for at least 1.50 s", "go to the vehicle"] {
            assert!(page.contains(says), "{page}");
        }
    }
}
