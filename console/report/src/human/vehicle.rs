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
    lines.extend(warnings(vehicle).into_iter().map(|warning| ("WARNING", warning)));
    lines.extend(at_end(vehicle).map(|at_end| ("at the end", at_end.to_owned())));
    lines
}

/// The vehicle, its link and its stops, as sentences.
pub(crate) fn sentences(vehicle: &VehicleRecord) -> String {
    let VehicleRecord { name, at, .. } = vehicle;
    let at_end = at_end(vehicle).map(|at_end| format!(" At the end: {at_end}.")).unwrap_or_default();
    let mut more: Vec<String> =
        warnings(vehicle).into_iter().map(|warning| format!("WARNING: {warning}.")).collect();
    more.insert(0, String::new());
    let warnings = more.join(" ").trim_end().to_owned();
    format!(
        "Vehicle {name} at {at}. Link: {}. Stops: {}.{warnings}{at_end} No figure in this report was compared with a true \
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

/// The facts about the vehicle and its link that make the data of the run doubtful.
fn warnings(vehicle: &VehicleRecord) -> Vec<String> {
    let mut warnings = Vec::new();
    if let (Some(first), Some(last)) = (&vehicle.fault_first, &vehicle.fault_last) {
        let last = if vehicle.faulty > 1 { format!("; the last: {last}") } else { String::new() };
        let number = counted(vehicle.faulty, "faulty message");
        warnings.push(format!("{number} ignored; the first: {first}{last}"));
    }
    let others = vehicle.others.iter();
    warnings.extend(others.map(|other| format!("another vehicle answered and was not driven: {other}")));
    warnings.extend(vehicle.clock_rate.map(|rate| {
        format!("the vehicle's clock advanced {rate:.3} s in each second of the console's clock, so ages are wrong")
    }));
    if vehicle.console_stopped_s > 0.0 {
        let s = vehicle.console_stopped_s;
        warnings
            .push(format!("the console itself was stopped for {s:.1} s, and sent no commands in this time"));
    }
    warnings
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
        vehicle.faulty = 200;
        vehicle.fault_first = Some("readings.seq: missing field".into());
        vehicle.fault_last = Some("state.mode: unknown".into());
        (vehicle.clock_rate, vehicle.console_stopped_s) = (Some(0.8), 4.0);
        vehicle.others = vec!["b (`name` is \"b\" instead of \"a\")".into()];
        let page = sentences(&vehicle);
        for (label, says) in lines(&vehicle).into_iter().skip(1) {
            assert!(page.contains(&says), "{label}: {says}: {page}");
        }
        for says in [
            "at least 66 readings",
            "motion unknown for at least 1.50 s",
            "go to the vehicle",
            "200 faulty messages ignored; the first: readings.seq: missing field; the last: state.mode: unknown",
            "another vehicle answered and was not driven: b",
            "advanced 0.800 s",
            "stopped for 4.0 s",
        ] {
            assert!(page.contains(says), "{page}");
        }
    }
}
